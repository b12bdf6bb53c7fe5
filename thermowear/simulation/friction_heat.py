"""Friction heat as part of the interface problem: it is proportional to the pressure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..contact.heat import HeatExchange, ThermalDistortion
from .system import System, ThermalSystem


@dataclass(frozen=True)
class Coupling:
    """What heat does to the interface for one set of touching points.

    Attributes
    ----------
    exchange : HeatExchange
    compliance : ndarray, shape (m, m)
        Weak gap per pressure coefficient, ``H diag(mu v) Ψ``: to be added to the elastic one.
    resting : ndarray, shape (m,)
        Weak gap of heat that does not come from friction [m³].
    """

    exchange: HeatExchange
    compliance: np.ndarray
    resting: np.ndarray


class FrictionHeat:
    """Couples pressure, temperature and distortion at the contact points.

    Parameters
    ----------
    system : System
    thermal : ThermalSystem
    distortion : ThermalDistortion
    """

    def __init__(self, system: System, thermal: ThermalSystem, distortion: ThermalDistortion):
        self._thermal = thermal
        self._distortion = distortion
        self._per_pressure = system.friction_heat(np.ones(len(system.weights)))
        self._basis = system.basis
        self._kept: tuple[bytes, Coupling] | None = None

    def coupling(self, closed: np.ndarray) -> Coupling:
        """Coupling for a set of touching points; the last one is kept, as sets seldom change.

        Parameters
        ----------
        closed : ndarray of bool, shape (n,)
        """
        key = closed.tobytes()
        if self._kept is None or self._kept[0] != key:
            exchange = self._thermal.face.exchange(closed)
            per_heat, resting = self._distortion.per_friction_heat(exchange)
            compliance = per_heat @ (self._per_pressure[:, None] * self._basis)
            self._kept = (key, Coupling(exchange, compliance, resting))
        return self._kept[1]

    def hottest(self, pressure: np.ndarray) -> float:
        """Highest temperature of both faces under a pressure at the points [K]."""
        state = self.coupling(pressure > 0).exchange.state(self._per_pressure * pressure)
        return float(np.max(state.rise) + self._thermal.ambient)
