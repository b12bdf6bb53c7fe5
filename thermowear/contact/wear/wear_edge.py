"""Pressure space of a contact that grows by wear: pointwise at the edge of the worn zone.

Where a layer is worn through, the pressure has such a jump at the edge of the next one.

The pressure of a worn contact has a jump at its edge, which travels through the elements. In an
element that it crosses, weak contact has two errors: the open gap beyond the edge contributes to
the means that close the gap before it, so that too much is worn there; and the best approximation
of a jump by continuous functions overshoots (by 27 % for linear ones). The facets at the edge
therefore have one pressure per contact point, with pointwise contact conditions.

The bodies are loaded by the projection ``Π p`` of the pressure on the pressure space, and their
deflection is projected likewise; weak values are the same as before::

    gap = g + Π C Π p + ε (p - Π p),    Π = Ψ (Ψᵀ w Ψ)⁻¹ Ψᵀ w

The remainder has shorter wavelengths than the pressure space. The response to it is about that to
the shortest wave of the space, with the compliance ε. Where faces conform and the pressure is
smooth, as behind the edge, the remainder vanishes, and weak contact is recovered.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..operators.condensation import CondensedContact
from ..operators.pressure import Basis, PressureSpace, dense, scaled
from ..operators.rigid_motion import RigidHolder

_ZERO = 1e-12
"""Relative area of a basis function that counts as zero."""
_SMOOTH = 1e-3
"""Largest projection remainder of a smooth pressure, relative to the largest pressure."""
_EDGE_ADVANCE = 2
"""Number of facets that the edge may advance in a step, see `has_passed`."""


def edge_points(facets: sp.csr_array, basis: Basis, reached: np.ndarray) -> np.ndarray:
    """Contact points of the facets at the edge of the worn zone, or within its reach in a step.

    These facets have unworn points, and are at most `_EDGE_ADVANCE` facets away from facets with
    worn points; beyond them, contact would be weak at the edge.

    Parameters
    ----------
    facets : csr_array of bool, shape (n_facets, n)
        Points on each facet.
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ.
    reached : ndarray of bool, shape (n,)
        Worn points.

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    near = facets @ reached
    for _ in range(_EDGE_ADVANCE):
        shared = basis[near @ facets].sum(axis=0) > 0.0
        near = facets @ (basis[:, shared].sum(axis=1) > 0.0)
    return (near & (facets @ ~reached)) @ facets


def has_passed(basis: Basis, points: np.ndarray, before: np.ndarray, after: np.ndarray) -> bool:
    """Test whether the edge of the worn zone has passed the edge points.

    True if edge points and other points that share a basis function with them were reached in the
    same step; a new contact elsewhere does not count.

    Parameters
    ----------
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ.
    points : ndarray of bool, shape (n,)
        Result of `edge_points`.
    before, after : ndarray of bool, shape (n,)
        Worn points before and after the step.
    """
    new = after & ~before
    shared = basis[new & points].sum(axis=0) > 0.0
    return bool(basis[new & ~points][:, shared].sum() > 0.0)


def rough_points(
    facets: sp.csr_array, basis: Basis, weights: np.ndarray, pressure: np.ndarray
) -> np.ndarray:
    """Contact points of the facets where a pressure is outside of the pressure space.

    Parameters
    ----------
    facets : csr_array of bool, shape (n_facets, n)
        Points on each facet.
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ.
    weights : ndarray, shape (n,) [m²]
    pressure : ndarray, shape (n,) [Pa]

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    space = PressureSpace(basis, scaled(weights, basis))
    left = pressure - basis @ space.projected(pressure)
    return (facets @ (np.abs(left) > _SMOOTH * pressure.max())) @ facets


def closing_times(start: np.ndarray, middle: np.ndarray, end: np.ndarray, step: float):
    """Times at which the edge of the worn zone reaches contact points, from the start of a step.

    A point with pointwise contact takes up pressure within about the time in which wear equals the
    deflection under it. Steps that end just after this time are the largest ones that resolve it;
    the time is extrapolated from the gaps of the points.

    Gaps open at the end of the step close at the zero of the parabola through all three values, or
    at its vertex if it has none; gaps open until the middle, at the zero of the line.

    Parameters
    ----------
    start, middle, end : ndarray, shape (n,)
        Gaps, 0 at closed points, NaN if unknown [m].
    step : float
        Step length [s].

    Returns
    -------
    ndarray, shape (n,)
        Closing times, infinite for gaps that open, are unknown or were closed until the middle [s].
    """
    slope = (start - 4 * middle + 3 * end) / step
    bend = 4 * (start - 2 * middle + end) / step**2
    with np.errstate(divide="ignore", invalid="ignore"):
        fall = np.sqrt(np.maximum(slope**2 - 2 * bend * end, 0.0)) - slope
        later = np.where(fall > 0.0, step + 2 * end / fall, np.inf)
        within = np.where((middle > 0.0) & (start > middle), start / (start - middle), np.inf)
    times = np.where(end > 0.0, later, step / 2 * within)
    return np.where(np.isnan(times), np.inf, times)


@dataclass(frozen=True)
class EdgeSpace(PressureSpace):
    """Pressure space of functions Ψ off given points, then of pressures of these single points.

    Attributes
    ----------
    points : ndarray of bool, shape (n,)
        Points with pointwise pressures of their own; those without area have that of the nearest.
    projection : ndarray, shape (m, k)
        Coefficients in Ψ of their projections, which load the bodies.
    local_compliance : ndarray, shape (k, k)
        Weak gap per coefficient due to the projection remainder.
    modes, force_modes : ndarray, shape (k, n_modes)
        See `CondensedContact`.
    """

    points: np.ndarray
    projection: np.ndarray
    local_compliance: np.ndarray
    modes: np.ndarray
    force_modes: np.ndarray

    @cached_property
    def area(self) -> np.ndarray:
        """Areas of the coefficients, shape (k,) [m²]."""
        return self.weighted.sum(axis=0)

    def compliance(self, compliance: np.ndarray) -> np.ndarray:
        """Weak gaps per coefficient, shape (k, k), from those of Ψ, shape (m, m)."""
        return self.projection.T @ compliance @ self.projection + self.local_compliance

    def pressing(self, pressure: np.ndarray) -> np.ndarray:
        """True for active coefficients of a pressure at the points, shape (k,)."""
        return self.weighted.T @ pressure > _ZERO * pressure.max() * self.area

    def at_points(self, weak: np.ndarray) -> np.ndarray:
        """Weak values (k,) per area at pointwise points; NaN at others and without area, (n,)."""
        result, count = np.full(len(self.points), np.nan), np.count_nonzero(self.points)
        area = self.area[-count:]
        means = np.full(count, np.nan)
        np.divide(weak[-count:], area, out=means, where=area > 0.0)
        result[self.points] = means
        return result


def edge_space(contact: CondensedContact, points: np.ndarray, holder: RigidHolder) -> EdgeSpace:
    """Build the pressure space of a contact with pointwise pressures at given points.

    Parameters
    ----------
    contact : CondensedContact
    points : ndarray of bool, shape (n,)
    holder : RigidHolder
    """
    weights = contact.weighted.sum(axis=1)
    share = (~points @ contact.weighted) / contact.weighted.sum(axis=0)
    cut = (share > _ZERO) & (share < 1.0 - _ZERO)
    whole = np.flatnonzero(share >= 1.0 - _ZERO)
    own_area = points & (weights > _ZERO * weights.max())
    single = _single_points(points, own_area, contact.basis)
    split = np.hstack([np.where(points[:, None], 0.0, dense(contact.basis[:, cut])), single])
    projection = contact.projected(split)
    left = split - contact.basis @ projection
    basis = np.hstack([dense(contact.basis[:, whole]), split])
    weighted = weights[:, None] * basis
    own = np.zeros((basis.shape[1],) * 2)
    yielding = (weights * shortest_compliance(contact))[:, None] * left
    own[len(whole) :, len(whole) :] = left.T @ yielding
    return EdgeSpace(
        points=own_area,
        basis=basis,
        weighted=weighted,
        projection=np.hstack([np.eye(len(share))[:, whole], projection]),
        local_compliance=own,
        modes=weighted.T @ holder.modes,
        force_modes=weighted.T @ holder.force_modes,
    )


def _single_points(points: np.ndarray, own: np.ndarray, basis: Basis) -> np.ndarray:
    """Functions of the points with an area of their own, shape (n, k).

    The others, as on the axis of symmetry, have the pressure of the nearest of them.
    """
    single = np.zeros((len(points), np.count_nonzero(own)))
    single[own] = np.eye(single.shape[1])
    bare = points & ~own
    if bare.any():
        distances = np.abs(dense(basis[bare])[:, None] - dense(basis[own])).sum(axis=2)
        single[bare] = single[own][distances.argmin(axis=1)]
    return single


def shortest_compliance(contact: CondensedContact) -> np.ndarray:
    """Compliance ε of the shortest pressure waves at the points, shape (n,) [m/Pa].

    Estimated by the diagonal of the stiffness A⁻¹, in which the soft long waves count little.
    """
    area = (contact.weighted * contact.basis).sum(axis=0)
    stiffness = area * np.diag(np.linalg.inv(contact.compliance))
    return contact.basis @ (1.0 / np.abs(stiffness))
