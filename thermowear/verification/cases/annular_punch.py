"""Steady state of the ring on a plate: worn shape, temperature, pressure, power."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference import annular_punch as reference
from ...results import Result
from ..check import Check, along, compare
from ..starter import run_starter

TABLE = "converged tables of degree 8 to 10 on other meshes"
CLOSED_FORM = "Páczelt and Mróz, Int. J. Solids Struct. 44 (2007) 895, special case 8"
INNER, OUTER, FRICTION, AMBIENT = 0.02, 0.12, 0.25, 293.15
FORCE = 50e6 * np.pi * (OUTER**2 - INNER**2)


def checks() -> Iterator[Check]:
    """Checks for b = 1, 2 and 0.5, without heat and at 0.1 rad/s."""
    for b, speed in reference.STEADY_SHAPE:
        result = steady(b, speed)
        yield from _shape(result, b, speed)
        yield from _pressure(result, b, speed)
        if (b, speed) == (1.0, 0.1):
            yield from _heat(result)


def steady(b: float, speed: float) -> Result:
    """Starter case with another pressure exponent; speed 0 means without heat."""
    overrides = (f"wear.punch.pressure_exponent={b}", f'wear.punch.coefficient="2e-7 1/MPa^{b}"')
    return run_starter("annular-punch", *overrides, without=() if speed else ("heat",))


def _shape(result: Result, b: float, speed: float) -> Iterator[Check]:
    """Height of the worn face relative to that at r = 70 mm, scaled by its range."""
    interface = result.interface
    heights = along(interface, reference.RADII, interface.shape)
    heights = 1e3 * (heights - along(interface, 0.07, interface.shape))
    expected = np.array(reference.STEADY_SHAPE[b, speed])
    for r, found, known in zip(reference.RADII, heights, expected, strict=True):
        if r == 0.07:
            continue
        corner = r in (INNER, OUTER)
        quantity = f"shape at r = {1e3 * r:g} mm, b = {b:g}, {_state(speed)} [mm]"
        allowed = 2e-3 if corner else 5e-4
        yield compare(quantity, found, known, allowed, TABLE, scale=np.ptp(expected))


def _pressure(result: Result, b: float, speed: float) -> Iterator[Check]:
    interface = result.interface
    exact = reference.steady_pressure(interface.x, FORCE, INNER, OUTER, b)
    worst = int(np.abs(interface.pressure / exact - 1).argmax())
    quantity = f"pressure at the point of largest deviation, b = {b:g}, {_state(speed)} [Pa]"
    yield compare(quantity, interface.pressure[worst], exact[worst], 1e-6, CLOSED_FORM)


def _heat(result: Result) -> Iterator[Check]:
    interface = result.interface
    rises = along(interface, reference.RADII, interface.temperature_1 - AMBIENT)
    for r, found, known in zip(reference.RADII, rises, reference.TEMPERATURE_RISE, strict=True):
        quantity = f"temperature rise at r = {1e3 * r:g} mm, b = 1, hot [K]"
        yield compare(quantity, found, known, 5e-4, TABLE)
    power = reference.friction_power(FORCE, INNER, OUTER, FRICTION, 0.1)
    found = result.summary["friction_power_W"]
    yield compare("friction power, b = 1, hot [W]", found, power, 1e-6, CLOSED_FORM)


def _state(speed: float) -> str:
    return "hot" if speed else "cold"
