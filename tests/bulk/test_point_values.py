"""Values of fields at points, and the cells that contain them."""

from mpi4py import MPI

import numpy as np
import pytest
from scipy.spatial import Delaunay

from thermowear.bulk.bodies import distribute
from thermowear.bulk.points import located, point_rows
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.geometry.mesh.tagged import TaggedMesh

OWNER = {"block": "block"}


def bodies_of(points, cells, cell_type, facet_nodes):
    """One body of cells, without named facets."""
    none = np.zeros((0, facet_nodes), dtype=np.int64)
    tags = np.ones(len(cells), dtype=np.int32)
    mesh = TaggedMesh(points, cell_type, cells, tags, none, tags[:0], ("block",), ())
    return distribute(mesh, MPI.COMM_SELF)


def value(bodies, spaces, nodal, point):
    """Value at a point; None outside."""
    (found,) = located(bodies, [tuple(point)], OWNER)
    return (point_rows(spaces, [found["block"]]) @ nodal)[0] if found else None


@pytest.mark.parametrize("dim", [2, 3])
def test_cells_of_triangles_and_tetrahedra(dim):
    """requirement: values in the simplex that Qhull finds, by its barycentric coordinates."""
    random = np.random.default_rng(3)
    corners = np.stack(np.meshgrid(*dim * [[0.0, 1.0]]), axis=-1).reshape(-1, dim)
    points = np.concatenate([corners, 0.05 + 0.9 * random.random((20, dim))])
    qhull = Delaunay(points)
    kind = "triangle" if dim == 2 else "tetrahedron"
    bodies = bodies_of(points, qhull.simplices.astype(np.int64), kind, dim)
    spaces = lagrange_spaces(bodies, 1)
    nodes = spaces.nodes()
    order = np.linalg.norm(nodes[:, None] - points, axis=2).argmin(axis=1)
    given = random.random(len(points))
    for point in random.random((40, dim)):
        simplex = int(qhull.find_simplex(point))
        inner = qhull.transform[simplex, :dim] @ (point - qhull.transform[simplex, dim])
        expected = given[qhull.simplices[simplex]] @ np.append(inner, 1 - inner.sum())
        assert value(bodies, spaces, given[order], point) == pytest.approx(expected, abs=1e-12)


def test_a_side_that_bulges_beyond_its_nodes():
    """
    requirement: points below the parabola y = 1 + 1.2 x - x², higher than its nodes, are inside,
    and a linear field is exact there; those above are outside.
    """
    x = np.array([0.0, 1.0, 1.0, 0.0, 0.5, 1.0, 0.5, 0.0, 0.5])
    height = np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.5, 1.0, 0.5, 0.5])
    points = np.stack([x, height * (1 + 1.2 * x - x**2)], axis=1)
    bodies = bodies_of(points, np.arange(9)[None], "quadrilateral", 3)
    spaces = lagrange_spaces(bodies, 2)
    nodal = spaces.nodes() @ np.array([1.0, 2.0])
    for x in (0.55, 0.6, 0.65):
        top = 1 + 1.2 * x - x**2
        assert top > points[:, 1].max()
        inside = np.array([x, top - 1e-4])
        assert value(bodies, spaces, nodal, inside) == pytest.approx(x + 2 * inside[1], abs=1e-12)
        assert value(bodies, spaces, nodal, [x, top + 1e-4]) is None


def test_points_outside():
    """requirement: a point belongs to a body up to rounding."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    bodies = bodies_of(points, np.arange(4)[None], "quadrilateral", 2)
    spaces = lagrange_spaces(bodies, 1)
    nodal = spaces.nodes()[:, 0]
    assert value(bodies, spaces, nodal, (0.3, 1.0)) == pytest.approx(0.3, abs=1e-12)
    assert value(bodies, spaces, nodal, (0.3, 1.0 + 1e-9)) == pytest.approx(0.3, abs=1e-12)
    assert value(bodies, spaces, nodal, (0.3, 1.0 + 1e-4)) is None
    assert value(bodies, spaces, nodal, (-1e-4, 0.5)) is None
