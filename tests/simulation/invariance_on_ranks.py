"""Random cases on ranks of mpirun: columns of their contacts, by rank; see `test_invariance`."""

import sys
from pathlib import Path

from mpi4py import MPI

import numpy as np

from .invariance import columns, run
from .random_pads import random_scene


def computed(first: int, count: int, folder: Path) -> dict[str, np.ndarray]:
    """Columns by seed, contact and name; without gaps, which are rounding where they are closed."""
    return {
        f"{seed} {contact} {name}": values
        for seed in range(first, first + count)
        for contact, of in columns(run(random_scene(seed), folder / str(seed))).items()
        for name, values in of.items()
        if name != "gap"
    }


if __name__ == "__main__":
    rank = MPI.COMM_WORLD.rank
    *numbers, place = sys.argv[1:]
    found = computed(*map(int, numbers), Path(place) / f"rank_{rank}")
    np.savez(Path(place) / f"found_{rank}.npz", **found)
