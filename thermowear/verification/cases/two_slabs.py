"""Two blocks that share friction heat: temperatures and fluxes of the faces in closed form."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, sqrt

from ...reference.slabs import contact_temperatures
from ...results import Result
from ..check import Check, compare_worst
from ..starter import run_starter

SERIES = "resistances in series (Carslaw and Jaeger, Conduction of Heat in Solids, 1959, 3.2)"
LENGTHS, CONDUCTIVITIES, AMBIENT = (0.01, 0.02), (50.0, 15.0), 293.15
HEAT = 0.2 * 5e6 * 0.1
_INSULATING = 1e-9
"""Conductance that represents insulation [W/(m² K)]."""
_STORING = (
    'bodies.upper.density="7800 kg/m^3"',
    'bodies.upper.specific_heat="470 J/(kg K)"',
    'bodies.lower.density="7900 kg/m^3"',
    'bodies.lower.specific_heat="500 J/(kg K)"',
)


def checks() -> Iterator[Check]:
    """Conductance from zero to perfect contact, partition, different end temperatures, gaps."""
    for h in (0.0, 1e3, 1e4, inf):
        for partition in (0.0, 0.5, 1.0):
            for analysis in ("steady", "initial"):
                settings = (f'analysis.type="{analysis}"', f"heat.partition={partition}")
                title = f"h = {h:g} W/(m² K), f = {partition:g}, {analysis}"
                yield from _rows(_run(h, *settings), title, partition, h)
    yield from _by_effusivity()
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


def _by_effusivity() -> Iterator[Check]:
    """Partition of the friction heat by effusivity."""
    first, second = sqrt(50.0 * 7800 * 470), sqrt(15.0 * 7900 * 500)
    partition = first / (first + second)
    result = _run(1e3, 'heat.partition="effusivity"', *_STORING)
    yield from _rows(result, "shared by effusivity", partition, 1e3)


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
