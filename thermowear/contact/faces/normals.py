"""Normals of a contact face, and tangential directions on it.

Mesh facets only approximate a smooth face: their normals jump where they meet, for straight edges
by the angle that an element subtends. Averaging at the corners and blending within the facets makes
the normals continuous (Yang, Laursen and Meng, Int. J. Numer. Meth. Engng 62 (2005) 1183), so that
opposite points are unique. Sharp edges of the face are preserved.

The blending functions of a facet of order p are Radau polynomials of odd degree q, p or p + 1
(linear for p = 1), orthogonal to polynomials of degree q - 2. On curved facets with nearly
continuous normals they preserve the resultant of a uniform pressure on the area of the facets. The
degree is odd because the normals of an arc have opposite errors of equal size at both ends of a
facet.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Legendre

from ...lagrange import lattice, on_lattice, order_of

_MIN_SMOOTH_COSINE = np.cos(np.radians(20.0))
"""Cosine between facet normal and mean normal at a corner, below which it is a sharp edge."""
_MAX_END_ERROR = 0.02
"""Largest error of a unit normal at the ends of curved or short facets."""
_BARYCENTRIC_SLOPES = np.array([[-1.0, 0.0, 1.0], [-1.0, 1.0, 0.0]])
"""Derivatives of the barycentric coordinates of a triangle, corners in the order of a lattice."""
_SECOND_DERIVATIVES = {1: [[2]], 2: [[3, 4], [4, 5]]}
"""Indices of the second derivatives of `on_lattice` by the number of parameters."""


def corner_corrections(
    kind: str, nodes: np.ndarray, outward: np.ndarray, corners: np.ndarray
) -> np.ndarray:
    """Differences between the mean normals at the corners and the facet normals.

    Parameters
    ----------
    kind, nodes, outward
        See `facets.FacetSet`.
    corners : ndarray of int, shape (n_facets, n_corners)
        Numbers of the corners.

    Returns
    -------
    ndarray, shape (n_facets, n_corners, gdim)
        Zero at sharp edges of the face.
    """
    ends = lattice(1, kind).reshape(corners.shape[1], -1)
    facet = np.repeat(np.arange(len(nodes)), len(ends))
    own, _ = _raw(kind, nodes, outward, facet, np.tile(ends, (len(nodes), 1)))
    _, number = np.unique(corners.reshape(-1), return_inverse=True)
    # on an arc the error at facet ends scales as the facet size to the power of its order
    size = np.linalg.norm(nodes[:, -1] - nodes[:, 0], axis=1)
    weight = np.repeat((size.min() / size) ** order_of(kind, nodes.shape[1]), len(ends))
    summed = np.column_stack([np.bincount(number, weight * component) for component in own.T])
    mean = summed / np.maximum(np.linalg.norm(summed, axis=1, keepdims=True), 1e-300)
    sharp = np.zeros(len(mean), dtype=bool)
    sharp[number[np.einsum("ni,ni->n", own, mean[number]) < _MIN_SMOOTH_COSINE]] = True
    correction = np.where(sharp[number, None], 0.0, mean[number] - own)
    correction = correction.reshape(len(nodes), len(ends), -1)
    if kind == "interval":
        # on an arc the error at an end of the face is minus that of the other end of its facet
        free = (np.bincount(number) == 1)[number].reshape(-1, 2)
        slight = np.linalg.norm(correction, axis=2).max(axis=1) < _MAX_END_ERROR
        mirrored = free & slight[:, None]
        correction[mirrored] = -correction[:, ::-1][mirrored]
    return correction


def smooth_normals(
    kind: str, nodes: np.ndarray, outward: np.ndarray, corrections: np.ndarray, facet: np.ndarray, t
) -> tuple[np.ndarray, np.ndarray]:
    """Continuous outward unit normals, and their derivatives along the parameters.

    Parameters
    ----------
    kind, nodes, outward, corrections
        See `corner_corrections`.
    facet : ndarray of int, shape (n,)
    t : ndarray, shape (n, dim)

    Returns
    -------
    normals : ndarray, shape (n, gdim)
    turning : ndarray, shape (n, dim, gdim)
    """
    normal, turning = _raw(kind, nodes, outward, facet, t)
    values, slopes = _blending(kind, order_of(kind, nodes.shape[1]), t)
    chosen = corrections[facet]
    blended = normal + (values[:, None] @ chosen)[:, 0]
    changing = turning + slopes @ chosen
    return _unit(blended, changing)


def _raw(kind, nodes, outward, facet, t) -> tuple[np.ndarray, np.ndarray]:
    """Outward unit normals of the facets, without blending, and their derivatives."""
    dim, on = t.shape[1], nodes[facet]
    table = on_lattice(order_of(kind, nodes.shape[1]), t, 2, kind)
    derivatives = table.swapaxes(0, 1) @ on
    tangents, bent = derivatives[:, 1 : 1 + dim], derivatives[:, _SECOND_DERIVATIVES[dim]]
    if dim == 1:
        changing = across(bent[:, 0])[:, None]
    else:
        first, second = tangents[:, :1], tangents[:, 1:]
        changing = np.cross(bent[:, :, 0], second) + np.cross(first, bent[:, :, 1])
    sign = outward[facet]
    return _unit(sign[:, None] * across(tangents), sign[:, None, None] * changing)


def across(tangents: np.ndarray) -> np.ndarray:
    """Vectors across tangents (n, dim, gdim): one turned clockwise, or the product of two."""
    if tangents.shape[1] == 1:
        return tangents[:, 0, ::-1] * (1.0, -1.0)
    return np.cross(tangents[:, 0], tangents[:, 1])


def _unit(vectors: np.ndarray, slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors (n, gdim) and their derivatives from those of the vectors."""
    size = np.linalg.norm(vectors, axis=1)
    unit = vectors / size[:, None]
    along = np.einsum("nki,ni->nk", slopes, unit)
    return unit, (slopes - along[:, :, None] * unit[:, None]) / size[:, None, None]


def _blending(kind: str, order: int, t: np.ndarray):
    """Values and derivatives of the corner functions of a facet, 1 at one corner, 0 at others.

    Products of ``(P_q(x) + P_{q-1}(x)) / 2``, the right Radau polynomial, and its mirror image for
    the other end, with ``x = 2 t - 1`` and Legendre polynomials P; q is the smallest odd number not
    below the order of the facet. On a triangle t is the barycentric coordinate of the corner, so
    that the functions agree along the edges of all facets. Shapes (n, n_corners) and
    (n, dim, n_corners).
    """
    degree = order + 1 - order % 2
    right = Legendre([0.0] * (degree - 1) + [0.5, 0.5], domain=[0.0, 1.0])
    slope = right.deriv()
    if kind == "triangle":
        part = np.column_stack([1.0 - t[:, 0] - t[:, 1], t[:, 1], t[:, 0]])
        return right(part), slope(part)[:, None] * _BARYCENTRIC_SLOPES
    values = [np.column_stack([right(1.0 - along), right(along)]) for along in t.T]
    slopes = [np.column_stack([-slope(1.0 - along), slope(along)]) for along in t.T]
    if len(values) == 1:
        return values[0], slopes[0][:, None]
    (u, v), (du, dv) = values, slopes
    return _times(u, v), np.stack([_times(du, v), _times(u, dv)], axis=1)


def _times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Products of functions (n, i) of the first and (n, j) of the second parameter, (n, i j)."""
    return np.einsum("na,nb->nab", a, b).reshape(len(a), a.shape[1] * b.shape[1])


_LEAST_SUM = 0.2
"""Least ``1 + m·n`` of a pole m and the normals: beyond it the frame turns fast."""
_PARALLEL = 0.9
"""Cosine between the pole and x from which the first axis follows y instead."""


@dataclass(frozen=True)
class TangentFrame:
    """Orthonormal tangential directions e_1, e_2 on a face in space.

    The axes at the pole m, a unit vector, are rotated by the smallest rotation that takes m to the
    normal n (parallel transport along the great circle between them),

        e_i = a_i - (a_i·n) (m + n) / (1 + m·n),

    so that they are smooth over the face and coincide wherever two frames have the same normal.
    Right-handed with respect to the inward normal: ``e_2 = e_1 × n``; for a body above the plane
    z = 0 they are x and y.

    Attributes
    ----------
    pole : ndarray, shape (3,)
        Unit vector m, opposite to no normal.
    turned : float
        Angle by which both axes are turned about the pole, from e_1 towards e_2 [rad].
    """

    pole: np.ndarray
    turned: float = 0.0

    @cached_property
    def axes(self) -> np.ndarray:
        """Axes a_1 and a_2 at the pole, shape (2, 3): along x, or y for a pole along x."""
        along = np.array([0.0, 1.0, 0.0] if abs(self.pole[0]) > _PARALLEL else [1.0, 0.0, 0.0])
        first = along - (along @ self.pole) * self.pole
        first = first / np.linalg.norm(first)
        second, (c, s) = np.cross(first, self.pole), (np.cos(self.turned), np.sin(self.turned))
        return np.array([c * first + s * second, c * second - s * first])

    def at(self, normals: np.ndarray) -> np.ndarray:
        """Directions at points with unit normals (n, 3), shape (2, n, 3)."""
        slopes = self.axes @ normals.T / (1 + normals @ self.pole)
        return self.axes[:, None] - slopes[..., None] * (self.pole + normals)


def frame_in_space(
    normals: np.ndarray, weights: np.ndarray, pole: np.ndarray | None = None, turned: float = 0.0
) -> TangentFrame:
    """Frame of a face from its normals.

    Its pole is a given direction, or the mean normal; or, where the normals turn far away from
    both, the coordinate direction nearest to all of them.

    Parameters
    ----------
    normals : ndarray, shape (n, 3)
    weights : ndarray, shape (n,)
        Areas of the points [m²].
    pole : ndarray, shape (3,), optional
        Preferred pole, such as the load direction.
    turned : float, optional
        See `TangentFrame` [rad].
    """
    mean = weights @ normals
    candidates = [] if pole is None else [pole]
    if np.linalg.norm(mean) > _LEAST_SUM * weights.sum():
        candidates.append(mean / np.linalg.norm(mean))
    for candidate in candidates:
        if 1.0 + (normals @ candidate).min() > _LEAST_SUM:
            return TangentFrame(candidate, turned)
    signed = np.concatenate([np.eye(3), -np.eye(3)])
    return TangentFrame(signed[np.argmax((normals @ signed.T).min(axis=0))], turned)
