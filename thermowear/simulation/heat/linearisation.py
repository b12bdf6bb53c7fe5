"""Heat steps of a system, linearised about the last temperatures.

Once where the properties of the bodies are constant, by Newton's method where conductivity or
expansion depend on temperature. Operators are kept for the step sizes used last.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...contact.operators.heat import BaselineResponse, ThermalState, baseline_response
from ...contact.operators.heat_condensation import condense_heat
from ...errors import ComputationError
from ..system.conditions import InterfaceConditions
from ..system.system import System
from ..system.thermal_loads import ThermalLoad
from ..system.thermal_system import ThermalSystem
from .distortion import CondensedDistortion
from .heat_steps import HeatOperators, InitialHeat, LinearHeatStep, StoredHeat

_MEMORY = 1e9
"""Memory limit for the operators of all step sizes on a rank [bytes]."""
_FEWEST = 3
"""Least number of step sizes whose operators are kept: a step, its half and its double."""
_FILL = {2: 100, 3: 1000}
"""Entries of the triangular factors per unknown, by dimension of the mesh."""

_TURNS = 60
_SETTLED = 1e-11
"""Tolerance of the change of the temperatures, relative to the largest rise."""
_SLOW = 0.3
"""Convergence rate of Newton's method above which the tangents are renewed."""
_LEAST_RISE = 1.0  # K


class NonlinearHeatStep:
    """Conduction with temperature-dependent properties at one time, by Newton's method.

    Parameters
    ----------
    linearise : callable
        `LinearHeatStep` about a rise (n_owned,), with new tangents on request. Every rank calls.
    comm : mpi4py.MPI.Comm
    rise : ndarray, shape (n_owned,)
        Initial guess, then the last temperatures [K].
    change : float, optional
        Last change of the rise, relative to its largest value.
    """

    def __init__(
        self,
        linearise: Callable[[np.ndarray, bool], LinearHeatStep],
        comm,
        rise: np.ndarray,
        change: float = np.inf,
    ):
        self.last_rise, self.last_change = rise, change
        self._linearise = linearise
        self._comm = comm
        self._linear = linearise(rise, False)
        self.load = self._linear.load

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
        return self.last_rise

    def coupling(
        self, conditions: InterfaceConditions, basis: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Thermal contribution to the condensed interface, about the last temperatures."""
        return self._linear.coupling(conditions, basis)

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Test whether the last coupling has converged at a pressure; relinearise if not."""
        return self._moved(self._linear.faces(conditions, pressure)) <= _SETTLED

    def _newton(self, respond: Callable[[], ThermalState]) -> ThermalState:
        """Iterate the temperatures by Newton's method on the response of the faces."""
        for _ in range(_TURNS):
            faces = respond()
            if self._moved(faces) <= _SETTLED:
                return faces
        raise ComputationError(
            "heat: Newton's method for temperature-dependent conductivity or expansion did not "
            "converge; give smoother tables, or reduce the speed"
        )

    def _moved(self, faces: ThermalState) -> float:
        """Relative change of the temperatures for a state of the faces; relinearise there."""
        rise = self._linear.rise(faces)
        change = self._change(rise)
        if change <= _SETTLED:
            self.last_change = np.inf
            return change
        slow = change > _SLOW * self.last_change
        self._linear = self._linearise(rise, slow)
        self.last_rise, self.last_change = rise, np.inf if slow else change
        return change

    def _change(self, rise: np.ndarray) -> float:
        """Difference from the last rise, relative to the largest value; every rank calls."""
        sizes = [float(np.abs(values).max(initial=0.0)) for values in (rise - self.last_rise, rise)]
        change, largest = np.max(self._comm.allgather(sizes), axis=0)
        return change / max(largest, _LEAST_RISE)


ConductingStep = LinearHeatStep | NonlinearHeatStep
HeatStep = ConductingStep | InitialHeat


@dataclass
class Tangents:
    """Last operators for one step size [s], or for the steady state (None).

    Each needs a factorisation: Newton's method reuses them while its increments keep decreasing.

    Attributes
    ----------
    step : float or None
    reference : ndarray or None, shape (n_owned,)
        Rise at which they were linearised [K].
    last : HeatOperators or None
    """

    step: float | None
    reference: np.ndarray | None = None
    last: HeatOperators | None = None


class HeatSteps:
    """Conduction at the times of an analysis, condensed to the interface.

    Parameters
    ----------
    system : System
    thermal : ThermalSystem

    Attributes
    ----------
    nonlinear : bool
        True if conductivity or expansion depend on temperature.
    """

    def __init__(self, system: System, thermal: ThermalSystem):
        self._system = system
        self._thermal = thermal
        self._distorts = system.model.interface.method.name == "condensed"
        self._distortion = CondensedDistortion(system, thermal)
        self._steps: OrderedDict[float, Tangents] = OrderedDict()
        self._steady_tangents = Tangents(None)
        self.nonlinear = thermal.varies

    @cached_property
    def steady(self) -> ConductingStep:
        """Steady conduction."""
        return self._steady_about(self._thermal.conduction.prescribed)

    def after(self, before: StoredHeat, step: float, time: float) -> ConductingStep:
        """Conduction in an implicit Euler step that ends at a time [s]; every rank calls."""
        tangents = self._steps.setdefault(step, Tangents(step))
        self._steps.move_to_end(step)
        if len(self._steps) > self._kept:
            self._steps.popitem(last=False)
        load = self._thermal.loads.constant or self._thermal.loads.at(time)
        supplied = load.heat + before.content / step
        return self._conducting(tangents, load, supplied, before.rise)

    def restart_data(self) -> tuple:
        """Linearisation points, which the Newton iterates of nonlinear heat depend on.

        Rise (n_owned,) by step size, the last used at the end; and for the steady state this rise,
        the last temperatures [K], and their last change.
        """
        steps = {step: tangents.reference for step, tangents in self._steps.items()}
        if self._steady_tangents.last is None:
            return steps, None
        assert isinstance(self.steady, NonlinearHeatStep)
        last = self.steady.last_rise, self.steady.last_change
        return steps, (self._steady_tangents.reference, *last)

    def restore(self, data: tuple) -> None:
        """Restore the linearisation points from `restart_data`."""
        steps, steady = data
        self._steps.update({step: Tangents(step, rise) for step, rise in steps.items()})
        if steady is not None:
            reference, rise, change = steady
            self._steady_tangents = Tangents(None, reference)
            self.steady = self._steady_about(rise, change)

    def at_rest(
        self,
        rise: np.ndarray,
        operators: HeatOperators | None = None,
        about: np.ndarray | None = None,
    ) -> BaselineResponse:
        """Interface response to a nodal rise (n_owned,); every rank calls.

        With operators the distortion is linearised about another rise, with their tangent.
        """
        traces, comm, distortion = self._thermal.face.traces, self._system.comm, self._distortion
        if not self._distorts:
            return baseline_response(rise, traces, comm)
        if not self.nonlinear:
            return baseline_response(rise, traces, comm, (operators or distortion).per_rise)
        if operators is None or about is None:
            return baseline_response(
                rise, traces, comm, distortion.per_rise, distortion.excess(rise)
            )
        excess = distortion.excess(about, operators.reference)
        return baseline_response(rise, traces, comm, operators.per_rise, excess)

    def _steady_about(self, rise: np.ndarray, change: float = np.inf) -> ConductingStep:
        """Steady conduction with an initial rise (n_owned,) and its last change."""
        load = self._thermal.loads.at(0.0)
        return self._conducting(self._steady_tangents, load, load.heat, rise, change)

    def _conducting(
        self,
        tangents: Tangents,
        load: ThermalLoad,
        supplied: np.ndarray,
        rise: np.ndarray,
        change: float = np.inf,
    ) -> ConductingStep:
        """Conduction at one time; if nonlinear, with an initial rise and its last change."""

        def linearise(rise: np.ndarray, renew: bool) -> LinearHeatStep:
            if renew or tangents.last is None:
                at = rise if renew or tangents.reference is None else tangents.reference
                tangents.reference, tangents.last = at, self._operators(at, tangents.step)
            return self._about(tangents.last, load, supplied, rise)

        if self.nonlinear:
            return NonlinearHeatStep(linearise, self._system.comm, rise, change)
        return linearise(rise, False)

    def _about(
        self, operators: HeatOperators, load: ThermalLoad, supplied: np.ndarray, rise: np.ndarray
    ) -> LinearHeatStep:
        """Heat linearised about a rise, with tangents of a nearby rise; every rank calls."""
        conduction = self._thermal.conduction
        heat = supplied + conduction.linearisation_error(rise, operators.reference)

        def alone() -> BaselineResponse:
            held = operators.conduction.with_prescribed(load.given)
            return self.at_rest(held.solve(heat), operators, rise)

        if operators.conduction is not conduction:  # of a time step, or a tangent
            return LinearHeatStep(operators, load, heat, alone())
        key = self._system.inputs.conduction, self._distorts
        return LinearHeatStep(operators, load, heat, self._system.parts.get("at rest", key, alone))

    @cached_property
    def _kept(self) -> int:
        """Number of step sizes whose operators are kept."""
        conduction, points = self._thermal.conduction, len(self._thermal.face.weights)
        dense, nodes = 12 * points**2, len(conduction.fixed)
        numbers = dense + _FILL[conduction.space.mesh.topology.dim] * nodes
        least = min(self._system.comm.allgather(_MEMORY / (8 * numbers)))
        return max(int(least), _FEWEST)

    def _operators(self, rise: np.ndarray, step: float | None) -> HeatOperators:
        """Operators linearised at a rise (n_owned,), steady or of a time step; every rank calls."""
        face, steady = self._thermal.face, self._thermal.conduction
        conduction = steady.tangent(rise, step)
        if conduction is not steady:
            with self._system.phases("condense conduction"):
                face = condense_heat(
                    conduction, face.weights, face.basis, face.traces, face.shift, face.partition
                )
        return HeatOperators(conduction, face, self._distortion, rise)
