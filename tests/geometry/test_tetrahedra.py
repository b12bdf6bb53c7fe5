"""Quality of curved tetrahedra."""

import itertools
import math

import numpy as np
import pytest

from thermowear.geometry.mesh.nodes import reference_nodes, shape_functions, slopes
from thermowear.geometry.mesh.tagged import scaled_jacobians_of_tetrahedra

REGULAR = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], dtype=float)


def cell(corners, order):
    """Straight cell of an order, right-handed."""
    corners = np.asarray(corners, dtype=float)
    if np.linalg.det(corners[1:] - corners[0]) < 0:
        corners = corners[[0, 2, 1, 3]]
    return shape_functions("tetrahedron", 1, reference_nodes("tetrahedron", order)) @ corners


@pytest.mark.parametrize("order", [1, 2, 3])
def test_closed_forms(order):
    """A regular cell is 1, the corner of a cube √2/(1·√2·√3), a flat one is bad at any."""
    assert scaled_jacobians_of_tetrahedra(order, cell(REGULAR, order)[None]) == pytest.approx([1.0])
    path = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1)]  # along edges of a cube
    assert scaled_jacobians_of_tetrahedra(order, cell(path, order)[None]) == pytest.approx(
        [1 / math.sqrt(3)]
    )
    flat = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1e-3)])
    found = [
        scaled_jacobians_of_tetrahedra(order, cell(flat[list(turn)], order)[None])[0]
        for turn in itertools.permutations(range(4))
    ]
    known = math.sqrt(2) * 1e-3 / (math.sqrt(2) * 1.0 * math.sqrt(1 + 1e-6))
    assert found == pytest.approx([known] * 24, rel=1e-9)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_inverted_cells_are_negative(order):
    nodes = cell(REGULAR, order) * (1, 1, -1)
    assert scaled_jacobians_of_tetrahedra(order, nodes[None]) == pytest.approx([-1.0])


def test_cells_inverted_between_the_samples():
    """An edge whose middle node lies beyond a quarter of it folds the cell; see its derivative.

    Along the edge x(s) = s + 4 d s (1 - s) from 0 to 1, so that x' = 1 ± 4 d at the ends.
    """
    middle = reference_nodes("tetrahedron", 2)
    (node,) = np.flatnonzero(np.all(middle == (0.5, 0.0, 0.0), axis=1))
    found = []
    for shift in (0.2, 0.249, 0.251, 0.3):
        nodes = middle.copy()
        nodes[node, 0] += shift
        found.append(scaled_jacobians_of_tetrahedra(2, nodes[None])[0])
    assert np.all(np.diff(found) < 0.0)
    assert np.array_equal(np.array(found) > 0.0, [True, True, False, False])


def test_smallest_determinant_of_random_cells():
    """Never positive where dense samples of the determinant are negative, also between nodes."""
    rng = np.random.default_rng(4)
    nodes = reference_nodes("tetrahedron", 2) + rng.uniform(-0.14, 0.14, (4000, 10, 3))
    dense = rng.dirichlet(np.ones(4) / 2, 2000)[:, 1:]
    sampled, at_lattice = (
        np.linalg.det(np.einsum("qdk,cki->cqdi", slopes("tetrahedron", 2, places), nodes)).min(1)
        for places in (dense, reference_nodes("tetrahedron", 3))
    )
    found = scaled_jacobians_of_tetrahedra(2, nodes)
    assert np.count_nonzero((sampled < 0.0) & (at_lattice > 0.0)) >= 3
    assert np.all(found[sampled < 0.0] <= 0.0)
    assert np.count_nonzero((found <= 0.0) & (sampled > 0.0)) < 200
