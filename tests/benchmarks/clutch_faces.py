"""Cost of a clutch pack by its number of friction faces.

    scripts/env python3 -m tests.benchmarks.clutch_faces [--faces N…] [--elements N] [--profile]

A pack of twice the faces has twice the bodies, contacts and unknowns; prints the CPU time of each
analysis, and its ratio to that of the pack before, relative to the ratio of the faces.
"""

from __future__ import annotations

import argparse
import cProfile
import pstats
import time
from typing import Any

from thermowear.case import load
from thermowear.verification.cases.assembly.clutch_pack import Pack
from thermowear.verification.check import computed

ANALYSES: dict[str, dict[str, Any]] = {
    "unworn": {"type": "initial"},
    "steady": {"type": "steady"},
    "running-in": {"type": "transient", "end_time": "1e4 s", "tolerance": 1e-2},
    "in time": {"type": "transient", "end_time": "10 s", "tolerance": 1e-2},
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--faces", type=int, nargs="+", default=[2, 4, 8, 16])
    parser.add_argument("--elements", type=int, default=16)
    parser.add_argument("--analyses", nargs="+", choices=ANALYSES, default=list(ANALYSES))
    parser.add_argument("--profile", action="store_true", help="of the last run")
    given = parser.parse_args()
    seconds(Pack(2, elements=4), "running-in")  # compiles the forms
    for analysis in given.analyses:
        before: tuple[int, float] | None = None
        for faces in given.faces:
            pack = Pack(faces, elements=given.elements)
            used, result = seconds(pack, analysis)
            line = f"{analysis:>10}: {faces:3} faces {used:8.2f} s CPU, "
            line += f"{result.summary['contact_points']} points, {result.summary['steps']} steps"
            if before is not None:
                line += f"; {used / before[1] / (faces / before[0]):.2f} of linear"
            print(line, flush=True)
            before = faces, used
        if given.profile:
            profiled(pack, analysis)


def tables(pack: Pack, analysis: str) -> dict[str, Any]:
    """Tables of a pack with an analysis of `ANALYSES`."""
    found = pack.tables() | {"analysis": ANALYSES[analysis]}
    found["wear"] = {"update": "never"} | found["wear"]
    if analysis == "in time":
        found["heat"] = found["heat"] | {"transient": True}
    return found


def seconds(pack: Pack, analysis: str):
    """CPU time of a run and its result."""
    case, start = load(tables(pack, analysis)), time.process_time()
    result = computed(case)
    return time.process_time() - start, result


def profiled(pack: Pack, analysis: str) -> None:
    """Print the functions that take most of the time of a run."""
    with cProfile.Profile() as profile:
        seconds(pack, analysis)
    pstats.Stats(profile).sort_stats("cumulative").print_stats(45)


if __name__ == "__main__":
    main()
