"""Friction heat of the interface problem: initial and stored heat, temperatures, balances."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...balances import relative
from ...contact.operators.heat import ThermalState
from ...parallel import sum_over_ranks
from ..system.conditions import InterfaceConditions
from ..system.system import System
from ..system.thermal_system import ThermalSystem
from .heat_steps import InitialHeat, StoredHeat
from .linearisation import ConductingStep, HeatSteps

_ROUNDING = 1e-3
"""Least scale of the heat balance, relative to the initial heat content (rounding)."""
_SHALLOW = 1e-3
"""Penetration depth of heat in the first step, relative to the length of the contact."""
_HARDLY = 0.1
"""Surface temperature rise allowed in the first step [K]."""


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
    """

    faces: ThermalState
    rise: np.ndarray
    error: float


@dataclass(frozen=True)
class HeatBalance:
    """Heat balance since the start.

    Attributes
    ----------
    made, stored, lost : float
        Heat input by friction and through surfaces with a given flux or power, heat stored in the
        bodies, and heat lost to the surroundings [J].
    moved : float
        Magnitude of all heat put in, lost, or moved inside the bodies [J].
    """

    made: float
    stored: float
    lost: float
    moved: float

    @property
    def error(self) -> float:
        """Imbalance relative to the largest term."""
        scale = max(abs(self.made), abs(self.stored), abs(self.lost), self.moved)
        return relative(self.made - self.stored - self.lost, scale)


def friction_heat(system: System) -> FrictionHeat | None:
    """Friction heat of a system; None without heat."""
    return None if system.thermal is None else FrictionHeat(system, system.thermal)


class FrictionHeat:
    """Coupling of pressure, temperature and distortion at the contact points.

    Parameters
    ----------
    system : System
    thermal : ThermalSystem

    Attributes
    ----------
    ambient : float
        Temperature of the surroundings [K].
    steps : HeatSteps
        Conduction, steady and in time steps.
    """

    def __init__(self, system: System, thermal: ThermalSystem):
        self.ambient = thermal.ambient
        self.steps = HeatSteps(system, thermal)
        self._system = system
        self._thermal = thermal
        heat = system.model.heat
        self._driven = heat is not None and heat.driven

    @cached_property
    def frozen(self) -> InitialHeat:
        """Initial temperatures, before any friction heat has flowed; every rank calls."""
        conduction = self._thermal.conduction
        rise = np.where(conduction.fixed, conduction.prescribed, self._thermal.initial)
        resting = self.steps.at_rest(rise)
        largest = max(float(np.abs(resting.rise).max()), self._largest(rise))
        return InitialHeat(
            StoredHeat(rise, conduction.stored_heat(rise), np.zeros(3), largest), resting
        )

    def at_moment(self, stored: StoredHeat) -> InitialHeat:
        """Known temperatures at a later time; every rank calls."""
        return InitialHeat(stored, self.steps.at_rest(stored.rise))

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
        taken = former.balance(stored).stored - self.balance(same).stored
        return replace(same, turnover=stored.turnover + np.array([0.0, taken, abs(taken)]))

    def stored(
        self,
        before: StoredHeat,
        step: float,
        heat: ConductingStep,
        faces: ThermalState,
        friction_heat: np.ndarray,
    ) -> StoredHeat:
        """Heat stored in the bodies at the end of an implicit Euler step.

        Parameters
        ----------
        before : StoredHeat
        step : float
            [s]
        heat : ConductingStep
            From `HeatSteps.after`.
        faces : ThermalState
            Temperatures and fluxes of the faces at the end.
        friction_heat : ndarray, shape (n,)
            Friction heat at the end [W/m²].
        """
        conduction, face, load = self._thermal.conduction, self._thermal.face, heat.load
        rise = heat.rise(faces)
        content = conduction.stored_heat(rise)
        nodal = face.nodal_heat(faces, bath=False) + load.heat - (content - before.content) / step
        lost = sum(conduction.losses(rise, nodal, load.ambient))
        made = float(face.weights @ friction_heat)
        outside = conduction.exchanged_heat(rise, nodal, load.ambient)
        exchanged = made + load.magnitude + outside
        largest = max(before.largest, float(np.abs(faces.rise).max()), self._largest(rise))
        turnover = before.turnover + step * np.array([made + load.prescribed, lost, exchanged])
        return StoredHeat(rise, content, turnover, largest)

    def lasting(self, conditions: InterfaceConditions, pressure: np.ndarray) -> TemperatureField:
        """Steady temperatures under a pressure (n,) [Pa]."""
        conduction, face = self._thermal.conduction, self._thermal.face
        steady = self.steps.steady
        faces, load = steady.faces(conditions, pressure), steady.load
        rise = steady.rise(faces)
        heat = face.nodal_heat(faces, bath=False) + load.heat
        made = float(face.weights @ (conditions.heating * pressure))
        lost = sum(conduction.losses(rise, heat))
        scale = max(made + load.magnitude, conduction.exchanged_heat(rise, heat))
        if made + load.magnitude == 0.0:  # the turnover may be at rounding level
            scale = max(scale, conduction.balance_scale(rise))
        return TemperatureField(faces, rise, relative(lost - made - load.prescribed, scale))

    def momentary(self, stored: StoredHeat, faces: ThermalState) -> TemperatureField:
        """Transient temperatures, with the error of the heat balance since the start."""
        return TemperatureField(faces, stored.rise, self.balance(stored).error)

    def balance(self, stored: StoredHeat) -> HeatBalance:
        """Heat balance since the start; every rank calls."""
        made, lost, exchanged = (float(heat) for heat in stored.turnover)
        before = self.frozen.stored.content
        gained = stored.content - before
        sums = np.array([gained.sum(), np.abs(gained).sum(), np.abs(before).sum()])
        gain, shifted, had = (float(heat) for heat in sum_over_ranks(self._system.comm, sums))
        return HeatBalance(made, gain, lost, max(exchanged, shifted, _ROUNDING * had))

    def difference(self, one: StoredHeat, other: StoredHeat) -> float:
        """Largest difference of the temperatures inside the bodies [K]; every rank calls.

        Zero where friction is the only heat source: the faces then show the errors of a step.
        """
        return self._largest(one.rise - other.rise)

    def _largest(self, rise: np.ndarray) -> float:
        """Largest rise inside the bodies with other heat sources, else 0 [K]; every rank calls."""
        if not self._driven:
            return 0.0
        return max(self._system.comm.allgather(float(np.abs(rise).max(initial=0.0))))

    def first_step(self, friction_heat: float) -> float:
        """Initial step size: small penetration depth of heat or small surface temperature rise [s].

        The surface of a half-space under a constant flux q warms by ``2 q √(t/π)/√(k ρ c)``.
        Infinite without any heat source at the start, friction [W/m²] or other.
        """
        system, thermal = self._system, self._thermal
        if self._driven:
            return (_SHALLOW * system.pairing.extent) ** 2 / thermal.diffusivity
        if friction_heat == 0.0:
            return np.inf
        share = thermal.face.partition
        first, second = system.facing.effusivities(system.model.materials)
        steepest = float(np.maximum(share / first, (1 - share) / second).max()) * friction_heat
        through = (_SHALLOW * system.pairing.extent) ** 2 / thermal.diffusivity
        return float(max(through, np.pi * (_HARDLY / (2 * steepest)) ** 2))
