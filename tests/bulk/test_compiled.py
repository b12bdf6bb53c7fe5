"""Compilation of forms beside other processes, and after one that was killed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
from mpi4py import MPI
import numpy as np
import ufl
from dolfinx import fem, mesh
from thermowear.bulk import compiled
compiled._PATIENCE = 1
square = mesh.create_unit_square(MPI.COMM_WORLD, 1, 1)
x = ufl.SpatialCoordinate(square)[0]
form = compiled.compiled(x**3 * ufl.dx(square))
total = square.comm.allreduce(fem.assemble_scalar(form))
middle = compiled.compiled_expression(x**5 + 1, np.array([[0.25, 0.25]]), square.comm)
print(f"{total:.12f}")
"""


def started(cache: Path, *launcher: str) -> subprocess.Popen:
    """Process that compiles a form and an expression into an own cache."""
    environment = os.environ | {"XDG_CACHE_HOME": str(cache)}
    return subprocess.Popen(
        [*launcher, sys.executable, "-c", PROGRAM],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    )


def results(*processes):
    """Standard outputs of processes, which must not fail."""
    found = []
    for process in processes:
        out, err = process.communicate()
        assert process.returncode == 0, err
        found.append(out)
    return found


@pytest.mark.parametrize("launcher", [(), ("mpirun", "-n", "2")], ids=["serial", "two ranks"])
def test_a_killed_compilation_is_made_up_for(tmp_path, launcher):
    """requirement: a process killed while it compiles a form blocks no later run."""
    results(started(tmp_path))
    sources = [*(tmp_path / "fenics").glob("*/libffcx_*.c")]
    assert len(sources) == 2
    assert len({source.parent for source in sources}) == 2  # not all in one folder
    for source in sources:  # as a killed process leaves it
        for made in source.parent.glob(f"{source.stem}*"):
            made.unlink()
        source.touch()
    (out,) = results(started(tmp_path, *launcher))
    ranks = 2 if launcher else 1
    assert "".join(out.split()) == ranks * "0.250000000000"  # mpirun may join the lines of ranks
    assert all(source.with_suffix(".c.cached").exists() for source in sources)


def test_processes_at_once(tmp_path):
    """requirement: processes that compile the same at once wait for each other, however long."""
    assert results(*(started(tmp_path) for _ in range(3))) == ["0.250000000000\n"] * 3


def test_a_cache_that_can_only_be_read(tmp_path):
    """requirement: forms of a cache without write permission, as of an image, are used."""
    results(started(tmp_path))
    lock = tmp_path / "fenics" / "thermowear.lock"
    lock.unlink()
    lock.mkdir()  # cannot be opened for writing, by root neither
    assert results(started(tmp_path)) == ["0.250000000000\n"]
