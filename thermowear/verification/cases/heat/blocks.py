"""Blocks that share friction heat, and properties that depend on temperature.

Temperatures and fluxes of the faces in closed form; where friction, wear, temperature and pressure
depend on each other, the fixed point against the transient.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import inf, sqrt

import numpy as np

from ....case.tables.schema import Case
from ....laws import LocalState
from ....reference.heat import conductance, contact_temperatures
from ....results import Result
from ...check import Check, compare, compare_worst, computed, run_starter, starter

SERIES = "resistances in series (Carslaw and Jaeger, Conduction of Heat in Solids, 1959, 3.2)"
MODEL = "h = C k_h p/H_h as in MOOSE (GapFluxModelPressureDependentConduction), blocks in series"
TABLE = "linear interpolation of the table, blocks in series"
KIRCHHOFF = "Kirchhoff's transformation of a slab with k = k0 (1 + b T)"
STRAIN = "thermal strain of blocks between planes of symmetry, integrated"
LINEAR = "friction linear in the temperature of two blocks: a linear equation"
LAWS = "tables at the computed pressures and temperatures"
IN_TIME = "end of a running-in"
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
_FAR = 600
"""Range of the linear tables, larger than any rise here [K]."""


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
        proportional = conductance(COEFFICIENT, CONDUCTIVITIES, HARDNESSES, 1e6 * pressure)
        tabulated = np.interp(pressure, (1.0, 10.0), (1e3, 5e3))
        for label, law, h, source in (
            ("proportional", _MODEL, proportional, MODEL),
            ("table", _TABLE, tabulated, TABLE),
        ):
            exact, _ = contact_temperatures(LENGTHS, CONDUCTIVITIES, ENDS, heat, 0.5, h)
            i = run_starter(
                "stacked-blocks",
                law,
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


def temperature_dependent() -> Iterator[Check]:
    """Conductivity, expansion, friction and wear."""
    yield from _conductivity()
    yield from _expansion()
    yield from _friction()
    for title, (name, *overrides) in _COUPLED.items():
        yield from _steady_against_time(title, name, *overrides)


def _straight(slope: float) -> str:
    """Linear factor, 1 at ambient, with a slope per kelvin."""
    return f'{{at=["20 degC", "{20 + _FAR} degC"], factor=[1.0, {1 + _FAR * slope}]}}'


_HOT_END = 'heat.temperature.lower_bottom="420 degC"'


def _conductivity() -> Iterator[Check]:
    """Flux through each block by the integral of its conductivity between its ends."""
    slopes = 2e-3, -4e-4
    factors = [
        f"bodies.{body}.conductivity_factor={_straight(slope)}"
        for body, slope in zip(("upper", "lower"), slopes, strict=True)
    ]
    for analysis in ("steady", "initial"):
        i = run_starter(
            "stacked-blocks", _HOT_END, *factors, f'analysis.type="{analysis}"'
        ).interface
        T1, T2 = (T - AMBIENT for T in (i.temperature_1, i.temperature_2))
        integral = (T2 + slopes[1] * T2**2 / 2) - (400 + slopes[1] * 400**2 / 2)
        first, second = 50.0 * (T1 + slopes[0] * T1**2 / 2) / 0.01, 15.0 * integral / 0.02
        exchanged = 1e4 * (T2 - T1) + 0.5 * 1e5
        for quantity, found, known, source in (
            ("heat flux into block 1", i.heat_flux_1, first, KIRCHHOFF),
            ("heat flux into block 2", i.heat_flux_2, second, KIRCHHOFF),
            ("heat exchanged", i.heat_flux_1, exchanged, "1e4 (T2 - T1) + q/2"),
        ):
            yield compare_worst(f"{quantity}, {analysis}", found, known, 1e-8, source)


def _expansion() -> Iterator[Check]:
    """Approach of the holder on blocks that are compressed and expand thermally."""
    slope = 1e-3
    factors = [f"bodies.{body}.expansion_factor={_straight(slope)}" for body in ("upper", "lower")]
    result = run_starter("stacked-blocks", _HOT_END, *factors, 'analysis.type="initial"')
    i = result.interface
    T1, T2 = (float(T.mean()) - AMBIENT for T in (i.temperature_1, i.temperature_2))
    squeezed = sum(
        5e6 * length * (1 + 0.3) * (1 - 2 * 0.3) / (E * (1 - 0.3))
        for length, E in ((0.01, 210e9), (0.02, 200e9))
    )
    strains = 1.2e-5 * 0.01 * _mean_strain(0.0, T1, slope)
    strains += 1.6e-5 * 0.02 * _mean_strain(400, T2, slope)
    found, known = result.summary["approach_m"], squeezed - (1 + 0.3) / (1 - 0.3) * strains
    yield compare("approach of the holder [m]", found, known, 1e-8, STRAIN)


def _mean_strain(T: float, other: float, slope: float) -> float:
    """Mean of ``(1 + slope T) T`` for T linear between two values."""
    return (T + other) / 2 + slope * (T**2 + T * other + other**2) / 3


def _friction() -> Iterator[Check]:
    """Friction of two blocks, whose mean face temperature is proportional to the friction heat."""
    i = run_starter("stacked-blocks").interface
    per_heat = (float((i.temperature_1 + i.temperature_2).mean() / 2) - AMBIENT) / 1e5
    for slope, analysis in product((-1.5e-3, 8e-3), ("steady", "initial")):
        factor = f"contact.friction_factor.temperature={_straight(slope)}"
        i = run_starter("stacked-blocks", factor, f'analysis.type="{analysis}"').interface
        found, heat = i.heat_flux_1 + i.heat_flux_2, 1e5 / (1 - slope * per_heat * 1e5)
        title = f"friction heat, factor 1 {slope:+g} (T - T0), {analysis}"
        yield compare_worst(title, found, heat, 1e-8, LINEAR)


_COUPLED: dict[str, tuple[str, ...]] = {
    "ring, friction falling": (
        "annular-punch",
        'motion.angular_velocity="0.04 rad/s"',
        "mesh.degree=6",
        "mesh.elements=8",
        'contact.friction_factor.temperature={at=["20 degC", "70 degC"], factor=[1.0, 0.5]}',
        'contact.friction_factor.speed={at=["0 m/s", "0.005 m/s"], factor=[1.1, 0.9]}',
        'wear.punch.factor.temperature={at=["20 degC", "70 degC"], factor=[1.0, 3.0]}',
        'wear.punch.factor.pressure={at=["0 MPa", "400 MPa"], factor=[1.0, 1.5]}',
    ),
    "block on disk, friction rising": (
        "block-on-disk",
        "mesh.degree=4",
        'contact.friction_factor.temperature={at=["20 degC", "28 degC"], factor=[1.0, 1.5]}',
        'wear.block.factor.temperature={at=["20 degC", "28 degC"], factor=[1.0, 3.0]}',
    ),
}
"""Cases in which friction, wear, temperature and pressure all depend on each other."""


def _steady_against_time(title: str, name: str, *overrides: str) -> Iterator[Check]:
    case = starter(name, *overrides)
    in_time = 'analysis={type="transient", until="steady", steady_tolerance=2e-4}'
    steady, ended = computed(case), run_starter(name, *overrides, in_time)
    i, j = steady.interface, ended.interface
    yield compare_worst(f"pressure, {title} [Pa]", i.pressure, j.pressure, 1e-3, IN_TIME)
    for body in (1, 2):
        found, known = (getattr(state, f"temperature_{body}") - AMBIENT for state in (i, j))
        yield compare_worst(f"rise of face {body}, {title} [K]", found, known, 1e-3, IN_TIME)
    found, known = (_along_press(result) for result in (steady, ended))
    scale = float(np.ptp(known))
    yield compare_worst(f"worn shape, {title} [m]", found, known, 1e-3, IN_TIME, scale)
    yield from _consistent(case, steady, title)


def _along_press(result: Result) -> np.ndarray:
    """Worn shape about its mean, without the singular ends."""
    shape, weight = result.profile.shape_along_press[1:-1], result.interface.weight[1:-1]
    return shape - np.average(shape, weights=weight)


def _consistent(case: Case, result: Result, title: str) -> Iterator[Check]:
    """Friction heat and wear rates by the laws of the case at the computed state."""
    i = result.interface
    assert case.motion is not None
    turned = case.geometry.rotation_center
    arms = i.x if turned is None else np.hypot(i.x - turned[0], i.y - turned[1])
    speed = case.motion.angular_velocity * arms
    at = LocalState(i.pressure, speed, (i.temperature_1 + i.temperature_2) / 2)
    friction = case.contact.friction * case.contact.friction_factor.multipliers.value(at)
    heat, exact = i.heat_flux_1 + i.heat_flux_2, friction * i.pressure * speed
    yield compare_worst(f"friction heat, {title} [W/m²]", heat, exact, 1e-8, LAWS)
    ((_, law),) = case.wear.items()
    factor = law.factor.multipliers.value(at._replace(T=i.temperature_1))
    rate = law.coefficient_si() * factor * friction * i.pressure * speed
    yield compare_worst(f"wear rate, {title} [m/s]", i.wear_rate_1, rate, 1e-8, LAWS)
    power = result.summary["heat_balance_relative_error"]
    yield compare(f"heat balance, {title}", 1 + power, 1.0, 1e-9, "conservation of energy")
