"""Twenty variants of a hot block on a turning disk against the first run.

    scripts/env python3 tests/benchmarks/variants.py

The disk carries its heat along (Péclet number 1000). Loads, frictions and wear laws change nothing
that is factorised or condensed. Results are computed and written, fields in the bodies are not.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np

import thermowear as tw
from thermowear.case import as_plain
from thermowear.output.folder import ResultsFolder
from thermowear.simulation.analyses.run import Series
from thermowear.simulation.from_case import analysis_of, model_of
from thermowear.timer import Phases

CASE = "demos/block_on_disk_turning.toml"
FORCES = ("1 kN", "2 kN", "3 kN", "4 kN", "5 kN")
FRICTIONS = (0.1, 0.3)
LAWS = ('{coefficient="1e-7 1/MPa"}', '{coefficient="1e-7 1/MPa^2", pressure_exponent=2.0}')


def variants(degree: int) -> list:
    return [
        tw.load(
            CASE,
            (
                f"mesh.degree={degree}",
                f'load.force="{force}"',
                f"contact.friction={friction}",
                f"wear.block={law}",
            ),
        )
        for law in LAWS
        for friction in FRICTIONS
        for force in FORCES
    ]


def seconds_of_each(cases: list) -> np.ndarray:
    """Wall time of each: preparing, computing, writing."""
    series, seconds = Series(), []
    with tempfile.TemporaryDirectory() as place:
        for number, case in enumerate(cases):
            began, phases = time.perf_counter(), Phases()
            folder = ResultsFolder(Path(place) / str(number), as_plain(case), 1, False)
            folder.finish(
                series.run(model_of(case), analysis_of(case), phases=phases), phases.seconds
            )
            folder.close("done")
            seconds.append(time.perf_counter() - began)
    return np.array(seconds)


def main() -> None:
    print("degree   first run   others, median and worst   worst part of the first")
    for degree in (5, 8):
        first, *others = seconds_of_each(variants(degree))
        print(
            f"{degree:6}   {first:7.2f} s   {np.median(others):8.4f} s {max(others):8.4f} s"
            f"   {100 * max(others) / first:14.1f} %"
        )


if __name__ == "__main__":
    main()
