"""Division of slender polygons between two curved edges."""

import numpy as np
import pytest

from thermowear.contact.search.clipping import ears, without_folds


def area(polygon):
    x, y = np.moveaxis(polygon, -1, 0)
    return 0.5 * (x * np.roll(y, -1, axis=-1) - y * np.roll(x, -1, axis=-1)).sum(axis=-1)


def crescent(depth, count=5):
    """Polygon between two parabolas of nearly the same height, anticlockwise."""
    x = np.linspace(-1, 1, count)
    low, high = (np.column_stack([x, h * (1 - x**2)]) for h in (1.0 - depth, 1.0))
    return np.vstack([low, high[-2:0:-1]])


@pytest.mark.parametrize("depth", [0.5, 0.1, 1e-3])
def test_ears_fill_the_polygon_once(depth):
    """requirement: triangles without overlap: all anticlockwise, with the area of the polygon."""
    polygon = crescent(depth)
    found = area(ears(polygon))
    assert len(found) == len(polygon) - 2
    assert found.min() >= 0
    assert found.sum() == pytest.approx(area(polygon), rel=1e-12)


def test_only_folded_polygons_are_divided_anew():
    """requirement: triangles about the mean remain where all corners are visible from it."""
    square = np.array([(0.0, 0.0), (1, 0), (1, 1), (0.5, 0.9), (0, 1)])
    polygons = [square, crescent(0.1)]
    points, of = np.vstack(polygons), np.repeat([0, 1], [len(p) for p in polygons])
    parts = []
    for polygon in polygons:
        following = np.roll(polygon, -1, axis=0)
        mean = np.broadcast_to(polygon.mean(axis=0), polygon.shape)
        parts.append(np.stack([mean, polygon, following, following], axis=1))
    found, numbers = without_folds(points, of, np.concatenate(parts), of)
    np.testing.assert_array_equal(found[numbers == 0], parts[0])
    assert area(parts[1][:, :3]).min() < 0
    assert area(found[:, :3]).min() >= 0
    for number, polygon in enumerate(polygons):
        total = area(found[numbers == number][:, :3]).sum()
        assert total == pytest.approx(area(polygon), rel=1e-12)
