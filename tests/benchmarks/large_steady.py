"""Steady state of large hot bodies in space by multigrid: time by phase, iterations, memory.

    python3 -m tests.benchmarks.large_steady [--model blocks | brake] [--sizes 60 150 400 1000 4000]
        [--solver auto] [--conductance 2e4 | perfect] [--cells tetrahedron]

``blocks``: a block of friction material slides on a metal block: quadratic tetrahedra whose faces
do not match unless ``--matching`` is given. ``brake``: a pad with back plate on half of a turning
disk with hat, which carries the heat along (starter ``disk-brake-3d``); ``--peclet`` is ``v L/κ``
with the length L of the pad. Sizes are thousands of displacement unknowns.
"""

from __future__ import annotations

import argparse

from mpi4py import MPI

import numpy as np

import thermowear as tw
from thermowear.model import StaticAnalysis
from thermowear.results import Result
from thermowear.simulation.analyses.positioning import prepare
from thermowear.simulation.analyses.run import needs_single_solution, solve
from thermowear.simulation.from_case import model_of

from ..simulation.hot_solids import BlockMeshes, hot_blocks
from ..simulation.turning_disk import turning_case
from .sizes import Console, run_sizes

BRAKE_UNKNOWNS = {8: 32, 16: 64, 24: 149, 32: 260, 48: 628, 64: 1171, 80: 2058, 104: 4000}
"""Thousands of displacement unknowns of pad and half a disk by ``mesh.elements``."""


def divisions(thousands: float, matching: bool) -> tuple:
    """Numbers of boxes along each direction of both blocks, for a number of unknowns."""
    # 4 x 3 x 2 and 4 x 3 x 3 boxes of equal size times the cube of a factor: 8 nodes a box
    factor = (thousands * 1e3 / 3 / 8 / (4 * 3 * 5)) ** (1 / 3)
    counts = [[max(round(n * factor), 1) for n in sides] for sides in ((4, 3, 2), (4, 3, 3))]
    if not matching:
        counts[1][0] += 1
        counts[1][1] -= 1
    return tuple(map(tuple, counts))


def blocks(thousands: float, options: argparse.Namespace):
    """Model of two blocks."""
    conductance = None if options.conductance == "perfect" else float(options.conductance)
    meshes = BlockMeshes(divisions(thousands, options.matching), cell_type=options.cells)
    return hot_blocks(meshes, options.solver, conductance)


def brake(thousands: float, options: argparse.Namespace):
    """Model of a pad on half of a disk."""
    conductance = None if options.conductance == "perfect" else f"{options.conductance} W/(m^2 K)"
    changes = {"mesh.solver": options.solver, "heat.conductance": conductance}
    elements = elements_along_pad(thousands)
    return model_of(tw.load(turning_case(options.peclet, elements, **changes)))


def elements_along_pad(thousands: float) -> int:
    """Number of elements along the pad for a number of unknowns."""
    sizes = np.log(list(BRAKE_UNKNOWNS.values())), np.log(list(BRAKE_UNKNOWNS))
    return round(float(np.exp(np.interp(np.log(thousands), *sizes))))


def solved(thousands: float, options: argparse.Namespace, console: Console) -> tuple[Result, dict]:
    """Steady state of one size."""
    model = {"blocks": blocks, "brake": brake}[options.model](thousands, options)
    analysis = StaticAnalysis("steady")
    single = needs_single_solution(model, analysis)
    system = prepare(model, MPI.COMM_WORLD, console.phases, single=single)
    return solve(system, analysis, console)[1], {}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--model", choices=("blocks", "brake"), default="blocks")
    parser.add_argument("--peclet", type=float, default=1e4)
    parser.add_argument("--cells", default="tetrahedron")
    parser.add_argument("--matching", action="store_true")
    run_sizes("large_steady", parser, solved, ("seconds", "memory_GB"))


if __name__ == "__main__":
    main()
