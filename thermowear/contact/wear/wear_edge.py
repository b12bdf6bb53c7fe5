"""Pressure space of a contact that grows by wear: point by point where the edge of the wear lies.

A worn contact ends with a jump of the pressure, which travels through the elements. In an element
that it crosses, weak contact goes wrong twice: the gap beyond the edge, still open, counts in the
means that close the gap before it, so too much is worn there; and the best approximation of a jump
by continuous functions overshoots (by 27 % for linear ones). So the facets at the edge of the wear
have a pressure for each contact point, and contact holds at each of them.

The bodies see the projection ``Π p`` of the pressure on the pressure space, and its points see the
projection of their deflection; both have the same means over the basis functions as before::

    gap = g + Π C Π p + ε (p - Π p),    Π = Ψ (Ψᵀ w Ψ)⁻¹ Ψᵀ w

What the projection leaves is shorter than any wave of the pressure space. The bodies yield to it
about as they do to the shortest of these, whose compliance is ε. Where faces fit and the
pressure is smooth, as it is behind the edge, nothing is left, and this is weak contact again.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..operators.condensation import CondensedContact
from ..operators.holder import Holder

_NONE = 1e-12
"""Of the area of a basis function."""
_SMOOTH = 1e-3
"""Of the largest pressure: what may be left by the projection on the pressure space."""
_AHEAD = 2
"""Facets that a step may take the edge to, see `has_passed`."""


def edge_points(facet: np.ndarray, basis: np.ndarray, reached: np.ndarray) -> np.ndarray:
    """Contact points of the facets where the edge of the wear lies, or may come to in a step.

    They have points that wear has not reached, and lie no more than `_AHEAD` facets before those
    that have one that it has: where the edge came to others, it would be weak contact again.

    Parameters
    ----------
    facet : ndarray of int, shape (n,)
        Of the points.
    basis : ndarray, shape (n, m)
        Ψ.
    reached : ndarray of bool, shape (n,)

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    near, partly = (np.zeros(facet.max() + 1, dtype=bool) for _ in range(2))
    near[facet[reached]] = True
    partly[facet[~reached]] = True
    for _ in range(_AHEAD):
        shared = np.any(basis[near[facet]] > 0.0, axis=0)
        near[facet[np.any(basis[:, shared] > 0.0, axis=1)]] = True
    return (near & partly)[facet]


def has_passed(
    basis: np.ndarray, points: np.ndarray, before: np.ndarray, after: np.ndarray
) -> bool:
    """Whether the edge of the wear has gone beyond the points that are there for it.

    It has where some of them and points that share a basis function with these have been reached
    in the same step. A contact that begins elsewhere has not.

    Parameters
    ----------
    basis : ndarray, shape (n, m)
        Ψ.
    points : ndarray of bool, shape (n,)
        From `edge_points`.
    before, after : ndarray of bool, shape (n,)
        Points that wear has reached.
    """
    new = after & ~before
    shared = np.any(basis[new & points] > 0.0, axis=0)
    return bool(np.any(basis[np.ix_(new & ~points, shared)] > 0.0))


def rough_points(
    facet: np.ndarray, basis: np.ndarray, weights: np.ndarray, pressure: np.ndarray
) -> np.ndarray:
    """Contact points of the facets where a pressure is not one of the pressure space.

    Parameters
    ----------
    facet : ndarray of int, shape (n,)
    basis : ndarray, shape (n, m)
        Ψ.
    weights : ndarray, shape (n,) [m²]
    pressure : ndarray, shape (n,) [Pa]

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    weighted = weights[:, None] * basis
    left = pressure - basis @ np.linalg.solve(weighted.T @ basis, weighted.T @ pressure)
    rough = np.zeros(facet.max() + 1, dtype=bool)
    rough[facet[np.abs(left) > _SMOOTH * pressure.max()]] = True
    return rough[facet]


@dataclass(frozen=True)
class WearEdge:
    """The contact points of a face, and which of them lie at the edge of its wear.

    Attributes
    ----------
    facet : ndarray of int, shape (n,)
        Of the points.
    basis : ndarray, shape (n, m)
        Ψ.
    weights : ndarray, shape (n,) [m²]
    """

    facet: np.ndarray
    basis: np.ndarray
    weights: np.ndarray

    def points(
        self,
        worn: np.ndarray,
        pressure: np.ndarray | None = None,
        before: np.ndarray | None = None,
    ) -> np.ndarray | None:
        """Points where contact is to hold one by one, shape (n,), None without any.

        Parameters
        ----------
        worn : ndarray, shape (n_wearing, n) [m]
        pressure : ndarray, shape (n,), optional
            [Pa]
        before : ndarray of bool, shape (n,), optional
            Those under that pressure: they stay until it is smooth there.
        """
        reached = np.any(worn > 0.0, axis=0)
        if before is None and (reached.all() or not reached.any()):
            return None
        points = edge_points(self.facet, self.basis, reached)
        if before is not None:
            assert pressure is not None
            points |= before & rough_points(self.facet, self.basis, self.weights, pressure)
        return points if points.any() else None

    def has_passed(self, points: np.ndarray, before: np.ndarray, after: np.ndarray) -> bool:
        """Whether the edge has gone beyond its points in a step, from depths to others (2, n)."""
        reached = (np.any(worn > 0.0, axis=0) for worn in (before, after))
        return has_passed(self.basis, points, *reached)


@dataclass(frozen=True)
class EdgeSpace:
    """The pressure space with a pressure for each of some points.

    Attributes
    ----------
    points : ndarray of bool, shape (n,)
        These points.
    basis : ndarray, shape (n, k)
        Basis functions Ψ off these points, then those of single points.
    weighted : ndarray, shape (n, k)
        ``diag(w)`` of them.
    seen : ndarray, shape (m, k)
        Coefficients in Ψ of their projections: what the bodies see.
    own : ndarray, shape (k, k)
        Weak gap by the part that is left, per coefficient.
    modes, force_modes : ndarray, shape (k, n_modes)
        See `CondensedContact`.
    """

    points: np.ndarray
    basis: np.ndarray
    weighted: np.ndarray
    seen: np.ndarray
    own: np.ndarray
    modes: np.ndarray
    force_modes: np.ndarray

    @cached_property
    def area(self) -> np.ndarray:
        """Of the coefficients, shape (k,) [m²]."""
        return self.weighted.sum(axis=0)

    def compliance(self, compliance: np.ndarray) -> np.ndarray:
        """Weak gaps per coefficient, shape (k, k), from those of Ψ, shape (m, m)."""
        return self.seen.T @ compliance @ self.seen + self.own

    def pressing(self, pressure: np.ndarray) -> np.ndarray:
        """Which coefficients press in a pressure at the points, shape (k,)."""
        return self.weighted.T @ pressure > _NONE * pressure.max() * self.area

    def at_points(self, weak: np.ndarray) -> np.ndarray:
        """Weak values (k,) per area at single points; NaN at others or without area, shape (n,)."""
        result, count = np.full(len(self.points), np.nan), np.count_nonzero(self.points)
        area = self.area[-count:]
        means = np.full(count, np.nan)
        np.divide(weak[-count:], area, out=means, where=area > 0.0)
        result[self.points] = means
        return result


def edge_space(contact: CondensedContact, points: np.ndarray, holder: Holder) -> EdgeSpace:
    """Give the pressure space of a contact a pressure for each of some points.

    Parameters
    ----------
    contact : CondensedContact
    points : ndarray of bool, shape (n,)
    holder : Holder
    """
    weights = contact.weighted.sum(axis=1)
    share = (~points @ contact.weighted) / contact.weighted.sum(axis=0)
    cut = (share > _NONE) & (share < 1.0 - _NONE)
    whole = np.flatnonzero(share >= 1.0 - _NONE)
    single = np.eye(len(points))[:, points]
    split = np.hstack([np.where(points[:, None], 0.0, contact.basis[:, cut]), single])
    seen = np.linalg.solve(contact.weighted.T @ contact.basis, contact.weighted.T @ split)
    left = split - contact.basis @ seen
    basis = np.hstack([contact.basis[:, whole], split])
    weighted = weights[:, None] * basis
    own = np.zeros((basis.shape[1],) * 2)
    yielding = (weights * _shortest_compliance(contact))[:, None] * left
    own[len(whole) :, len(whole) :] = left.T @ yielding
    return EdgeSpace(
        points=points,
        basis=basis,
        weighted=weighted,
        seen=np.hstack([np.eye(len(share))[:, whole], seen]),
        own=own,
        modes=weighted.T @ holder.modes,
        force_modes=weighted.T @ holder.force_modes,
    )


def _shortest_compliance(contact: CondensedContact) -> np.ndarray:
    """ε at the points: deflection per pressure that goes with the shortest waves, (n,) [m/Pa].

    The diagonal of the stiffness A⁻¹ is theirs: long waves are soft, and count little in it.
    """
    area = np.einsum("nj,nj->j", contact.weighted, contact.basis)
    stiffness = area * np.diag(np.linalg.inv(contact.compliance))
    return contact.basis @ (1.0 / np.abs(stiffness))
