"""Small running-ins of a ring, and data from them."""

from __future__ import annotations

import tomllib
from functools import cache

import numpy as np

import thermowear as tw

from ...conftest import COLD_RUNNING_IN

K, MU = 2e-7, 0.25
"""True wear coefficient per friction stress [1/MPa], and friction."""
TIMES = (5.0, 12.0, 20.0, 33.0, 50.0)
WEAR = {
    "key": "wear.punch.coefficient",
    "start": "1e-7 1/MPa",
    "lower": "1e-8 1/MPa",
    "upper": "1e-6 1/MPa",
    "scale": "log",
}
FRICTION = {"key": "contact.friction", "start": 0.3, "lower": 0.1, "upper": 0.5, "scale": "log"}


def tables(**calibrate):
    """Tables of a small cold running-in."""
    found = tomllib.loads(COLD_RUNNING_IN.read_text(encoding="utf-8"))
    found["mesh"] = {"degree": 2, "elements": 4, "grading": 0.4}
    found["analysis"] = {"type": "transient", "end_time": "50 s", "tolerance": 1e-4}
    return found | ({"calibrate": calibrate} if calibrate else {})


@cache
def truth(*changes):
    """Result with the true values, whose steps hit the times of the data."""
    times = ", ".join(f'"{t} s"' for t in TIMES[:-1])
    return tw.run(tw.load(tables(), (f"analysis.output_times=[{times}]", *changes)))


def rows_at_times(result):
    """Rows of the history at the times of the data."""
    return [next(row for row in result.history if row.time == time) for time in TIMES]


def write(path, head, columns):
    """CSV file of columns of numbers."""
    rows = [", ".join(repr(float(cell)) for cell in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return path


def volumes(path, result, noise=0.0, seed=1):
    """CSV file of the worn volumes of a running-in, with 2 % deviation."""
    exact = np.array([row.wear_volume_1 for row in rows_at_times(result)])
    draw = np.random.default_rng(seed).normal(size=len(exact))
    values = 1e9 * exact * (1 + noise * draw)
    head = "time [s], wear_volume_1 [mm^3], deviation [mm^3]"
    return write(path, head, (TIMES, values, 0.02e9 * exact))
