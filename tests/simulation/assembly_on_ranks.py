"""Brake with unequal pads and a floating disk, also on the ranks of mpirun."""

import sys
from pathlib import Path

from mpi4py import MPI

import numpy as np

from thermowear.verification.cases.assembly.pad_disk_pad import ANALYSES, Brake

COLUMNS = ("pressure", "wear_1", "temperature_1", "temperature_2", "heat_flux_1", "gap")


def computed(transient):
    """Columns of the interface after a few steps of running-in."""
    brake = Brake("floating", 9.0, heated=True, transient=transient, elements=4)
    analysis = ANALYSES["after running-in"] | {"end_time": "100 s", "tolerance": 1e-2}
    result = brake.run("after running-in", analysis=analysis)
    return {name: getattr(result.interface, name) for name in COLUMNS}


if __name__ == "__main__":
    kind, folder = sys.argv[1:]
    np.savez(Path(folder) / f"found_{MPI.COMM_WORLD.rank}.npz", **computed(kind == "in time"))
