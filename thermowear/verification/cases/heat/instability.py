"""Thermoelastic instability of bodies that slide on an insulator and take all friction heat.

A rod pressed on a wall (a column of steel with ν = 0), and half a wavelength of a half-plane
between planes of symmetry, in blocks 1.5 wavelengths deep; with and without wear.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from .... import geometry  # noqa: F401  (makes the geometries known)
from ....case import load
from ....reference.instability import ConductorOnInsulator, SlidingRod
from ....results import Result
from ...check import Check, compare, computed

ROD_SOURCE = "exact solution of a rod pressed on an insulating wall, E = 210 GPa, k = 50 W/(m K)"
BARBER = "Chebfun example, J. R. Barber's rod: φ'' = λ φ, φ(0) = 0, φ'(1) + φ(1) = 4 d ∫φ"
BURTON = "R. A. Burton, V. Nerlikar and S. R. Kilaparti, Wear 24 (1973) 177"
YOUNG_MODULUS, RATIO = 2.1e11, 0.3  # Pa, -
STEEL = {
    "expansion": 1.2e-5,  # 1/K
    "conductivity": 50.0,  # W/(m K)
    "capacity": 3.7e6,  # J/(m³ K)
    "friction": 0.3,
}
RIGID = (1e20, 0.0)  # Pa, -
COLD = 1e5  # W/(m K): little heat and high conductivity: no temperature rise
WEAR = 1e-14  # 1/Pa
ROD = SlidingRod(length=0.05, young_modulus=YOUNG_MODULUS, **STEEL)
WALL = 0.01  # m, its thickness
EIGENVALUES = {0.96: -0.1601435706615, 1.02: 0.0799646106}
"""Eigenvalues λ of the cooled rod by d."""
SPEEDS = {0.0: (0.5, 1.05, 2.0), WEAR: (0.5, 1.05, 2.0), 30 * WEAR: (1.3, 2.0)}
"""Speeds of the rod relative to the critical speed, by wear coefficient."""
WAVE = 0.02  # m
INSULATORS = {"rigid": RIGID, "elastic": (0.5 * YOUNG_MODULUS, 0.2)}


def sliding_rod() -> Iterator[Check]:
    """Critical speed of a rod, growth rates at some speeds, and a rod cooled by its wall."""
    for wear, parts in SPEEDS.items():
        rod = replace(ROD, wear=wear)
        worn = f", k_w = {1e6 * wear:g}/MPa" if wear else ""
        for part in parts:
            result = _rod_at(part, wear)
            at = f"{worn}, from {part:g} of it [m/s]"
            found = result.summary["critical_speed_m_per_s"]
            yield compare(f"critical speed{at}", found, rod.critical_speed, 1e-4, ROD_SOURCE)
            if wear > 0:
                found = result.summary["critical_speed_with_wear_m_per_s"]
                known = rod.critical_speed_with_wear
                yield compare(f"critical speed with wear{at}", found, known, 1e-4, ROD_SOURCE)
            rate = rod.growth_rate(part * rod.critical_speed)
            yield from _growth(result, f"at {part:g} vcr{worn}", rate, ROD_SOURCE)
    for d, eigenvalue in EIGENVALUES.items():
        # the wall removes as much heat from the end of the rod as the rod itself conducts
        resistance = ROD.length / ROD.conductivity - WALL / COLD
        summary = _rod_at(2 * d, conductance=1 / resistance).summary
        found = summary["growth_rate_per_s"] * ROD.capacity * ROD.length**2 / ROD.conductivity
        yield compare(f"λ of the cooled rod, d = {d:g} [1]", found, eigenvalue, 1e-3, BARBER)
        factor = summary["static_speed_factors"][0] * d
        yield compare(f"critical d of the cooled rod, from {d:g} [1]", factor, 1.0, 1e-4, BARBER)


def half_plane_instability() -> Iterator[Check]:
    """Half-plane on a rigid and on an elastic insulator, and a half-plane that wears."""
    for name, insulator in INSULATORS.items():
        speed = 1.3 * _wave(insulator).critical_speed
        result = _half_wave(speed, insulator)
        for halves, factor in enumerate(result.summary["static_speed_factors"], 1):
            known = _wave(insulator, halves).critical_speed
            quantity = f"critical speed of {halves} half waves, {name} insulator [m/s]"
            yield compare(quantity, factor * speed, known, 1e-4, BURTON)
        at = f"at 1.3 times the critical speed, {name} insulator"
        yield from _growth(result, at, _wave(insulator).growth_rate(speed), BURTON)
    for wear, part in ((0.0, 0.6), (0.0, 3.0), (WEAR, 0.6), (WEAR, 1.05), (WEAR, 3.0)):
        pair = _wave(RIGID, wear=wear)
        speed = part * pair.critical_speed
        result = _half_wave(speed, RIGID, wear)
        at = f"at {part:g} times the critical speed, {'rigid, worn' if wear else 'rigid'} insulator"
        yield from _growth(result, at, pair.growth_rate(speed), BURTON)


def _growth(result: Result, at: str, rate: complex, source: str) -> Iterator[Check]:
    """Growth rate of the fastest mode, and its frequency if it is oscillatory."""
    found = result.summary["growth_rate_per_s"]
    yield compare(f"growth rate {at} [1/s]", found, rate.real, 1e-3, source, abs(rate))
    if rate.imag > 0:
        found = result.summary["growth_frequency_rad_per_s"]
        quantity = f"frequency of the growing mode {at} [1/s]"
        yield compare(quantity, found, rate.imag, 1e-3, source)


def _wave(
    insulator: tuple[float, float], halves: int = 1, wear: float = 0.0
) -> ConductorOnInsulator:
    """Closed form for a number of half waves along the face."""
    modulus, ratio = insulator
    softness = (1 - RATIO**2) / YOUNG_MODULUS + (1 - ratio**2) / modulus
    return ConductorOnInsulator(WAVE / halves, 1 / softness, RATIO, wear=wear, **STEEL)


def _half_wave(speed: float, insulator: tuple[float, float], wear: float = 0.0) -> Result:
    """Stability analysis of half a wavelength of the conductor."""
    sizes = {"width": WAVE / 2, "upper_height": 1.5 * WAVE, "lower_height": 1.5 * WAVE}
    return _stability(speed, sizes, RATIO, {"mean_pressure": "5 MPa"}, wear, insulator)


def _rod_at(part: float, wear: float = 0.0, conductance: float = 1e-4) -> Result:
    """Stability analysis of the rod as a column with ν = 0, at a part of its critical speed."""
    sizes = {"width": 0.01, "upper_height": ROD.length, "lower_height": WALL}
    speed, pressing = part * ROD.critical_speed, {"approach": "1 um"}
    return _stability(speed, sizes, 0.0, pressing, wear, conductance=conductance, fineness=4)


def _stability(
    speed: float,
    sizes: dict[str, float],
    poisson_ratio: float,
    pressing: dict[str, str],
    wear: float,
    insulator: tuple[float, float] = RIGID,
    conductance: float = 1e-4,
    fineness: int = 6,
) -> Result:
    """Run the stability analysis of a block between planes of symmetry, at a speed [m/s].

    Sizes in m, Archard's k of the steel in 1/Pa, Young's modulus [Pa] and Poisson's ratio of the
    insulator, conductance (nearly insulating) in W/(m² K); fineness: number and degree of elements.
    """

    def body(modulus: float, ratio: float, conductivity: float, expansion: float) -> dict:
        return {
            "young_modulus": f"{modulus} Pa",
            "poisson_ratio": ratio,
            "conductivity": f"{conductivity} W/(m K)",
            "expansion": f"{expansion} 1/K",
            "density": "1000 kg/m^3",
            "specific_heat": f"{STEEL['capacity'] / 1e3} J/(kg K)",
        }

    steel = body(YOUNG_MODULUS, poisson_ratio, STEEL["conductivity"], STEEL["expansion"])
    lengths = {key: f"{size!r} m" for key, size in sizes.items()}
    tables: dict[str, Any] = {
        "title": "A block on an insulator",
        "model": "plane-strain",
        "geometry": {"type": "stacked-blocks", "thickness": "10 mm", **lengths},
        "mesh": {"degree": fineness, "elements": fineness, "grading": 0.5},
        "bodies": {"upper": steel, "lower": body(*insulator, COLD, 1e-12)},
        "load": pressing,
        "motion": {"velocity": f"{speed!r} m/s"},
        "contact": {"friction": STEEL["friction"]},
        "heat": {
            "conductance": f"{conductance!r} W/(m^2 K)",
            "partition": 1.0,
            "ambient": "20 degC",
            "temperature": {"upper_top": "20 degC", "lower_bottom": "20 degC"},
        },
        "analysis": {"type": "stability"},
    }
    if wear > 0:
        tables["wear"] = {"upper": {"coefficient": f"{wear} 1/Pa", "per": "pressure"}}
    return computed(load(tables))
