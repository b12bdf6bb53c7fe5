"""Heat at the interface: temperatures and fluxes of the faces.

The bodies are linear and are condensed to the nodes of their contact faces once (`condensation`);
their coupling (conductance, perfect contact, separated points) is solved with dense matrices of
these nodes in `heat_exchange`, or without condensation in `coupled_heat`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...parallel import sum_over_ranks
from ...serialise import serialisable
from .exchange_matrix import Division, divided
from .pressure import Basis

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


@dataclass(frozen=True)
class FaceHeat:
    """Heat at the contact points, and its exchange between the faces.

    Attributes
    ----------
    weights : ndarray, shape (n,)
        Areas of the points [m²].
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ of the exchanged heat in perfect contact.
    traces : tuple of csr_matrix, shape (n_owned, n)
        Transposed trace Eᵀ of each face.
    shift : float
        Heat transfer to a bath at ambient included in the factorised conduction on both faces, and
        subtracted again here [W/(m² K)].
    partition : float or ndarray, shape (n,)
        Fraction of the friction heat released on body 1.
    """

    weights: np.ndarray
    basis: Basis
    traces: tuple[sp.csr_matrix, sp.csr_matrix]
    shift: float
    partition: float | np.ndarray

    def nodal_heat(self, state: ThermalState, bath: bool) -> np.ndarray:
        """Nodal heat of the contact [W], owned rows; heat of the bath included on request."""
        shift = self.shift if bath else 0.0
        first, second = (
            trace @ (self.weights * (flux + shift * rise))
            for trace, rise, flux in zip(self.traces, state.rise, state.flux, strict=True)
        )
        return first + second

    def state(
        self, rise: tuple[np.ndarray, np.ndarray], friction_heat: np.ndarray, crossing: np.ndarray
    ) -> ThermalState:
        """State by the rises [K], and friction heat and heat from body 2 to 1 (n,) [W/m²]."""
        f = self.partition
        return ThermalState(
            rise, (f * friction_heat + crossing, (1 - f) * friction_heat - crossing)
        )

    def divided(self, conductance: np.ndarray) -> Division:
        """Divide conductances (n,) into parts that are finite and well scaled."""
        return divided(conductance, self.shift * self.basis.shape[1])


def at_faces(
    rise: np.ndarray, traces: tuple[sp.csr_matrix, sp.csr_matrix], comm
) -> tuple[np.ndarray, np.ndarray]:
    """Values of a nodal rise (n_owned,) at the points of both faces, shape (n,) each."""
    first, second = (sum_over_ranks(comm, trace.T @ rise) for trace in traces)
    return first, second


def baseline_response(
    rise: np.ndarray, traces: tuple[sp.csr_matrix, sp.csr_matrix], comm, opening=None
) -> BaselineResponse:
    """Response of the faces to a nodal rise (n_owned,), with the weak gap opened by it."""
    return BaselineResponse(at_faces(rise, traces, comm), opening)
