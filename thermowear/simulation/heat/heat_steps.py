"""Heat at one time, coupled to the contact solver: linear, nonlinear, or given temperatures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...contact.operators.heat import BaselineResponse, ThermalState
from ...errors import ComputationError
from ..system.conditions import InterfaceConditions
from ..system.thermal_loads import ThermalLoad
from .heat_operators import HeatOperators
from .heat_states import StoredHeat

_TURNS = 60
_SETTLED = 1e-11
"""Tolerance of the change of the temperatures, relative to the largest rise."""
_SLOW = 0.3
"""Convergence rate of Newton's method above which the tangents are renewed."""
_LEAST_RISE = 1.0  # K


@dataclass(frozen=True)
class LinearHeatStep:
    """Linear conduction at one time: operators, loads and stored heat.

    Attributes
    ----------
    operators : HeatOperators
    load : ThermalLoad
    supplied : ndarray, shape (n_owned,)
        Nodal heat beside that of the contact: loads, and heat stored before the step per step
        size [W].
    resting : BaselineResponse
        Response of the faces without heat at the contact.
    """

    operators: HeatOperators
    load: ThermalLoad
    supplied: np.ndarray
    resting: BaselineResponse

    @property
    def unheated(self) -> ThermalState:
        """State of the faces without any heat at the contact."""
        nothing = np.zeros(len(self.resting.rise[0]))
        return ThermalState(self.resting.rise, (nothing, nothing))

    def faces(self, conditions: InterfaceConditions, pressure: np.ndarray) -> ThermalState:
        """Temperatures and fluxes of the faces under a pressure at the points [Pa]."""
        exchange = self.operators.exchange(conditions.conductance)
        return exchange.state(conditions.heating * pressure, self.resting)

    def rise(self, faces: ThermalState) -> np.ndarray:
        """Temperature rise of the bodies, shape (n_owned,) [K]."""
        heat = self.operators.face.nodal_heat(faces, bath=True) + self.supplied
        return self.load.on(self.operators.conduction).solve(heat)

    def coupling(
        self, conditions: InterfaceConditions, basis: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Thermal contribution to the condensed interface.

        Returns
        -------
        compliance : ndarray, shape (m, m)
            Weak gap per pressure coefficient, added to the elastic compliance.
        opening : ndarray, shape (m,)
            Weak gap by heat other than friction heat [m³].
        """
        operators = self.operators
        exchange = operators.exchange(conditions.conductance)
        opening = operators.distortion.baseline_gap(exchange, self.resting)
        return operators.compliance(conditions, basis), opening

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Test whether the last coupling has converged at a pressure: linear heat always has."""
        return True


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


class InitialHeat:
    """Given temperatures of the bodies, without friction heat.

    Attributes
    ----------
    stored : StoredHeat
    initial : ThermalState
        Temperatures of the faces, with zero flux.
    """

    def __init__(self, stored: StoredHeat, resting: BaselineResponse):
        nothing = np.zeros(len(resting.rise[0]))
        self.stored = stored
        self.initial = ThermalState(resting.rise, (nothing, nothing))
        self._resting = resting

    def faces(self, conditions: InterfaceConditions, pressure: np.ndarray) -> ThermalState:
        return self.initial

    def coupling(
        self, conditions: InterfaceConditions, basis: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        opening, m = self._resting.opening, basis.shape[1]
        assert opening is not None
        return np.zeros((m, m)), opening

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        return True


ConductingStep = LinearHeatStep | NonlinearHeatStep
HeatStep = ConductingStep | InitialHeat
