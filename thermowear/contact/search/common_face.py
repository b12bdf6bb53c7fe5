"""The common face of two bodies in contact, and which points of their faces meet on it.

Where bodies are pressed together their faces deform until they coincide. Body i takes the share
``s_i = c_i / (c_1 + c_2)``, ``c_i = (1 - ν_i²) / E_i``, of the approach of two points x_1 and x_2
(Johnson, Contact Mechanics, 1985, section 4.2), so the common face and its normal are about

    x = s_2 x_1 + s_1 x_2,      n ∝ s_2 n_1 - s_1 n_2

with the outward normals n_1 and n_2 of the unloaded faces: the mean of both faces for bodies of
like stiffness, the face of the stiffer body where the other one is soft. The gap of two points is
``g = (x_2 - x_1)·n``.

Points are opposite each other where ``x_2 - x_1`` is along the bisector ``m ∝ n_1 - n_2`` of both
normals, whatever the stiffness. Where bodies touch, points meet that have about the same length of
face from where they touched first, as pressure alone hardly stretches faces. For curvatures
``κ_1 + κ_2 = κ`` and a length s, points along m are apart by ``s³ κ (κ_1 - κ_2) / 12``, those along
n of unlike bodies by up to ``s³ κ (2 κ_1 + κ_2) / 6``. On faces of equal curvature points along m
are at the same place of both. Where the faces slide and wear, no points stay together, and material
goes off along n: there points are opposite each other along n. Exchanging the bodies turns n and m
round and changes nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .face import Face
from .projection import beside, project
from .surface import Surface

FACING = -0.5
"""Cosine between the outward normals of points that can meet: at most this."""
_FLATTEST = 0.3
"""Cosine between a line and a normal of the face that it meets; steeper is taken for so much."""
_BEHIND = 0.25
"""Of a face's size: points that overlap by more are on the far sides of their bodies."""
_PASSES = 40
_SETTLED = 1e-13
"""Of a face's size."""
_NONE = 0.1
"""Length of a sum of unit normals below which it is no direction."""


@dataclass(frozen=True)
class Opposite:
    """Points of one face and those opposite to them on another one.

    Attributes
    ----------
    facet : ndarray of int, shape (n,)
    t : ndarray, shape (n,) or (n, 2)
        Parameters on the other face.
    normals : ndarray, shape (n, gdim)
        Of the common face, outward from the first body.
    offset : ndarray, shape (n, gdim)
        From the points to those opposite [m].
    share : ndarray, shape (n,)
        s of the first body.
    cosine : ndarray, shape (n,)
        Between the outward normals of both faces.
    beside : ndarray, shape (n,)
        How far the points lie beside their closest ones: more than 0 beyond the edge of the other
        face. Where their lines lean past an edge, the face is taken to go on straight [m].
    """

    facet: np.ndarray
    t: np.ndarray
    normals: np.ndarray
    offset: np.ndarray
    share: np.ndarray
    cosine: np.ndarray
    beside: np.ndarray

    @property
    def gap(self) -> np.ndarray:
        """Part of the offsets along the normals, shape (n,) [m]."""
        return np.einsum("ni,ni->n", self.offset, self.normals)

    def meets(self, size: float, allowed: float) -> np.ndarray:
        """Which points can meet those opposite.

        Parameters
        ----------
        size : float
            Of the face [m].
        allowed : float
            So far beside the other face at most, of the size.
        """
        inside = (self.beside <= allowed * size) & (self.gap >= -_BEHIND * size)
        return (self.cosine <= FACING) & inside


@dataclass(frozen=True)
class NormalLines:
    """Lines from points to the planes that touch the other face where they meet.

    Attributes
    ----------
    normals, share, cosine : ndarray
        See `Opposite`.
    offset : ndarray, shape (n, gdim)
        From the points to the planes [m].
    """

    normals: np.ndarray
    offset: np.ndarray
    share: np.ndarray
    cosine: np.ndarray


def opposite(face: Face | Surface, facet: np.ndarray, t: np.ndarray, other: Face | Surface):
    """Points of another face opposite to points of a face.

    Parameters
    ----------
    face : Face or Surface
    facet : ndarray of int, shape (n,)
    t : ndarray, shape (n,) or (n, 2)
    other : Face or Surface

    Returns
    -------
    Opposite
    """

    def locate(points: np.ndarray, _) -> tuple[np.ndarray, np.ndarray]:
        return project(other, points)[:2]

    points, out = face.points(facet, t), face.smooth_normals(facet, t)[0]
    closest, at, offset = project(other, points)
    off = beside(other, closest, at, offset)
    facet, t, line = met(points, out, face.soft(facet), other, closest, at, locate)
    return Opposite(facet, t, line.normals, line.offset, line.share, line.cosine, off)


def met(
    points: np.ndarray,
    out: np.ndarray,
    soft: np.ndarray,
    other: Face | Surface,
    facet: np.ndarray,
    t: np.ndarray,
    locate: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]],
) -> tuple[np.ndarray, np.ndarray, NormalLines]:
    """Facets and parameters of a face opposite to points of a body, and the lines between them.

    From the closest point on, the line along m, or n where faces wear, is followed to the plane
    that touches the face there.

    Parameters
    ----------
    points, out : ndarray, shape (n, gdim)
        Points [m] and outward normals of the body.
    soft : ndarray, shape (n,)
        c of the body at the points [1/Pa].
    other : Face or Surface
    facet, t : ndarray
        Of the points on it that are closest.
    locate : callable
        Facets and parameters on the other face that are closest to places (m, gdim), and which of
        the points these are for.
    """
    facet, t = facet.copy(), t.copy()
    found = other.points(facet, t)
    moving = np.arange(len(points))
    for _ in range(_PASSES):
        now = slice(None) if len(moving) == len(points) else moving
        line = _line(points[now], out[now], soft[now], other, facet[now], t[now])
        facet[now], t[now] = locate(points[now] + line.offset, moving)
        before, found[now] = found[now].copy(), other.points(facet[now], t[now])
        missed = np.linalg.norm(found[now] - before, axis=1)
        moving = moving[missed > _SETTLED * other.extent]
        if not len(moving):
            break
    return facet, t, _line(points, out, soft, other, facet, t)


def stretch(face: Face | Surface, facet: np.ndarray, t: np.ndarray, other, pairs: Opposite):
    """Area of the common face per area of the parameters of a face, shape (n,) [m or m²].

    The points opposite move with the parameters so that ``x_2 - x_1 = h m`` stays true, with m
    along ``a_1 n_1 - a_2 n_2``: ``P (x_2' + h a_2 n_2' / l) t_2' = P (x_1' + h a_1 n_1' / l)``,
    where P projects across m and l is the length of that vector.
    """
    (n_1, turn_1), (n_2, turn_2) = (
        side.smooth_normals(*at)
        for side, at in ((face, (facet, t)), (other, (pairs.facet, pairs.t)))
    )
    count, dim = len(facet), n_1.shape[1]
    x_1 = face.tangents(facet, t).reshape(count, -1, dim)
    x_2 = other.tangents(pairs.facet, pairs.t).reshape(count, -1, dim)
    a_1, a_2 = _parts(pairs.share, other)
    m, length = _direction(a_1 * n_1 - a_2 * n_2, n_1)
    turned = (np.einsum("ni,ni->n", pairs.offset, m) / length)[:, None, None]
    here = _across(x_1 + turned * a_1[..., None] * turn_1, m)
    there = _across(x_2 + turned * a_2[..., None] * turn_2, m)
    square = np.einsum("nki,nli->nkl", there, there)
    along = np.linalg.solve(square, np.einsum("nki,nji->nkj", there, here))
    s = pairs.share[:, None, None]
    tangents = (1 - s) * x_1 + s * np.einsum("nkj,nki->nji", along, x_2)
    if tangents.shape[1] == 1:
        return np.linalg.norm(tangents[:, 0], axis=1)
    return np.linalg.norm(np.cross(tangents[:, 0], tangents[:, 1]), axis=1)


def _line(points, out, soft, other, facet, t) -> NormalLines:
    against, softer = other.smooth_normals(facet, t)[0], other.soft(facet)
    share = soft / (soft + softer)
    normals, _ = _direction((1 - share)[:, None] * out - share[:, None] * against, out)
    a_1, a_2 = _parts(share, other)
    along, _ = _direction(a_1 * out - a_2 * against, out)
    steep = np.minimum(np.einsum("ni,ni->n", along, against), -_FLATTEST)
    to_plane = np.einsum("ni,ni->n", other.points(facet, t) - points, against) / steep
    cosine = np.einsum("ni,ni->n", out, against)
    return NormalLines(normals, to_plane[:, None] * along, share, cosine)


def _parts(share: np.ndarray, face: Face | Surface) -> tuple[np.ndarray, np.ndarray]:
    """Parts a_1 and a_2 of both normals in the direction along which points meet, (n, 1) each."""
    s = share[:, None]
    return (1.0 - s, s) if face.wears else (np.ones_like(s), np.ones_like(s))


def _direction(vectors: np.ndarray, otherwise: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors (n, gdim), others where the vectors are about none, and lengths (n,)."""
    length = np.linalg.norm(vectors, axis=1)
    unit = vectors / np.maximum(length, _NONE)[:, None]
    return np.where(length[:, None] > _NONE, unit, otherwise), np.maximum(length, _NONE)


def _across(vectors: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Vectors (n, k, gdim) without their part along unit vectors (n, gdim)."""
    along = np.einsum("nki,ni->nk", vectors, directions)
    return vectors - along[:, :, None] * directions[:, None]
