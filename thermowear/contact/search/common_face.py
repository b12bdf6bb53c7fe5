"""Common face of two bodies: the face that carries it, and pairs of opposite facets.

Faces pressed together deform until they coincide. Body i takes the share
``s_i = c_i / (c_1 + c_2)``, ``c_i = (1 - ν_i²) / E_i``, of the approach of two points x_1 and x_2
(Johnson, Contact Mechanics, 1985, section 4.2), so the common face and its normal are approximately

    x = s_2 x_1 + s_1 x_2,      n ∝ s_2 n_1 - s_1 n_2

with the outward normals n_1 and n_2 of the unloaded faces: the mean of both faces for equal
stiffness, the face of the stiffer body if the other one is soft. The gap of two points is
``g = (x_2 - x_1)·n``.

Points are opposite each other if ``x_2 - x_1`` is along the bisector ``m ∝ n_1 - n_2`` of both
normals, for any stiffness. Points that meet in contact have about the same arc length from the
point of first contact, as pressure alone hardly stretches faces. For curvatures ``κ_1 + κ_2 = κ``
and an arc length s, the mismatch of points along m is ``s³ κ (κ_1 - κ_2) / 12``, that along n for
dissimilar bodies up to ``s³ κ (2 κ_1 + κ_2) / 6``. On faces of equal curvature points along m have
the same arc length on both. On faces that slide and wear, no points stay together, and material is
removed along n: there points are opposite each other along n. Exchanging the bodies reverses n and
m and changes nothing else.

Contact ends at the rim of a face that lies within the other one. Elements of the other face are cut
there: functions that reach over the rim by a sliver have next to no area, and follow the singular
pressure at the edge down to the width of the sliver. The face whose own rim ends the contact
therefore carries the pressure; functions that are cut nevertheless are joined to others, see
`operators.pressure`. The choice does not depend on the order of the faces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...lagrange import lattice
from ...parallel import rows_over_ranks
from ..faces.face import Face, Surface
from ..faces.normals import across
from ..faces.projection import MIN_COSINE, nearest, overhang, project
from ..faces.rim import edges_of, rim_edges

Line = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
MAX_FACING_COSINE = -0.5
"""Largest cosine between the outward normals of points that can meet."""
_MAX_PENETRATION = 0.25
"""Largest overlap of points, relative to the face; beyond it they are on far sides of bodies."""
_MAX_ITERATIONS = 40
_TOLERANCE = 1e-13
"""Convergence tolerance of points, relative to the size of the face."""
_MIN_SUM_LENGTH = 0.1
"""Smallest length of a sum of unit normals that defines a direction."""


@dataclass(frozen=True)
class Opposite:
    """Points on the other face opposite to given points of a face.

    Attributes
    ----------
    facet : ndarray of int, shape (n,)
    t : ndarray, shape (n,) or (n, 2)
        Parameters on the other face.
    normals : ndarray, shape (n, gdim)
        Normals of the common face, outward from the first body.
    offset : ndarray, shape (n, gdim)
        Vectors from the points to those opposite [m].
    share : ndarray, shape (n,)
        Share s of the first body.
    cosine : ndarray, shape (n,)
        Cosine between the outward normals of both faces.
    overhang : ndarray, shape (n,)
        Tangential distance of the points from their closest ones, positive beyond the edge of the
        other face, which is extrapolated linearly beyond its edges [m].
    """

    facet: np.ndarray
    t: np.ndarray
    normals: np.ndarray
    offset: np.ndarray
    share: np.ndarray
    cosine: np.ndarray
    overhang: np.ndarray

    @property
    def gap(self) -> np.ndarray:
        """Normal component of the offsets, shape (n,) [m]."""
        return np.einsum("ni,ni->n", self.offset, self.normals)

    def meets(self, size: float, max_overhang: float) -> np.ndarray:
        """True for points that can meet those opposite.

        Parameters
        ----------
        size : float
            Size of the face [m].
        max_overhang : float
            Largest tangential distance from the other face, relative to the size.
        """
        inside = (self.overhang <= max_overhang * size) & (self.gap >= -_MAX_PENETRATION * size)
        return (self.cosine <= MAX_FACING_COSINE) & inside


def opposite(
    face: Face | Surface, facet: np.ndarray, t: np.ndarray, other: Face | Surface, comm=None
) -> Opposite:
    """Points of another face opposite to points of a face.

    Parameters
    ----------
    face : Face or Surface
    facet : ndarray of int, shape (n,)
    t : ndarray, shape (n,) or (n, 2)
    other : Face or Surface
    comm : mpi4py.MPI.Comm, optional
        Ranks that share the work; every rank calls, with the same points.
    """

    def found(rows: slice) -> tuple[np.ndarray, ...]:
        return _opposite(face, facet[rows], t[rows], other)

    return Opposite(*rows_over_ranks(comm, len(facet), found))


def _opposite(
    face: Face | Surface, facet: np.ndarray, t: np.ndarray, other: Face | Surface
) -> tuple[np.ndarray, ...]:
    """Columns of `Opposite`."""
    points, outward = face.points(facet, t), face.smooth_normals(facet, t)[0]
    closest, at, offset = project(other, points)
    overhangs = overhang(other, closest, at, offset)
    facet, t, line = opposite_parameters(
        points, outward, face.softness_at(facet), other, closest, at, nearest
    )
    return facet, t, *line, overhangs


def opposite_parameters(
    points: np.ndarray,
    outward: np.ndarray,
    softness: np.ndarray,
    other: Face | Surface,
    facet: np.ndarray,
    t: np.ndarray,
    locate: Callable,
) -> tuple[np.ndarray, np.ndarray, Line]:
    """Facets and parameters of a face opposite to points of a body, and the lines between them.

    Lines by their normals, offset, share and cosine, see `Opposite`; they end on the tangent plane.

    Fixed-point iteration from the closest point: the line along m, or n where faces wear, is
    intersected with the tangent plane of the face.

    Parameters
    ----------
    points, outward : ndarray, shape (n, gdim)
        Points [m] and outward normals of the body.
    softness : ndarray, shape (n,)
        Softness c of the body at the points [1/Pa].
    other : Face or Surface
    facet, t : ndarray
        Closest points on it.
    locate : callable
        Closest facets and parameters on the other face, from that face, positions (m, gdim), and
        facets and parameters nearby.
    """
    facet, t = facet.copy(), t.copy()
    opposite_points = other.points(facet, t)
    moving = np.arange(len(points))
    for _ in range(_MAX_ITERATIONS):
        now = slice(None) if len(moving) == len(points) else moving
        line = _line(points[now], outward[now], softness[now], other, facet[now], t[now])
        facet[now], t[now] = locate(other, points[now] + line[1], facet[now], t[now])
        before, opposite_points[now] = opposite_points[now].copy(), other.points(facet[now], t[now])
        change = np.linalg.norm(opposite_points[now] - before, axis=1)
        moving = moving[change > _TOLERANCE * other.extent]
        if not len(moving):
            break
    return facet, t, _line(points, outward, softness, other, facet, t)


def stretch(face: Face | Surface, facet: np.ndarray, t: np.ndarray, other, pairs: Opposite):
    """Jacobian of the common face by the parameters of a face, shape (n,) [m or m²].

    Linearisation of ``x_2 - x_1 = h m`` by the parameters, with m along ``a_1 n_1 - a_2 n_2``:
    ``P (x_2' + h a_2 n_2' / l) t_2' = P (x_1' + h a_1 n_1' / l)``,
    where P projects across m and l is the length of that vector.
    """
    (n_1, turn_1), (n_2, turn_2) = (
        side.smooth_normals(*at)
        for side, at in ((face, (facet, t)), (other, (pairs.facet, pairs.t)))
    )
    x_1, x_2 = face.tangents(facet, t), other.tangents(pairs.facet, pairs.t)
    a_1, a_2 = _parts(pairs.share, other)
    m, length = _direction(a_1 * n_1 - a_2 * n_2, n_1)
    turned = (np.einsum("ni,ni->n", pairs.offset, m) / length)[:, None, None]
    here = _without(x_1 + turned * a_1[..., None] * turn_1, m)
    there = _without(x_2 + turned * a_2[..., None] * turn_2, m)
    square = np.einsum("nki,nli->nkl", there, there)
    along = np.linalg.solve(square, np.einsum("nki,nji->nkj", there, here))
    s = pairs.share[:, None, None]
    tangents = (1 - s) * x_1 + s * np.einsum("nkj,nki->nji", along, x_2)
    return np.linalg.norm(across(tangents), axis=1)


def _line(points, outward, softness, other, facet, t) -> Line:
    """Normals, offset to the tangent plane of the other face, share and cosine of points."""
    against, other_softness = other.smooth_normals(facet, t)[0], other.softness_at(facet)
    share = softness / (softness + other_softness)
    normals, _ = _direction((1 - share)[:, None] * outward - share[:, None] * against, outward)
    a_1, a_2 = _parts(share, other)
    along, _ = _direction(a_1 * outward - a_2 * against, outward)
    steep = np.minimum(np.einsum("ni,ni->n", along, against), -MIN_COSINE)
    to_plane = np.einsum("ni,ni->n", other.points(facet, t) - points, against) / steep
    cosine = np.einsum("ni,ni->n", outward, against)
    return normals, to_plane[:, None] * along, share, cosine


def _parts(share: np.ndarray, face: Face | Surface) -> tuple[np.ndarray, np.ndarray]:
    """Weights a_1 and a_2 of both normals in the direction between opposite points, (n, 1) each."""
    s = share[:, None]
    return (1.0 - s, s) if face.wears else (np.ones_like(s), np.ones_like(s))


def _direction(vectors: np.ndarray, otherwise: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors (n, gdim), substitutes for near-zero vectors, and lengths (n,)."""
    length = np.maximum(np.linalg.norm(vectors, axis=1), _MIN_SUM_LENGTH)
    unit = vectors / length[:, None]
    return np.where(length[:, None] > _MIN_SUM_LENGTH, unit, otherwise), length


def _without(vectors: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Vectors (n, k, gdim) without their component along unit vectors (n, gdim)."""
    along = np.einsum("nki,ni->nk", vectors, directions)
    return vectors - along[:, :, None] * directions[:, None]


_BEYOND = 0.2
"""Distance beyond the rim at which the other face is sought, relative to that of the rim from the
middle of its facet."""
_CLOSE = 0.5
"""Part of this distance within which rims of both faces coincide."""
_ALIKE = 1e-6
"""Relative difference of values that count as equal, and that of normals."""


def carrying_side(face_1: Face | Surface, face_2: Face | Surface) -> int:
    """Side (0 or 1) of the face whose facets carry the contact points.

    That with the longer rim within the other face; of equal ones that with more facets, the convex
    one, that which wears more, on both sides of a disk between pads the same one, and that whose
    mean normal points towards the last negative coordinate.
    """
    each = (face_1, face_2), (face_2, face_1)
    within, wear = [_length_within(*both) for both in each], [_wear(own) for own, _ in each]
    for (first, second), scale in (
        (within, max(within)),
        ([len(own.nodes) for own, _ in each], 0.0),
        ([_bulge(own) for own, _ in each], 1.0),
        (wear, max(wear)),
    ):
        if abs(first - second) > _ALIKE * scale:
            return int(second > first)
    apart = _mean_normal(face_2) - _mean_normal(face_1)
    differing = np.flatnonzero(np.abs(apart) > _ALIKE)
    return int(len(differing) > 0 and apart[differing[-1]] < 0.0)


def ends_within(face: Face | Surface, other: Face | Surface) -> np.ndarray:
    """Edges at the rim of a face beyond which the other one goes on, bool (n_facets, n_edges)."""
    facet, edge = rim_edges(face)
    if not len(facet):  # closed all round
        return np.zeros((len(face.nodes), len(edges_of(face.kind))), dtype=bool)
    corners = lattice(1, face.kind).reshape(-1, face.dim)
    middle = corners[edges_of(face.kind)].mean(axis=1)
    beyond = middle + _BEYOND * (middle - corners.mean(axis=0))
    at, beside = (t[edge, 0] if face.dim == 1 else t[edge] for t in (middle, beyond))
    step = np.linalg.norm(face.points(facet, beside) - face.points(facet, at), axis=1)
    pairs = opposite(face, facet, beside, other)
    result = np.zeros((len(face.nodes), len(middle)), dtype=bool)
    result[facet, edge] = pairs.meets(face.extent, np.inf) & (pairs.overhang < _CLOSE * step)
    return result


def _length_within(face: Face | Surface, other: Face | Surface) -> float:
    """Length of the rim of a face that lies within the other one [m]; in a section, its ends."""
    facet, edge = np.nonzero(ends_within(face, other))
    ends = edges_of(face.kind)[edge]
    if face.dim == 1:
        return float(len(facet))
    corners = face.corner_points[facet[:, None], ends]
    return float(np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1).sum())


def _wear(face: Face | Surface) -> float:
    """Mean softness by wear, by the size of the facets; 0 without wear."""
    if not face.wears:
        return 0.0
    return float(np.average(face.softness_at(np.arange(len(face.nodes))), weights=face.sizes))


def _mean_normal(face: Face | Surface) -> np.ndarray:
    return face.sizes @ face.normals(*_middles(face)) / face.sizes.sum()


def _bulge(face: Face | Surface) -> float:
    """Mean distance of the facets from their centre along their normals, by the size; 0: flat."""
    middles, shares = _middles(face), face.sizes / face.sizes.sum()
    points = face.points(*middles)
    outward = np.einsum("ni,ni->n", points - shares @ points, face.normals(*middles))
    return float(shares @ outward) / face.extent


def _middles(face: Face | Surface) -> tuple[np.ndarray, np.ndarray]:
    """Facets and parameters of their middles."""
    centre = lattice(1, face.kind).mean(axis=0, keepdims=True)
    return face.on_each(centre if face.dim > 1 else centre.ravel())
