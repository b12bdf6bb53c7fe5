"""Lists of polygons in the plane: orientation, cuts, removal of redundant corners, division.

Polygons are cut by the method of Sutherland and Hodgman (Commun. ACM 17 (1974) 32), all together:
the corners of all polygons are one list.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .ears import without_folds

TOLERANCE = 1e-9
"""Relative size of a facet below which corners coincide with each other or with a side."""


class Polygons(NamedTuple):
    """Corners of polygons in one list, those of each polygon one after the other.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
    of : ndarray of int, shape (n,)
        Number of the polygon, ascending.
    """

    points: np.ndarray
    of: np.ndarray

    @property
    def first(self) -> np.ndarray:
        """Index of the first corner of each polygon."""
        return np.flatnonzero(np.diff(self.of, prepend=-1))

    @property
    def before(self) -> np.ndarray:
        """Index of the corner before each corner."""
        first, result = self.first, np.arange(len(self.of)) - 1
        result[first] = np.append(first[1:], len(self.of)) - 1
        return result

    @property
    def after(self) -> np.ndarray:
        """Index of the corner after each corner."""
        result = np.empty(len(self.of), dtype=np.int64)
        result[self.before] = np.arange(len(self.of))
        return result

    def per_corner(self, values: np.ndarray) -> np.ndarray:
        """Values of the polygons, repeated for each of their corners."""
        return np.repeat(values, np.diff(np.append(self.first, len(self.of))))

    def only(self, kept: np.ndarray) -> Polygons:
        """Polygons of the chosen corners."""
        return Polygons(self.points[kept], self.of[kept])


def anticlockwise(polygons: Polygons) -> Polygons:
    """Polygons without orientation reversed where they run clockwise."""
    p, following = polygons.points, polygons.points[polygons.after]
    area = np.bincount(polygons.of, p[:, 0] * following[:, 1] - p[:, 1] * following[:, 0])
    first = polygons.first
    last = np.append(first[1:], len(p)) - 1
    every = np.arange(len(p))
    mirrored = polygons.per_corner(first + last) - every
    return polygons._replace(points=p[np.where(area[polygons.of] > 0, every, mirrored)])


def cut(polygons: Polygons, height: np.ndarray) -> Polygons:
    """Parts of polygons where the interpolated height of their corners is nonnegative."""
    before = polygons.before
    lower = height[before]
    crossed = ((height > 0) & (lower < 0)) | ((height < 0) & (lower > 0))
    part = np.divide(lower, lower - height, out=np.zeros_like(height), where=crossed)[:, None]
    start = polygons.points[before]
    points = np.stack([start + part * (polygons.points - start), polygons.points], axis=1)
    kept = np.column_stack([crossed, height >= 0])
    return Polygons(points[kept], np.repeat(polygons.of, 2).reshape(-1, 2)[kept])


def tidied(polygons: Polygons) -> Polygons:
    """Polygons without redundant corners; those of less than three corners vanish."""
    while len(polygons.of):
        turn, first = np.abs(_turns(polygons)), polygons.first
        least = np.minimum.reduceat(turn, first)
        count = np.diff(np.append(first, len(turn)))
        small = polygons.per_corner(count) < 3
        flattest = polygons.per_corner(np.where(least > TOLERANCE, -1.0, least)) == turn
        candidates = np.flatnonzero(flattest)
        removed = candidates[np.unique(polygons.of[candidates], return_index=True)[1]]
        small[removed] = True
        if not small.any():
            break
        polygons = polygons.only(~small)
    return polygons


def _turns(polygons: Polygons) -> np.ndarray:
    """Distance of each corner from the line of its neighbours, positive for a left turn."""
    p = polygons.points
    before, after = p - p[polygons.before], p[polygons.after] - p
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    longer = np.maximum(np.hypot(*before.T), np.hypot(*after.T))
    return across / np.maximum(longer, TOLERANCE)


def divided(polygons: Polygons, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Parts (n, 4, 2) of polygons, and the polygon of each.

    Convex polygons are divided from their first corner, into quadrilaterals in those, into
    triangles in triangles; others into triangles about the mean of their corners or, where that
    does not see all sides, by cutting off ears.
    """
    p, of, first = polygons.points, polygons.of, polygons.first
    if not len(of):
        return np.empty((0, 4, 2)), of
    count = np.diff(np.append(first, len(of)))
    convex = np.minimum.reduceat(_turns(polygons), first) >= 0
    step = 1 if kind == "triangle" else 2
    parts = np.where(convex, (count - 3) // step + 1, 0)
    origin, sides = np.repeat(first, parts), np.repeat(count, parts)
    k = 1 + step * (np.arange(len(origin)) - np.repeat(np.cumsum(parts) - parts, parts))
    fan = np.stack([0 * k, k, k + 1, (k + step) % sides], axis=1)
    bent = np.flatnonzero(~polygons.per_corner(convex))
    following = p[polygons.after]
    mean = np.column_stack([np.bincount(of, x)[of] / np.bincount(of)[of] for x in p.T])
    about = np.stack([mean, p, following, following], axis=1)[bent]
    about, of_bent = without_folds(p, of, about, of[bent])
    corners = np.concatenate([p[origin[:, None] + fan], about])
    of_part = np.concatenate([of[origin], of_bent])
    order = np.argsort(of_part, kind="stable")
    return corners[order], of_part[order]
