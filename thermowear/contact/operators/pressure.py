"""Pressure on a contact face: its space, the gap orthogonal to it, and the contact zones.

The pressure space consists of continuous piecewise Bernstein polynomials, on quadrilaterals tensor
products in both parameters. They are nonnegative and sum to one, so that coefficients ``λ >= 0``
give a pressure without tension, and each weak gap is a mean of the gap with nonnegative weights.
They jump at the borders of materials that wear by different laws, as the steady pressure does.

Where the other face ends within a facet, functions beyond its edge keep a sliver of their support.
They have next to no area, and would follow the pressure at the edge, which is singular there, down
to the width of the sliver. Functions with less than a fraction of their area are therefore joined
to their neighbours, as cut elements are aggregated (Badia, Verdugo and Martín, Comput. Methods
Appl. Mech. Eng. 336 (2018) 533), here by nonnegative shares, so that the sum remains one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import scipy.sparse as sp
from scipy.special import comb, factorial

from ...lagrange import lattice
from ..faces.face import Face, Surface
from ..search.pairing import Contacts, Pairing

Basis: TypeAlias = "np.ndarray | sp.csr_array"
_LEAST_COVERED = 0.4
"""Fraction of the area of a function, on the facets in contact, that must face the other body."""
_NEAREST = 8
"""Power of the distance by which shares in farther neighbours fall: nearly the nearest alone."""
_ROUNDING = 1e-12
"""Rounding of the parameters of points on facets."""
_ZERO_PRESSURE = 1e-9  # of the largest pressure
_FIT_FRACTION = 0.8  # fraction of half a zone used to fit its edge
_DEGREE = 2
_SKIPPED_ELEMENTS = 2  # number of elements next to the edge


@dataclass(frozen=True)
class PressureSpace:
    """Pressures ``p = Ψ λ`` at the contact points.

    Attributes
    ----------
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ; sparse on a surface.
    weighted : ndarray or csr_array, shape (n, m)
        ``diag(w) Ψ``.
    """

    basis: Basis
    weighted: Basis

    def weak(self, values: np.ndarray) -> np.ndarray:
        """Weighted means ``Ψᵀ w v`` of values at the points, shape (m,)."""
        return self.weighted.T @ values

    def projected(self, values: np.ndarray) -> np.ndarray:
        """Coefficients of the L² projection of values at the points, by columns."""
        return np.linalg.solve(self.mass, self.weighted.T @ values)

    def pressed(self, pressure: np.ndarray) -> np.ndarray:
        """Mask (m,) of the coefficients that are positive under a pressure (n,)."""
        if (pressure > 0.0).all():
            return np.ones(self.basis.shape[1], dtype=bool)
        coefficients = np.linalg.lstsq(dense(self.basis), pressure, rcond=None)[0]
        return coefficients > _ZERO_PRESSURE * coefficients.max()

    @cached_property
    def mass(self) -> np.ndarray:
        """Matrix ``Ψᵀ w Ψ``, shape (m, m)."""
        return dense(self.weighted.T @ self.basis)


def scaled(factors: np.ndarray, basis: Basis) -> Basis:
    """Product ``diag(f) Ψ`` for factors at the points, shape (n,)."""
    if isinstance(basis, np.ndarray):
        return factors[:, None] * basis
    return (sp.diags_array(factors) @ basis).tocsr()


def dense(matrix: Basis) -> np.ndarray:
    """Dense copy of a sparse matrix; others as they are."""
    return matrix if isinstance(matrix, np.ndarray) else matrix.toarray()


def pressure_basis(pairing: Pairing, degree: int) -> Basis:
    """Values Ψ of the basis functions at the contact points.

    Parameters
    ----------
    pairing : Pairing
    degree : int
        At least 1; one or two below that of the displacement for a stable space.

    Returns
    -------
    ndarray or csr_array, shape (n_points, n_functions)
        Functions without contact points in their support are omitted, those with few are joined.
    """
    face, pieces = pairing.carrying.face, pairing.pieces
    assert pieces.point is not None  # the points are paired
    t = pieces.t.reshape(len(pieces.facet), -1)
    values = _on_triangles(degree, t) if face.kind == "triangle" else _on_products(degree, t)
    numbers = face.numbers(degree)[pieces.facet]
    if jumps(pairing):
        first, second = pairing.groups[:, pieces.point]
        group = first * (second.max() + 1) + second
        each = numbers * (group.max() + 1) + group[:, None]
        numbers = np.unique(each, return_inverse=True)[1].reshape(numbers.shape)
    facet, piece = np.unique(pieces.facet, return_index=True)
    of_facets = numbers[piece]
    starts = np.arange(len(values) + 1) * values.shape[1]
    shape = len(values), numbers.max() + 1
    entries = values.ravel(), numbers.ravel(), starts
    basis = sp.csr_array(entries, shape=shape)
    basis.eliminate_zeros()
    covered = (pieces.weight / face.measure * face.sizes[pieces.facet]) @ basis
    basis = basis[np.unique(pieces.point, return_index=True)[1]]
    onto = _onto_supported(covered, face, degree, facet, of_facets)
    basis = basis if onto is None else (basis @ onto).tocsr()
    basis = basis[:, pairing.weights @ basis > 0.0]
    return basis if isinstance(face, Surface) else basis.toarray()


def _onto_supported(
    covered: np.ndarray, face: Face | Surface, degree: int, facet: np.ndarray, numbers: np.ndarray
) -> sp.csr_array | None:
    """Shares (M, M) of all functions in those with enough of their area; None if all have.

    Functions far from such ones, as in a contact within a single facet, are judged by the best of
    them.

    Parameters
    ----------
    covered : ndarray, shape (M,)
        Area of each function opposite to the other face [m or m²].
    face : Face or Surface
    degree : int
    facet : ndarray of int, shape (n_facets,)
        Facets in contact.
    numbers : ndarray of int, shape (n_facets, k)
        Functions on them.
    """
    whole, k = np.zeros(len(covered)), numbers.shape[1]
    np.add.at(whole, numbers, face.sizes[facet, None] / k)  # Bernstein polynomials have equal areas
    coverage = np.divide(covered, whole, out=np.ones_like(covered), where=whole > 0.0)
    supported = coverage >= _LEAST_COVERED
    if supported.all():
        return None
    cut = np.any(~supported[numbers], axis=1)
    facet, numbers = facet[cut], numbers[cut]
    at = np.tile(lattice(degree, face.kind), (len(facet), *[1] * (face.dim - 1)))
    places = face.points(np.repeat(facet, k), at).reshape(len(facet), k, -1)
    first, second = np.nonzero(~np.eye(k, dtype=bool))
    apart = np.linalg.norm(places[:, first] - places[:, second], axis=2)
    near = (face.lengths[facet, None] / apart) ** _NEAREST
    ends = numbers[:, first].ravel(), numbers[:, second].ravel()
    links = sp.csr_array((near.ravel(), ends), shape=(len(covered),) * 2)
    onto = sp.diags_array(supported.astype(float)).tocsr()
    while not supported.all():
        known = links @ sp.diags_array(supported.astype(float))
        total = np.where(supported, 0.0, known.sum(axis=1))
        new = total > 0.0
        if new.any():
            parts = np.divide(1.0, total, out=np.zeros_like(total), where=new)
            onto = onto + sp.diags_array(parts) @ known @ onto
        else:
            new = ~supported & (coverage >= _LEAST_COVERED * coverage[~supported].max())
            onto = onto + sp.diags_array(new.astype(float))
        supported = supported | new
    return onto


def joined_bases(each: Sequence[Basis]) -> Basis:
    """Basis at the points of several interfaces, one after the other; sparse if there are several.

    Each function belongs to one interface.
    """
    return each[0] if len(each) == 1 else sp.csr_array(sp.block_diag(each, format="csr"))


def function_ranges(contacts: Contacts, basis: Basis) -> tuple[slice, ...]:
    """Range of the pressure functions of each interface."""
    if len(contacts.each) == 1:
        return (slice(0, basis.shape[1]),)
    counts = [len(np.unique(basis[own].nonzero()[1])) for own in contacts.ranges]
    return tuple(slice(int(a), int(b)) for a, b in pairwise([0, *np.cumsum(counts)]))


def functions_by_interface(contacts: Contacts, basis: Basis) -> np.ndarray:
    """Number of the pressure functions of the interface that each point lies on, shape (n,)."""
    return contacts.per_point([own.stop - own.start for own in function_ranges(contacts, basis)])


def jumps(pairing: Pairing) -> bool:
    """True if materials that wear by different laws adjoin on a contact face."""
    return bool(np.ptp(pairing.groups, axis=1).any())


def _on_products(degree: int, t: np.ndarray) -> np.ndarray:
    """Products of Bernstein polynomials of each parameter, shape (n, (degree + 1)**dim)."""
    values = np.ones((len(t), 1))
    for along in _at_ends(t).T:
        values = (values[:, :, None] * _bernstein(degree, along)[:, None]).reshape(len(t), -1)
    return values


def _on_triangles(degree: int, t: np.ndarray) -> np.ndarray:
    """Bernstein polynomials of a triangle in the order of its lattice.

    Shape (n, (degree + 1) (degree + 2) / 2).
    """
    powers = np.rint(lattice(degree, "triangle") * degree)
    powers = np.column_stack([powers, degree - powers.sum(axis=1)])
    parts = _at_ends(np.column_stack([t, np.maximum(1.0 - t.sum(axis=1), 0.0)]))
    scale = factorial(degree) / factorial(powers).prod(axis=1)
    return scale * (parts[:, None] ** powers).prod(axis=2)


def _at_ends(t: np.ndarray) -> np.ndarray:
    """Parameters without rounding at the ends of facets.

    Points there have no part of the functions of other facets or edges, and no pressure of theirs,
    not even of rounding: heat passes the points that press.
    """
    whole = np.rint(t)
    return np.where(np.abs(t - whole) < _ROUNDING, whole, t)


def _bernstein(degree: int, t: np.ndarray) -> np.ndarray:
    """Bernstein polynomials on [0, 1], shape (n, degree + 1)."""
    k = np.arange(degree + 1)
    return comb(degree, k) * t[:, None] ** k * (1 - t[:, None]) ** (degree - k)


def unresolved_gap(gap: np.ndarray, pressing: np.ndarray, contacts: Contacts, basis: Basis):
    """Gap component orthogonal to the pressure space, on fully closed facets.

    Weak contact closes the mean of the gap with each basis function, not the gap at each point.
    Under continued wear this component grows without effect on the pressure. It is the gap less its
    L² projection on the pressure space of the fully closed facets; zero on all others.

    Parameters
    ----------
    gap : ndarray, shape (n,)
        Gap at the contact points [m].
    pressing : ndarray of bool, shape (n,)
    contacts : Contacts
    basis : ndarray or csr_array, shape (n, m)
        Ψ, see `pressure_basis`.

    Returns
    -------
    ndarray, shape (n,)
        Component whose weak values ``Ψᵀ w v`` vanish [m].
    """
    facets = contacts.facets
    closed = ~(facets @ ~pressing) @ facets
    used = basis[closed].sum(axis=0) > 0.0
    on_closed = basis[closed][:, used]
    space = PressureSpace(on_closed, scaled(contacts.weights[closed], on_closed))
    result = np.zeros_like(gap)
    if closed.any():
        result[closed] = gap[closed] - on_closed @ space.projected(gap[closed])
    return result


def contact_zones(pairing: Pairing, pressure: np.ndarray) -> list[tuple[float, float]]:
    """Ranges of the position s of the contact zones, in order [m]; empty on a surface.

    At the edge of contact of smooth faces the pressure vanishes as the square root of the distance
    times an analytic function (Johnson, Contact Mechanics, 1985, ch. 4). The squared pressure is
    fitted by a polynomial, without the elements next to the edge, and extrapolated to its zero.
    Zones of few elements end with their last point.

    Parameters
    ----------
    pairing : Pairing
    pressure : ndarray, shape (n,) [Pa]
    """
    if isinstance(pairing.carrying.face, Surface):
        return []
    pressing = pressure > _ZERO_PRESSURE * pressure.max(initial=0.0)
    change = np.flatnonzero(np.diff(pressing.astype(int), prepend=0, append=0))
    zones = []
    for first, after in change.reshape(-1, 2):
        zone = np.arange(first, after)
        bounded = (first == 0) + (after == len(pressure))
        part = 0.5 if bounded == 0 else 1.0  # fraction of the zone that belongs to an edge
        start, end = pairing.position[zone[[0, -1]]]
        if first > 0:
            start = _edge(pairing, pressure, zone[::-1], part)
        if after < len(pressure):
            end = _edge(pairing, pressure, zone, part)
        zones.append((float(min(start, end)), float(max(start, end))))
    return sorted(zones)


def _edge(pairing: Pairing, pressure: np.ndarray, zone: np.ndarray, part: float) -> float:
    """Position of the edge beyond the last point of a zone."""
    s, along = pairing.position[zone], (pairing.carrying.facet + pairing.carrying.t)[zone]
    distance = np.abs(s - s[-1])
    # points between facets are on those farther from the edge, at either end
    facet = np.ceil(np.round(np.sign(along[-1] - along[0]) * along, 9))
    last = np.unique(np.abs(facet - facet[-1]))[:_SKIPPED_ELEMENTS]
    chosen = ~np.isin(np.abs(facet - facet[-1]), last)
    chosen &= distance <= _FIT_FRACTION * part * distance[0]
    if chosen.sum() <= 2 * _DEGREE:
        return float(s[-1])
    fit = np.polynomial.Polynomial.fit(distance[chosen], pressure[zone][chosen] ** 2, _DEGREE)
    roots = fit.roots()
    nearest = distance[chosen].min()
    roots = roots[np.abs(roots.imag) < 1e-9].real
    roots = roots[(roots < nearest) & (roots > -nearest)]
    if len(roots) == 0:
        return float(s[-1])
    return float(s[-1] + np.sign(s[0] - s[-1]) * roots.max())
