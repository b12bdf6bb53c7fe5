"""Two blocks that share friction heat: temperatures and fluxes of the faces in closed form."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import inf, sqrt

import numpy as np

from ...reference.slabs import block_temperatures, contact_temperatures
from ...results import Result
from ..check import Check, compare_worst
from ..starter import run_starter

SERIES = "resistances in series (Carslaw and Jaeger, Conduction of Heat in Solids, 1959, 3.2)"
MODEL = "h = C k_h p/H_h as in MOOSE (GapFluxModelPressureDependentConduction), blocks in series"
TABLE = "linear interpolation of the table, blocks in series"
LENGTHS, CONDUCTIVITIES, HARDNESSES = (0.01, 0.02), (50.0, 15.0), (2e9, 3e9)
AMBIENT, HEAT, COEFFICIENT = 293.15, 0.2 * 5e6 * 0.1, 2e4
ENDS = (AMBIENT, 393.15)
_INSULATING = 1e-9
"""Conductance that represents insulation [W/(m² K)]."""
_STORING = (
    'bodies.upper.density="7800 kg/m^3"',
    'bodies.upper.specific_heat="470 J/(kg K)"',
    'bodies.lower.density="7900 kg/m^3"',
    'bodies.lower.specific_heat="500 J/(kg K)"',
)
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


def two_slabs() -> Iterator[Check]:
    """Conductance from zero to perfect contact, partition, different end temperatures, gaps."""
    for h, partition, analysis in product(
        (0.0, 1e3, 1e4, inf), (0.0, 0.5, 1.0), ("steady", "initial")
    ):
        settings = (f'analysis.type="{analysis}"', f"heat.partition={partition}")
        title = f"h = {h:g} W/(m² K), f = {partition:g}, {analysis}"
        yield from _rows(_run(h, *settings), title, partition, h)
    first, second = sqrt(50.0 * 7800 * 470), sqrt(15.0 * 7900 * 500)
    result = _run(1e3, 'heat.partition="effusivity"', *_STORING)
    yield from _rows(result, "shared by effusivity", first / (first + second), 1e3)
    yield from _across_a_gap()


def _run(conductance: float, *overrides: str) -> Result:
    if conductance == inf:
        return run_starter("stacked-blocks", *overrides, without=("heat.conductance",))
    given = f'heat.conductance="{conductance or _INSULATING} W/(m^2 K)"'
    return run_starter("stacked-blocks", given, *overrides)


def _rows(
    result: Result,
    title: str,
    partition: float,
    conductance: float,
    heat: float = HEAT,
    ends: tuple[float, float] = (AMBIENT, AMBIENT),
) -> Iterator[Check]:
    """Temperatures and fluxes of both faces at the points of largest deviation."""
    i = result.interface
    known = contact_temperatures(LENGTHS, CONDUCTIVITIES, ends, heat, partition, conductance)
    scales = max(abs(T - AMBIENT) for T in known[0]), max(map(abs, known[1])) or HEAT
    found = (i.temperature_1, i.temperature_2), (i.heat_flux_1, i.heat_flux_2)
    names = ("temperature of face {} [K]", "heat flux into body {} [W/m²]")
    for name, values, exact, scale in zip(names, found, known, scales, strict=True):
        for body, (value, reference) in enumerate(zip(values, exact, strict=True), start=1):
            quantity = f"{name.format(body)}, {title}"
            yield compare_worst(quantity, value, reference, 1e-6, SERIES, scale)


def _across_a_gap() -> Iterator[Check]:
    """Blocks that separate thermally: no friction heat, heat exchange across the gap only."""
    cold = 'heat.temperature.lower_bottom="-80 degC"'
    slow = 'motion.velocity="1e-6 m/s"'
    apart = ('load={approach="1 um"}', 'analysis.type="initial"', cold, slow)
    ends = (AMBIENT, AMBIENT - 100)
    for gap in (0.0, 500.0):
        given = () if gap == 0.0 else (f'heat.gap_conductance="{gap} W/(m^2 K)"',)
        result = run_starter("stacked-blocks", *apart, *given, without=("load",))
        yield from _rows(result, f"apart, {gap:g} W/(m² K) across the gap", 0.5, gap, 0.0, ends)


def pressure_conductance() -> Iterator[Check]:
    """Pressure-dependent conductance under several loads and speeds, steady and unworn."""
    for analysis, pressure, speed in product(("steady", "initial"), (0.5, 5.0, 50.0), (1e-9, 0.01)):
        heat = 0.2 * 1e6 * pressure * speed
        proportional = block_temperatures(
            LENGTHS, CONDUCTIVITIES, HARDNESSES, ENDS, COEFFICIENT, 1e6 * pressure, heat
        )
        h = np.interp(pressure, (1.0, 10.0), (1e3, 5e3))
        tabulated, _ = contact_temperatures(LENGTHS, CONDUCTIVITIES, ENDS, heat, 0.5, h)
        for label, conductance, exact, source in (
            ("proportional", _MODEL, proportional, MODEL),
            ("table", _TABLE, tabulated, TABLE),
        ):
            i = run_starter(
                "stacked-blocks",
                conductance,
                *_HARD,
                f'load.mean_pressure="{pressure} MPa"',
                f'motion.velocity="{speed} m/s"',
                f'analysis.type="{analysis}"',
            ).interface
            title = f"{label}, {pressure:g} MPa, {speed:.1g} m/s, {analysis}"
            for body, (found, known) in enumerate(
                zip((i.temperature_1, i.temperature_2), exact, strict=True), start=1
            ):
                quantity = f"temperature of face {body}, {title} [K]"
                yield compare_worst(quantity, found, known, 1e-6, source, known - ENDS[0])
