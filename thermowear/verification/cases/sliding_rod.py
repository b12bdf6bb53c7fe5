"""Sliding rod: critical speed, and growth rates below and above it, with and without wear."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ...reference.sliding_rod import SlidingRod
from ...results import Result
from ..check import Check, compare
from . import insulated

SOURCE = "exact solution of a rod pressed on an insulating wall, E = 210 GPa, k = 50 W/(m K)"
ROD = SlidingRod(
    length=0.05,
    young_modulus=insulated.YOUNG_MODULUS,
    expansion=insulated.EXPANSION,
    conductivity=insulated.CONDUCTIVITY,
    capacity=insulated.CAPACITY,
    friction=insulated.FRICTION,
)
WALL = 0.01  # m, its thickness
BARBER = "Chebfun example, J. R. Barber's rod: φ'' = λ φ, φ(0) = 0, φ'(1) + φ(1) = 4 d ∫φ"
EIGENVALUES = {0.96: -0.1601435706615, 1.02: 0.0799646106}
"""Eigenvalues λ by d."""
WEAR = 1e-14  # 1/Pa
SPEEDS = {0.0: (0.5, 1.05, 2.0), WEAR: (0.5, 1.05, 2.0), 30 * WEAR: (1.3, 2.0)}
"""Speeds relative to the critical speed, by wear coefficient."""


def checks() -> Iterator[Check]:
    """Critical speed, growth rates at some speeds, and a rod that is cooled by its wall."""
    for wear, parts in SPEEDS.items():
        rod = replace(ROD, wear=wear)
        for part in parts:
            result = solved(rod, part)
            yield from _critical(rod, part, result)
            rate, at = rod.growth_rate(part * rod.critical_speed), f"at {part:g} vcr{_worn(rod)}"
            yield from insulated.growth(result, at, rate, SOURCE)
    for d, eigenvalue in EIGENVALUES.items():
        yield from _cooled(d, eigenvalue)


def _cooled(d: float, eigenvalue: float) -> Iterator[Check]:
    """Wall that removes as much heat from the end of the rod as the rod itself conducts."""
    resistance = ROD.length / ROD.conductivity - WALL / insulated.COLD
    summary = solved(ROD, 2 * d, conductance=1 / resistance).summary
    found = summary["growth_rate_per_s"] * ROD.capacity * ROD.length**2 / ROD.conductivity
    yield compare(f"λ of the cooled rod, d = {d:g} [1]", found, eigenvalue, 1e-3, BARBER)
    factor = summary["static_speed_factors"][0] * d
    yield compare(f"critical d of the cooled rod, from {d:g} [1]", factor, 1.0, 1e-4, BARBER)


def _critical(rod: SlidingRod, part: float, result: Result) -> Iterator[Check]:
    summary, at = result.summary, f"{_worn(rod)}, from {part:g} of it [m/s]"
    found = summary["critical_speed_m_per_s"]
    yield compare(f"critical speed{at}", found, rod.critical_speed, 1e-4, SOURCE)
    if rod.wear > 0:
        found, known = summary["critical_speed_with_wear_m_per_s"], rod.critical_speed_with_wear
        yield compare(f"critical speed with wear{at}", found, known, 1e-4, SOURCE)


def _worn(rod: SlidingRod) -> str:
    return f", k_w = {1e6 * rod.wear:g}/MPa" if rod.wear else ""


def solved(rod: SlidingRod, part: float, conductance: float = 1e-4) -> Result:
    """Stability analysis of the rod as a column with ν = 0, at a part of its critical speed."""
    sizes = {"width": 0.01, "upper_height": rod.length, "lower_height": WALL}
    pressing = {"approach": "1 um"}
    speed = part * rod.critical_speed
    return insulated.stability(
        speed, sizes, 0.0, pressing, rod.wear, conductance=conductance, elements=4, degree=4
    )
