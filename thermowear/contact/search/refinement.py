"""Quadrature on the common refinement of two contact faces.

The facets of body 1 are cut at the ends of facets of body 2, so that elementwise smooth functions
are integrated accurately on matching and nonmatching faces.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import CaseError
from ...lagrange import lobatto, on_lattice
from ..faces.face import Face, Surface
from .clipping import parts_opposite
from .common_face import MAX_FACING_COSINE, Opposite, opposite

OVERHANG_TOLERANCE = 1e-9
"""Largest tangential distance from body 2, relative to the face, of paired points."""

SLIVER = 1e-9
"""Smallest distance of a cut from the ends of a facet, relative to the facet."""
_MAX_BACKWARD_RATIO = 2.0
"""Largest backward step of consecutive opposite points, relative to their gap."""
_BACKWARD_TOLERANCE = 1e-6
"""Largest backward step by rounding, relative to the length of the face."""


@dataclass(frozen=True)
class Rule:
    """Quadrature points on the facets of body 1 opposite to body 2.

    Attributes
    ----------
    facet : ndarray of int, shape (n,)
    t : ndarray, shape (n,) or (n, 2)
        Parameters.
    weight : ndarray, shape (n,)
        Length or area in parameters; the sum is that of the facet if it is fully opposite.
    point : ndarray of int or None, shape (n,)
        Contact point that each point is merged into; None before it is paired.
    """

    facet: np.ndarray
    t: np.ndarray
    weight: np.ndarray
    point: np.ndarray | None = None


def rule(
    face_1: Face | Surface,
    face_2: Face | Surface,
    order: int,
    refine: bool,
    sliver: float,
    max_overhang: float = OVERHANG_TOLERANCE,
) -> Rule:
    """Quadrature rule on the common refinement; parameters as in `pairing.pair`."""
    if not refine:
        return _on_facets(face_1, face_2, order, max_overhang)
    if isinstance(face_1, Surface):
        assert isinstance(face_2, Surface)
        return _on_parts(face_1, face_2, order)
    assert isinstance(face_2, Face)
    return _on_pieces(face_1, face_2, order, sliver, max_overhang)


def _on_pieces(face_1: Face, face_2: Face, order: int, sliver: float, max_overhang: float) -> Rule:
    """Gauss-Lobatto rule on each piece of the facets of a chain."""
    cuts = _cuts(face_1, face_2, sliver)
    x, w = lobatto(order)
    start = np.concatenate([c[:-1] for c in cuts])
    size = np.concatenate([np.diff(c) for c in cuts])
    facet = np.repeat(np.arange(len(cuts)), [len(c) - 1 for c in cuts])
    t = (start[:, None] + size[:, None] * x).ravel()
    pieces = Rule(np.repeat(facet, order), t, (size[:, None] * w).ravel())
    return _facing(face_1, face_2, pieces, x, max_overhang)


def _cuts(face_1: Face, face_2: Face, sliver: float) -> list[np.ndarray]:
    """Parameters of the cuts of each facet of body 1, facet ends included."""
    count = len(face_2.nodes)
    pairs = opposite(
        face_2, np.append(np.arange(count), count - 1), np.append(np.zeros(count), 1.0), face_1
    )
    meeting = pairs.meets(face_1.extent, OVERHANG_TOLERANCE)
    facet, t = pairs.facet[meeting], pairs.t[meeting]
    cuts = []
    for f in range(len(face_1.nodes)):
        inner = np.sort(t[(facet == f) & (t > sliver) & (t < 1 - sliver)])
        separate = np.diff(inner, prepend=-1.0) > 1e-9
        cuts.append(np.concatenate([[0.0], inner[separate], [1.0]]))
    return cuts


def _on_parts(face_1: Surface, face_2: Surface, order: int) -> Rule:
    """Rules on the opposite parts of facets: Gauss-Lobatto, in triangles without their edges."""
    facet, corners = parts_opposite(face_1, face_2)
    triangular = np.all(corners[:, 2] == corners[:, 3], axis=1)
    parts = []
    for kind, of_kind, listed in (
        ("quadrilateral", ~triangular, (0, 3, 1, 2)),
        ("triangle", triangular, (0, 2, 1)),
    ):
        chosen, (places, weights) = np.flatnonzero(of_kind), lobatto(order, kind)
        table = on_lattice(1, places, 1, kind)
        at, u, v = np.einsum("dqc,pci->dpqi", table, corners[chosen][:, listed])
        area = weights * (u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
        at = np.clip(at, 0.0, 1.0)  # corners on an edge may lie beyond it by rounding
        parts.append((np.repeat(facet[chosen], len(weights)), at.reshape(-1, 2), area.ravel()))
    columns = [np.concatenate(column) for column in zip(*parts, strict=True)]
    counting = columns[2] > 0.0
    by_facet = np.argsort(columns[0][counting], kind="stable")
    return Rule(*(column[counting][by_facet] for column in columns))


def _on_facets(face_1: Face | Surface, face_2, order: int, max_overhang: float) -> Rule:
    """Gauss-Lobatto rule on each whole facet."""
    places, weights = lobatto(order, face_1.kind)
    whole = Rule(*face_1.on_each(places), np.tile(weights, len(face_1.nodes)))
    return _facing(face_1, face_2, whole, places, max_overhang)


def _facing(face_1, face_2, pieces: Rule, places: np.ndarray, max_overhang: float) -> Rule:
    """Pieces, each with points at the same places, whose inner points are opposite to body 2."""
    count, within = len(places), (places > 0) & (places < 1)
    # ends do not count: the end of an outer piece is a point of the next inner one
    inner = np.flatnonzero(within.reshape(count, -1).all(axis=1))
    inner = inner if len(inner) else np.arange(count)
    pairs = opposite(face_1, pieces.facet, pieces.t, face_2)
    meeting = pairs.meets(face_1.extent, max_overhang).reshape(-1, count)[:, inner]
    whole = np.all(meeting, axis=1)
    kept = np.repeat(whole, count)
    if isinstance(face_1, Face):
        facing = np.all((pairs.cosine <= MAX_FACING_COSINE).reshape(-1, count)[:, inner], axis=1)
        _check_order(face_1, face_2, pairs, whole, facing & ~whole)
    return Rule(pieces.facet[kept], pieces.t[kept], pieces.weight[kept])


def _check_order(face_1: Face, face_2: Face, pairs: Opposite, kept: np.ndarray, lost: np.ndarray):
    """Raise if opposite points along a chain are interrupted or not in order.

    Small backward steps, of the order of the gap, may occur at edges and bends of faces.
    """
    between = np.flatnonzero(kept)
    if len(between) == 0:
        return
    if lost[between[0] : between[-1]].any():
        raise CaseError(ambiguity_message(face_1, face_2))
    chosen = np.repeat(kept, len(pairs.gap) // len(kept))
    s, apart = face_2.position(pairs.facet, pairs.t)[chosen], np.abs(pairs.gap[chosen])
    step, length = np.diff(s), face_2.sizes.sum()
    if face_2.closed:
        step = (step + length / 2) % length - length / 2
    step = step * np.sign(np.median(step))
    max_overhang = (
        _MAX_BACKWARD_RATIO * np.maximum(apart[1:], apart[:-1]) + _BACKWARD_TOLERANCE * length
    )
    if np.any(step < -max_overhang):
        raise CaseError(ambiguity_message(face_1, face_2))


def ambiguity_message(face_1: Face | Surface, face_2: Face | Surface) -> str:
    """Message for faces with ambiguous pairs of opposite points."""
    return (
        f"geometry.contact: it is not clear which points of {face_1.name} and {face_2.name} meet, "
        "as one of them folds back opposite the other; name only the part that is to touch"
    )
