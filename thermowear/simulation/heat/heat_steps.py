"""Heat at one time, coupled to the contact solver: linear conduction, or given temperatures."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...bulk.heat.conduction import Conduction
from ...contact.operators.heat import (
    BaselineResponse,
    HeatExchange,
    InterfaceHeat,
    ThermalDistortion,
    ThermalState,
)
from ...serialise import serialisable
from ..system.conditions import InterfaceConditions
from ..system.thermal_loads import ThermalLoad
from .distortion import CondensedDistortion


@serialisable
@dataclass(frozen=True)
class StoredHeat:
    """Heat stored in the bodies in transient conduction.

    Attributes
    ----------
    rise : ndarray, shape (n_owned,)
        Nodal temperature rise over the ambient [K].
    content : ndarray, shape (n_owned,)
        Nodal heat content over the ambient [J].
    turnover : ndarray, shape (3,)
        Cumulated heat input by friction and through surfaces, heat lost, and sum of the magnitudes
        of all heat in and out [J].
    largest : float
        Largest magnitude so far of the rise of the faces; also inside the bodies where friction is
        not the only heat source [K].
    """

    rise: np.ndarray
    content: np.ndarray
    turnover: np.ndarray
    largest: float

    def towards(self, other: StoredHeat, part: float) -> StoredHeat:
        """Interpolate linearly (or extrapolate) to another state by a fraction of the way."""
        return StoredHeat(
            self.rise + part * (other.rise - self.rise),
            self.content + part * (other.content - self.content),
            self.turnover + part * (other.turnover - self.turnover),
            other.largest,
        )


class HeatOperators:
    """Linear conduction condensed to the interface: steady, or over a time step of one size.

    The last exchange and couplings are kept, as conditions seldom change.

    Parameters
    ----------
    conduction : Conduction
    face : InterfaceHeat
    condensed : CondensedDistortion
    reference : ndarray, shape (n_owned,)
        Rise at which conduction and distortion are linearised [K].
    """

    def __init__(
        self,
        conduction: Conduction,
        face: InterfaceHeat,
        condensed: CondensedDistortion,
        reference: np.ndarray,
    ):
        self.conduction = conduction
        self.face = face
        self.reference = reference
        self._condensed = condensed
        self._exchange: tuple[bytes, HeatExchange] | None = None
        self._compliance: tuple[HeatExchange, bytes, np.ndarray] | None = None
        self._opening: tuple[HeatExchange, BaselineResponse, np.ndarray] | None = None

    @cached_property
    def distortion(self) -> ThermalDistortion:
        """Weak gap per heat at the faces. Every rank calls."""
        return self._condensed(self.conduction, self.face, lambda: self.per_rise)

    @cached_property
    def per_rise(self) -> np.ndarray:
        """Derivative of the weak gap by the nodal rise, shape (n_owned, m) [m³/K]."""
        return self._condensed.slope(self.reference)

    def exchange(self, conductance: np.ndarray) -> HeatExchange:
        """Heat exchange of the faces for conductances at the points, shape (n,)."""
        key = conductance.tobytes()
        if self._exchange is None or self._exchange[0] != key:
            self._exchange = None  # frees its memory
            self._exchange = key, self.face.exchange(conductance)
        return self._exchange[1]

    def compliance(self, exchange: HeatExchange, heating: np.ndarray, basis: np.ndarray):
        """Thermal compliance ``H diag(mu v) Ψ`` for a heating ``mu v`` (n,) [m/s], (m, m)."""
        key, last = heating.tobytes(), self._compliance
        if last is None or last[0] is not exchange or last[1] != key:
            per_heat = self.distortion.per_friction_heat(exchange)
            last = self._compliance = exchange, key, per_heat @ (heating[:, None] * basis)
        return last[2]

    def opening(self, exchange: HeatExchange, resting: BaselineResponse) -> np.ndarray:
        """Weak gap by heat other than friction heat, shape (m,) [m³]."""
        last = self._opening
        if last is None or last[0] is not exchange or last[1] is not resting:
            found = self.distortion.baseline_gap(exchange, resting)
            last = self._opening = exchange, resting, found
        return last[2]


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
        return self.operators.conduction.with_prescribed(self.load.given).solve(heat)

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
        exchange = self.operators.exchange(conditions.conductance)
        compliance = self.operators.compliance(exchange, conditions.heating, basis)
        return compliance, self.operators.opening(exchange, self.resting)

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Test whether the last coupling has converged at a pressure: linear heat always has."""
        return True


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
