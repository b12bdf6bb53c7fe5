"""Flat punch on a block: singular pressure of a rigid punch on a half-plane."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference import hertz as reference
from ..check import Check, along, compare
from ..starter import run_starter

JOHNSON = "Johnson, Contact Mechanics (1985), section 2.8"
HALF_WIDTH, THICKNESS = 5e-3, 1e-3
PLACES = (0.0, 0.3, 0.6, 0.8, 0.9, 0.95)
RIGID = ("bodies.punch.young_modulus=1e6 GPa",)


def checks() -> Iterator[Check]:
    """Pressure up to 5 % of the half-width from the edge, in plane strain and plane stress."""
    for model in ("plane-strain", "plane-stress"):
        result = run_starter("punch-on-block", f"model={model}", *RIGID)
        force = result.summary["normal_force_N"] / THICKNESS
        places = HALF_WIDTH * np.array(PLACES)
        exact = reference.flat_punch(places, force, HALF_WIDTH)
        found = along(result.interface, places, result.interface.pressure)
        for place, p, known in zip(PLACES, found, exact, strict=True):
            quantity = f"pressure at x = {place:g} of the half-width, {model} [Pa]"
            yield compare(quantity, p, known, 1e-2, JOHNSON)
