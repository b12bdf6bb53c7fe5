"""Counts the files and functions of the program that one step visits, and a whole run.

A reader who follows the code walks through as many. Counted are the calls between two accepted
steps of wear, in the median of the steps after the first few, and from the case to the results
folder:

    scripts/env python3 tests/benchmarks/step_walk.py [--files]

`--files` lists them.
"""

import argparse
import sys
import tempfile
from pathlib import Path
from statistics import median_low

import thermowear as tw
from thermowear.results import HistoryRow
from thermowear.simulation import Observer

ROOT = Path(tw.__file__).parent
DEMOS = ROOT.parent / "demos"
COARSE = ("mesh.degree=3", "mesh.elements=6")
IN_TIME = (*COARSE, "analysis.type=transient", "analysis.end_time=2000 s")
CASES = {
    "cold": ("annular_punch_running_in.toml", COARSE),
    "hot": ("annular_punch.toml", IN_TIME),
    "temperatures in time": (
        "annular_punch.toml",
        (
            *IN_TIME,
            "heat.transient=true",
            "bodies.punch.density=7800 kg/m^3",
            "bodies.punch.specific_heat=460 J/(kg K)",
        ),
    ),
}
SKIPPED = 8
"""Steps at the start, which fill caches."""


class Walk:
    """Profiler that collects the functions of the program that are called."""

    def __init__(self):
        self.visited = set()

    def __call__(self, frame, event, argument):
        if event == "call":
            code = frame.f_code
            if code.co_filename.startswith(str(ROOT)) and not code.co_name.startswith("<"):
                name = Path(code.co_filename).relative_to(ROOT).as_posix()
                self.visited.add((name, code.co_qualname))

    @property
    def files(self):
        return sorted({file for file, _ in self.visited})


class Steps(Observer):
    """Observer that notes the walk of each accepted step."""

    def __init__(self, walk):
        self.walk, self.found = walk, []

    def row(self, row, distance):
        if isinstance(row, HistoryRow):
            self.found.append(set(self.walk.visited))
            self.walk.visited.clear()


def profiled(action):
    walk = Walk()
    sys.setprofile(walk)
    try:
        action(walk)
    finally:
        sys.setprofile(None)
    return walk


def of_a_step(demo, overrides):
    """Files and functions of a typical step."""
    case, steps = tw.load(DEMOS / demo, overrides), []

    def run(walk):
        observer = Steps(walk)
        steps.append(observer)
        tw.run(case, observer=observer)

    profiled(run)
    later = steps[0].found[SKIPPED:-1]
    middle = median_low(len({file for file, _ in visited}) for visited in later)
    return next(v for v in later if len({file for file, _ in v}) == middle)


def of_a_run(demo, overrides):
    """Files and functions from the case to the results folder."""
    from thermowear.app.cli import main

    with tempfile.TemporaryDirectory() as folder:
        words = ["run", str(DEMOS / demo), "-o", f"{folder}/run", "--no-pictures"]
        words += [word for text in overrides for word in ("--set", text)]
        return profiled(lambda walk: main(words)).visited


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--files", action="store_true", help="list the files")
    chosen = parser.parse_args()
    for name, (demo, overrides) in CASES.items():
        tell(f"a step, {name}", of_a_step(demo, overrides), chosen.files)
    demo, overrides = CASES["cold"]
    tell("a run, cold", of_a_run(demo, overrides), chosen.files)


def tell(what, visited, lists):
    files = sorted({file for file, _ in visited})
    print(f"{what:28} {len(files):3} files {len(visited):4} functions")
    if lists:
        for file in files:
            names = sorted(name for path, name in visited if path == file)
            print(f"    {file:50} {', '.join(names)}")


if __name__ == "__main__":
    main()
