"""Ring on a plate (special case 8) under changing conditions: exponent and load, then heat.

It starts from the steady shape for b = 2 and 100 MPa and continues with b = 1 and 50 MPa, then
with friction heat. The final shapes differ; the pressure is the closed form in both cases.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...reference.annular_punch import steady_pressure
from ...results import Result
from ..check import Check, compare
from ..computed import computed
from ..starter import starter
from .finite_elements import away_from_ends

CLOSED_FORM = "Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895, special case 8"
INNER, OUTER = 0.02, 0.12
FORCE = 50e6 * np.pi * (OUTER**2 - INNER**2)

_COLD, _HOT = "annular-punch-running-in", "annular-punch"
_QUADRATIC = (
    "wear.punch.pressure_exponent=2.0",
    "wear.punch.coefficient=2e-7 1/MPa^2",
    "load.mean_pressure=100 MPa",
    "analysis={type='steady'}",
)
_ON = "analysis={type='transient', until='steady', steady_tolerance=2e-4, tolerance=1e-3}"


def story() -> Iterator[Check]:
    """Pressures, rates and shapes at the ends of its three parts."""
    first = computed(starter(_COLD, *_QUADRATIC))
    second = _continued(_COLD, first)
    third = _continued(_HOT, second)
    for name, result in (("cold", second), ("then hot", third)):
        inner = away_from_ends(starter(_COLD), result)
        exact = steady_pressure(result.interface.x, FORCE, INNER, OUTER, 1.0)
        off = np.abs(result.interface.pressure / exact - 1.0)[inner]
        worst = np.flatnonzero(inner)[off.argmax()]
        quantity = f"from the shape of b = 2, 100 MPa, with b = 1, 50 MPa, {name}: pressure [Pa]"
        found = result.interface.pressure[worst]
        yield compare(quantity, found, exact[worst], 1e-3, CLOSED_FORM)
        first_rate, last_rate = _volume_rates(result)
        yield compare(
            f"{name}: second difference of the worn volume, over the first, at the end [1]",
            last_rate / first_rate - 1.0,
            0.0,
            1e-3,
            "steady wear rate",
            scale=1.0,
        )


def _continued(name: str, before: Result) -> Result:
    """Running-in from the worn shape of another run."""
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "shape.csv"
        table = np.column_stack([before.profile.s, before.profile.shape])
        np.savetxt(file, table, delimiter=",", header="s_m,shape_m", comments="", fmt="%.17g")
        return computed(starter(name, _ON, f"geometry.initial_shape={str(file)!r}"))


def _volume_rates(result: Result) -> tuple[float, float]:
    """Wear volume rates of the last two steps [m³/s]."""
    times = np.array([row.time for row in result.history[-3:]])
    volumes = np.array([row.wear_volume_1 for row in result.history[-3:]])
    first, last = np.diff(volumes) / np.diff(times)
    return float(first), float(last)
