"""Places where CAD faces in contact curve against each other, and the zones that a load closes.

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
from .request import CadRequest, Point, Zone
from .solids import UNIT, CadBody, CadFace, distance, parameters

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
