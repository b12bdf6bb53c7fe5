"""Points of faces that lie opposite others: the closest ones, and those straight ahead."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from thermowear.contact.faces.face import Face, Surface
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


def slanted_walls():
    """The groove in space, of parallelograms with sharp corners, three facets long."""
    ends = np.vstack([WALLS.nodes[:, 0], WALLS.nodes[-1:, 1]])
    places = np.array([[(x, y, z + 1.5 * x) for z in range(4)] for x, y in ends])
    numbers, parts = np.arange(16).reshape(4, 4), [slice(None, -1), slice(1, None)]
    nodes, corners = (
        np.stack([each[i, j] for i in parts for j in parts], axis=2) for each in (places, numbers)
    )
    owner = [np.zeros(9, dtype=int)] * 3
    nodes, corners = nodes.reshape(9, 4, 3), corners.reshape(9, 4)
    return Surface(nodes, np.ones(9), *owner, corners, kind="quadrilateral")


def test_the_closest_point_of_a_groove():
    """No point of any facet is closer, also where another one is along its skewed sides."""
    walls = slanted_walls()
    points = np.random.default_rng(7).uniform([-1, -1.2, -1], [5, 0.7, 9], (600, 3))
    u = np.linspace(0.0, 1.0, 41)
    everywhere = walls.points(*walls.on_each(np.array([(v, w) for v in u for w in u])))
    sampled = cKDTree(everywhere).query(points)[0]
    close = sampled < 0.5  # far beyond its size, a facet's skewed sides hide the closest one
    points, sampled = points[close], sampled[close]
    facet, t, offset = project(walls, points)
    distance = np.linalg.norm(offset, axis=1)
    assert np.all(distance <= sampled + 1e-12)
    assert np.all(distance >= sampled - 0.05)
    assert walls.points(facet, t) == pytest.approx(points + offset, abs=1e-12)


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
