"""Heat at the interface: friction heat, its partition, exchange between the faces.

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
from .pressure import Basis

_REGULARITY = 1e-12
"""Regularisation of an infinite resistance, relative to that of the bodies: keeps heat flux
functions independent that differ only where no heat crosses."""
_MAX_DIRECT_RATIO = 10.0
"""Largest conductance treated point by point, relative to that of a layer of the bodies as thick as
the support of a basis function."""
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

    def divided(self, conductance: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Divide conductances (n,) into parts that are finite and well scaled.

        Up to a conductance ``k``, a multiple of that of the bodies, heat crosses point by point:
        ``c = h (T2 - T1)``. Nonmatching finite elements cannot represent a larger one pointwise,
        and small temperature differences times large numbers would lose digits: the excess
        ``h - k`` has a resistance ``r = 1/(h - k)``, zero in perfect contact, and an unknown of
        moderate size, ``z = Ψ μ``. With ``η = 1/(1 + k r)`` it gives both the exchanged heat
        ``η z`` and the temperature jump ``r η z = (1 - η) z / k``, which is imposed weakly with the
        test functions ``η Ψ``. The equations are symmetric and regular from zero to infinite
        conductance.

        Returns
        -------
        direct : ndarray, shape (n,)
            Conductance point by point [W/(m² K)].
        passing_fraction : ndarray, shape (n,)
            Fraction η.
        resistance : ndarray, shape (n,)
            Resistance ``η r η`` of the unknowns [m² K/W].
        """
        limit = _MAX_DIRECT_RATIO * self.shift * self.basis.shape[1]
        direct = np.minimum(conductance, limit)
        passing_fraction, blocked_fraction = _parts(limit, conductance - direct)
        resistance = blocked_fraction * (passing_fraction + _REGULARITY * blocked_fraction) / limit
        return direct, passing_fraction, resistance


def _parts(limit: float, conductance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fractions ``h/(h + k)`` and ``k/(h + k)`` of conductances from zero to infinity."""
    inverse = np.full(len(conductance), np.inf)
    np.divide(limit, conductance, out=inverse, where=conductance > 0)
    return 1 / (1 + inverse), limit / (limit + conductance)


def baseline_response(
    rise: np.ndarray,
    traces: tuple[sp.csr_matrix, sp.csr_matrix],
    comm,
    opening: np.ndarray | None = None,
) -> BaselineResponse:
    """Response of the faces to a nodal rise (n_owned,), with the weak gap opened by it."""
    T1, T2 = (sum_over_ranks(comm, trace.T @ rise) for trace in traces)
    return BaselineResponse((T1, T2), opening)
