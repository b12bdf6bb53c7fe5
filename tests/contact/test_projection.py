"""Points of faces that lie opposite others: the closest ones, and those straight ahead."""

from dataclasses import replace

import numpy as np
import pytest

from thermowear.contact.faces.face import Face
from thermowear.contact.faces.projection import overhang, project, ray_intersections
from thermowear.contact.search.refinement import rule


def chain(x, y):
    """Straight facets through points from left to right, the body below them."""
    ends = np.column_stack([x, y])
    nodes = np.stack([ends[:-1], ends[1:]], axis=1)
    count = np.zeros(len(nodes), dtype=int)
    return Face(nodes, -np.ones(len(nodes)), count, count, count, np.zeros(len(nodes), dtype=bool))


WALLS = chain([0.0, 1.0, 3.0, 4.0], [0.0, -0.5, -0.5, 0.0])
"""A groove with slanted walls."""
DOWN = np.array([[0.0, -1.0]])


@pytest.mark.parametrize("height", [-0.8, -0.4, 0.0, 0.3])
def test_the_way_straight_ahead(height):
    """Above the face and behind it, on its walls and past its kinks: along x nothing changes."""
    x = np.linspace(0.05, 3.95, 40)
    points = np.column_stack([x, np.full(40, height)])
    facet, t, way = ray_intersections(WALLS, points, np.repeat(DOWN, 40, axis=0))
    y = np.interp(x, [0.0, 1.0, 3.0, 4.0], [0.0, -0.5, -0.5, 0.0])
    assert way == pytest.approx(height - y, abs=1e-12)
    assert WALLS.points(facet, t) == pytest.approx(np.column_stack([x, y]), abs=1e-12)


def test_the_face_goes_on_straight_beyond_its_ends():
    level = chain([0.0, 1.0], [0.0, 0.0])
    facet, t, way = ray_intersections(level, np.array([[1.2, 0.1]]), DOWN)
    assert (facet[0], t[0]) == (0, 1.0)
    assert way == pytest.approx([0.1])


def test_only_the_ends_of_a_face_have_something_beside_them():
    """A point behind a kink is nearest to the kink itself, and yet the face is opposite it."""
    ridge = chain([0.0, 1.0, 2.0], [0.0, 0.5, 0.0])
    points = np.array([[1.0, 0.9], [-0.2, 0.0], [2.0, -0.2]])
    off = overhang(ridge, *project(ridge, points))
    assert off[0] == 0.0
    assert np.all(off[1:] > 0.05)


def test_a_face_may_reach_past_the_other():
    """Pieces beside the other face count only if requested, all others always."""
    lower, upper = chain([0.0, 1.0, 2.0], [0.0] * 3), chain([0.05, 1.05, 2.05], [0.1] * 3)
    upper = replace(upper, outward=-upper.outward)
    strict, generous = (rule(upper, lower, 4, True, 1e-9, size) for size in (1e-9, 0.05))
    assert strict.weight.sum() == pytest.approx(1.95)
    assert generous.weight.sum() == pytest.approx(2.0)
