"""Band of friction heat moving on a half-space: Jaeger's moving heat source.

A guided punch with uniform pressure on a long and high strip; all of the friction heat goes into
the strip, which advects it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....reference.heat import PEAKS, MovingBand
from ....results import Result
from ...check import Check, compare, compare_worst, run_starter

JAEGER = "J. C. Jaeger, J. Proc. Roy. Soc. New South Wales 76 (1942) 203"
BALANCE = "energy balance"
DOMAIN = "same case on a strip of half the length and height"
SHOWN = (0.5, 1.0, 5.0, 10.0, 20.0)
FAST = 100.0
HALF_WIDTH, CONDUCTIVITY, DIFFUSIVITY = 1e-3, 50.0, 1e-5
PRESSURE, FRICTION, AMBIENT = 10e6, 0.3, 293.15


def moving_band() -> Iterator[Check]:
    """Slow to fast motion, in terms of ``L = v b/(2 κ)``."""
    for L in SHOWN:
        yield from _rises(passed(L), L)
    large, small = (
        passed(SHOWN[0], reach=size * _reach(SHOWN[0])).summary["max_temperature_K"] - AMBIENT
        for size in (2, 1)
    )
    yield compare(f"largest rise, L = {SHOWN[0]:g}, large strip [K]", large, small, 1e-3, DOMAIN)
    result = passed(FAST)
    yield from _rises(result, FAST)
    yield from _smooth(result)


def band(L: float) -> MovingBand:
    """Moving source equivalent to the punch."""
    speed = 2 * DIFFUSIVITY * L / HALF_WIDTH
    return MovingBand(FRICTION * PRESSURE * speed, HALF_WIDTH, speed, CONDUCTIVITY, DIFFUSIVITY)


def _reach(L: float) -> float:
    """Length of the strip to both sides in half-widths: heat diffuses about ``b/L`` ahead."""
    return max(10.0, 10.0 / L)


def passed(L: float, reach: float | None = None, *overrides: str) -> Result:
    """Strip under the punch."""
    reach = reach or _reach(L)
    return run_starter(
        "punch-on-strip",
        f'geometry.width="{2 * HALF_WIDTH} m"',
        f'geometry.height="{HALF_WIDTH} m"',
        f'geometry.strip_length="{2 * reach * HALF_WIDTH} m"',
        f'geometry.strip_height="{0.6 * reach * HALF_WIDTH} m"',
        f'bodies.punch.conductivity="{CONDUCTIVITY} W/(m K)"',
        'bodies.punch.density="5000 kg/m^3"',
        f'bodies.punch.specific_heat="{CONDUCTIVITY / DIFFUSIVITY / 5000} J/(kg K)"',
        f'load.force="{PRESSURE * 2 * HALF_WIDTH * 0.01} N"',
        f'motion.velocity="{-band(L).speed} m/s"',  # of the punch; the strip moves along +x
        f"contact.friction={FRICTION}",
        'heat.conductance="1e-9 W/(m^2 K)"',
        "heat.partition=0",
        'heat.advection="resolved"',
        *overrides,
    )


def surface(result: Result) -> tuple[np.ndarray, np.ndarray]:
    """Positions x along the strip's face [m], and temperature rise there [K]."""
    points, rise = _strip(result)
    top = np.abs(points[..., 1]) < 1e-9 * HALF_WIDTH
    x = points[..., 0][top]
    order = np.argsort(x)
    return x[order], rise[top][order]


def _strip(result: Result) -> tuple[np.ndarray, np.ndarray]:
    """Points of the strip, and temperature rise there [K]."""
    assert result.fields is not None
    (fields,) = result.fields.blocks
    assert fields.temperature is not None
    own = fields.body == 2
    return fields.points[own], fields.temperature[own] - AMBIENT


def _rises(result: Result, L: float) -> Iterator[Check]:
    """Largest rise, rise under the band, and heat balance."""
    summary, source = result.summary, band(L)
    peak = PEAKS[L] * source.scale
    found = summary["max_temperature_K"] - AMBIENT
    yield compare(f"largest rise, L = {L:g} [K]", found, peak, 1e-3, JAEGER)
    interface = result.interface
    rise, exact = interface.temperature_2 - AMBIENT, source.rise(-interface.x)
    quantity = (
        f"rise under the band at the point of largest deviation, L = {L:g}, of the largest [K]"
    )
    yield compare_worst(quantity, rise, exact, 1e-3, JAEGER, peak)
    error = summary["heat_balance_relative_error"]
    yield compare(f"relative error of the heat balance, L = {L:g}", error, 0.0, 1e-9, BALANCE, 1.0)
    lost = summary["heat_carried_out_W"] + summary["heat_cooled_W"]
    quantity = f"heat advected out and removed by cooling, L = {L:g} [W]"
    yield compare(quantity, lost, summary["friction_power_W"], 1e-9, BALANCE)


def _smooth(result: Result) -> Iterator[Check]:
    """No undershoot below the inflow temperature, and monotonic rise up to the band."""
    x, rise = surface(result)
    for name, value in (
        ("rise below zero", min(0.0, float(_strip(result)[1].min()))),
        ("rise that falls ahead of the band", np.diff(rise[x < -HALF_WIDTH]).min(initial=0.0)),
        ("rise that grows behind it", np.diff(rise[x > HALF_WIDTH]).max(initial=0.0)),
    ):
        quantity = f"{name}, L = {FAST:g}, of the largest [K]"
        yield compare(quantity, value, 0.0, 1e-3, JAEGER, rise.max())
