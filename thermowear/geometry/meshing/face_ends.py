"""Division of a contact face: in the contact zone and on both sides of it."""

from __future__ import annotations

import math

import numpy as np

from .blocks import graded_face, sizes

_QUICKLY = 3.0
"""Size ratio of elements away from a graded contact edge, outside the contact zone."""


def growth(elements: int) -> float:
    """Growth ratio of elements away from a contact with `elements`; lower in fine meshes."""
    return min(3.0, 1.0 + 16.0 / elements)


def row_ratio(elements: int) -> float:
    """Growth ratio of elements close to the contact."""
    return min(2.0, 1.0 + 12.0 / elements)


def face_ends(
    zone: tuple[float, float],
    elements: int,
    grading: float,
    half: bool,
    limits: tuple[float, float],
) -> tuple[np.ndarray, float]:
    """Element ends along a face.

    Elements shrink towards both ends of the zone, from inside and, with a larger ratio, from
    outside. Outside they extend over half the width of the zone, or up to the limits.

    Parameters
    ----------
    zone : tuple of float
        Contact zone [m]; the left end is not used for `half`.
    elements, grading
        Number of elements and grading in the zone, see `thermowear.case.tables.schema.Mesh`.
    half : bool
        True if only the right half of a symmetric face is meshed.
    limits : tuple of float
        Outer limits of the face [m].

    Returns
    -------
    ends : ndarray
    largest : float
        Size of the largest element in the zone.
    """
    if half:
        zone, elements = (-zone[1], zone[1]), 2 * math.ceil(elements / 2)
    inside = sizes(graded_face(*zone, elements, grading))
    reach = (zone[1] - zone[0]) / 2
    ratio = row_ratio(elements)
    left, right = (
        _outer_sizes(inside, ratio, min(reach, room))
        for room in (zone[0] - limits[0], limits[1] - zone[1])
    )
    within = zone[0] + np.concatenate([[0.0], np.cumsum(inside)])
    within[-1] = zone[1]
    ends = np.concatenate([zone[0] - np.cumsum(left)[::-1], within, zone[1] + np.cumsum(right)])
    if half:
        ends = np.concatenate([[0.0], within[elements // 2 + 1 :], zone[1] + np.cumsum(right)])
    return ends, float(inside.max())


def _outer_sizes(inside: np.ndarray, ratio: float, reach: float) -> np.ndarray:
    """Sizes of elements outside the zone, from its end outwards.

    The first is as large as the adjacent one inside. Sizes grow by `_QUICKLY` up to the largest
    inside, from there by `ratio`, and extend over about `reach`.
    """
    found: list[float] = []
    while sum(found) < 0.8 * reach:
        if not found:
            found.append(inside[0])
        else:
            found.append(found[-1] * (_QUICKLY if found[-1] < 0.9 * inside.max() else ratio))
    if found:
        found[-1] = min(found[-1], 1.25 * reach - sum(found[:-1]))
    return np.array(found)


def smoothed(ends: np.ndarray, ratio: float) -> np.ndarray:
    """Split elements that are larger than their neighbours by much more than `ratio`."""
    found = [float(x) for x in ends]
    k = 0
    while k < len(found) - 1:
        size = found[k + 1] - found[k]
        before = found[k] - found[k - 1] if k > 0 else math.inf
        after = found[k + 2] - found[k + 1] if k + 2 < len(found) else math.inf
        if size <= 1.5 * ratio * min(before, after):
            k += 1
        elif before < after:
            found.insert(k + 1, found[k] + ratio * before)
        else:
            found.insert(k + 1, found[k + 1] - ratio * after)
            k = max(k - 1, 0)
    return np.array(found)


def depth_ends(first: float, depth: float, ratio: float) -> np.ndarray:
    """Row ends below a face, from 0 to `depth`, growing by a ratio from about `first`."""
    count = max(1, round(math.log1p(depth / first * (ratio - 1)) / math.log(ratio)))
    steps = ratio ** np.arange(count)
    return np.concatenate([[0.0], np.cumsum(steps)]) * depth / steps.sum()
