"""The starter of parts from CAD with large elements, also on the ranks of mpirun."""

import sys
from pathlib import Path

from mpi4py import MPI

import numpy as np

import thermowear as tw

COARSE = ("mesh.size=18 mm", "mesh.contact_size=9 mm", "mesh.grading=1.0")
COLUMNS = ("pressure", "shape", "temperature_1", "temperature_2")


def columns(result):
    """Columns of the interface."""
    return {name: getattr(result.interface, name) for name in COLUMNS}


if __name__ == "__main__":
    case, folder = sys.argv[1:]
    found = columns(tw.run(tw.load(case, overrides=COARSE)))
    np.savez(Path(folder) / f"found_{MPI.COMM_WORLD.rank}.npz", **found)
