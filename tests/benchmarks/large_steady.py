"""Steady state of large hot bodies in space by multigrid: time by phase, iterations, memory.

    python3 -m tests.benchmarks.large_steady [--model blocks | brake] [--sizes 60 150 400 1000 4000]
        [--solver auto] [--conductance 2e4 | perfect] [--cells tetrahedron]

``blocks``: a block of friction material slides on a metal block: quadratic tetrahedra whose faces
do not match unless ``--matching`` is given. ``brake``: a pad with back plate on half of a turning
disk with hat, which carries the heat along (starter ``disk-brake-3d``); ``--peclet`` is ``v L/κ``
with the length L of the pad. Each size (thousands of displacement unknowns) runs in a process of
its own, so that the largest memory is that of the size.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import subprocess
import sys
import time

import numpy as np

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
    from ..simulation.hot_solids import BlockMeshes, hot_blocks

    conductance = None if options.conductance == "perfect" else float(options.conductance)
    meshes = BlockMeshes(divisions(thousands, options.matching), cell_type=options.cells)
    return hot_blocks(meshes, options.solver, conductance)


def brake(thousands: float, options: argparse.Namespace):
    """Model of a pad on half of a disk."""
    import thermowear as tw
    from thermowear.simulation.from_case.model import model_of

    from ..simulation.turning_disk import turning_case

    conductance = None if options.conductance == "perfect" else f"{options.conductance} W/(m^2 K)"
    changes = {"mesh.solver": options.solver, "heat.conductance": conductance}
    elements = elements_along_pad(thousands)
    return model_of(tw.load(turning_case(options.peclet, elements, **changes)))


def elements_along_pad(thousands: float) -> int:
    """Number of elements along the pad for a number of unknowns."""
    sizes = np.log(list(BRAKE_UNKNOWNS.values())), np.log(list(BRAKE_UNKNOWNS))
    return round(float(np.exp(np.interp(np.log(thousands), *sizes))))


def measured(thousands: float, options: argparse.Namespace) -> dict:
    """Run one size in this process."""
    from thermowear.model import StaticAnalysis
    from thermowear.simulation.analyses.positioning import prepare
    from thermowear.simulation.analyses.run import needs_single_solution, solve
    from thermowear.simulation.runtime.observer import Observer
    from thermowear.timer import Phases

    class Console(Observer):
        def note(self, text):
            print("note:", text, file=sys.stderr)

        def phase(self, name):
            print(f"{largest():6.2f} GB  {name}", file=sys.stderr)

    model = {"blocks": blocks, "brake": brake}[options.model](thousands, options)
    analysis, observer, since = StaticAnalysis("steady"), Console(), time.perf_counter()
    phases = Phases(observer.phase)
    from mpi4py import MPI

    single = needs_single_solution(model, analysis)
    system = prepare(model, MPI.COMM_WORLD, phases, single=single)
    _, result = solve(system, analysis, observer)
    summary = result.summary
    names = (
        "dofs_displacement",
        "dofs_temperature",
        "contact_points",
        "max_temperature_K",
        "shape_range_m",
        "max_cell_peclet_number",
        "heat_balance_relative_error",
        "equilibrium_relative_error",
        "solver",
        "multigrid_iterations_elasticity",
        "multigrid_iterations_conduction",
    )
    found = {name: summary.get(name) for name in names}
    found |= {"seconds": time.perf_counter() - since, "memory_GB": largest()}
    return found | {"phases": {name: round(s, 2) for name, s in phases.seconds.items()}}


def largest() -> float:
    """Largest memory of this process so far [GB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9


def main() -> None:
    """Run all sizes and print a table with growth exponents."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--model", choices=("blocks", "brake"), default="blocks")
    parser.add_argument("--peclet", type=float, default=1e4)
    parser.add_argument("--sizes", type=float, nargs="+", default=[60, 150, 400, 1000])
    parser.add_argument("--solver", default="auto")
    parser.add_argument("--conductance", default="2e4")
    parser.add_argument("--cells", default="tetrahedron")
    parser.add_argument("--matching", action="store_true")
    parser.add_argument("--alone", action="store_true", help="run the first size in this process")
    options = parser.parse_args()
    if options.alone:
        print(json.dumps(measured(options.sizes[0], options), default=float))
        return
    before = None
    for size in options.sizes:
        chosen = [*sys.argv[1:], "--sizes", str(size), "--alone"]
        command = [sys.executable, "-m", "tests.benchmarks.large_steady", *chosen]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        found = json.loads(done.stdout.splitlines()[-1])
        print(json.dumps(found, indent=1))
        if before is not None:
            grown = found["dofs_displacement"] / before["dofs_displacement"]
            for name in ("seconds", "memory_GB"):
                exponent = math.log(found[name] / before[name]) / math.log(grown)
                print(f"growth exponent of {name}: {exponent:.2f}")
        before = found


if __name__ == "__main__":
    main()
