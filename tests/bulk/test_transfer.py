"""Carrying a field over to a mesh whose nodes have moved."""

from dataclasses import replace

from mpi4py import MPI

import numpy as np

from thermowear.bulk.bodies import distribute
from thermowear.bulk.points import transferred
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.verification.check import starter


def _carried(amount):
    """Transfer of a smooth field after an upward motion of the punch nodes, largest at its face."""
    case = starter("annular-punch", "mesh.elements=8")
    mesh = case.tagged_mesh()
    points = mesh.points.copy()
    punch = np.unique(mesh.cells[mesh.cell_tags == 1])
    points[punch, 1] += amount * (1 - mesh.points[punch, 1] / 0.05)
    old, new = (distribute(m, MPI.COMM_WORLD) for m in (mesh, replace(mesh, points=points)))
    spaces = [lagrange_spaces(bodies, 6) for bodies in (old, new)]
    before, after = (_field(*each) for each in zip(spaces, (old, new), strict=True))
    found, error = transferred(before, *spaces, old, new)
    return found, after, error


def _field(spaces, bodies):
    """Smooth field with a jump between the bodies, for they meet."""
    r, z = spaces.nodes().T
    return np.sin(40 * r) * np.exp(20 * z) + 5.0 * spaces.nodes_of(bodies, "punch")


def test_the_field_stays_where_it_is_in_space():
    """requirement: temperatures stay at their place in space and in their body."""
    for amount in (1e-3, 2e-2):
        found, expected, error = _carried(amount)
        assert np.abs(found - expected).max() < 1e-4
        assert 0.0 < error < 1e-4


def test_nodes_that_stay_keep_their_values():
    found, expected, _ = _carried(0.0)
    assert np.array_equal(found, expected)


def test_a_field_on_cells_of_another_number():
    """Body by body, as both meshes touch at z = 0 where the field jumps."""
    old, new = (
        distribute(starter("annular-punch", f"mesh.elements={n}").tagged_mesh(), MPI.COMM_WORLD)
        for n in (8, 11)
    )
    spaces = [lagrange_spaces(bodies, 6) for bodies in (old, new)]
    values, expected = _field(spaces[0], old), _field(spaces[1], new)
    found, error = transferred(values, *spaces, old, new)
    assert len(expected) != len(values)
    assert np.abs(found - expected).max() < 1e-4
    assert 0.0 < error < 1e-4
