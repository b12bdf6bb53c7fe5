"""Condensed contact, Nitsche's method and the penalty method against each other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...results import Result
from ..check import Check, compare_each, compare_worst
from ..starter import run_starter

CONDENSED = "same case with condensed contact"
THEORY = "penalty error proportional to 1/penalty (Kikuchi and Oden, Contact Problems, 1988, ch. 3)"
HALF_WIDTH = 0.496e-3
CASES = {
    "hertz": ((0.0, 0.95 * HALF_WIDTH), (1e16, 1e17, 1e18)),
    "annular punch": ((0.025, 0.115), (1e14, 1e15, 1e16)),
}
"""Range of the compared pressures, and penalties."""
_PUNCH = ("analysis.type=initial", "mesh.degree=6", "mesh.elements=16")


def methods_agree() -> Iterator[Check]:
    """Pressure away from edges; convergence order of the penalty error."""
    for case, (ends, penalties) in CASES.items():
        x = np.linspace(*ends, 400)
        condensed = _solved(case, "condensed")
        compared = {
            f"Nitsche, theta = {theta}": _solved(case, "nitsche", f"contact.theta={theta}")
            for theta in (1, 0, -1)
        }
        stiff = [_solved(case, "penalty", f"contact.penalty={p} Pa/m") for p in penalties]
        compared[f"penalty {penalties[-1]:g} Pa/m"] = stiff[-1]
        for note, result in compared.items():
            found, known = (
                np.interp(x, i.x, i.pressure) for i in (result.interface, condensed.interface)
            )
            quantity = f"pressure at the point of largest deviation, {note}, {case} [Pa]"
            yield compare_worst(quantity, found, known, 1e-3, CONDENSED)
        approaches = np.array([result.summary["approach_m"] for result in stiff])
        slopes = -np.diff(np.log10(approaches - condensed.summary["approach_m"]))
        quantity = f"slope of the approach, penalty from {{:g}} Pa/m, {case} [1]"
        yield from compare_each(quantity, penalties[:-1], slopes, (1.0, 1.0), 0.1, THEORY)


def _solved(case: str, method: str, *overrides: str) -> Result:
    """Unworn contact of a starter case by a method."""
    keys = f"contact.method={method}", *overrides
    if case == "hertz":
        return run_starter("cylinder-on-block", 'load={force="2230 N"}', "mesh.elements=16", *keys)
    return run_starter("annular-punch", *keys, *_PUNCH, without=("heat",))
