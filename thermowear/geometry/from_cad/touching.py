"""Faces where two CAD bodies touch.

Points of a face of one body are compared with the faces of the other one: the distance to them is
exact, and ends at their edges. The bodies must lie on both sides of the common place.
"""

from __future__ import annotations

import numpy as np

from .request import CadError, TouchRequest
from .solids import UNIT, CadBody, CadFace, distance, parameters

_TOLERANCE = 1e-4
"""Largest distance of faces that touch, relative to the size of the smaller body."""
_BEYOND = 3.0
"""Distance of a place inside the other body from the common one, relative to the tolerance."""
_GRIDS = (4, 12, 36)
"""Points along each parameter of a face, increased until enough of them lie on it."""
_ENOUGH = 8
"""Number of points of a face that are compared."""


def touching_faces(
    gmsh, request: TouchRequest, bodies: dict[str, CadBody], tolerance: float | None
) -> tuple[list[CadFace], list[CadFace]]:
    """Faces of both bodies that coincide, at least in part.

    Raises
    ------
    CadError
        If there are none, with the distance of the bodies.
    """
    one, other = (bodies[name] for name in request.bodies)
    found = common_faces(gmsh, one, other, tolerance)
    if not any(found):
        raise CadError(_apart(gmsh, request, one, other, _within(one, other, tolerance)))
    return found


def _within(one: CadBody, other: CadBody, tolerance: float | None) -> float:
    """Largest distance of faces that touch [mm]."""
    size = min(one.size, other.size)
    return _TOLERANCE * size if tolerance is None else tolerance / UNIT


def common_faces(
    gmsh, one: CadBody, other: CadBody, tolerance: float | None
) -> tuple[list[CadFace], list[CadFace]]:
    """Faces of both bodies that coincide, at least in part; none if the bodies do not touch.

    Parameters
    ----------
    gmsh : module
    one, other : CadBody
    tolerance : float or None
        See `CadRequest`.
    """
    within = _within(one, other, tolerance)
    boxes, others = (np.array([face.box for face in body.faces]) for body in (one, other))
    near = (boxes[:, None, 0] <= others[:, 1] + within) & (
        others[:, 0] <= boxes[:, None, 1] + within
    )
    pairs = [(one.faces[a], other.faces[b]) for a, b in np.argwhere(near.all(axis=2))]
    touched = dict.fromkeys(face for pair in pairs for face in pair)
    samples = {face: _samples(gmsh, face) for face in touched}
    found = [
        (a, b)
        for a, b in pairs
        if _meet(gmsh, samples[a], one, b, other, within)
        or _meet(gmsh, samples[b], other, a, one, within)
    ]
    return list(dict.fromkeys(a for a, _ in found)), list(dict.fromkeys(b for _, b in found))


def _samples(gmsh, face: CadFace) -> tuple[np.ndarray, np.ndarray]:
    """Points on a face, and its normals of either sign there, shape (n, 3) [mm]."""
    near = 1e-6 * float(np.linalg.norm(face.box[1] - face.box[0]))
    for count in _GRIDS:
        places = parameters(gmsh, face, count)
        points = gmsh.model.getValue(2, face.tag, places.ravel()).reshape(-1, 3)
        on_face = np.array([distance(gmsh, x, (2, face.tag)) <= near for x in points])
        if on_face.sum() >= _ENOUGH:
            break
    normals = gmsh.model.getNormal(face.tag, places[on_face].ravel()).reshape(-1, 3)
    return points[on_face], normals


def _meet(
    gmsh,
    samples: tuple[np.ndarray, np.ndarray],
    own: CadBody,
    face: CadFace,
    other: CadBody,
    within: float,
) -> bool:
    """Test for a point of a body on a face of the other one, which lies beyond that point."""
    points, normals = samples
    outside = np.maximum(np.maximum(face.box[0] - points, points - face.box[1]), 0.0)
    close = np.flatnonzero(np.linalg.norm(outside, axis=1) <= within)
    for k in close:
        if distance(gmsh, points[k], (2, face.tag)) > within:
            continue
        inside = own.contains(gmsh, points[k] - _BEYOND * within * normals[k])
        outward = normals[k] if inside else -normals[k]
        if other.contains(gmsh, points[k] + _BEYOND * within * outward):
            return True
    return False


def _apart(gmsh, request: TouchRequest, one: CadBody, other: CadBody, within: float) -> str:
    gap = min(
        gmsh.model.occ.getDistance(3, a.tag, 3, b.tag)[0] for a in one.solids for b in other.solids
    )
    names = f"{one.name!r} and {other.name!r}"
    if gap > within:
        return (
            f"{request.key}: {names} do not touch; they lie {gap:.4g} mm apart, and faces touch up "
            f"to {within:.3g} mm: move the parts, name the faces, or set geometry.contact_tolerance"
        )
    return (
        f"{request.key}: {names} touch, but no faces of them coincide; name the contact faces: "
        "contact = [...]"
    )
