"""Condensed contact, Nitsche's method and the penalty method against each other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...results import Result
from ..check import Check, compare, compare_worst
from ..starter import run_starter

CONDENSED = "same case with condensed contact"
THEORY = "penalty error proportional to 1/penalty (Kikuchi and Oden, Contact Problems, 1988, ch. 3)"
HALF_WIDTH = 0.496e-3
RANGES = {"hertz": (0.0, 0.95 * HALF_WIDTH), "annular punch": (0.025, 0.115)}
PENALTIES = {"hertz": (1e16, 1e17, 1e18), "annular punch": (1e14, 1e15, 1e16)}


def checks() -> Iterator[Check]:
    """Pressure away from edges; convergence order of the penalty error."""
    for case in RANGES:
        condensed = solved(case, "condensed")
        for theta in (1, 0, -1):
            nitsche = solved(case, "nitsche", f"contact.theta={theta}")
            yield _compared(case, nitsche, condensed, f"Nitsche, theta = {theta}")
        penalties = PENALTIES[case]
        stiff = [solved(case, "penalty", f"contact.penalty={p} Pa/m") for p in penalties]
        yield _compared(case, stiff[-1], condensed, f"penalty {penalties[-1]:g} Pa/m")
        errors = [result.summary["approach_m"] for result in stiff] - np.array(
            condensed.summary["approach_m"]
        )
        for slope, p in zip(-np.diff(np.log10(errors)), penalties, strict=False):
            quantity = f"slope of the approach, penalty from {p:g} Pa/m, {case} [1]"
            yield compare(quantity, slope, 1.0, 0.1, THEORY)


def solved(case: str, method: str, *overrides: str) -> Result:
    """Unworn contact of a starter case by a method."""
    key = f"contact.method={method}"
    if case == "hertz":
        return run_starter("cylinder-on-block", 'load={force="2230 N"}', key, *HERTZ, *overrides)
    return run_starter("annular-punch", key, *PUNCH, *overrides, without=("heat",))


HERTZ = ("mesh.elements=16",)
PUNCH = ("analysis.type=initial", "mesh.degree=6", "mesh.elements=16")


def _compared(case: str, result: Result, condensed: Result, note: str) -> Check:
    """Pressure at the point of largest deviation, relative to the largest pressure."""
    x = np.linspace(*RANGES[case], 400)
    found, known = (_along(r, x) for r in (result, condensed))
    quantity = f"pressure at the point of largest deviation, {note}, {case} [Pa]"
    return compare_worst(quantity, found, known, 1e-3, CONDENSED)


def _along(result: Result, x: np.ndarray) -> np.ndarray:
    return np.interp(x, result.interface.x, result.interface.pressure)
