"""Harmonic extension of displacements into meshes, and into lines and surfaces in space."""

import os
import shutil
import subprocess
import sys
from dataclasses import replace

from mpi4py import MPI

import numpy as np
import pytest

from tests.conftest import two_blocks
from tests.contact.solids import MATCHING, bent, skewed, turned, two_solids
from thermowear.bulk.bodies import distribute
from thermowear.bulk.mesh_motion import extended, serial_extension
from thermowear.geometry.mesh.nodes import boundary

from ..test_parallel import ROOT


def inside(mesh):
    """Mask of the nodes inside the bodies."""
    result = np.ones(len(mesh.points), dtype=bool)
    result[boundary(mesh.cell_type, mesh.order, mesh.cells)] = False
    return result


@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_harmonic_polynomials_of_the_plane(order, triangles):
    """requirement: exact where the space contains the solution."""
    mesh = two_blocks(order=order, triangles=triangles)
    z = 10 * (mesh.points @ (1.0, 1j))
    known = np.column_stack([(z**order).real, (z**order).imag])
    given = np.where(inside(mesh)[:, None], np.nan, known)  # as values inside are ignored
    assert np.isnan(given).any()
    found = extended(distribute(mesh, MPI.COMM_SELF), given)
    assert found == pytest.approx(known, abs=1e-12)
    assert np.array_equal(found[~inside(mesh)], given[~inside(mesh)])


@pytest.mark.parametrize(("order", "place"), [(1, turned), (2, skewed), (3, skewed)])
def test_harmonic_polynomials_in_space(order, place):
    """requirement: likewise, also for bodies with a single node inside."""
    divisions = ((2, 2, 2), (2, 2, 2)) if order == 1 else MATCHING
    mesh = two_solids(divisions, order, (place, place))
    x, y, z = 10 * mesh.points.T
    known = np.column_stack([x - 2 * y + z, x**2 + y**2 - 2 * z**2, x * y * z])[:, :order]
    known = np.column_stack([known, x + 1])
    found = extended(distribute(mesh, MPI.COMM_SELF), np.where(inside(mesh)[:, None], 0.0, known))
    assert found == pytest.approx(known, abs=1e-12)


def test_bodies_follow_their_own_boundary():
    """requirement: a body whose boundary stays keeps its nodes bit by bit."""
    mesh = two_solids(order=2, maps=(bent, bent))
    upper = np.unique(mesh.cells[mesh.cell_tags == 1])
    given = np.zeros_like(mesh.points)
    given[upper] = np.sin(100 * mesh.points[upper])
    found = extended(distribute(mesh, MPI.COMM_SELF), given)
    assert np.all(np.delete(found, upper, axis=0) == 0.0)
    moved = inside(mesh) & np.isin(np.arange(len(found)), upper)
    low, high = given[upper].min(axis=0), given[upper].max(axis=0)
    assert np.all((found[moved] > low) & (found[moved] < high))


def test_three_lines_that_meet():
    """requirement: linear along each; the gradients at the joint balance."""
    mesh = two_solids()
    ends = np.array([(3.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 4.0)])
    points = np.concatenate([[(0.0, 0.0, 0.0)], ends, ends / 4])
    lines = np.array([(0, 4), (4, 1), (0, 5), (5, 2), (0, 6), (6, 3)])
    known = np.isin(np.arange(7), (1, 2, 3))
    given = np.zeros((7, 3))
    given[1:4] = np.random.default_rng(0).normal(size=(3, 3))
    found = serial_extension(replace(mesh, points=points), "interval", lines, known)(given)
    lengths = ends.sum(axis=1)
    joint = (given[1:4] / lengths[:, None]).sum(axis=0) / (1 / lengths).sum()
    assert found[0] == pytest.approx(joint, abs=1e-14)
    assert found[4:] == pytest.approx(0.75 * joint + 0.25 * given[1:4], abs=1e-14)


@pytest.mark.parametrize("order", [1, 2])
def test_a_surface_in_space(order):
    """requirement: the gradient within the surface counts; points off it keep what is given."""
    mesh = two_solids(order=order, maps=(skewed, skewed))
    side = mesh.facets[mesh.facet_tags == mesh.surfaces.index("upper_low_x") + 1]
    known = mesh.points @ np.array([(1.0, 2.0, 0.5), (-1.0, 0.0, 3.0), (0.3, 0.2, 1.0)])
    rim = boundary("quadrilateral", order, side)
    free = np.setdiff1d(side, rim)
    assert len(free)
    given = known.copy()
    given[free] = 0.0
    found = serial_extension(mesh, "quadrilateral", side)(given)
    assert found == pytest.approx(known, abs=1e-14)


SCRIPT = """
from mpi4py import MPI
import numpy as np
from tests.contact.solids import bent, two_solids
from thermowear.bulk.bodies import distribute
from thermowear.bulk.mesh_motion import extended
mesh = two_solids(order=2, maps=(bent, bent))
given = np.sin(80 * mesh.points)
comms = MPI.COMM_SELF, MPI.COMM_WORLD
serial, parallel = (extended(distribute(mesh, comm), given) for comm in comms)
assert np.abs(serial - given).max() > 1e-3
off = MPI.COMM_WORLD.gather(np.abs(parallel - serial).max())
if MPI.COMM_WORLD.rank == 0:
    print(len(off), max(off) < 1e-12)
"""


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
def test_on_three_ranks_as_on_one():
    """requirement: the same displacement on every rank."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PMIX", "PRTE_"))}
    done = subprocess.run(
        ["mpirun", "--oversubscribe", "-n", "3", sys.executable, "-c", SCRIPT],
        capture_output=True,
        text=True,
        check=False,
        env=environment | ROOT,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "3 True\n"
