"""Closest-point projection on a contact face."""

from __future__ import annotations

import numpy as np

from .facets import FacetSet

_MAX_NEWTON_STEPS = 30
_TOLERANCE = 1e-13
_ROUND_TRIANGLE = (-0.5, 1.5)
"""Bounds of the parameters within which the closest point of a triangle's surface is sought."""
_EDGES = np.array([[[0, 0], [1, 0]], [[0, 0], [0, 1]], [[1, 0], [-1, 1]]], dtype=float)
"""First corner and vector of each edge of a triangle, in its parameters."""
_MAX_ITERATIONS = 10
MIN_COSINE = 0.3
"""Smallest magnitude of the cosine between a line and the normal of the face that it meets."""


def project(face: FacetSet, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Closest-point projection on a face.

    Parameters
    ----------
    face : FacetSet
    points : ndarray, shape (n, gdim) [m]

    Returns
    -------
    facet : ndarray, shape (n,)
    t : ndarray, shape (n,) or (n, 2)
    offset : ndarray, shape (n, gdim)
        Vector from each point to its projection [m].
    """
    facet, t = _closest(face, points)
    t = t[:, 0] if face.dim == 1 else t
    return facet, t, face.points(facet, t) - points


def nearest(
    face: FacetSet, points: np.ndarray, facet: np.ndarray, t: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Closest facets and parameters to points (n, gdim) that have moved from places nearby.

    Points whose closest one on the given facet lies inside it are not sought elsewhere.
    """
    facet, start = facet.copy(), t.reshape(len(points), -1)
    place = inside(face, points, facet, start)
    beyond = np.flatnonzero(face.at_edge(place))
    if len(beyond):
        facet[beyond], place[beyond] = _closest(face, points[beyond])
    return facet, place.reshape(t.shape)


def ray_intersections(
    face: FacetSet, points: np.ndarray, directions: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intersections of a face with lines through given points, forward or backward.

    Beyond its ends the face is extrapolated linearly and its outermost points are returned.

    Parameters
    ----------
    face : FacetSet
    points : ndarray, shape (n, gdim) [m]
    directions : ndarray, shape (n, gdim)
        Unit vectors against the outward normals of the face.

    Returns
    -------
    facet : ndarray, shape (n,)
    t : ndarray, shape (n,) or (n, 2)
    distance : ndarray, shape (n,)
        Signed distance along the directions, negative backward [m].
    """
    distance = np.zeros(len(points))
    for _ in range(_MAX_ITERATIONS):
        facet, t, offset = project(face, points + distance[:, None] * directions)
        normals = face.normals(facet, t)
        against = np.minimum(np.einsum("ni,ni->n", directions, normals), -MIN_COSINE)
        change = np.einsum("ni,ni->n", offset, normals) / against
        distance += change
        if np.abs(change).max() <= _TOLERANCE * face.extent:
            break
    return facet, t, distance


def overhang(face: FacetSet, facet: np.ndarray, t: np.ndarray, offset: np.ndarray):
    """Tangential distance of points from their projections, positive beyond the edge [m]."""
    across = np.linalg.qr(face.tangents(facet, t).mT)[0]
    result = np.linalg.norm(np.einsum("nik,ni->nk", across, offset), axis=1)
    if face.dim == 1:  # at a corner between two facets offsets have tangential parts
        result[(facet + t > 0.0) & (facet + t < len(face.nodes))] = 0.0
    return result


def _closest(face: FacetSet, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Facets and parameters (n, dim) of the closest points, the best of some candidates."""
    sampled = face.sampled_nearby(points)
    if sampled is not None:
        point, facet, start = sampled
        t = inside(face, points[point], facet, start)
        distance = np.linalg.norm(face.points(facet, t) - points[point], axis=1)
        order = np.lexsort((distance, point))
        chosen = order[np.unique(point[order], return_index=True)[1]]
        return facet[chosen], t[chosen]
    facets = face.nearby(points)
    order = face.flat_distances(facets, points).argsort(axis=1, kind="stable")
    facets = np.take_along_axis(facets, order, axis=1)
    least = face.least_distances(facets, points) + _TOLERANCE * face.extent
    best = facets[:, 0].copy()
    t, distance = _on_facets(face, points, best)
    for candidate, bound in zip(facets.T[1:], least.T[1:], strict=True):
        nearer = np.flatnonzero((candidate != best) & (bound < distance))
        if len(nearer):
            at, far = _on_facets(face, points[nearer], candidate[nearer])
            closer = far < distance[nearer]
            chosen = nearer[closer]
            best[chosen], t[chosen] = candidate[chosen], at[closer]
            distance[chosen] = far[closer]
    return best, t


def _on_facets(face: FacetSet, points: np.ndarray, facet: np.ndarray):
    """Parameters (n, dim) of the closest points of given facets, and distances (n,) [m]."""
    start = face.inside(face.flattened.parameters(facet, points))
    t = inside(face, points, facet, start)
    return t, np.linalg.norm(face.points(facet, t) - points, axis=1)


def inside(face: FacetSet, points, facet: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Parameters (n, dim) of the closest points of given facets."""
    if face.kind != "triangle":
        return within(face, points, facet, start, bounds=(0.0, 1.0))
    t = within(face, points, facet, start, _ROUND_TRIANGLE)
    off = np.flatnonzero((t.min(axis=1) < 0.0) | (t.sum(axis=1) > 1.0))
    if not len(off):
        return t
    points, facet = np.repeat(points[off], 3, axis=0), np.repeat(facet[off], 3)
    at = _on_edges(face, points, facet, np.repeat(t[off], 3, axis=0), np.tile([0, 1, 2], len(off)))
    distance = np.linalg.norm(face.points(facet, at) - points, axis=1).reshape(-1, 3)
    t[off] = at.reshape(-1, 3, 2)[np.arange(len(off)), distance.argmin(axis=1)]
    return t


def _on_edges(face: FacetSet, points, facet, start, edge: np.ndarray) -> np.ndarray:
    """Parameters (n, 2) of the closest points of edges of triangles, by their numbers (n,)."""
    origin, along = _EDGES[edge].swapaxes(0, 1)
    s = np.sum((start - origin) * along, axis=1) / np.sum(along**2, axis=1)
    s = np.clip(s, 0.0, 1.0)[:, None]
    s = within(face, points, facet, s, (0.0, 1.0), origin, along[:, None])
    return np.clip(origin + s * along, 0.0, 1.0)


def within(
    face: FacetSet,
    points: np.ndarray,
    facet: np.ndarray,
    start: np.ndarray,
    bounds: tuple[float, float],
    origin: np.ndarray | None = None,
    axes: np.ndarray | None = None,
) -> np.ndarray:
    """Parameters of the closest points of given facets, by the Gauss-Newton method.

    Parameters
    ----------
    face : FacetSet
    points : ndarray, shape (n, gdim) [m]
    facet : ndarray of int, shape (n,)
    start : ndarray, shape (n, k)
        Initial parameters s.
    bounds : tuple of float
        Bounds of the parameters; a parameter is fixed at a bound that a step would cross.
    origin, axes : ndarray, shape (n, dim) and (n, k, dim), optional
        Subspaces ``t = origin + s axes`` of the parameters of the facets, by default all of them.
    """
    s, moving = start.copy(), np.arange(len(start))
    for _ in range(_MAX_NEWTON_STEPS):
        now, on = s[moving], facet[moving]
        if origin is None or axes is None:
            places, tangents = face.points_and_tangents(on, now)
        else:
            along = axes[moving]
            t = origin[moving] + (now[:, None] @ along)[:, 0]
            places, tangents = face.points_and_tangents(on, t)
            tangents = along @ tangents
        offset = places - points[moving]
        slope = np.einsum("nki,ni->nk", tangents, offset)
        held = ((now <= bounds[0]) & (slope > 0)) | ((now >= bounds[1]) & (slope < 0))
        tangents = np.where(held[:, :, None], 0.0, tangents)
        matrix = np.einsum("nki,nli->nkl", tangents, tangents) + held[:, :, None] * np.eye(
            now.shape[1]
        )
        step = np.linalg.solve(matrix, np.where(held, 0.0, slope)[:, :, None])[:, :, 0]
        s[moving] = np.clip(now - step, *bounds)
        moving = moving[np.abs(s[moving] - now).max(axis=1) > _TOLERANCE]
        if not len(moving):
            break
    return s
