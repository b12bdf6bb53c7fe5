"""Faces where two CAD bodies touch, and places where they curve against each other.

Points of a face of one body are compared with the faces of the other one: the distance to them is
exact, and ends at their edges. The bodies must lie on both sides of the common place.

There the gap grows by ``(ξ²/R_1 + η²/R_2)/2`` from the closest points, with the sum of the
curvatures of both faces. Hertz's contact has the half-axes ``c (R_1/R_2)^(±1/3)`` about,
``c³ = 3 F √(R_1 R_2)/(4 E*)`` (Johnson, Contact Mechanics, 1985, section 4.2); one that reaches the
ends of the faces is a line.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...case.values.pressing import Pressing
from ...reference.elastic_contact.hertz import line_contact, point_contact
from .request import CadError, CadRequest, Point, TouchRequest, Zone
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


_SAME = 1e-4
"""Distance relative to the size of a body below which places are equally close."""
_INSIDE = 1e-3
"""Least distance of parameters from their bounds, where surfaces may be singular."""
_OPPOSITE = -0.999
"""Largest cosine between the outward normals of faces that are tangential to each other."""
_STRAIGHT = 1e-3
"""Curvature relative to the largest one, or times the size of a face, that is none."""
_ACROSS = 12
"""Points along each parameter of a face from which its length follows."""


@dataclass(frozen=True)
class CurvedPlace:
    """Closest points of two faces that curve away from each other.

    Attributes
    ----------
    contact : int
        Index of the faces in `CadRequest.faces`.
    points : tuple of Point
        On each body [m].
    along : Point
        Unit vector of the least curvature.
    curvatures : tuple of float
        Sums of those of both faces: the largest one, and the least [1/m].
    length : float
        Length of the faces along the vector [m].
    is_straight : bool
        Whether the faces stay as close along that length.
    """

    contact: int
    points: tuple[Point, Point]
    along: Point
    curvatures: tuple[float, float]
    length: float
    is_straight: bool


def curved_places(
    gmsh, faces: Sequence[tuple[Sequence[CadFace], Sequence[CadFace]]], bodies: dict[str, CadBody]
) -> list[CurvedPlace]:
    """Places of all contacts, given by their faces."""
    return [
        place
        for contact, (first, second) in enumerate(faces)
        for place in _of_contact(gmsh, contact, first, second, bodies)
    ]


def _of_contact(
    gmsh, contact: int, first: Sequence[CadFace], second: Sequence[CadFace], bodies
) -> list[CurvedPlace]:
    """Places of a contact; none if some of its faces conform where they are closest."""
    near = _SAME * min(bodies[faces[0].body].size for faces in (first, second))
    pairs = [(a, b) for a in first for b in second]
    gaps = [gmsh.model.occ.getDistance(2, a.tag, 2, b.tag) for a, b in pairs]
    least, result = min(gap[0] for gap in gaps), list[CurvedPlace]()
    for pair, (gap, *places) in zip(pairs, gaps, strict=True):
        if gap > least + near:
            continue
        place = _place(gmsh, contact, pair, np.reshape(places, (2, 3)), bodies)
        if place is not None and not place.curvatures[0]:
            return []
        # neighbours have the points of their common edge in common
        if place is not None and all(
            math.dist(place.points[0], other.points[0]) > near * UNIT for other in result
        ):
            result.append(place)
    return result


def _place(gmsh, contact: int, pair, points: np.ndarray, bodies) -> CurvedPlace | None:
    """Place at the closest points [mm] of two faces; None if they meet at an edge.

    It has no curvatures where they conform.
    """
    (normal, one), (against, other) = (
        _falling(gmsh, face, x, bodies[face.body]) for face, x in zip(pair, points, strict=True)
    )
    if normal @ against > _OPPOSITE:
        return None
    across = np.linalg.svd(normal[None])[2][1:]
    curvatures, ways = np.linalg.eigh(across @ (one + other) @ across.T)
    low, high = (float(k) for k in curvatures)
    extent = min(float(np.linalg.norm(face.box[1] - face.box[0])) for face in pair)
    if low < -_STRAIGHT * max(high, 1 / extent):
        return None
    if high * extent < _STRAIGHT:
        high = low = 0.0
    along = ways[:, 0] @ across
    spans = [_span(gmsh, face, along) for face in pair]
    start, end = max(low for low, _ in spans), min(high for _, high in spans)
    if low <= _STRAIGHT * high:  # any point of a line is as close
        points = points + ((start + end) / 2 - points @ along)[:, None] * along
    ends = points[0] + np.array([[-0.45], [0.45]]) * (end - start) * along
    far = max(distance(gmsh, x, (2, face.tag)) for x in ends for face in pair)
    gap = float(np.linalg.norm(points[1] - points[0]))
    return CurvedPlace(
        contact,
        (_in_metres(points[0]), _in_metres(points[1])),
        (float(along[0]), float(along[1]), float(along[2])),
        (high / UNIT, max(low, 0.0) / UNIT),
        (end - start) * UNIT,
        far <= gap + _STRAIGHT * extent,
    )


def _in_metres(place: np.ndarray) -> Point:
    x, y, z = (float(value) for value in UNIT * place)
    return x, y, z


def _falling(gmsh, face: CadFace, place: np.ndarray, body: CadBody):
    """Outward normal of a face at a place, and its curvatures (3, 3), positive if convex [1/mm]."""
    low, high = (np.array(b) for b in gmsh.model.getParametrizationBounds(2, face.tag))
    margin = _INSIDE * (high - low)
    at = np.clip(gmsh.model.getParametrization(2, face.tag, place), low + margin, high - margin)
    tangents = gmsh.model.getDerivative(2, face.tag, at).reshape(2, 3)
    normal = np.cross(*tangents) / np.linalg.norm(np.cross(*tangents))
    point = gmsh.model.getValue(2, face.tag, at)
    if not body.contains(gmsh, point - _SAME * body.size * normal):
        normal = -normal
    uu, vv, uv = gmsh.model.getSecondDerivative(2, face.tag, at).reshape(3, 3) @ normal
    inverse = np.linalg.pinv(tangents)
    return normal, -inverse @ np.array([[uu, uv], [uv, vv]]) @ inverse.T


def _span(gmsh, face: CadFace, along: np.ndarray) -> tuple[float, float]:
    """Range of the positions of a face along a vector [mm]."""
    places = parameters(gmsh, face, _ACROSS)
    x = gmsh.model.getValue(2, face.tag, places.ravel()).reshape(-1, 3) @ along
    beyond = np.ptp(x) / (2 * (_ACROSS - 1))
    return float(x.min() - beyond), float(x.max() + beyond)


def expected_zones(
    request: CadRequest, places: Sequence[CurvedPlace], pressing: Sequence[Pressing | None]
) -> tuple[Zone, ...]:
    """Zones that loads of the contacts close, shared by the places of each.

    Places whose faces conform, or touch along a curve, have none.
    """
    zones = []
    for place in places:
        load = pressing[place.contact]
        shares = sum(other.contact == place.contact for other in places)
        axes = None if load is None else _half_axes(place, load, shares)
        if axes is not None:
            zones.append(Zone(request.faces[place.contact], place.points, place.along, *axes))
    return tuple(zones)


def _half_axes(place: CurvedPlace, load: Pressing, shares: int) -> tuple[float, float] | None:
    """Half of the length and of the width of a zone [m]; None if it is as wide as the faces."""
    high, low = place.curvatures
    if load.force is None:
        assert load.approach is not None
        width = math.sqrt(load.approach / high)
        length = math.sqrt(load.approach / low) if low else math.inf
    elif low:
        mean = point_contact(load.force / shares, 1 / math.sqrt(high * low), load.modulus)
        width, length = (mean.half_width * (low / high) ** (k / 3) for k in (1, -1))
    else:
        length = math.inf
    half = place.length / 2
    if length > half:
        if not place.is_straight:
            return None
        length = half
        if load.force is not None:
            per_length = load.force / shares / place.length
            width = line_contact(per_length, 1 / high, load.modulus).half_width
    return length, width
