"""Pressure-dependent contact conductance: temperatures of two blocks against closed forms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.pressure_conductance import block_temperatures
from ...reference.slabs import contact_temperatures
from ...results import Result
from ..check import Check, compare_worst
from ..starter import run_starter

MODEL = "h = C k_h p/H_h as in MOOSE (GapFluxModelPressureDependentConduction), blocks in series"
SERIES = "linear interpolation of the table, blocks in series"
LENGTHS, CONDUCTIVITIES, HARDNESSES = (0.01, 0.02), (50.0, 15.0), (2e9, 3e9)
ENDS = (293.15, 393.15)
COEFFICIENT = 2e4
_HARD = (
    'bodies.upper.hardness="2 GPa"',
    'bodies.lower.hardness="3 GPa"',
    'heat.temperature.lower_bottom="120 degC"',
)
_MODEL = f'heat.conductance={{type="pressure", coefficient="{COEFFICIENT} 1/m"}}'
_TABLE = (
    'heat.conductance={type="table", pressure=["1 MPa", "10 MPa"],'
    ' conductance=["1e3 W/(m^2 K)", "5e3 W/(m^2 K)"]}'
)


def checks() -> Iterator[Check]:
    """Several loads and speeds, in the steady state and for unworn faces."""
    for analysis in ("steady", "initial"):
        for pressure in (0.5, 5.0, 50.0):
            for speed in (1e-9, 0.01):
                title = f"{pressure:g} MPa, {speed:.1g} m/s, {analysis}"
                heat = 0.2 * 1e6 * pressure * speed
                exact = block_temperatures(
                    LENGTHS, CONDUCTIVITIES, HARDNESSES, ENDS, COEFFICIENT, 1e6 * pressure, heat
                )
                result = _run(_MODEL, pressure, speed, analysis)
                yield from _rows(result, f"proportional, {title}", exact, MODEL)
                h = np.interp(pressure, (1.0, 10.0), (1e3, 5e3))
                exact, _ = contact_temperatures(LENGTHS, CONDUCTIVITIES, ENDS, heat, 0.5, h)
                result = _run(_TABLE, pressure, speed, analysis)
                yield from _rows(result, f"table, {title}", exact, SERIES)


def _run(conductance: str, pressure: float, speed: float, analysis: str) -> Result:
    return run_starter(
        "stacked-blocks",
        conductance,
        *_HARD,
        f'load.mean_pressure="{pressure} MPa"',
        f'motion.velocity="{speed} m/s"',
        f'analysis.type="{analysis}"',
    )


def _rows(result: Result, title: str, exact, source: str) -> Iterator[Check]:
    faces = result.interface.temperature_1, result.interface.temperature_2
    for body, (found, known) in enumerate(zip(faces, exact, strict=True), start=1):
        quantity = f"temperature of face {body}, {title} [K]"
        yield compare_worst(quantity, found, known, 1e-6, source, known - ENDS[0])
