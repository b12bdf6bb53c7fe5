"""Lagrange polynomials, quadrature rules and lattices of reference cells."""

import itertools

import numpy as np
import pytest

from thermowear.geometry.mesh.nodes import reference_nodes, shape_functions, slopes
from thermowear.lagrange import (
    corner_nodes,
    edge_nodes,
    equispaced,
    gauss,
    lattice,
    lebesgue,
    lobatto,
    neighbour_nodes,
    on_lattice,
    tabulated,
)


@pytest.mark.parametrize("n", range(2, 14))
def test_exact_to_its_degree_and_no_further(n):
    """requirement: exact to degree 2n - 3, both ends among the points."""
    x, w = lobatto(n)
    assert (x[0], x[-1]) == (0.0, 1.0)
    degrees = np.arange(2 * n - 2)
    np.testing.assert_allclose(w @ x[:, None] ** degrees, 1 / (degrees + 1), rtol=1e-13)
    assert abs(w @ (2 * x - 1) ** (2 * n - 2) - 1 / (2 * n - 1)) > 1e-9


def test_one_point_is_refused():
    with pytest.raises(ValueError, match="two points"):
        lobatto(1)


@pytest.mark.parametrize(
    ("order", "kind", "known"),
    [(1, "triangle", 1.0), (2, "interval", 1.25), (2, "triangle", 5 / 3), (3, "interval", 1.6311)]
    + [(1, "quadrilateral", 1.0), (2, "quadrilateral", 1.25**2), (4, "interval", 2.2078)],
)
def test_polynomials_are_bounded_by_their_nodes(order, kind, known):
    """requirement: at least Lebesgue's constant, at most a tenth more."""
    assert known <= lebesgue(order, kind) <= 1.1 * known


@pytest.mark.parametrize("n", range(1, 9))
def test_gauss_rules_are_those_of_numpy(n):
    """requirement: n points along each side, the second parameter running fastest."""
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    for found, known in zip(gauss(n), (x, w), strict=True):
        assert found == pytest.approx(known, abs=1e-15)
    t, weights = gauss(n, kind="quadrilateral")
    assert t == pytest.approx(np.array(list(itertools.product(x, repeat=2))), abs=1e-15)
    assert weights == pytest.approx(np.outer(w, w).ravel(), abs=1e-15)


@pytest.mark.parametrize("rule", [gauss, lobatto])
def test_rules_of_squares_are_products(rule):
    (x, w), (t, weights) = rule(4), rule(4, kind="quadrilateral")
    assert np.array_equal(t, np.array(list(itertools.product(x, repeat=2))))
    assert weights == pytest.approx(np.outer(w, w).ravel(), rel=1e-14)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_facets_of_one_parameter(order):
    """requirement: values and two derivatives of the interpolation of a polynomial."""
    f = np.polynomial.Polynomial(np.arange(1.0, order + 2))
    t = np.linspace(0.0, 1.0, 7)
    nodes = lattice(order)
    assert nodes == pytest.approx(np.linspace(0.0, 1.0, order + 1), abs=1e-15)
    found = on_lattice(order, t, 2) @ f(nodes)
    for values, known in zip(found, (f, f.deriv(), f.deriv(2)), strict=True):
        assert values == pytest.approx(known(t), rel=1e-12, abs=1e-12)


def test_facets_of_two_parameters():
    """requirement: order of the nodes and of the derivatives: x, y, xx, xy, yy."""
    s, t = np.random.default_rng(0).uniform(size=(2, 9))
    a, b = lattice(2, kind="quadrilateral").T
    assert np.array_equal(
        np.column_stack([a, b]), list(itertools.product((0.0, 0.5, 1.0), (0.0, 0.5, 1.0)))
    )
    found = on_lattice(2, np.column_stack([s, t]), 2, "quadrilateral") @ (a**2 * b + 3 * a * b**2)
    known = (
        s**2 * t + 3 * s * t**2,
        2 * s * t + 3 * t**2,
        s**2 + 6 * s * t,
        2 * t,
        2 * s + 6 * t,
        6 * s,
    )
    assert found == pytest.approx(np.array(known), abs=1e-13)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize(
    "kind", ["interval", "triangle", "quadrilateral", "tetrahedron", "hexahedron"]
)
def test_cells_in_the_order_of_gmsh(kind, order):
    """requirement: 1 at their own node, exactly 0 at the others; gradients of the coordinates."""
    nodes = reference_nodes(kind, order)
    values = shape_functions(kind, order, nodes)
    assert values == pytest.approx(np.eye(len(nodes)), abs=1e-13)
    assert np.all(values[~np.eye(len(nodes), dtype=bool)] == 0.0)
    places = np.full((1, nodes.shape[1]), 0.3)
    assert (slopes(kind, order, places) @ nodes)[0] == pytest.approx(
        np.eye(len(places[0])), abs=1e-12
    )


@pytest.mark.parametrize(
    ("kind", "pairs", "edges"),
    [("interval", 3, None), ("quadrilateral", 24, 4), ("triangle", 12, 3)],
)
def test_nodes_of_facets(kind, pairs, edges):
    """requirement: corners, neighbours one step apart along the parameters, nodes along edges."""
    nodes = lattice(3, kind).reshape(len(lattice(3, kind)), -1)
    first, second = nodes[neighbour_nodes(3, kind).T]
    assert len(first) == pairs
    assert (second - first).max(axis=1) == pytest.approx(np.full(pairs, 1 / 3))
    assert (second - first).sum(axis=1) == pytest.approx(np.full(pairs, 1 / 3))
    corners = lattice(1, kind).reshape(-1, nodes.shape[1])
    assert np.array_equal(nodes[corner_nodes(3, kind)], corners)
    if edges:
        along = nodes[edge_nodes(3, kind)]
        assert along.shape == (edges, 4, 2)
        assert np.diff(along, 2, axis=1) == pytest.approx(np.zeros((edges, 2, 2)), abs=1e-15)
        assert np.linalg.norm(along[:, 3] - along[:, 0], axis=1).min() >= 1.0


def test_no_points():
    """requirement: a rank without facets tabulates nothing."""
    for kind, dim, count in (("interval", 1, 3), ("quadrilateral", 2, 6), ("hexahedron", 3, 10)):
        element = equispaced(kind, 2)
        assert tabulated(element, np.empty((0, dim)), 2).shape == (count, 0, element.dim)
        assert tabulated(element, np.full((1, dim), 0.5), 2).shape == (count, 1, element.dim)
    assert on_lattice(2, np.empty(0)).shape == (1, 0, 3)
    assert on_lattice(2, np.empty((0, 2)), 0, "quadrilateral").shape == (1, 0, 9)
