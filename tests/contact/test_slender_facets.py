"""Search on faces of narrow curved facets: rows of elements along the rim of a ring."""

import numpy as np
import pytest

from thermowear.bulk.kinematics import Spatial
from thermowear.contact.faces.facets import slenderness
from thermowear.contact.faces.projection import project
from thermowear.contact.search.pairing import pair

from .solids import SIZE, gathered, two_solids

INNER, ROWS = 0.05, (0.0, 5.6e-3, 8e-3, 8.35e-3)
CELLS = ["hexahedron", "tetrahedron"]


def narrow(p):
    """A quarter of a ring whose rows are narrow at the outer rim: 5.6, 2.4 and 0.35 mm wide."""
    x, y, z = np.moveaxis(p, -1, 0)
    r = INNER + np.interp(3 * x / SIZE[0], range(4), ROWS)
    angle = y / SIZE[1] * np.pi / 2
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)


AREA = np.pi / 4 * (2 * INNER * ROWS[-1] + ROWS[-1] ** 2)


def faces(sectors, cell_type):
    divisions = tuple((3, count, 2) for count in sectors)
    return gathered(two_solids(divisions, 2, (narrow, narrow), cell_type))[1]


@pytest.mark.parametrize("cell_type", CELLS)
def test_narrow_facets_of_the_same_nodes(cell_type):
    """requirement: every point lies opposite to itself, and the face is covered once."""
    upper, lower = faces((3, 3), cell_type)
    assert slenderness(upper).max() > 2.0
    pairing = pair(upper, lower, Spatial(), 4)
    on_1, on_2 = (side.points for side in pairing.sides)
    np.testing.assert_allclose(on_1, on_2, atol=1e-14)
    assert pairing.weights.sum() == pytest.approx(AREA, rel=1e-3)
    assert pairing.weights.sum() == pytest.approx(upper.sizes.sum(), rel=1e-5)
    assert pairing.unpaired < 1e-12


@pytest.mark.parametrize("cell_type", CELLS)
def test_closest_points_on_narrow_facets(cell_type):
    """requirement: a point of a face is its own closest one; above it, its foot is."""
    _, lower = faces((3, 2), cell_type)
    rng = np.random.default_rng(3)
    facet, t = rng.integers(len(lower.nodes), size=400), rng.uniform(0.0, 1.0, (400, 2))
    if cell_type == "tetrahedron":
        t = np.where(t.sum(axis=1, keepdims=True) < 1, t, 1 - t)
    on = lower.points(facet, t)
    found, at, offset = project(lower, on + [0.0, 0.0, 1e-3])
    np.testing.assert_allclose(lower.points(found, at), on, atol=1e-12)
    np.testing.assert_allclose(offset, [[0.0, 0.0, -1e-3]] * 400, atol=1e-12)
