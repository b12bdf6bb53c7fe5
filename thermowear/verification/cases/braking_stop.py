"""Braking to a stop: wide blocks against the exact solution, a car brake against its energy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.braking import highest_rise, surface_rise
from ...results import Result
from ..check import Check, compare
from ..computed import computed
from ..starter import run_starter, starter
from .step_flux import AMBIENT, DEEP, HEAT, LOWER, UPPER, balance

EXACT = "Duhamel's integral; Fazekas, SAE Technical Paper 530221, 1953"
ENERGY = "energy over heat capacity, by hand"
STOP, TIMES = 4.0, (1.0, 2.0, 3.0, 4.0, 6.0)
FORCE, FRICTION, SPEED, RISE = 7.9e3, 0.4, 92.6, 0.2
ARM = 2 / 3 * (0.13**3 - 0.08**3) / (0.13**2 - 0.08**2)
"""Mean radius of the pads [m]."""
DISK_CAPACITY = 7200.0 * 480 * np.pi * (0.135**2 - 0.05**2) * 6e-3
"""Heat capacity of half the disk [J/K]."""


def checks() -> Iterator[Check]:
    """Half-spaces, the starter case, and a disk that stores all of the heat."""
    yield from _wide_blocks()
    yield from _starter(run_starter("disk-brake-stop"))
    yield from _insulated_disk()


def _wide_blocks() -> Iterator[Check]:
    """Both faces of half-spaces in perfect contact, during and after the stop."""
    times = ",".join(f'"{time:g} s"' for time in TIMES)
    case = starter(
        "stacked-blocks",
        *DEEP,
        'motion.history.time=["0 s", "4 s"]',
        "motion.history.factor=[1, 0]",
        f"analysis.output_times=[{times}]",
        without=("wear", "heat.temperature", "heat.conductance"),
    )
    result = computed(case)
    both = UPPER.effusivity + LOWER.effusivity
    for time in TIMES:
        known = float(surface_rise(both, HEAT, STOP, time))
        for body in (1, 2):
            found = getattr(result.outputs[time], f"temperature_{body}").mean() - AMBIENT
            yield compare(f"rise of body {body} at {time:g} s [K]", found, known, 1e-3, EXACT)
    highest = result.summary["peak_temperature_K"] - AMBIENT
    yield compare("highest rise [K]", highest, highest_rise(both, HEAT, STOP), 2e-3, EXACT)
    slid = result.history[-1].sliding_distance
    yield compare("sliding distance [m]", slid, 0.1 * STOP / 2, 1e-12, "half of v t")
    yield balance(result, "wide blocks")


def _starter(result: Result) -> Iterator[Check]:
    """Energy balance in each step, and integral of the friction power."""
    yield balance(result, "car")
    time = np.array([row.time for row in result.heat])
    power = np.array([row.friction_power for row in result.heat])
    made, known = result.summary["heat_in_J"], float(np.trapezoid(power, time))
    yield compare("friction heat, car [J]", made, known, 1e-3, "integral of the friction power")
    slid = result.history[-1].sliding_distance
    distance = SPEED * ARM * STOP / 2
    yield compare("sliding distance, car [m]", slid, distance, 1e-9, "half of v t")


def _insulated_disk() -> Iterator[Check]:
    """Disk that receives all of the heat without losses: its temperature becomes uniform."""
    result = run_starter(
        "disk-brake-stop",
        "heat.partition=0",
        'heat.conductance="1e-3 W/(m^2 K)"',
        'analysis.end_time="5000 s"',
        without=("heat.cooling",),
    )
    yield balance(result, "insulated disk")
    made, last = result.summary["heat_in_J"], result.heat[-1]
    expected = made / DISK_CAPACITY
    for which in ("mean", "max"):
        rise = getattr(last, f"{which}_temperature_2") - AMBIENT
        quantity = f"{which} rise of the insulated disk's face in the end [K]"
        yield compare(quantity, rise, expected, 1e-3, ENERGY)
    # torque for a uniform pressure, which is an approximation
    under_way = RISE / 2 - RISE**2 / (3 * STOP) + (STOP - RISE) ** 2 / (2 * STOP)
    work = FRICTION * FORCE * ARM * SPEED * under_way
    yield compare("friction heat, insulated disk [J]", made, work, 2e-2, "torque times angle")
