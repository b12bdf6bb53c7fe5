"""Thermoelastic instability of a conductor on an insulator: critical speed and growth rate.

Half a wavelength between planes of symmetry, in blocks 1.5 wavelengths deep.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...reference.half_plane_instability import ConductorOnInsulator
from ...results import Result
from ..check import Check, compare
from . import insulated

SOURCE = "R. A. Burton, V. Nerlikar and S. R. Kilaparti, Wear 24 (1973) 177"
WAVE = 0.02  # m
RATIO = 0.3
INSULATORS = {"rigid": (insulated.RIGID, 0.0), "elastic": (0.5 * insulated.YOUNG_MODULUS, 0.2)}
WEAR = 1e-14  # 1/Pa


def checks() -> Iterator[Check]:
    """Rigid and elastic insulator, and a conductor that wears."""
    for name, insulator in INSULATORS.items():
        speed = 1.3 * wave(insulator).critical_speed
        result = half_wave(speed, insulator)
        yield from _critical(name, result, speed, insulator)
        yield from _rates(name, result, 1.3, wave(insulator).growth_rate(speed))
    for wear, part in ((0.0, 0.6), (0.0, 3.0), (WEAR, 0.6), (WEAR, 1.05), (WEAR, 3.0)):
        pair = wave(INSULATORS["rigid"], wear=wear)
        speed = part * pair.critical_speed
        result = half_wave(speed, INSULATORS["rigid"], wear)
        name = "rigid, worn" if wear else "rigid"
        yield from _rates(name, result, part, pair.growth_rate(speed))


def _critical(name: str, result: Result, speed: float, insulator) -> Iterator[Check]:
    """Critical speeds of one to four half waves along the face."""
    for halves, factor in enumerate(result.summary["static_speed_factors"], 1):
        known = wave(insulator, halves).critical_speed
        quantity = f"critical speed of {halves} half waves, {name} insulator [m/s]"
        yield compare(quantity, factor * speed, known, 1e-4, SOURCE)


def _rates(name: str, result: Result, part: float, rate: complex) -> Iterator[Check]:
    at = f"at {part:g} times the critical speed, {name} insulator"
    yield from insulated.growth(result, at, rate, SOURCE)


def wave(
    insulator: tuple[float, float], halves: int = 1, wear: float = 0.0
) -> ConductorOnInsulator:
    """Closed form for a number of half waves along the face."""
    modulus, ratio = insulator
    softness = (1 - RATIO**2) / insulated.YOUNG_MODULUS + (1 - ratio**2) / modulus
    return ConductorOnInsulator(
        wave_length=WAVE / halves,
        modulus=1 / softness,
        poisson_ratio=RATIO,
        expansion=insulated.EXPANSION,
        conductivity=insulated.CONDUCTIVITY,
        friction=insulated.FRICTION,
        capacity=insulated.CAPACITY,
        wear=wear,
    )


def half_wave(speed: float, insulator: tuple[float, float], wear: float = 0.0) -> Result:
    """Stability analysis of half a wavelength of the conductor."""
    depth = 1.5 * WAVE
    sizes = {"width": WAVE / 2, "upper_height": depth, "lower_height": depth}
    pressing = {"mean_pressure": "5 MPa"}
    return insulated.stability(speed, sizes, RATIO, pressing, wear, insulator)
