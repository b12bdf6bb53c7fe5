"""Temperature-dependent properties: closed forms, and the fixed point against the transient."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...case.tables.schema import Case
from ...laws import LocalState
from ...results import Result
from ..check import Check, compare, compare_worst
from ..computed import computed
from ..starter import starter

KIRCHHOFF = "Kirchhoff's transformation of a slab with k = k0 (1 + b T)"
STRAIN = "thermal strain of blocks between planes of symmetry, integrated"
LINEAR = "friction linear in the temperature of two blocks: a linear equation"
LAWS = "tables at the computed pressures and temperatures"
IN_TIME = "end of a running-in"
AMBIENT = 293.15
_FAR = 600
"""Range of the linear tables, larger than any rise here [K]."""


def checks() -> Iterator[Check]:
    """Conductivity, expansion, friction and wear."""
    yield from _conductivity()
    yield from _expansion()
    yield from _friction()
    for title, name, overrides in _worn():
        yield from _steady_against_time(title, name, *overrides)


def _straight(slope: float) -> str:
    """Linear factor, 1 at ambient, with a slope per kelvin."""
    return f'{{at=["20 degC", "{20 + _FAR} degC"], factor=[1.0, {1 + _FAR * slope}]}}'


_SLOPES = 2e-3, -4e-4
_BLOCKS = (
    'heat.temperature.lower_bottom="420 degC"',
    f"bodies.upper.conductivity_factor={_straight(_SLOPES[0])}",
    f"bodies.lower.conductivity_factor={_straight(_SLOPES[1])}",
)


def _conductivity() -> Iterator[Check]:
    """Flux through each block by the integral of its conductivity between its ends."""
    for analysis in ("steady", "initial"):
        i = computed(starter("stacked-blocks", *_BLOCKS, f'analysis.type="{analysis}"')).interface
        T1, T2 = (T - AMBIENT for T in (i.temperature_1, i.temperature_2))
        known = 50.0 * (T1 + _SLOPES[0] * T1**2 / 2) / 0.01
        yield compare_worst(
            f"heat flux into block 1, {analysis}", i.heat_flux_1, known, 1e-8, KIRCHHOFF
        )
        integral = (T2 + _SLOPES[1] * T2**2 / 2) - (400 + _SLOPES[1] * 400**2 / 2)
        known = 15.0 * integral / 0.02
        yield compare_worst(
            f"heat flux into block 2, {analysis}", i.heat_flux_2, known, 1e-8, KIRCHHOFF
        )
        known = 1e4 * (T2 - T1) + 0.5 * 1e5
        yield compare_worst(
            f"heat exchanged, {analysis}", i.heat_flux_1, known, 1e-8, "1e4 (T2 - T1) + q/2"
        )


def _expansion() -> Iterator[Check]:
    """Approach of the holder on blocks that are compressed and expand thermally."""
    slope = 1e-3
    factors = [f"bodies.{body}.expansion_factor={_straight(slope)}" for body in ("upper", "lower")]
    result = computed(starter("stacked-blocks", *_BLOCKS[:1], *factors, 'analysis.type="initial"'))
    T1, T2 = (
        float(T.mean()) - AMBIENT
        for T in (result.interface.temperature_1, result.interface.temperature_2)
    )
    squeezed = sum(
        5e6 * length * (1 + 0.3) * (1 - 2 * 0.3) / (E * (1 - 0.3))
        for length, E in ((0.01, 210e9), (0.02, 200e9))
    )
    swollen = (
        (1 + 0.3)
        / (1 - 0.3)
        * (
            1.2e-5 * 0.01 * _mean_strain(0.0, T1, slope)
            + 1.6e-5 * 0.02 * _mean_strain(400, T2, slope)
        )
    )
    found, known = result.summary["approach_m"], squeezed - swollen
    yield compare("approach of the holder [m]", found, known, 1e-8, STRAIN)


def _mean_strain(T: float, other: float, slope: float) -> float:
    """Mean of ``(1 + slope T) T`` for T linear between two values."""
    return (T + other) / 2 + slope * (T**2 + T * other + other**2) / 3


def _friction() -> Iterator[Check]:
    """Friction of two blocks, whose mean face temperature is proportional to the friction heat."""
    for slope in (-1.5e-3, 8e-3):
        overrides = f"contact.friction_factor.temperature={_straight(slope)}"
        per_heat = _mean_rise(starter("stacked-blocks")) / 1e5
        heat = 1e5 / (1 - slope * per_heat * 1e5)
        for analysis in ("steady", "initial"):
            result = computed(starter("stacked-blocks", overrides, f'analysis.type="{analysis}"'))
            i = result.interface
            found = i.heat_flux_1 + i.heat_flux_2
            title = f"friction heat, factor 1 {slope:+g} (T - T0), {analysis}"
            yield compare_worst(title, found, np.full(len(found), heat), 1e-8, LINEAR)


def _mean_rise(case: Case) -> float:
    i = computed(case).interface
    return float((i.temperature_1 + i.temperature_2).mean() / 2) - AMBIENT


def _worn() -> Iterator[tuple[str, str, tuple[str, ...]]]:
    """Cases in which friction, wear, temperature and pressure all depend on each other."""
    yield (
        "ring, friction falling",
        "annular-punch",
        (
            'motion.angular_velocity="0.04 rad/s"',
            "mesh.degree=6",
            "mesh.elements=8",
            'contact.friction_factor.temperature={at=["20 degC", "70 degC"], factor=[1.0, 0.5]}',
            'contact.friction_factor.speed={at=["0 m/s", "0.005 m/s"], factor=[1.1, 0.9]}',
            'wear.punch.factor.temperature={at=["20 degC", "70 degC"], factor=[1.0, 3.0]}',
            'wear.punch.factor.pressure={at=["0 MPa", "400 MPa"], factor=[1.0, 1.5]}',
        ),
    )
    yield (
        "block on disk, friction rising",
        "block-on-disk",
        (
            "mesh.degree=4",
            'contact.friction_factor.temperature={at=["20 degC", "28 degC"], factor=[1.0, 1.5]}',
            'wear.block.factor.temperature={at=["20 degC", "28 degC"], factor=[1.0, 3.0]}',
        ),
    )


def _steady_against_time(title: str, name: str, *overrides: str) -> Iterator[Check]:
    case = starter(name, *overrides)
    steady = computed(case)
    in_time = 'analysis={type="transient", until="steady", steady_tolerance=2e-4}'
    ended = computed(starter(name, *overrides, in_time))
    i, j = steady.interface, ended.interface
    yield compare_worst(f"pressure, {title} [Pa]", i.pressure, j.pressure, 1e-3, IN_TIME)
    for body, found, known in (
        (1, i.temperature_1, j.temperature_1),
        (2, i.temperature_2, j.temperature_2),
    ):
        quantity = f"rise of face {body}, {title} [K]"
        yield compare_worst(quantity, found - AMBIENT, known - AMBIENT, 1e-3, IN_TIME)
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
    mean = (i.temperature_1 + i.temperature_2) / 2
    at = LocalState(i.pressure, speed, mean)
    friction = case.contact.friction * case.contact.friction_factor.multipliers.value(at)
    heat = i.heat_flux_1 + i.heat_flux_2
    yield compare_worst(
        f"friction heat, {title} [W/m²]", heat, friction * i.pressure * speed, 1e-8, LAWS
    )
    ((_, law),) = case.wear.items()
    factor = law.factor.multipliers.value(at._replace(T=i.temperature_1))
    rate = law.coefficient_si() * factor * friction * i.pressure * speed
    yield compare_worst(f"wear rate, {title} [m/s]", i.wear_rate_1, rate, 1e-8, LAWS)
    power = result.summary["heat_balance_relative_error"]
    yield compare(f"heat balance, {title}", 1 + power, 1.0, 1e-9, "conservation of energy")
