"""Closest-point projection on a contact face."""

from __future__ import annotations

import numpy as np

from .face import Face
from .surface import Surface

_MAX_NEWTON_STEPS = 30
_TOLERANCE = 1e-13
_ROUNDING = 1e-15
"""Convergence tolerance of a parameter."""
_CANDIDATES = 4
"""Number of candidate facets per point in space: the nearest ones in flat approximation."""
_BLOCK_SIZE = 1_000_000
"""Number of point-facet pairs processed at once."""
_MAX_ITERATIONS = 10
_MIN_COSINE = 0.3
"""Smallest magnitude of the cosine between a ray and the normal of the face that it meets."""


def project(face: Face | Surface, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Closest-point projection on a face.

    Parameters
    ----------
    face : Face or Surface
    points : ndarray, shape (n, gdim) [m]

    Returns
    -------
    facet : ndarray, shape (n,)
    t : ndarray, shape (n,) or (n, 2)
    offset : ndarray, shape (n, gdim)
        Vector from each point to its projection [m].
    """
    facet, t = _on_surface(face, points) if isinstance(face, Surface) else _on_chain(face, points)
    return facet, t, face.points(facet, t) - points


def ray_intersections(
    face: Face | Surface, points: np.ndarray, directions: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intersections of a face with lines through given points, forward or backward.

    Beyond its ends the face is extrapolated linearly and its outermost points are returned.

    Parameters
    ----------
    face : Face or Surface
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
        against = np.minimum(np.einsum("ni,ni->n", directions, normals), -_MIN_COSINE)
        change = np.einsum("ni,ni->n", offset, normals) / against
        distance += change
        if np.abs(change).max() <= _TOLERANCE * face.extent:
            break
    return facet, t, distance


def overhang(face: Face | Surface, facet: np.ndarray, t: np.ndarray, offset: np.ndarray):
    """Tangential distance of points from their projections, positive beyond the edge [m]."""
    tangents = face.tangents(facet, t).reshape(len(facet), -1, offset.shape[1])
    across = np.linalg.qr(np.moveaxis(tangents, 1, 2))[0]
    result = np.linalg.norm(np.einsum("nik,ni->nk", across, offset), axis=1)
    if isinstance(face, Face):  # at a corner between two facets offsets have tangential parts
        result[(facet + t > 0.0) & (facet + t < len(face.nodes))] = 0.0
    return result


def _on_chain(face: Face, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Facet and parameter of the closest points on a chain."""
    a, b = face.nodes[:, 0], face.nodes[:, -1]
    chord = b - a
    along = np.einsum("nfi,fi->nf", points[:, None] - a, chord) / (chord**2).sum(axis=1)
    along = np.clip(along, 0.0, 1.0)
    distance = np.linalg.norm(a + along[..., None] * chord - points[:, None], axis=2)
    nearest = distance.argmin(axis=1)
    # the nearest chord may belong to a neighbour of the nearest curved facet
    facets = [np.clip(nearest + k, 0, len(a) - 1) for k in (0, -1, 1)]
    trials = [(facet, _along(face, points, facet)) for facet in facets]
    return _best(face, points, trials)


def _best(face, points: np.ndarray, trials: list[tuple[np.ndarray, np.ndarray]]):
    """Candidate with the smallest distance, point by point."""
    distances = [np.linalg.norm(face.points(facet, t) - points, axis=1) for facet, t in trials]
    best, every = np.argmin(distances, axis=0), np.arange(len(points))
    facet, t = (np.array([trial[k] for trial in trials])[best, every] for k in (0, 1))
    return facet, t


def _along(face: Face, points: np.ndarray, facet: np.ndarray) -> np.ndarray:
    """Closest points of given facets by the Gauss-Newton method, starting from the chord."""
    start, end = face.nodes[facet, 0], face.nodes[facet, -1]
    chord = end - start
    t = ((points - start) * chord).sum(axis=1) / (chord**2).sum(axis=1)
    t = np.clip(t, 0.0, 1.0)
    for _ in range(0 if face.nodes.shape[1] == 2 else 20):
        offset, tangent = face.points(facet, t) - points, face.tangents(facet, t)
        step = (offset * tangent).sum(axis=1) / (tangent**2).sum(axis=1)
        last, t = t, np.clip(t - step, 0.0, 1.0)
        if np.abs(t - last).max(initial=0.0) <= _ROUNDING:
            break
    return t


def _on_surface(face: Surface, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    chunk = max(1, _BLOCK_SIZE // len(face.nodes))
    parts = [_in_chunk(face, points[i : i + chunk]) for i in range(0, len(points), chunk)]
    facet, t = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
    return facet, t


def _in_chunk(face: Surface, points: np.ndarray):
    flat = face.flattened
    t = np.clip(flat.parameters(points), 0.0, 1.0)
    distance = np.linalg.norm(flat.points(t) - points[:, None], axis=2)
    count = min(_CANDIDATES, distance.shape[1])
    facets = np.argpartition(distance, count - 1, axis=1)[:, :count]
    facets = np.sort(facets, axis=1)
    starts = np.take_along_axis(t, facets[:, :, None], axis=1)
    trials = [
        (facets[:, k], within(face, points, facets[:, k], starts[:, k], bounds=(0.0, 1.0)))
        for k in range(count)
    ]
    return _best(face, points, trials)


def within(
    face: Surface,
    points: np.ndarray,
    facet: np.ndarray,
    start: np.ndarray,
    bounds: tuple[float, float],
) -> np.ndarray:
    """Parameters of the closest points of given facets, by the Gauss-Newton method.

    Parameters
    ----------
    face : Surface
    points : ndarray, shape (n, 3) [m]
    facet : ndarray of int, shape (n,)
    start : ndarray, shape (n, 2)
        Initial parameters.
    bounds : tuple of float
        Bounds of both parameters; a parameter is fixed at a bound that a step would cross.
    """
    t, moving = start.copy(), np.arange(len(start))
    for _ in range(_MAX_NEWTON_STEPS):
        now, on = t[moving], facet[moving]
        offset, tangents = face.points(on, now) - points[moving], face.tangents(on, now)
        slope = np.einsum("nki,ni->nk", tangents, offset)
        held = ((now <= bounds[0]) & (slope > 0)) | ((now >= bounds[1]) & (slope < 0))
        tangents = np.where(held[:, :, None], 0.0, tangents)
        matrix = np.einsum("nki,nli->nkl", tangents, tangents) + held[:, :, None] * np.eye(2)
        step = np.linalg.solve(matrix, np.where(held, 0.0, slope)[:, :, None])[:, :, 0]
        t[moving] = np.clip(now - step, *bounds)
        moving = moving[np.abs(t[moving] - now).max(axis=1) > _TOLERANCE]
        if not len(moving):
            break
    return t
