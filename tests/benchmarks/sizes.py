"""Frame of benchmarks with growing sizes: table, growth exponents, largest memory.

Each size (thousands of displacement unknowns) runs in a process of its own, so that the largest
memory is that of the size.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import subprocess
import sys
import time
from collections.abc import Callable

from thermowear.results import Result
from thermowear.simulation.runtime.observer import Observer
from thermowear.timer import Phases

NAMES = (
    "dofs_displacement",
    "dofs_temperature",
    "contact_points",
    "steps",
    "max_pressure_Pa",
    "max_temperature_K",
    "shape_range_m",
    "wear_volume_1_m3",
    "max_cell_peclet_number",
    "heat_balance_relative_error",
    "equilibrium_relative_error",
    "solver",
    "multigrid_iterations_elasticity",
    "multigrid_iterations_conduction",
)
"""Numbers of the summary to print."""


class Console(Observer):
    """Print notes and phases with times and the largest memory so far."""

    def __init__(self):
        self.since = time.perf_counter()
        self.phases = Phases(self.phase)

    def note(self, text):
        print(self, "note:", text, file=sys.stderr)

    def phase(self, name):
        print(self, name, file=sys.stderr, flush=True)

    def __str__(self):
        spent = f"{self.costs['seconds']:7.1f} s (cpu {self.costs['processor_seconds']:6.1f} s)"
        return f"{spent} {self.costs['memory_GB']:6.2f} GB "

    @property
    def costs(self) -> dict[str, float]:
        """Times since the start and largest memory of this process."""
        return {
            "seconds": time.perf_counter() - self.since,
            "processor_seconds": time.process_time(),
            "memory_GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9,
        }


Solved = Callable[[float, argparse.Namespace, Console], tuple[Result, dict]]


def run_sizes(module: str, parser: argparse.ArgumentParser, solved: Solved, growing) -> None:
    """Run all sizes and print numbers of each, and growth exponents of costs.

    Parameters
    ----------
    module : str
        Name of the benchmark, started again for each size.
    parser : ArgumentParser
        Its options; those of the sizes and of the solver are added.
    solved : callable
        Result and further numbers by size, options and observer.
    growing : sequence of str
        Names of the costs.
    """
    parser.add_argument("--sizes", type=float, nargs="+", default=[60, 150, 400, 1000])
    parser.add_argument("--solver", default="auto")
    parser.add_argument("--conductance", default="2e4")
    parser.add_argument("--alone", action="store_true", help="run the first size in this process")
    options = parser.parse_args()
    if options.alone:
        print(json.dumps(_measured(solved, options), default=float))
        return
    before = None
    for size in options.sizes:
        chosen = [*sys.argv[1:], "--sizes", str(size), "--alone"]
        command = [sys.executable, "-m", f"tests.benchmarks.{module}", *chosen]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        found = json.loads(done.stdout.splitlines()[-1])
        print(json.dumps(found, indent=1))
        if before is not None:
            grown = math.log(found["dofs_displacement"] / before["dofs_displacement"])
            for name in growing:
                exponent = math.log(found[name] / before[name]) / grown
                print(f"growth exponent of {name}: {exponent:.2f}")
        before = found


def _measured(solved: Solved, options: argparse.Namespace) -> dict:
    """Numbers and costs of the first size, run in this process."""
    console = Console()
    result, more = solved(options.sizes[0], options, console)
    found = {name: result.summary[name] for name in NAMES if name in result.summary}
    phases = {name: round(s, 2) for name, s in console.phases.seconds.items()}
    return found | more | console.costs | {"phases": phases}
