"""Friction heat of the interface problem: initial temperatures, temperature fields, heat steps."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...balances import relative
from ...contact.operators.exchange_matrix import BaselineResponse, ThermalState
from ...contact.operators.heat_exchange import InterfaceHeat
from ..system.conditions import InterfaceConditions
from ..system.system import System
from ..system.thermal_system import ThermalSystem
from . import heat_steps
from .heat_steps import ROUNDING, HeatBalance, HeatStep, HeatSteps, StoredHeat
from .varying_heat import VaryingHeatSteps

_FIRST_DEPTH = 1e-3
"""Penetration depth of heat in the first step, relative to the length of the contact."""
_FIRST_RISE = 0.1
"""Surface temperature rise allowed in the first step [K]."""
_MEMORY = 1e9
"""Memory limit for the operators of all step sizes on a rank [bytes]."""
_FEWEST = 3
"""Least number of step sizes whose operators are kept: a step, its half and its double."""
_FILL = {2: 100, 3: 1000}
"""Entries of the triangular factors per unknown, by dimension of the mesh."""


@dataclass(frozen=True)
class TemperatureField:
    """Temperatures of bodies and faces.

    Attributes
    ----------
    faces : ThermalState
    rise : ndarray, shape (n_owned,)
        Nodal temperature rise over the ambient [K].
    error : float
        Relative error of the heat balance.
    errors : list of float
        Those of each body; empty for a pair.
    """

    faces: ThermalState
    rise: np.ndarray
    error: float
    errors: list[float]


@dataclass(frozen=True)
class InitialHeat:
    """Given temperatures of the bodies, without friction heat.

    Attributes
    ----------
    stored : StoredHeat
    baseline : BaselineResponse
        Response of the faces to these temperatures.
    """

    stored: StoredHeat
    baseline: BaselineResponse

    def coupling(
        self, conditions: InterfaceConditions, basis: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        opening, m = self.baseline.opening, basis.shape[1]
        assert opening is not None
        return np.zeros((m, m)), opening

    def converged(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        return True


AnyHeat = HeatStep | InitialHeat
"""Heat at one time, as contact solvers use it."""


def friction_heat(system: System) -> FrictionHeat | None:
    """Friction heat of a system; None without heat."""
    return None if system.thermal is None else FrictionHeat(system, system.thermal)


class FrictionHeat:
    """Coupling of pressure, temperature and distortion at the contact points.

    Attributes
    ----------
    ambient : float
        Temperature of the surroundings [K].
    steps : HeatSteps
        Conduction, steady and in time steps.
    """

    def __init__(self, system: System, thermal: ThermalSystem):
        self.ambient = thermal.ambient
        kind = VaryingHeatSteps if thermal.varies else HeatSteps
        self.steps = kind(system, thermal, _kept_sizes(system, thermal))
        self._system, self._thermal = system, thermal

    @cached_property
    def initial(self) -> InitialHeat:
        """Initial temperatures, before any friction heat has flowed; every rank calls."""
        conduction = self._thermal.conduction
        rise = np.where(conduction.fixed, conduction.prescribed, self._thermal.initial)
        baseline = self.steps.operators.baseline(rise)
        largest = max(float(np.abs(baseline.rise).max()), self.steps.largest(rise))
        nothing = np.zeros(3 + 2 * len(self._system.model.bodies))
        stored = StoredHeat(rise, conduction.stored_heat(rise), nothing, largest)
        return InitialHeat(stored, baseline)

    def given(self, stored: StoredHeat) -> InitialHeat:
        """Known temperatures at a later time; every rank calls."""
        return InitialHeat(stored, self.steps.operators.baseline(stored.rise))

    def take_over(self, former: FrictionHeat, stored: StoredHeat, rise: np.ndarray) -> StoredHeat:
        """Transfer stored heat from a former mesh; every rank calls.

        The heat removed with the worn material counts as lost.

        Parameters
        ----------
        former : FrictionHeat
            Friction heat on the former mesh.
        stored : StoredHeat
            Stored heat on the former mesh.
        rise : ndarray, shape (n_owned,)
            Transferred temperature rise on this mesh [K].
        """
        content = self._thermal.conduction.stored_heat(rise)
        same = replace(stored, rise=rise, content=content)
        taken = former._balance(stored).stored - self._balance(same).stored
        each = self._gains(same) - former._gains(stored)
        flows = np.array([0.0, taken, abs(taken), *each, *np.abs(each)])
        return replace(same, turnover=stored.turnover + flows[: len(stored.turnover)])

    def steady(self, conditions: InterfaceConditions, pressure: np.ndarray) -> TemperatureField:
        """Steady temperatures under a pressure (n,) [Pa]."""
        conduction, face = self._thermal.conduction, self._thermal.face
        steady = self.steps.steady
        faces, load = steady.faces(conditions, pressure), steady.load
        rise = steady.rise(faces)
        heat = face.nodal_heat(faces, bath=False) + load.heat
        made = float(face.weights @ (conditions.heating * pressure))
        lost = sum(conduction.losses(rise, heat, load.ambient))
        scale = max(made + load.magnitude, conduction.exchanged_heat(rise, heat, load.ambient))
        if made + load.magnitude == 0.0:  # the turnover may be at rounding level
            scale = max(scale, conduction.balance_scale(rise))
        error = relative(lost - made - load.prescribed, scale)
        net = heat_steps.into_bodies(self._system, self._thermal, faces, rise, load)
        return TemperatureField(faces, rise, error, heat_steps.body_balance_errors(*net))

    def transient(self, stored: StoredHeat, faces: ThermalState) -> TemperatureField:
        """Transient temperatures, with the error of the heat balance since the start."""
        net, sizes = np.split(stored.turnover[3:], 2)
        if not len(net):  # of a checkpoint of an earlier version
            return TemperatureField(faces, stored.rise, self._balance(stored).error, [])
        gains, before = self._gains(stored), np.abs(self.initial.stored.content)[None]
        sizes = sizes + np.abs(gains) + ROUNDING * heat_steps.of_bodies(self._system, before)[0]
        errors = heat_steps.body_balance_errors(net - gains, sizes)
        return TemperatureField(faces, stored.rise, self._balance(stored).error, errors)

    def _gains(self, stored: StoredHeat) -> np.ndarray:
        """Heat stored in each body since the start, (n_bodies,) [J]."""
        gained = (stored.content - self.initial.stored.content)[None]
        return heat_steps.of_bodies(self._system, gained)[0]

    def _balance(self, stored: StoredHeat) -> HeatBalance:
        return stored.balance(self.initial.stored, self._system.comm)

    def first_step(self, friction_heat: float) -> float:
        """Initial step size: small penetration depth of heat or small surface temperature rise [s].

        The surface of a half-space under a constant flux q warms by ``2 q √(t/π)/√(k ρ c)``.
        Infinite without any heat source at the start, friction [W/m²] or other.
        """
        system, thermal = self._system, self._thermal
        extent = min(pairing.extent for pairing in system.contacts.each)
        through = (_FIRST_DEPTH * extent) ** 2 / thermal.diffusivity
        if self.steps.driven:
            return through
        if friction_heat == 0.0:
            return np.inf
        share, materials = thermal.face.partition, system.model.materials
        each = [facing.effusivities(materials) for facing in system.facing]
        first, second = (np.concatenate(side) for side in zip(*each, strict=True))
        steepest = float(np.maximum(share / first, (1 - share) / second).max()) * friction_heat
        return float(max(through, np.pi * (_FIRST_RISE / (2 * steepest)) ** 2))


def _kept_sizes(system: System, thermal: ThermalSystem) -> int:
    """Number of step sizes whose operators fit into the memory; every rank calls."""
    conduction, face = thermal.conduction, thermal.face
    faces = [nodes.count for nodes in face.nodes] if isinstance(face, InterfaceHeat) else [0]
    # responses of the faces, their exchange, and the weak gap per heat
    functions, nodes = system.basis.shape[1], len(conduction.fixed)
    dense = sum(faces) * (max(faces) + sum(faces) + 2 * functions) + functions**2
    numbers = dense + _FILL[conduction.spaces.dim] * nodes
    least = min(system.comm.allgather(_MEMORY / (8 * numbers)))
    return max(int(least), _FEWEST)
