"""Heat at the interface: friction heat, its partition, exchange between the faces.

The bodies are linear and are condensed to their contact points once (`condensation`); their
coupling (conductance, perfect contact, separated points) is solved here with small dense matrices.
Bodies with many contact points are coupled without condensation in `coupled_heat`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ...errors import ComputationError
from ...parallel import sum_over_ranks
from ...serialise import serialisable
from .pressure import Basis, dense

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


@dataclass(frozen=True)
class InterfaceHeat(FaceHeat):
    """Heat conduction in both bodies, condensed to the contact points.

    Attributes
    ----------
    response : tuple of ndarray, shape (n, n)
        Face rise per heat flux at the points, the bath included [m² K/W].
    """

    response: tuple[np.ndarray, np.ndarray]

    def exchange(self, conductance: np.ndarray) -> HeatExchange:
        """Couple the faces by a conductance, see `divided`.

        Parameters
        ----------
        conductance : ndarray, shape (n,)
            Conductance of the contact or the gap at each point [W/(m² K)]; infinite in perfect
            contact.

        Raises
        ------
        ComputationError
            If a heated body has no heat sink.
        """
        n, s, (Θ1, Θ2) = len(self.weights), self.shift, self.response
        direct, passing_fraction, resistance = self.divided(conductance)
        basis = dense(self.basis)
        crossing = passing_fraction[:, None] * basis
        jump = crossing.T * self.weights
        resisted = (basis.T * (self.weights * resistance)) @ basis
        sizes = np.sqrt(np.diag(resisted) + np.einsum("in,nm,mi->i", jump, Θ1 + Θ2, crossing))
        crossing, jump = crossing / sizes, jump / sizes[:, None]
        identity, count = np.eye(n), len(sizes)
        matrix = np.block(
            [
                [identity - Θ1 * (s - direct), -Θ1 * direct, -Θ1 @ crossing],
                [-Θ2 * direct, identity - Θ2 * (s - direct), Θ2 @ crossing],
                [-jump, jump, -resisted / np.outer(sizes, sizes)],
            ]
        )
        try:
            rise = np.linalg.solve(matrix, np.eye(2 * n + count, 2 * n))
        except np.linalg.LinAlgError:
            raise ComputationError(NO_HEAT_SINK) from None
        across = direct[:, None] * (rise[n : 2 * n] - rise[:n]) + crossing @ rise[2 * n :]
        return HeatExchange(self, rise[: 2 * n], across)


@dataclass(frozen=True)
class HeatExchange:
    """Coupled faces: linear map from the temperature rises without exchange.

    Attributes
    ----------
    interface : InterfaceHeat
    rise : ndarray, shape (2 n, 2 n)
        Temperature rises of both faces, stacked.
    crossing : ndarray, shape (n, 2 n)
        Heat from body 2 to body 1 [W/(m² K)].
    """

    interface: InterfaceHeat
    rise: np.ndarray
    crossing: np.ndarray

    def state(self, friction_heat: np.ndarray, baseline: BaselineResponse) -> ThermalState:
        """Temperatures and fluxes due to friction heat [W/m²] at the points, shape (n,)."""
        uncoupled_rise = self._uncoupled_per_heat @ friction_heat + np.concatenate(baseline.rise)
        T1, T2 = np.split(self.rise @ uncoupled_rise, 2)
        crossing = self.crossing @ uncoupled_rise
        f = self.interface.partition
        return ThermalState(
            (T1, T2), (f * friction_heat + crossing, (1 - f) * friction_heat - crossing)
        )

    def into_bath(self, uncoupled_rise: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Exchanged heat and heat of the bath, into both bodies, from rises without exchange."""
        T1, T2 = np.split(self.rise @ uncoupled_rise, 2)
        crossing, s = self.crossing @ uncoupled_rise, self.interface.shift
        return crossing + s * T1, s * T2 - crossing

    @cached_property
    def crossing_per_friction_heat(self) -> np.ndarray:
        """Heat from body 2 to body 1 per friction heat, shape (n, n)."""
        return self.crossing @ self._uncoupled_per_heat

    @cached_property
    def per_friction_heat(self) -> tuple[np.ndarray, np.ndarray]:
        """Heat into both bodies per friction heat, bath included, shape (n, n)."""
        first, second = self.into_bath(self._uncoupled_per_heat)
        f, identity = self.interface.partition, np.eye(len(self.interface.weights))
        return f * identity + first, (1 - f) * identity + second

    @cached_property
    def _uncoupled_per_heat(self) -> np.ndarray:
        """Rises of both faces without exchange per friction heat, shape (2 n, n)."""
        f, (Θ1, Θ2) = self.interface.partition, self.interface.response
        return np.vstack([f * Θ1, (1 - f) * Θ2])


@dataclass(frozen=True)
class ThermalDistortion:
    """Thermal distortion: weak gap opened by heat (negative: closed).

    Attributes
    ----------
    per_flux : tuple of ndarray, shape (m, n)
        Weak gap per heat flux into each body at the points, bath included [m³ per W/m²].
    """

    per_flux: tuple[np.ndarray, np.ndarray]

    def per_friction_heat(self, exchange: HeatExchange) -> np.ndarray:
        """Weak gap of coupled faces per friction heat, H, shape (m, n)."""
        first, second = exchange.per_friction_heat
        return self.per_flux[0] @ first + self.per_flux[1] @ second

    def baseline_gap(self, exchange: HeatExchange, baseline: BaselineResponse) -> np.ndarray:
        """Weak gap of coupled faces without friction heat, shape (m,)."""
        assert baseline.opening is not None
        first, second = exchange.into_bath(np.concatenate(baseline.rise))
        return self.per_flux[0] @ first + self.per_flux[1] @ second + baseline.opening


def _parts(limit: float, conductance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fractions ``h/(h + k)`` and ``k/(h + k)`` of conductances from zero to infinity."""
    inverse = np.full(len(conductance), np.inf)
    np.divide(limit, conductance, out=inverse, where=conductance > 0)
    return 1 / (1 + inverse), limit / (limit + conductance)


def baseline_response(
    rise: np.ndarray,
    traces: tuple[sp.csr_matrix, sp.csr_matrix],
    comm,
    per_rise: np.ndarray | None = None,
    excess: np.ndarray | float = 0.0,
) -> BaselineResponse:
    """Response of faces and, with `per_rise`, of the weak gap to a nodal rise (n_owned,).

    The weak gap may have a part of this rank in `excess` of the linear one.
    """
    T1, T2 = (sum_over_ranks(comm, trace.T @ rise) for trace in traces)
    opening = None if per_rise is None else sum_over_ranks(comm, per_rise.T @ rise + excess)
    return BaselineResponse((T1, T2), opening)
