"""Division of the boundary lines of a body for a quadrilateral mesh.

The mesh is generated with cells twice as long as the edges, then refined. Edges are therefore
grouped in pairs of similar length; an edge without a similar neighbour is halved, and so are pairs
much longer than their neighbours, also around corners.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from .skeleton import OutlinePiece

_UNEVEN = 1.6
"""Largest length ratio of the two edges of a pair."""
_GROWTH = 4.0
"""Largest length ratio of neighbouring pairs."""

Span = tuple[float, float, float]
"""Start, middle and end of a pair, as edge numbers and fractions."""


def even(lines: list[OutlinePiece]) -> list[np.ndarray]:
    """Edge ends of the new division of each line, as numbers and fractions of its edges."""
    spans = [_pairs(_sizes(line)) for line in lines]
    while True:
        lengths = [_lengths(line, pairs) for line, pairs in zip(lines, spans, strict=True)]
        limits = _limits(lines, lengths)
        if all(np.all(a <= b) for a, b in zip(lengths, limits, strict=True)):
            break
        spans = [
            [
                part
                for span, far in zip(pairs, long > most, strict=True)
                for part in _parts(span, far)
            ]
            for pairs, long, most in zip(spans, lengths, limits, strict=True)
        ]
    return [np.array([*(u for span in pairs for u in span[:2]), pairs[-1][2]]) for pairs in spans]


def _pairs(lengths: np.ndarray) -> list[Span]:
    """Pairs of neighbours of similar length, and halves of the other edges."""
    found: list[Span] = []
    k = 0
    while k < len(lengths):
        short, long = min(lengths[k : k + 2]), max(lengths[k : k + 2])
        step = 2 if k + 1 < len(lengths) and long <= _UNEVEN * short else 1
        found.append((k, k + step / 2, k + step))
        k += step
    return found


def _parts(span: Span, divided: np.bool) -> list[Span]:
    """Pair, or its two halves as pairs."""
    start, middle, end = span
    if not divided:
        return [span]
    return [(a, (a + b) / 2, b) for a, b in ((start, middle), (middle, end))]


def _limits(lines: list[OutlinePiece], lengths: list[np.ndarray]) -> list[np.ndarray]:
    """Largest length of the pairs of each line, given by their neighbours."""
    at = defaultdict(list)
    for line, own in zip(lines, lengths, strict=True):
        for end, length in zip(line.ends, own[[0, -1]], strict=True):
            at[end].append(length)
    found = []
    for line, own in zip(lines, lengths, strict=True):
        around = np.concatenate([[min(at[line.ends[0]])], own, [min(at[line.ends[1]])]])
        found.append(_GROWTH * np.minimum(around[:-2], around[2:]))
    return found


def _sizes(line: OutlinePiece) -> np.ndarray:
    return np.linalg.norm(line.edges[:, -1] - line.edges[:, 0], axis=1)


def _lengths(line: OutlinePiece, spans: list[Span]) -> np.ndarray:
    """Lengths of pairs, with uniform chord length within each edge [m]."""
    so_far = np.concatenate([[0.0], np.cumsum(_sizes(line))])
    start, _, end = np.array(spans).T
    numbers = np.arange(len(so_far))
    return np.interp(end, numbers, so_far) - np.interp(start, numbers, so_far)
