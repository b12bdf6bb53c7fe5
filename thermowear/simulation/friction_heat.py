"""Friction heat as part of the interface problem: it is proportional to the pressure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..contact.heat import HeatExchange, ThermalState
from .system import System
from .thermal_system import ThermalSystem


@dataclass(frozen=True)
class Coupling:
    """What heat does to the interface for one set of touching points.

    Attributes
    ----------
    compliance : ndarray, shape (m, m)
        Weak gap per pressure coefficient, ``H diag(mu v) Ψ``: to be added to the elastic one.
    resting : ndarray, shape (m,)
        Weak gap of heat that does not come from friction [m³].
    """

    compliance: np.ndarray
    resting: np.ndarray


class FrictionHeat:
    """Couples pressure, temperature and distortion at the contact points.

    The last exchange and coupling are kept, as sets of touching points seldom change.

    Parameters
    ----------
    system : System
    thermal : ThermalSystem
    """

    def __init__(self, system: System, thermal: ThermalSystem):
        self._system = system
        self._thermal = thermal
        self._per_pressure = system.friction_heat(np.ones(len(system.weights)))
        self._exchange: tuple[bytes, HeatExchange] | None = None
        self._coupling: tuple[bytes, Coupling] | None = None

    def exchange(self, closed: np.ndarray) -> HeatExchange:
        """How heat crosses the interface for a set of touching points, shape (n,)."""
        key = closed.tobytes()
        if self._exchange is None or self._exchange[0] != key:
            self._exchange = (key, self._thermal.face.exchange(closed))
        return self._exchange[1]

    def coupling(self, closed: np.ndarray) -> Coupling:
        """What heat does to the condensed interface for a set of touching points, shape (n,)."""
        key = closed.tobytes()
        if self._coupling is None or self._coupling[0] != key:
            distortion = self._system.distortion
            assert distortion is not None  # there is a thermal system
            per_heat, resting = distortion.per_friction_heat(self.exchange(closed))
            compliance = per_heat @ (self._per_pressure[:, None] * self._system.basis)
            self._coupling = (key, Coupling(compliance, resting))
        return self._coupling[1]

    def state(self, pressure: np.ndarray, closed: np.ndarray) -> ThermalState:
        """Temperatures and fluxes of the faces under a pressure at the points [Pa]."""
        return self.exchange(closed).state(self._per_pressure * pressure)

    def hottest(self, pressure: np.ndarray) -> float:
        """Highest temperature of both faces under a pressure at the points [K]."""
        rise = self.state(pressure, pressure > 0).rise
        return float(np.max(rise) + self._thermal.ambient)
