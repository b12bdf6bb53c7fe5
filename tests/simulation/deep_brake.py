"""Brake of `pad_disk_pad` with a disk as wide as its pads, all deeply worn; also for mpirun."""

import sys
from pathlib import Path

from mpi4py import MPI

import numpy as np

from thermowear.case import load
from thermowear.verification.cases.assembly.pad_disk_pad import Brake
from thermowear.verification.check import computed

COLUMNS = ("pressure", "wear_1", "wear_2", "x", "y", "temperature_1", "temperature_2")
PAD, DISK = 3e-10, 1e-10
"""Coefficients of wear per friction stress [1/Pa]."""
DURATION = 20e3
"""[s]"""


def tables(disk, right=15.0, transient=False, update="auto", wearing=("left", "right", "disk")):
    """Tables of a running-in, with geometry updates; parameters as those of `Brake`."""
    brake = Brake(disk, right, heated=transient, transient=transient, elements=4)
    found = brake.tables("after running-in")
    found["analysis"]["end_time"] = f"{DURATION} s"
    layers = found["geometry"]["layers"]
    layers["disk"]["x"] = layers["left"]["x"]
    known = [name for name in wearing if name in found["bodies"]]
    laws = {
        name: {"coefficient": f"{DISK if name == 'disk' else PAD} 1/Pa", "per": "friction-stress"}
        for name in known
    }
    return found | {"wear": {"update": update} | laws}


def worn(*args, **options):
    """Result of a running-in; parameters as those of `tables`."""
    return computed(load(tables(*args, **options)))


def short(transient):
    """Tables of a short running-in of unequal pads and a floating disk."""
    found = tables("floating", 9.0, transient, update=0.01)
    return found | {"analysis": {"type": "transient", "end_time": "4000 s", "tolerance": 1e-2}}


def columns(transient):
    """Columns of the interfaces at the end of the short running-in."""
    result = computed(load(short(transient)))
    assert result.summary["geometry_updates"] >= 2
    return {name: getattr(result.interface, name) for name in COLUMNS}


if __name__ == "__main__":
    kind, folder = sys.argv[1:]
    np.savez(Path(folder) / f"found_{MPI.COMM_WORLD.rank}.npz", **columns(kind == "in time"))
