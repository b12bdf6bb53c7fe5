"""Brake with unequal pads and a floating disk, also on the ranks of mpirun."""

import sys
from pathlib import Path

from mpi4py import MPI

import numpy as np

from thermowear.verification.cases.assembly.pad_disk_pad import ANALYSES, Brake

COLUMNS = ("pressure", "wear_1", "temperature_1", "temperature_2", "heat_flux_1", "gap")
_LAYERS = {"thickness": ["1 nm", "2 nm"], "coefficient": ["4e-8 1/MPa", "2e-7 1/MPa"]}
"""Worn through in part within the time of the run."""
_RING = {"coefficient": "1e-6 1/MPa", "where": "105 mm < r < 0.13 m"}
ON_A_FACE = {"coated": {"layers": _LAYERS}, "by region": {"materials": {"ring": _RING}}}
"""Keys of the wear of the pads."""
KINDS = ("quasi-steady", "in time", *ON_A_FACE)


def computed(kind):
    """Columns of the interface after a few steps of running-in."""
    brake = Brake("floating", 9.0, heated=True, transient=kind == "in time", elements=4)
    analysis = ANALYSES["after running-in"] | {"end_time": "100 s", "tolerance": 1e-2}
    wear = brake.tables("after running-in")["wear"]
    pads = {pad: wear[pad] | ON_A_FACE.get(kind, {}) for pad in ("left", "right")}
    result = brake.run("after running-in", analysis=analysis, wear=wear | pads)
    return {name: getattr(result.interface, name) for name in COLUMNS}


if __name__ == "__main__":
    kind, folder = sys.argv[1:]
    np.savez(Path(folder) / f"found_{MPI.COMM_WORLD.rank}.npz", **computed(kind))
