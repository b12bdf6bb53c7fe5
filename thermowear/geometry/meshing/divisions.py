"""Division of lines into elements, graded towards contact edges.

A division is an array of element ends in ascending order.
"""

from __future__ import annotations

import math

import numpy as np

from ...errors import CaseError

SAME = 1e-9
"""Relative tolerance: lengths in different units that differ by less are equal."""
MOST_CELLS = 1_000_000
"""Largest number of cells of a body: more are a unit error and would exceed the memory."""
MOST_HEXAHEDRA = 100_000
"""Largest number of cells of a body in space, with many more nodes and neighbours each."""
QUICKLY = 3.0
"""Size ratio of elements away from a graded contact edge, outside the contact zone."""
_APART = 1e-6
"""Least distance of a contact edge from the edge of the face, relative to its farthest end."""


def check_count(*counts: float, most: int = MOST_CELLS) -> None:
    """Reject a grid of too many cells.

    Parameters
    ----------
    *counts : float
        Number of cells in each direction.
    most : int
        Largest number of cells of a body.

    Raises
    ------
    CaseError
    """
    cells = math.prod(counts)
    if not cells <= most:
        raise CaseError(
            f"geometry: dimensions and mesh.elements lead to about {cells:.2g} cells in one body; "
            f"at most {most} can be meshed; check the units, or use fewer elements"
        )


def joined(*parts: np.ndarray) -> np.ndarray:
    """Division of consecutive lines; those without elements consist of one point."""
    return np.concatenate([*(part[:-1] for part in parts[:-1]), parts[-1]])


def graded_face(start: float, end: float, elements: int, grading: float) -> np.ndarray:
    """Divide a contact face so that its elements shrink towards both edges.

    Up to three elements at each edge follow the ratio `grading`; the rest are equal.
    """
    layers = min(3, (elements - 1) // 2)
    steps, thin = np.ones(elements), grading ** np.arange(1.0, layers + 1)
    steps[:layers], steps[elements - layers :] = thin[::-1], thin
    return _filled(start, end, steps)


def divided_face(
    start: float, end: float, elements: int, grading: float, zone: tuple[float, float] | None
) -> np.ndarray:
    """Grade a face towards its edges, or towards those of a contact zone inside it.

    Parameters
    ----------
    start, end : float
        Ends of the face [m].
    elements, grading
        Number of elements and grading in the contact, see `thermowear.case.tables.schema.Mesh`.
    zone : tuple of float, optional
        Contact zone [m].
    """
    if zone is None:
        return graded_face(start, end, elements, grading)
    first, last = max(zone[0], start), min(zone[1], end)
    face = graded_face(first, last, elements, grading)
    parts = [face]
    size, largest = np.diff(face).min(), (last - first) / elements
    apart = _APART * max(abs(start), abs(end))
    if first - start > apart:
        parts = [growing_from_both(start, first, (size, size), grading, largest), face]
    if end - last > apart:
        parts.append(growing_from_both(last, end, (size, size), grading, largest))
    return joined(*parts)


def growing(start: float, end: float, first: float, grading: float, largest: float) -> np.ndarray:
    """Fill ``start…end`` with elements that grow from `first` by ``1/grading`` up to `largest`.

    `end` may lie below `start`: the elements grow from `start` in either case. There are none if
    both are equal up to rounding.
    """
    span = abs(end - start)
    if span <= SAME * max(abs(start), abs(end)):
        return np.array([start])
    if grading == 1.0:
        steps: np.ndarray = np.ones(_count(span, largest))
    else:
        ratio, count, size, graded = 1.0 / grading, 1, first, first
        while graded < span * (1 - SAME) and size * ratio <= largest:
            size *= ratio
            graded += size
            count += 1
        steps, rest = first * ratio ** np.arange(count), span - graded
        if rest >= 0.5 * size:
            equal = _count(rest, largest)
            steps = np.concatenate([steps, np.full(equal, rest / equal)])
    ends = _filled(start, end, steps)
    return ends if start < end else ends[::-1]


def growing_from_both(
    start: float, end: float, first: tuple[float, float], grading: float, largest: float
) -> np.ndarray:
    """Fill ``start…end`` (upwards) with elements that grow from both ends to the middle.

    `first` are the sizes at start and end; there may be no elements as in `growing`.
    """
    if abs(end - start) <= SAME * max(abs(start), abs(end)):
        return np.array([start])
    middle = (start + end) / 2
    lower = growing(start, middle, first[0], grading, largest)
    return joined(lower, growing(end, middle, first[1], grading, largest))


def _count(span: float, largest: float) -> int:
    """Number of equal elements that fill a span, none larger than `largest`."""
    check_count(span / largest)
    return max(1, math.ceil(span / largest - 1e-9))


def _filled(start: float, end: float, steps: np.ndarray) -> np.ndarray:
    """Ends of elements with sizes in proportion to `steps`, from start to end."""
    ends = start + np.concatenate([[0.0], np.cumsum(steps)]) * ((end - start) / steps.sum())
    ends[-1] = end
    return ends


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
    within = graded_face(*zone, elements, grading)
    inside, reach = np.diff(within), (zone[1] - zone[0]) / 2
    ratio = row_ratio(elements)
    left, right = (
        _outer_sizes(inside, ratio, min(reach, room))
        for room in (zone[0] - limits[0], limits[1] - zone[1])
    )
    ends = np.concatenate([zone[0] - np.cumsum(left)[::-1], within, zone[1] + np.cumsum(right)])
    if half:
        ends = np.concatenate([[0.0], within[elements // 2 + 1 :], zone[1] + np.cumsum(right)])
    return ends, float(inside.max())


def _outer_sizes(inside: np.ndarray, ratio: float, reach: float) -> np.ndarray:
    """Sizes of elements outside the zone, from its end outwards.

    The first is as large as the adjacent one inside. Sizes grow by `QUICKLY` up to the largest
    inside, from there by `ratio`, and extend over about `reach`.
    """
    found: list[float] = []
    while sum(found) < 0.8 * reach:
        if not found:
            found.append(inside[0])
        else:
            found.append(found[-1] * (QUICKLY if found[-1] < 0.9 * inside.max() else ratio))
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
    return _filled(0.0, depth, ratio ** np.arange(count))
