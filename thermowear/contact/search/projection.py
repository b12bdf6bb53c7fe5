"""Closest-point projection on a contact face."""

from __future__ import annotations

import numpy as np

from .facets import FacetSet

_MAX_NEWTON_STEPS = 30
_TOLERANCE = 1e-13
_BLOCK_SIZE = 1_000_000
"""Number of point-facet pairs processed at once."""
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
    chunk = max(1, _BLOCK_SIZE // len(face.nodes))
    parts = [_closest(face, points[i : i + chunk]) for i in range(0, max(len(points), 1), chunk)]
    facet, t = (np.concatenate(column) for column in zip(*parts, strict=True))
    t = t[:, 0] if face.dim == 1 else t
    return facet, t, face.points(facet, t) - points


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
    flat = face.flattened
    t = np.clip(flat.parameters(points), 0.0, 1.0)
    facets = face.nearby(np.linalg.norm(flat.points(t) - points[:, None], axis=2))
    starts = np.take_along_axis(t, facets[:, :, None], axis=1)
    places = np.stack(
        [
            within(face, points, facet, start, bounds=(0.0, 1.0))
            for facet, start in zip(facets.T, starts.swapaxes(0, 1), strict=True)
        ]
    )
    trials = zip(facets.T, places, strict=True)
    distances = [np.linalg.norm(face.points(facet, t) - points, axis=1) for facet, t in trials]
    best, every = np.argmin(distances, axis=0), np.arange(len(points))
    return facets[every, best], places[best, every]


def within(
    face: FacetSet,
    points: np.ndarray,
    facet: np.ndarray,
    start: np.ndarray,
    bounds: tuple[float, float],
) -> np.ndarray:
    """Parameters of the closest points of given facets, by the Gauss-Newton method.

    Parameters
    ----------
    face : FacetSet
    points : ndarray, shape (n, gdim) [m]
    facet : ndarray of int, shape (n,)
    start : ndarray, shape (n, dim)
        Initial parameters.
    bounds : tuple of float
        Bounds of the parameters; a parameter is fixed at a bound that a step would cross.
    """
    t, moving = start.copy(), np.arange(len(start))
    for _ in range(_MAX_NEWTON_STEPS):
        now, on = t[moving], facet[moving]
        offset, tangents = face.points(on, now) - points[moving], face.tangents(on, now)
        slope = np.einsum("nki,ni->nk", tangents, offset)
        held = ((now <= bounds[0]) & (slope > 0)) | ((now >= bounds[1]) & (slope < 0))
        tangents = np.where(held[:, :, None], 0.0, tangents)
        matrix = np.einsum("nki,nli->nkl", tangents, tangents) + held[:, :, None] * np.eye(face.dim)
        step = np.linalg.solve(matrix, np.where(held, 0.0, slope)[:, :, None])[:, :, 0]
        t[moving] = np.clip(now - step, *bounds)
        moving = moving[np.abs(t[moving] - now).max(axis=1) > _TOLERANCE]
        if not len(moving):
            break
    return t
