"""Heat at the interface: temperatures and fluxes of the faces.

The bodies are linear and are condensed to the nodes of their contact faces once (`condensation`);
their coupling (conductance, perfect contact, separated points) is solved with dense matrices of
these nodes in `heat_exchange`, or without condensation in `coupled_heat`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...serialise import serialisable

NO_HEAT_SINK = (
    "heat: a body is heated that nothing cools and that touches nothing, so that it has no steady "
    "temperature; give it heat.cooling, heat.temperature, or heat.gap_conductance"
)


@serialisable
@dataclass(frozen=True)
class ThermalState:
    """Thermal state at the contact points, shape (n,) each; index 0 is body 1.

    Attributes
    ----------
    rise : tuple of ndarray
        Temperature rise of each face above ambient [K].
    flux : tuple of ndarray
        Heat into each body [W/m²].
    """

    rise: tuple[np.ndarray, np.ndarray]
    flux: tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class BaselineResponse:
    """Response of the bodies without heat at the contact: given temperatures, or stored heat.

    Attributes
    ----------
    rise : tuple of ndarray, shape (n,)
        Temperature rise of the faces [K].
    opening : ndarray or None, shape (m,)
        Weak gap opened by it [m³]; None if not requested.
    """

    rise: tuple[np.ndarray, np.ndarray]
    opening: np.ndarray | None = None

    @property
    def unheated(self) -> ThermalState:
        """State of the faces without any heat at the contact."""
        zeros = np.zeros(len(self.rise[0]))
        return ThermalState(self.rise, (zeros, zeros))
