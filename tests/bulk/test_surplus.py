"""Hierarchical surplus of Lagrange elements."""

from __future__ import annotations

from types import SimpleNamespace

from mpi4py import MPI

import numpy as np
import pytest
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh

from thermowear.bulk.elasticity.enriched import surplus_spaces
from thermowear.bulk.spaces import lagrange_spaces

MESHES = {
    "quadrilateral": lambda: dmesh.create_unit_square(
        MPI.COMM_WORLD, 2, 2, dmesh.CellType.quadrilateral
    ),
    "triangle": lambda: dmesh.create_unit_square(MPI.COMM_WORLD, 2, 2),
    "tetrahedron": lambda: dmesh.create_unit_cube(MPI.COMM_WORLD, 1, 1, 1),
}


def one_body(mesh):
    return SimpleNamespace(each=(SimpleNamespace(mesh=mesh),))


@pytest.mark.parametrize("degree", [1, 2, 3])
@pytest.mark.parametrize("cell", MESHES)
def test_space_and_surplus_make_the_next_degree(cell, degree):
    """requirement: space and surplus together are the complete space of the next degree."""
    body = one_body(MESHES[cell]())
    spaces = (
        surplus_spaces(body, degree),
        lagrange_spaces(body, degree),
        lagrange_spaces(body, degree + 1),
    )
    assert spaces[0].total + spaces[1].total == spaces[2].total
    surplus, low, high = (each for space in spaces for each in space.each)
    field, same, none = fem.Function(surplus), fem.Function(high), fem.Function(low)
    field.x.array[:] = np.linspace(-1.0, 2.0, len(field.x.array))
    same.interpolate(field)
    none.interpolate(field)
    squares = [fem.assemble_scalar(fem.form(f**2 * ufl.dx)) for f in (field, same - field)]
    assert squares[1] < 1e-20 * squares[0]  # continuous: a jump would be lost in the next degree
    assert np.abs(none.x.array).max() < 1e-12 * np.abs(same.x.array).max()


def test_hexahedra_take_what_leads():
    """requirement: in 3D the surplus belongs to edges; x³ is in the sum of both spaces."""
    mesh = dmesh.create_unit_cube(MPI.COMM_WORLD, 1, 1, 1, dmesh.CellType.hexahedron)
    body = one_body(mesh)
    assert surplus_spaces(body, 2).total == 12
    surplus, low = surplus_spaces(body, 2).each[0], lagrange_spaces(body, 2).each[0]
    x = ufl.SpatialCoordinate(mesh)
    u, v, field = ufl.TrialFunction(surplus), ufl.TestFunction(surplus), fem.Function(low)
    field.interpolate(lambda p: p[0] ** 3)
    mass = fem.assemble_matrix(fem.form(u * v * ufl.dx)).to_dense()
    moments = fem.assemble_vector(fem.form((x[0] ** 3 - field) * v * ufl.dx)).array
    left = fem.Function(surplus)
    left.x.array[:] = np.linalg.solve(mass, moments)
    missed = fem.assemble_scalar(fem.form((x[0] ** 3 - field - left) ** 2 * ufl.dx))
    assert missed < 1e-20
