"""Running-in of hot blocks in space whose faces do not match, also on the ranks of mpirun."""

import sys
from dataclasses import replace
from pathlib import Path

from mpi4py import MPI

import numpy as np

from thermowear.contact.operators import thermal_opening
from thermowear.model import Heat, Motion, TransientAnalysis
from thermowear.simulation.analyses.run import run

from .hot_solids import COOLING, BlockMeshes, hot_blocks

MESHES = BlockMeshes(((3, 2, 1), (2, 3, 2)))
TIMES = {"quasi-steady": 3e4, "in time": 60.0}
FEW = 3
"""Steps on ranks."""
COLUMNS = ("pressure", "wear_1", "temperature_1", "temperature_2", "heat_flux_1")


def running_in(kind, conductance=2e4, observer=None, expansion_factor=None, steps=40):
    """Result of the running-in with quasi-steady temperatures, or with temperatures in time."""
    heat = Heat(cooling=COOLING, transient=kind == "in time")
    free = ("z", "rotation-x", "rotation-y")
    motion = Motion(velocity=0.02)
    model = hot_blocks(MESHES, "direct", conductance, free=free, heat=heat, motion=motion)
    bodies = tuple(
        replace(
            body,
            materials={
                part: replace(
                    m, density=7e3, specific_heat=500.0, expansion_factor=expansion_factor
                )
                for part, m in body.materials.items()
            },
        )
        for body in model.bodies
    )
    holder = replace(model.holder, point=(0.03, 0.014, 0.0))
    model = replace(model, bodies=bodies, holders=(holder,))
    analysis = TransientAnalysis(
        end_time=TIMES[kind], tolerance=1e-2, max_steps=steps, largest_kept=np.inf
    )
    return run(model, analysis, observer=observer)


def columns(result):
    """Columns of the interface at the end."""
    return {name: getattr(result.interface, name) for name in COLUMNS}


if __name__ == "__main__":
    kind, given, folder = sys.argv[1:]
    if kind == "quasi-steady":  # in time each step size would cost a condensation
        thermal_opening._STORED = 0.0
    found = running_in(kind, None if given == "perfect" else float(given), steps=FEW)
    np.savez(Path(folder) / f"found_{MPI.COMM_WORLD.rank}.npz", **columns(found))
