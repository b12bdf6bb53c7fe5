"""Friction heat in bodies with temperature-dependent conductivity or expansion.

Newton's method: contact is solved for bodies linearised about the last temperatures.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from functools import cached_property

import numpy as np

from ...bulk.heat.varying import VaryingConduction, VaryingExpansion
from ...contact.operators.heat import BaselineResponse, ThermalState, at_rest
from ...contact.operators.heat_condensation import condense_heat, gap_per_rise
from ...errors import ComputationError
from ...parallel import sum_over_ranks
from ..model.conditions import InterfaceConditions
from ..model.system import System
from ..model.thermal_loads import ThermalLoad
from ..model.thermal_system import ThermalSystem
from .friction_heat import FrictionHeat
from .heat_stages import Coupling, LinearHeatStep
from .heat_states import StoredHeat
from .tangents import LastTangents, TangentOperators, Tangents

_TURNS = 60
_SETTLED = 1e-11
"""Tolerance of the change of the temperatures, relative to the largest rise."""
_SLOW = 0.3
"""Convergence rate of Newton's method above which the tangents are renewed."""
_LEAST_RISE = 1.0  # K


def friction_heat(system: System) -> FrictionHeat | None:
    """Friction heat of a system; None without heat."""
    thermal = system.thermal
    if thermal is None:
        return None
    return (VaryingFrictionHeat if thermal.varies else FrictionHeat)(system, thermal)


class VaryingFrictionHeat(FrictionHeat):
    """Friction heat with temperature-dependent properties; parameters as in `FrictionHeat`."""

    def __init__(self, system: System, thermal: ThermalSystem):
        super().__init__(system, thermal)
        assert isinstance(thermal.conduction, VaryingConduction)
        self._conduction = thermal.conduction
        self._tangents: OrderedDict[float, Tangents] = OrderedDict()
        self._lasting: VaryingHeat | None = None

    @property
    def steady(self) -> VaryingHeat:
        if self._lasting is None:
            load = self._thermal.loads.at(0.0)
            start = self._conduction.given
            self._lasting = VaryingHeat(self, Tangents(self, None), load, load.heat, start)
        return self._lasting

    def after(self, before: StoredHeat, step: float, time: float) -> VaryingHeat:
        if step not in self._tangents:
            self._tangents[step] = Tangents(self, step)
            if len(self._tangents) > self._kept:
                self._tangents.popitem(last=False)
        self._tangents.move_to_end(step)
        load = self._thermal.loads.at(time)
        supplied = load.heat + before.content / step
        return VaryingHeat(self, self._tangents[step], load, supplied, before.rise)

    def memory(self) -> LastTangents:
        steps = {step: tangents.reference for step, tangents in self._tangents.items()}
        return LastTangents(steps, None if self._lasting is None else self._lasting.memory())

    def recall(self, memory: LastTangents) -> None:
        for step, reference in memory.steps.items():
            self._tangents[step] = Tangents(self, step, reference)
        if memory.steady is not None:
            reference, rise, change = memory.steady
            tangents, load = Tangents(self, None, reference), self._thermal.loads.at(0.0)
            self._lasting = VaryingHeat(self, tangents, load, load.heat, rise, change)

    def at_rest(self, rise: np.ndarray) -> BaselineResponse:
        faces = at_rest(rise, self._thermal.face.traces, self._system.comm).rise
        return BaselineResponse(faces, self._opening(rise))

    def tangent(self, rise: np.ndarray, step: float | None) -> TangentOperators:
        """Tangent operators at a rise (n_owned,); every rank calls."""
        face = self._thermal.face
        with self._system.phases("condense conduction"):
            conduction = self._conduction.tangent(rise, step)
            face = condense_heat(
                conduction, face.weights, face.basis, face.traces, face.shift, face.partition
            )
        return TangentOperators(conduction, face, self, rise)

    def gap_per_rise(self, rise: np.ndarray) -> np.ndarray:
        """Derivative of the weak gap by a nodal rise, shape (n_owned, m) [m³/K]."""
        result = self.condensed.per_rise
        for part, per_rise in self._per_excess:
            result = result + part.slope(rise)[:, None] * per_rise
        return result

    def about(
        self,
        operators: TangentOperators,
        load: ThermalLoad,
        supplied: np.ndarray,
        rise: np.ndarray,
    ) -> LinearHeatStep:
        """Heat linearised about a rise, with tangents of a nearby rise; every rank calls."""
        heat = self._conduction.remainder(rise, operators.reference) + supplied
        alone = load.on(operators.conduction).solve(heat)
        traces, comm = self._thermal.face.traces, self._system.comm
        faces = at_rest(alone, traces, comm).rise
        changed = sum_over_ranks(comm, operators.per_rise.T @ (alone - rise))
        return LinearHeatStep(
            operators, load, heat, BaselineResponse(faces, self._opening(rise) + changed)
        )

    def far(self, rise: np.ndarray, other: np.ndarray) -> float:
        """Difference of two rises, relative to the largest value of the first; every rank calls."""
        sizes = [float(np.abs(values).max(initial=0.0)) for values in (rise - other, rise)]
        change, largest = np.max(self._system.comm.allgather(sizes), axis=0)
        return change / max(largest, _LEAST_RISE)

    def _opening(self, rise: np.ndarray) -> np.ndarray:
        """Weak gap opened by a rise, shape (m,) [m³]."""
        opening = self.condensed.per_rise.T @ rise
        for part, per_rise in self._per_excess:
            opening = opening + per_rise.T @ part.excess(rise)
        return sum_over_ranks(self._system.comm, opening)

    @cached_property
    def _per_excess(self) -> list[tuple[VaryingExpansion, np.ndarray]]:
        """Varying expansions and the weak gap per excess rise of their parts, (n_owned, m)."""
        contact = self._system.contact
        return [(part, gap_per_rise(part.matrix, contact)) for part in self._thermal.expansions]


class VaryingHeat:
    """Heat at one time, linearised about the last temperatures.

    Parameters
    ----------
    heat : VaryingFrictionHeat
    tangents : Tangents
    load : ThermalLoad
    supplied : ndarray, shape (n_owned,)
        Nodal heat, see `LinearHeatStep` [W].
    rise : ndarray, shape (n_owned,)
        Initial guess [K].
    change : float, optional
        Last relative change of the rise, see `VaryingFrictionHeat.far`.
    """

    def __init__(
        self,
        heat: VaryingFrictionHeat,
        tangents: Tangents,
        load: ThermalLoad,
        supplied: np.ndarray,
        rise: np.ndarray,
        change: float = np.inf,
    ):
        self._heat = heat
        self._tangents = tangents
        self.load = load
        self._supplied = supplied
        self._rise = rise
        self._last = change
        self._linear = heat.about(tangents.near(rise), load, supplied, rise)

    def memory(self) -> tuple[np.ndarray | None, np.ndarray, float]:
        """Linearisation point of the tangents, temperatures, and their last change."""
        return self._tangents.reference, self._rise, self._last

    @property
    def unheated(self) -> ThermalState:
        """Linearised state of the faces without any heat at the contact."""
        return self._linear.unheated

    def faces(self, conditions: InterfaceConditions, pressure: np.ndarray) -> ThermalState:
        """Temperatures and fluxes of the faces under a pressure at the points [Pa]."""
        return self._newton(lambda: self._linear.faces(conditions, pressure))

    def rise(self, faces: ThermalState) -> np.ndarray:
        """Temperature rise of the bodies, shape (n_owned,) [K]."""
        self._newton(lambda: faces)
        return self._rise

    def coupling(self, conditions: InterfaceConditions, basis: np.ndarray) -> Coupling:
        """Thermal coupling of the condensed interface, linearised about the last temperatures."""
        return self._linear.coupling(conditions, basis)

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Test the convergence of the last coupling at a pressure; relinearise if not converged."""
        return self._moved(self._linear.faces(conditions, pressure)) <= _SETTLED

    def _newton(self, respond: Callable[[], ThermalState]) -> ThermalState:
        """Iterate the temperatures by Newton's method on the response of the faces."""
        for _ in range(_TURNS):
            faces = respond()
            if self._moved(faces) <= _SETTLED:
                return faces
        raise ComputationError(
            "heat: Newton's method for conductivity or expansion that change with temperature does "
            "not settle; give smoother tables, or reduce the speed"
        )

    def _moved(self, faces: ThermalState) -> float:
        """Relative change of the temperatures for a state of the faces; relinearise there."""
        rise = self._linear.rise(faces)
        change = self._heat.far(rise, self._rise)
        if change <= _SETTLED:
            self._last = np.inf
            return change
        slow = change > _SLOW * self._last
        operators = self._tangents.at(rise) if slow else self._tangents.near(rise)
        self._linear = self._heat.about(operators, self.load, self._supplied, rise)
        self._rise, self._last = rise, np.inf if slow else change
        return change
