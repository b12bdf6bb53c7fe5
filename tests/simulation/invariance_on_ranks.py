"""Random cases on ranks of mpirun: columns of their contacts, by rank; see `test_invariance`."""

import sys
from pathlib import Path

from mpi4py import MPI

import numpy as np

from .invariance import columns, faces_exchanged, run
from .random_pads import ONCE


def computed(first: int, count: int, folder: Path, exchanged: bool) -> dict[str, np.ndarray]:
    """Columns by seed, contact and name, and those of the same cases with exchanged faces.

    Without gaps, which are rounding where they are closed, and places, which are on body 1.
    """
    result = {}
    for seed in range(first, first + count):
        # faces that fret may stick: their wear is rounding
        scene, other = faces_exchanged(seed, (*ONCE, "reciprocating"))
        found = run(other.scene if exchanged else scene, folder / str(seed))
        for contact, of in columns(found, other if exchanged else None).items():
            kept = of.keys() - {"gap", "places"}
            result |= {f"{seed} {contact} {name}": of[name] for name in kept}
    return result


if __name__ == "__main__":
    rank = MPI.COMM_WORLD.rank
    *numbers, place = sys.argv[1:]
    found = computed(*map(int, numbers), Path(place) / f"rank_{rank}", exchanged=True)
    np.savez(Path(place) / f"found_{rank}.npz", **found)
