"""Steady state by multigrid on the ranks of mpirun: columns of the interface, saved by rank."""

import sys
from dataclasses import fields, replace
from pathlib import Path

from mpi4py import MPI

import numpy as np

from thermowear.model import StaticAnalysis
from thermowear.simulation.analyses.run import run

from .hot_solids import BlockMeshes, hot_blocks


def computed(conductance, solver="multigrid"):
    """Columns of the interface under a tilted load."""
    model = hot_blocks(BlockMeshes(((4, 3, 2), (3, 4, 3))), solver, conductance)
    free = ("z", "rotation-x", "rotation-y")
    holder = replace(model.holder, free=free, point=(0.022, 0.014, 0.0))
    result = run(replace(model, holders=(holder,)), StaticAnalysis("steady"))
    assert result.stopped is None, result.stopped
    interface = result.interface
    return {f.name: getattr(interface, f.name) for f in fields(interface)}


if __name__ == "__main__":
    given, folder = sys.argv[1:]
    columns = computed(None if given == "perfect" else float(given))
    np.savez(Path(folder) / f"found_{MPI.COMM_WORLD.rank}.npz", **columns)
