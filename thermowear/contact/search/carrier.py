"""Choice of the contact face that carries the contact points and the pressure space.

Contact ends at the rim of a face that lies within the other one. Elements of the other face are cut
there: functions that reach over the rim by a sliver have next to no area, and follow the singular
pressure at the edge down to the width of the sliver. The face whose own rim ends the contact
therefore carries the pressure; functions that are cut nevertheless are joined to others, see
`operators.pressure`. The choice does not depend on the order of the faces.
"""

from __future__ import annotations

import numpy as np

from ...lagrange import lattice
from ..faces.face import Face, Surface
from ..faces.rim import edges_of, rim_edges
from .common_face import opposite

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
