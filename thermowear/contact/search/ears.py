"""Triangulation of simple polygons by cutting off ears."""

from __future__ import annotations

import numpy as np

_TOLERANCE = 1e-9
"""Area of an inverted triangle that is rounding."""


def without_folds(
    points: np.ndarray, of: np.ndarray, parts: np.ndarray, of_part: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of polygons, replaced by `ears` in polygons of which some are inverted.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Corners of the polygons, one after the other, anticlockwise.
    of : ndarray of int, shape (n,)
        Number of the polygon of each corner.
    parts : ndarray, shape (n_parts, 4, 2)
        Triangles whose last two corners coincide.
    of_part : ndarray of int, shape (n_parts,)

    Returns
    -------
    parts, of_part : ndarray
    """
    first, second = np.moveaxis(parts[:, 1:3] - parts[:, :1], 1, 0)
    folded = np.unique(of_part[_cross(first, second) < -_TOLERANCE])
    kept = ~np.isin(of_part, folded)
    found, numbers = [parts[kept]], [of_part[kept]]
    for number in folded:  # few: slender ones between two curved edges
        cut = ears(points[of == number])
        found.append(cut[:, [0, 1, 2, 2]])
        numbers.append(np.full(len(cut), number))
    return np.concatenate(found), np.concatenate(numbers)


def ears(polygon: np.ndarray) -> np.ndarray:
    """Triangles of a simple polygon, by cutting off one corner after the other.

    An ear is a convex corner whose triangle with its neighbours contains no other corner (Meisters,
    Amer. Math. Monthly 82 (1975) 648); the one of the largest smallest height is cut off.

    Parameters
    ----------
    polygon : ndarray, shape (n, 2)
        Corners, anticlockwise.

    Returns
    -------
    ndarray, shape (n - 2, 3, 2)
        Anticlockwise.
    """
    found, left = [], polygon
    while len(left) > 3:
        candidates = np.stack([np.roll(left, 1, axis=0), left, np.roll(left, -1, axis=0)], axis=1)
        quality = np.where(_holds_a_corner(candidates, left), -np.inf, _height(candidates))
        k = int(quality.argmax())
        found.append(candidates[k])
        left = np.delete(left, k, axis=0)
    return np.array([*found, left])


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _height(triangles: np.ndarray) -> np.ndarray:
    """Smallest height of triangles (n, 3, 2), negative for clockwise ones, shape (n,)."""
    sides = np.roll(triangles, -1, axis=1) - triangles
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    return _cross(sides[:, 0], sides[:, 1]) / np.maximum(longest, 1e-300)


def _holds_a_corner(triangles: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Mask of the triangles (n, 3, 2) that contain one of n corners other than their own."""
    sides = np.roll(triangles, -1, axis=1) - triangles
    off = _cross(sides[:, :, None], corners - triangles[:, :, None])
    inside = np.all(off >= 0.0, axis=1)
    n = len(corners)
    for shift in (-1, 0, 1):
        inside[np.arange(n), (np.arange(n) + shift) % n] = False
    return inside.any(axis=1)
