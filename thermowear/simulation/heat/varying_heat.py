"""Heat steps with temperature-dependent conductivity or expansion, by Newton's method.

The steps are linearised about the last temperatures. Their operators are kept while the increments
keep decreasing, as each tangent needs a factorisation.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from ...bulk.heat.conduction import Conduction
from ...bulk.heat.varying import VaryingExpansion
from ...contact.operators.condensation import condense_heat
from ...contact.operators.exchange_matrix import BaselineResponse, ThermalState
from ...contact.operators.heat_exchange import baseline_response
from ...errors import ComputationError
from ..system.conditions import InterfaceConditions
from ..system.system import System
from ..system.thermal_system import ThermalLoad, ThermalSystem
from .heat_steps import AnyFace, HeatOperators, HeatStep, HeatSteps

_ITERATIONS = 60
_TOLERANCE = 1e-11
"""Tolerance of the change of the temperatures, relative to the largest rise."""
_SLOW = 0.3
"""Convergence rate of Newton's method above which the tangents are renewed."""
_LEAST_RISE = 1.0  # K


class TangentOperators(HeatOperators):
    """Operators linearised at a rise (n_owned,) [K]; None: at the ambient temperature."""

    def __init__(
        self, system: System, conduction: Conduction, face: AnyFace, at: np.ndarray | None
    ):
        super().__init__(system, conduction, face)
        self._at = at

    @property
    def _expansions(self) -> tuple[VaryingExpansion, ...]:
        assert self._system.thermal is not None
        return self._system.thermal.expansions

    @cached_property
    def slopes(self) -> list[np.ndarray]:
        if self._at is None:
            return []
        return [expansion.slope(self._at) for expansion in self._expansions]

    def baseline(self, rise: np.ndarray, about: np.ndarray | None = None) -> BaselineResponse:
        """Interface response to a nodal rise, its distortion linearised about another rise."""
        if not self.distorts:
            return super().baseline(rise)
        about = rise if about is None else about
        excesses = [expansion.excess(about) for expansion in self._expansions]
        for excess, slope in zip(excesses, self.slopes, strict=False):
            excess += slope * (rise - about)
        opening = self.opened([rise, *excesses])
        return baseline_response(rise, self.face.traces, self._system.comm, opening)


Linearisation = tuple[TangentOperators, np.ndarray, BaselineResponse]
"""Operators, supplied heat and baseline response of a `HeatStep` linearised about a rise."""


class NonlinearHeatStep(HeatStep):
    """Conduction with temperature-dependent properties at one time, by Newton's method.

    Parameters
    ----------
    linearise : callable
        `Linearisation` about a rise (n_owned,), with new tangents on request. Every rank calls.
    comm : mpi4py.MPI.Comm
    load : ThermalLoad
    rise : ndarray, shape (n_owned,)
        Initial guess, then the last temperatures [K].
    change : float, optional
        Last change of the rise, relative to its largest value.
    """

    def __init__(
        self,
        linearise: Callable[[np.ndarray, bool], Linearisation],
        comm,
        load: ThermalLoad,
        rise: np.ndarray,
        change: float = np.inf,
    ):
        operators, supplied, baseline = linearise(rise, False)
        super().__init__(operators, load, supplied, baseline)
        self.last_rise, self.last_change = rise, change
        self._linearise, self._comm = linearise, comm

    def faces(self, conditions: InterfaceConditions, pressure: np.ndarray) -> ThermalState:
        return self._newton(partial(super().faces, conditions, pressure))

    def rise(self, faces: ThermalState) -> np.ndarray:
        self._newton(lambda: faces)
        return self.last_rise

    def converged(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Test whether the last coupling has converged at a pressure; relinearise if not."""
        return self._moved(super().faces(conditions, pressure)) <= _TOLERANCE

    def _newton(self, respond: Callable[[], ThermalState]) -> ThermalState:
        """Iterate the temperatures by Newton's method on the response of the faces."""
        for _ in range(_ITERATIONS):
            faces = respond()
            if self._moved(faces) <= _TOLERANCE:
                return faces
        raise ComputationError(
            "heat: Newton's method for temperature-dependent conductivity or expansion did not "
            "converge; give smoother tables, or reduce the speed"
        )

    def _moved(self, faces: ThermalState) -> float:
        """Relative change of the temperatures for a state of the faces; relinearise there."""
        rise = super().rise(faces)
        change = self._change(rise)
        if change <= _TOLERANCE:
            self.last_change = np.inf
            return change
        slow = change > _SLOW * self.last_change
        self.operators, self.supplied, self.baseline = self._linearise(rise, slow)
        self._gap = None
        self.last_rise, self.last_change = rise, np.inf if slow else change
        return change

    def _change(self, rise: np.ndarray) -> float:
        """Difference from the last rise, relative to the largest value; every rank calls."""
        sizes = [float(np.abs(values).max(initial=0.0)) for values in (rise - self.last_rise, rise)]
        change, largest = np.max(self._comm.allgather(sizes), axis=0)
        return change / max(largest, _LEAST_RISE)


@dataclass
class Tangents:
    """Last operators for one step size [s], or for the steady state (None).

    Attributes
    ----------
    step : float or None
    reference : ndarray or None, shape (n_owned,)
        Rise at which they were linearised [K].
    last : TangentOperators or None
    """

    step: float | None
    reference: np.ndarray | None = None
    last: TangentOperators | None = None


class VaryingHeatSteps(HeatSteps):
    """Conduction at the times of an analysis, with temperature-dependent properties."""

    def __init__(self, system: System, thermal: ThermalSystem, kept: int):
        super().__init__(system, thermal, kept)
        self._steady_tangents = Tangents(None)

    @cached_property
    def operators(self) -> TangentOperators:
        return TangentOperators(self._system, self._thermal.conduction, self._thermal.face, None)

    @cached_property
    def steady(self) -> HeatStep:
        return self._steady_about(self._thermal.conduction.prescribed)

    def restart_data(self) -> tuple:
        """Linearisation points, which the Newton iterates depend on.

        Rise (n_owned,) by step size, the last used at the end; and for the steady state this rise,
        the last temperatures [K], and their last change.
        """
        steps = {step: tangents.reference for step, tangents in self._of_size.items()}
        if self._steady_tangents.last is None:
            return steps, None
        assert isinstance(self.steady, NonlinearHeatStep)
        last = self.steady.last_rise, self.steady.last_change
        return steps, (self._steady_tangents.reference, *last)

    def restore(self, data: tuple) -> None:
        steps, steady = data
        self._of_size.update({step: Tangents(step, rise) for step, rise in steps.items()})
        if steady is not None:
            reference, rise, change = steady
            self._steady_tangents = Tangents(None, reference)
            self.steady = self._steady_about(rise, change)

    def operators_within(self, step: float) -> Tangents:
        return Tangents(step)

    def _steady_about(self, rise: np.ndarray, change: float = np.inf) -> HeatStep:
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
    ) -> HeatStep:
        def linearise(rise: np.ndarray, renew: bool) -> Linearisation:
            if renew or tangents.reference is None:
                tangents.reference, tangents.last = rise, None
            if tangents.last is None:
                tangents.last = self._tangent(tangents.reference, tangents.step)
            operators, conduction = tangents.last, self._thermal.conduction
            heat = supplied + conduction.linearisation_error(rise, tangents.reference)
            return operators, heat, operators.baseline(operators.rise(load, heat), rise)

        return NonlinearHeatStep(linearise, self._system.comm, load, rise, change)

    def _tangent(self, rise: np.ndarray, step: float | None) -> TangentOperators:
        """Operators linearised at a rise (n_owned,), steady or of a time step; every rank calls."""
        conduction = self._thermal.conduction.tangent(rise, step)
        return TangentOperators(
            self._system, conduction, condense_heat(conduction, self._thermal.face), rise
        )
