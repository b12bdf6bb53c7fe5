"""Critical speeds of hot spots of a coarse disk brake, also on the ranks of mpirun."""

import sys
from pathlib import Path

from mpi4py import MPI

import numpy as np

from thermowear.case import load
from thermowear.verification.check import computed

from ..case.starter import tables

_CHANGES = {"mesh.degree": 3, "mesh.elements": 4, "analysis.hot_spots": [0, 4, 5]}


def computed_modes():
    """Columns of the tables of critical speeds and growth."""
    spots = computed(load(tables("disk-brake-stability", _CHANGES))).hot_spots
    rows, growth = spots.rows, spots.growth
    return {
        "speed_factor": np.array([row.speed_factor for row in rows]),
        "frequency": np.array([row.frequency for row in rows]),
        "with_wear": np.array([row.speed_factor_with_wear for row in rows]),
        "growth_rate": np.array([row.growth_rate for row in growth]),
    }


if __name__ == "__main__":
    np.savez(Path(sys.argv[1]) / f"found_{MPI.COMM_WORLD.rank}.npz", **computed_modes())
