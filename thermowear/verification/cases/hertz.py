"""Common data of the Hertzian cases: contact modulus, computed half-width."""

from __future__ import annotations

import numpy as np

from ...reference.hertz import contact_modulus
from ...results import Result

STEEL = (210e9, 0.3)
MODULUS = contact_modulus(STEEL, STEEL)


def half_width(result: Result) -> float:
    """Distance from the middle to the edge of the contact [m]."""
    interface = result.interface
    (zone,) = result.summary["contact_zones_m"]
    ends = np.interp(zone, interface.s, interface.x)
    return float(np.abs(ends).max())
