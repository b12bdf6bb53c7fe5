"""Heat at one moment, as contact sees it: conduction condensed to the interface."""

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
    """What heat does to the interface under some conditions.

    Attributes
    ----------
    compliance : ndarray, shape (m, m)
        Weak gap per pressure coefficient, ``H diag(mu v) Ψ``: to be added to the elastic one.
    resting : ndarray, shape (m,)
        Weak gap of heat that does not come from friction [m³].
    """

    compliance: np.ndarray
    resting: np.ndarray


class HeatOperators:
    """Conduction condensed to the interface: steady, or over a step of time of one size.

    The last exchange and coupling are kept, as conditions seldom change.

    Parameters
    ----------
    conduction : Conduction
    face : InterfaceHeat
    condensed : callable
        Condenses the distortion by that conduction to the pressure space.
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
        """How heat crosses the interface for conductances at the points, shape (n,)."""
        key = conductance.tobytes()
        if self._exchange is None or self._exchange[0] != key:
            self._exchange = (key, self.face.exchange(conductance))
        return self._exchange[1]

    def compliance(self, conditions: InterfaceConditions, basis: np.ndarray) -> np.ndarray:
        """``H diag(mu v) Ψ``, shape (m, m)."""
        key = conditions.conductance.tobytes() + conditions.heating.tobytes()
        if self._compliance is None or self._compliance[0] != key:
            per_heat = self.distortion.per_friction_heat(self.exchange(conditions.conductance))
            self._compliance = (key, per_heat @ (conditions.heating[:, None] * basis))
        return self._compliance[1]


class HeatStage(Protocol):
    """Heat at one moment, as contact sees it."""

    def faces(self, conditions: InterfaceConditions, pressure: np.ndarray) -> ThermalState:
        """Temperatures and fluxes of the faces under a pressure at the points [Pa]."""

    def coupling(self, conditions: InterfaceConditions, basis: np.ndarray) -> Coupling:
        """What heat does to the condensed interface."""

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Whether the last coupling is right under the pressure that it has led to.

        Where it is not, the next one is nearer.
        """


class ConductingStage(HeatStage, Protocol):
    """Heat that the bodies conduct, as opposed to that of the first moment."""

    @property
    def load(self) -> ThermalLoad:
        """What heats or cools the bodies beside friction."""

    @property
    def unheated(self) -> ThermalState:
        """The faces without any heat at the contact."""

    def rise(self, faces: ThermalState) -> np.ndarray:
        """Temperature rise of the bodies, shape (n_owned,) [K]."""


@dataclass(frozen=True)
class LinearHeatStep:
    """Conduction at one moment: its operators, and what the bodies bring along.

    Attributes
    ----------
    operators : HeatOperators
    load : ThermalLoad
    supplied : ndarray, shape (n_owned,)
        Nodal heat beside that of the contact: of the loads, and what the bodies have stored before,
        per time [W].
    resting : BaselineResponse
    """

    operators: HeatOperators
    load: ThermalLoad
    supplied: np.ndarray
    resting: BaselineResponse

    @property
    def unheated(self) -> ThermalState:
        """The faces without any heat at the contact."""
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
        """What heat does to the condensed interface."""
        operators = self.operators
        exchange = operators.exchange(conditions.conductance)
        return Coupling(
            operators.compliance(conditions, basis),
            operators.distortion.at_rest(exchange, self.resting),
        )

    def holds(self, conditions: InterfaceConditions, pressure: np.ndarray) -> bool:
        """Linear heat is right at once."""
        return True


class InitialHeat:
    """The first moment, in which no friction heat has flowed yet.

    Attributes
    ----------
    stored : StoredHeat
    initial : ThermalState
        Of the faces.
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
