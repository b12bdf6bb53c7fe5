"""Structured, graded quadrilaterals on a tensor grid of rectangles, by gmsh's transfinite rules.

A direction is a list of intervals, each with its number of elements and their growth ratio.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..mesh.limits import check_count

SAME = 1e-9
"""Relative tolerance: lengths in different units that differ by less are equal."""


@dataclass(frozen=True)
class Interval:
    """Interval of a grid direction.

    Attributes
    ----------
    start, end : float [m]
    elements : int
    growth : float
        Size ratio of successive elements, from start to end.
    """

    start: float
    end: float
    elements: int
    growth: float = 1.0


def graded_face(start: float, end: float, elements: int, grading: float) -> list[Interval]:
    """Divide a contact face so that its elements shrink towards both edges.

    Up to three elements at each edge follow the ratio `grading`; the rest are equal.

    Returns
    -------
    list of Interval
        ``thin edge, middle, thin edge`` (only the middle if nothing is graded).
    """
    layers = min(3, (elements - 1) // 2)
    if layers == 0 or grading == 1.0:
        return [Interval(start, end, elements)]
    edge = sum(grading**i for i in range(1, layers + 1))
    middle = elements - 2 * layers
    size = (end - start) / (middle + 2 * edge)
    return [
        Interval(start, start + edge * size, layers, 1 / grading),
        Interval(start + edge * size, end - edge * size, middle),
        Interval(end - edge * size, end, layers, grading),
    ]


def smallest(intervals: list[Interval]) -> float:
    """Size of the smallest element of a direction."""
    return min(_first_size(i) * min(1.0, i.growth ** (i.elements - 1)) for i in intervals)


def growing(
    start: float, end: float, first: float, grading: float, largest: float
) -> list[Interval]:
    """Fill ``start…end`` with elements that grow from `first` by ``1/grading`` up to `largest`.

    `end` may lie below `start`: the elements grow from `start` in either case. The result is empty
    if both are equal up to rounding.
    """
    span = abs(end - start)
    if span <= SAME * max(abs(start), abs(end)):
        return []
    ratio = 1.0 / grading
    if grading == 1.0:
        return _oriented([Interval(start, end, _count(span, largest))])
    count, size, graded = 1, first, first
    while graded < span and size * ratio <= largest:
        size *= ratio
        graded += size
        count += 1
    rest = span - graded
    if rest < 0.5 * size:
        return _oriented([Interval(start, end, count, ratio)])
    border = start + (graded if end > start else -graded)
    return _oriented(
        [Interval(start, border, count, ratio), Interval(border, end, _count(rest, largest))]
    )


def _count(span: float, largest: float) -> int:
    """Number of equal elements that fill a span, none larger than `largest`."""
    check_count(span / largest)
    return max(1, math.ceil(span / largest - 1e-9))


def growing_from_both(
    start: float, end: float, first: tuple[float, float], grading: float, largest: float
) -> list[Interval]:
    """Fill ``start…end`` (upwards) with elements that grow from both ends to the middle.

    `first` are the sizes at start and end; the result may be empty as in `growing`.
    """
    if abs(end - start) <= SAME * max(abs(start), abs(end)):
        return []
    middle = (start + end) / 2
    lower = growing(start, middle, first[0], grading, largest)
    upper = growing(end, middle, first[1], grading, largest)
    return lower + upper


def _oriented(intervals: list[Interval]) -> list[Interval]:
    """Intervals in ascending order, whichever way they were filled."""
    if intervals[0].start < intervals[0].end:
        return intervals
    return [Interval(i.end, i.start, i.elements, 1 / i.growth) for i in reversed(intervals)]


def _first_size(interval: Interval) -> float:
    n, g = interval.elements, interval.growth
    length = interval.end - interval.start
    return length / n if g == 1.0 else length * (1 - g) / (1 - g**n)


def sizes(intervals: list[Interval]) -> np.ndarray:
    """Sizes of all elements of a direction."""
    parts = [i.growth ** np.arange(i.elements) for i in intervals]
    return np.concatenate(
        [p / p.sum() * (i.end - i.start) for p, i in zip(parts, intervals, strict=True)]
    )


def ends_of(intervals: list[Interval]) -> np.ndarray:
    """Ends of the elements of consecutive intervals."""
    ends = intervals[0].start + np.concatenate([[0.0], np.cumsum(sizes(intervals))])
    ends[-1] = intervals[-1].end
    return ends


@dataclass(frozen=True)
class Grid:
    """Curves and surfaces of a meshed rectangle in gmsh, by position in the grid.

    Attributes
    ----------
    surfaces : list of int
    bottom, top, left, right : list of int
        Boundary curves, one per interval.
    """

    surfaces: list[int]
    bottom: list[int]
    top: list[int]
    left: list[int]
    right: list[int]


def add_grid(model, columns: list[Interval], rows: list[Interval]) -> Grid:
    """Add a rectangle to a gmsh model, prepared for a structured quadrilateral mesh.

    Parameters
    ----------
    model : gmsh.model
    columns, rows : list of Interval
        Consecutive and ascending; the directions of the first and second coordinate.
    """
    check_count(*(sum(i.elements for i in intervals) for intervals in (columns, rows)))
    geo = model.geo
    xs = [columns[0].start] + [c.end for c in columns]
    ys = [rows[0].start] + [r.end for r in rows]
    point = [[geo.addPoint(x, y, 0.0) for x in xs] for y in ys]
    along = [
        [_line(geo, point[j][i], point[j][i + 1], columns[i]) for i in range(len(columns))]
        for j in range(len(ys))
    ]
    up = [
        [_line(geo, point[j][i], point[j + 1][i], rows[j]) for i in range(len(xs))]
        for j in range(len(rows))
    ]
    surfaces = []
    for j in range(len(rows)):
        for i in range(len(columns)):
            loop = geo.addCurveLoop([along[j][i], up[j][i + 1], -along[j + 1][i], -up[j][i]])
            surface = geo.addPlaneSurface([loop])
            geo.mesh.setTransfiniteSurface(surface)
            geo.mesh.setRecombine(2, surface)
            surfaces.append(surface)
    return Grid(
        surfaces=surfaces,
        bottom=along[0],
        top=along[-1],
        left=[row[0] for row in up],
        right=[row[-1] for row in up],
    )


def _line(geo, start: int, end: int, interval: Interval) -> int:
    line = geo.addLine(start, end)
    geo.mesh.setTransfiniteCurve(line, interval.elements + 1, "Progression", interval.growth)
    return line
