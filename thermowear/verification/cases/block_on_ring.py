"""Block worn by a rotating ring: from line contact to a worn circle.

The geometry updates remove the wear of the block; the ring does not wear.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.growing_contact import GrowingContact, growing_line
from ...results import InterfaceFields
from ..check import Check, compare
from ..starter import run_starter
from .growing import ARCHARD, RIGID, SPEED, worn_half_width
from .hertz import MODULUS

PRESS, RADIUS, COEFFICIENT = 10_833.0, 20e-3, 2e-15
DISTANCES = (400.0, 800.0, 1600.0, 2400.0, 3600.0)
CIRCLE = "circle with the radius of the ring"


def checks() -> Iterator[Check]:
    """Half-width and depth against the closed form, the worn face against the ring."""
    law = growing_line(PRESS, RADIUS, MODULUS, COEFFICIENT)
    times = [s / SPEED for s in DISTANCES]
    result = run_starter("block-on-ring")
    states = result.outputs | {times[-1]: result.interface}
    for s, t in zip(DISTANCES, times, strict=True):
        yield from _state(law, s, states[t])
    summary, volume = result.summary, COEFFICIENT * PRESS * 1e-3 * DISTANCES[-1]
    found = summary["geometry_volume_2_m3"]
    yield compare("volume lost by the mesh [m³]", found, volume, 1e-3, ARCHARD)
    error = summary["geometry_volume_error"]
    known = "integral of the wear over the face"
    yield compare("worst update: volume lost by the mesh [1]", 1 + error, 1.0, 1e-6, known)


def _state(law: GrowingContact, distance: float, state: InterfaceFields) -> Iterator[Check]:
    """State after a sliding distance [m]."""
    place, depth = f"after {distance:g} m", float(state.wear_2[0])
    width, known = worn_half_width(state, 5), float(law.half_width(distance))
    yield compare(f"half-width {place} [m]", width, known, 1e-2, RIGID)
    yield compare(f"depth {place} [m]", depth, float(law.depth(distance)), 1e-2, RIGID)
    inside = state.x < 0.95 * known
    ring = depth - RADIUS + np.sqrt(RADIUS**2 - state.x**2)
    off = float(np.abs(state.wear_2 - ring)[inside].max())
    yield compare(f"worn face {place} [m], relative to its depth", off, 0.0, 1e-2, CIRCLE, depth)
