"""Heat at one time: conduction condensed to the interface, for the contact solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from ...bulk.heat.conduction import Conduction
from ...contact.operators.heat import BaselineResponse, HeatExchange, InterfaceHeat, ThermalState
from ...contact.operators.heat_condensation import ThermalDistortion
from ..model.conditions import InterfaceConditions
from ..model.thermal_loads import ThermalLoad
from .heat_states import StoredHeat


@dataclass(frozen=True)
class Coupling:
    """Thermal contribution to the condensed interface under given conditions.

    Attributes
    ----------
    compliance : ndarray, shape (m, m)
        Weak gap per pressure coefficient, ``H diag(mu v) Ψ``, added to the elastic compliance.
    resting : ndarray, shape (m,)
        Weak gap by heat other than friction heat [m³].
    """

    compliance: np.ndarray
    resting: np.ndarray


class HeatOperators:
    """Conduction condensed to the interface: steady, or over a time step of one size.

    The last exchange and coupling are cached, as conditions seldom change.

    Parameters
    ----------
    conduction : Conduction
    face : InterfaceHeat
    condensed : callable
        Condensation of the distortion by that conduction to the pressure space.
    """

    def __init__(
        self,
        conduction: Conduction,
        face: InterfaceHeat,
        condensed: Callable[[Conduction, InterfaceHeat], ThermalDistortion],
    ):
        self.conduction = conduction
        self.face = face
        self._condensed = condensed
        self._exchange: tuple[bytes, HeatExchange] | None = None
        self._compliance: tuple[bytes, np.ndarray] | None = None

    @cached_property
    def distortion(self) -> ThermalDistortion:
        """Weak gap per heat at the faces. Every rank calls."""
        return self._condensed(self.conduction, self.face)

    def exchange(self, conductance: np.ndarray) -> HeatExchange:
        """Heat exchange of the faces for conductances at the points, shape (n,)."""
        key = conductance.tobytes()
        if self._exchange is None or self._exchange[0] != key:
            self._exchange = (key, self.face.exchange(conductance))
        return self._exchange[1]

    def compliance(self, conditions: InterfaceConditions, basis: np.ndarray) -> np.ndarray:
        """Thermal compliance ``H diag(mu v) Ψ``, shape (m, m)."""
        key = conditions.conductance.tobytes() + conditions.heating.tobytes()
        if self._compliance is None or self._compliance[0] != key:
            per_heat = self.distortion.per_friction_heat(self.exchange(conditions.conductance))
            self._compliance = (key, per_heat @ (conditions.heating[:, None] * basis))
        return self._compliance[1]


class HeatStage(Protocol):
    """Heat at one time: interface to the contact solver."""

    def faces(self, conditions: InterfaceConditions, pressure: np.ndarray) -> ThermalState:
        """Temperatures and fluxes of the faces under a pressure at the points [Pa]."""

    def coupling(self, conditions: InterfaceConditions, basis: np.ndarray) -> Coupling:
        """Thermal coupling of the condensed interface."""

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Test whether the last coupling has converged at the pressure computed with it.

        If not, relinearise for the next coupling.
        """


class ConductingStage(HeatStage, Protocol):
    """Heat with conduction in the bodies, as opposed to the initial temperatures."""

    @property
    def load(self) -> ThermalLoad:
        """Thermal loads beside friction."""

    @property
    def unheated(self) -> ThermalState:
        """State of the faces without any heat at the contact."""

    def rise(self, faces: ThermalState) -> np.ndarray:
        """Temperature rise of the bodies, shape (n_owned,) [K]."""


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

    def coupling(self, conditions: InterfaceConditions, basis: np.ndarray) -> Coupling:
        """Thermal coupling of the condensed interface."""
        operators = self.operators
        exchange = operators.exchange(conditions.conductance)
        return Coupling(
            operators.compliance(conditions, basis),
            operators.distortion.at_rest(exchange, self.resting),
        )

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """True: linear heat converges at once."""
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

    def coupling(self, conditions: InterfaceConditions, basis: np.ndarray) -> Coupling:
        opening, m = self._resting.opening, basis.shape[1]
        assert opening is not None
        return Coupling(np.zeros((m, m)), opening)

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        return True
