"""Friction heat, proportional to the pressure, as part of the interface problem."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ...balances import relative
from ...contact.operators.heat import BaselineResponse, ThermalState, at_rest
from ...contact.operators.heat_condensation import condense_heat
from ...parallel import sum_over_ranks
from ..model.conditions import InterfaceConditions
from ..model.system import System
from ..model.thermal_system import ThermalSystem
from .condensed_distortion import CondensedDistortion
from .heat_stages import ConductingStage, HeatOperators, InitialHeat, LinearHeatStep
from .heat_states import HeatBalance, StoredHeat, TemperatureField

_MEMORY = 1e9
"""Memory limit for the operators of all step sizes on a rank [bytes]."""
_FEWEST = 3
"""Least number of step sizes whose operators are kept: a step, its half and its double."""
_FILL = {2: 100, 3: 1000}
"""Entries of the triangular factors per unknown, by dimension of the mesh."""
_ROUNDING = 1e-3
"""Least scale of the heat balance, relative to the initial heat content (rounding)."""
_SHALLOW = 1e-3
"""Penetration depth of heat in the first step, relative to the length of the contact."""
_HARDLY = 0.1
"""Surface temperature rise allowed in the first step [K]."""


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
    """

    def __init__(self, system: System, thermal: ThermalSystem):
        self._system = system
        self._thermal = thermal
        self.ambient = thermal.ambient
        self._steps: OrderedDict[float, HeatOperators] = OrderedDict()
        self._distorts = system.model.interface.method.name == "condensed"
        self.condensed = CondensedDistortion(system, thermal)
        heat = system.model.heat
        self._driven = heat is not None and heat.driven

    @cached_property
    def steady(self) -> ConductingStage:
        """Steady conduction."""
        thermal = self._thermal
        operators = HeatOperators(thermal.conduction, thermal.face, self.condensed)
        load = thermal.loads.at(0.0)
        resting = self._system.parts.get(
            "at rest",
            (self._system.inputs.conduction, self._distorts),
            lambda: self.at_rest(thermal.conduction.solve(load.heat)),
        )
        return LinearHeatStep(operators, load, load.heat, resting)

    def after(self, before: StoredHeat, step: float, time: float) -> ConductingStage:
        """Conduction in an implicit Euler step that ends at a time [s]; every rank calls."""
        if step not in self._steps:
            self._steps[step] = self._operators(step)
            if len(self._steps) > self._kept:
                self._steps.popitem(last=False)
        self._steps.move_to_end(step)
        operators, load = self._steps[step], self._thermal.loads.at(time)
        supplied = load.heat + before.content / step
        alone = load.on(operators.conduction).solve(supplied)
        return LinearHeatStep(operators, load, supplied, self.at_rest(alone))

    @cached_property
    def frozen(self) -> InitialHeat:
        """Initial temperatures, before any friction heat has flowed; every rank calls."""
        conduction = self._thermal.conduction
        rise = np.where(conduction.fixed, conduction.given, self._thermal.initial)
        resting = self.at_rest(rise)
        largest = max(float(np.abs(resting.rise).max()), self._largest(rise))
        return InitialHeat(StoredHeat(rise, conduction.stored(rise), np.zeros(3), largest), resting)

    def at_moment(self, stored: StoredHeat) -> InitialHeat:
        """Known temperatures at a later time; every rank calls."""
        return InitialHeat(stored, self.at_rest(stored.rise))

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
        content = self._thermal.conduction.stored(rise)
        same = replace(stored, rise=rise, content=content)
        taken = former.balance(stored).stored - self.balance(same).stored
        return replace(same, turnover=stored.turnover + np.array([0.0, taken, abs(taken)]))

    def stored(
        self,
        before: StoredHeat,
        step: float,
        heat: ConductingStage,
        faces: ThermalState,
        friction_heat: np.ndarray,
    ) -> StoredHeat:
        """Heat stored in the bodies at the end of an implicit Euler step.

        Parameters
        ----------
        before : StoredHeat
        step : float
            [s]
        heat : ConductingStage
            From `after`.
        faces : ThermalState
            Temperatures and fluxes of the faces at the end.
        friction_heat : ndarray, shape (n,)
            Friction heat at the end [W/m²].
        """
        conduction, face, load = self._thermal.conduction, self._thermal.face, heat.load
        rise = heat.rise(faces)
        content = conduction.stored(rise)
        storage = (content - before.content) / step
        nodal = face.nodal_heat(faces, bath=False) + load.heat
        lost = sum(conduction.losses(rise, nodal, storage, load.ambient))
        made = float(face.weights @ friction_heat)
        outside = conduction.turnover(rise, nodal, storage, load.ambient)
        exchanged = made + load.magnitude + outside
        largest = max(before.largest, float(np.abs(faces.rise).max()), self._largest(rise))
        turnover = before.turnover + step * np.array([made + load.prescribed, lost, exchanged])
        return StoredHeat(rise, content, turnover, largest)

    def memory(self) -> Any:
        """Internal state to restart from, see `recall`; None for linear heat."""
        return None

    def recall(self, memory: Any) -> None:
        """Restore the internal state from `memory`."""

    def lasting(self, conditions: InterfaceConditions, pressure: np.ndarray) -> TemperatureField:
        """Steady temperatures under a pressure (n,) [Pa]."""
        conduction, face = self._thermal.conduction, self._thermal.face
        faces = self.steady.faces(conditions, pressure)
        rise = self.steady.rise(faces)
        load = self.steady.load
        heat = face.nodal_heat(faces, bath=False) + load.heat
        made = float(face.weights @ (conditions.heating * pressure))
        lost = sum(conduction.losses(rise, heat))
        scale = max(made + load.magnitude, conduction.turnover(rise, heat))
        if made + load.magnitude == 0.0:  # the turnover may be at rounding level
            scale = max(scale, conduction.rounding(rise))
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

    def at_rest(self, rise: np.ndarray) -> BaselineResponse:
        """Interface response to a nodal rise (n_owned,); every rank calls."""
        per_rise = self.condensed.per_rise if self._distorts else None
        return at_rest(rise, self._thermal.face.traces, self._system.comm, per_rise)

    @cached_property
    def _kept(self) -> int:
        """Number of step sizes whose operators are kept."""
        conduction, points = self._thermal.conduction, len(self._thermal.face.weights)
        dense, nodes = 12 * points**2, len(conduction.fixed)
        numbers = dense + _FILL[conduction.space.mesh.topology.dim] * nodes
        least = min(self._system.comm.allgather(_MEMORY / (8 * numbers)))
        return max(int(least), _FEWEST)

    def _operators(self, step: float) -> HeatOperators:
        steady = self._thermal.face
        with self._system.phases("condense conduction"):
            conduction = self._thermal.conduction.storing(step)
            face = condense_heat(
                conduction,
                steady.weights,
                steady.basis,
                steady.traces,
                steady.shift,
                steady.partition,
            )
        return HeatOperators(conduction, face, self.condensed)
