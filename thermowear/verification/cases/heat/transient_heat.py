"""Temperatures in time: half-spaces that start to slide, or brake to a stop, and a car brake."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from mpi4py import MPI

import numpy as np

from ....case.tables.schema import Case
from ....reference.heat import HalfSpace, braking_peak, braking_rise, surface_rises
from ....results import Result
from ....simulation.analyses.positioning import prepare
from ....simulation.from_case import model_of
from ....simulation.interface.interface_problem import InterfaceProblem, interface_problem
from ....simulation.interface.sdirk import InterfaceState, advance
from ....timer import Phases
from ...check import Check, compare, compare_worst, computed, run_starter, starter

CARSLAW = "Carslaw and Jaeger, Conduction of Heat in Solids, 1959, section 2.9"
SCHEME = "Alexander, SIAM J. Numer. Anal. 14 (1977) 1006"
FAZEKAS = "Duhamel's integral; Fazekas, SAE Technical Paper 530221, 1953"
ENERGY = "energy over heat capacity, by hand"
UPPER, LOWER = HalfSpace(50.0, 7800.0 * 460), HalfSpace(15.0, 8000.0 * 500)
HEAT, AMBIENT = 0.2 * 5e6 * 0.1, 293.15
END = 10.0
DEEP = (
    'geometry.width="2 mm"',
    'geometry.upper_height="100 mm"',
    'geometry.lower_height="100 mm"',
    "mesh.elements=8",
    "mesh.grading=0.25",
    'bodies.upper.density="7800 kg/m^3"',
    'bodies.upper.specific_heat="460 J/(kg K)"',
    'bodies.lower.density="8000 kg/m^3"',
    'bodies.lower.specific_heat="500 J/(kg K)"',
    "heat.transient=true",
    'analysis.type="transient"',
    f'analysis.end_time="{END} s"',
)
"""Starter case as two half-spaces, deep enough for the duration."""
HEATED = (
    ("heat into one alone", 1.0, 1e-3),
    ("perfect contact", 0.5, inf),
    ("conductance 1e4 W/(m² K)", 0.5, 1e4),
    ("conductance 2e3 W/(m² K), heat set free on body 2", 0.0, 2e3),
)
"""Label, partition and conductance."""
STEPS, FINEST = (2, 4, 8, 16), 64
STOP, STOP_TIMES = 4.0, (1.0, 2.0, 3.0, 4.0, 6.0)
FORCE, FRICTION, SPEED, RISE = 7.9e3, 0.4, 92.6, 0.2
ARM = 2 / 3 * (0.13**3 - 0.08**3) / (0.13**2 - 0.08**2)
"""Mean radius of the pads [m]."""
DISK_CAPACITY = 7200.0 * 480 * np.pi * (0.135**2 - 0.05**2) * 6e-3
"""Heat capacity of half the disk [J/K]."""


def step_flux() -> Iterator[Check]:
    """Both faces over two decades of time, the heat balance, the order of the time integration."""
    for name, partition, conductance in HEATED:
        result = computed(_heated(partition, conductance))
        for time, state in (result.outputs | {END: result.interface}).items():
            exact = surface_rises((UPPER, LOWER), HEAT, time, partition, conductance)
            for body, known in enumerate(map(float, exact), 1):
                if known < 1e-3 * float(np.max(exact)):  # of the body without heat input
                    continue
                rises = getattr(state, f"temperature_{body}") - AMBIENT
                quantity = f"rise of body {body} at {time:g} s, {name} [K]"
                yield compare_worst(quantity, rises, known, 1e-3, CARSLAW)
        yield _balance(result, name)
    yield from _orders()


def _heated(partition: float, conductance: float) -> Case:
    """Two half-spaces that start to slide, with a heat partition and conductance."""
    times = 'analysis.output_times=["0.1 s","0.3 s","1 s","3 s"]'
    own, without = [f"heat.partition={partition}", times], ["wear", "heat.temperature"]
    if conductance == inf:
        without.append("heat.conductance")
    else:
        own.append(f'heat.conductance="{conductance} W/(m^2 K)"')
    return starter("stacked-blocks", *DEEP, *own, without=tuple(without))


def _balance(result: Result, name: str) -> Check:
    """Energy balance in the step with the largest error."""
    worst = max(result.heat, key=lambda row: row.balance_error)
    gone = worst.heat_stored + worst.heat_lost
    quantity = f"heat stored and lost in the step of largest balance error, {name} [J]"
    return compare(quantity, gone, worst.heat_in, 1e-9, "energy balance")


def _orders() -> Iterator[Check]:
    """Convergence order in time, from equal steps that are halved successively."""
    problem = interface_problem(prepare(model_of(_heated(0.5, 1e4)), MPI.COMM_WORLD, Phases()))
    start = problem.start()
    warm = _march(problem, start, 0.0, FINEST)
    for name, state, begin in (("from 1 s on", warm, 1.0), ("from the start on", start, 0.0)):
        finest, *others = (
            _rises(_march(problem, state, begin, steps)) for steps in (FINEST * STEPS[0], *STEPS)
        )
        errors = [float(np.abs(rises - finest).max()) for rises in others]
        order = float(np.log2(errors[-2] / errors[-1]))
        yield compare(f"order in time, {name} [1]", order, 2.0, 0.05, SCHEME)


def _march(
    problem: InterfaceProblem, state: InterfaceState, begin: float, steps: int
) -> InterfaceState:
    """State after equal steps during one second."""
    step = 1.0 / steps
    for k in range(steps):
        state = advance(problem, state, begin + k * step, step)
    return state


def _rises(state: InterfaceState) -> np.ndarray:
    """Temperature rises of both faces [K]."""
    assert state.faces is not None
    return np.array(state.faces.rise)


def braking_stop() -> Iterator[Check]:
    """Braking of half-spaces, of the starter case, and of a disk that stores all of the heat."""
    yield from _wide_blocks()
    result = run_starter("disk-brake-stop")
    yield _balance(result, "car")
    time, power = np.array([(row.time, row.friction_power) for row in result.heat]).T
    made, known = result.summary["heat_in_J"], float(np.trapezoid(power, time))
    yield compare("friction heat, car [J]", made, known, 1e-3, "integral of the friction power")
    slid = result.history[-1].sliding_distance
    distance = SPEED * ARM * STOP / 2
    yield compare("sliding distance, car [m]", slid, distance, 1e-9, "half of v t")
    yield from _insulated_disk()


def _wide_blocks() -> Iterator[Check]:
    """Both faces of half-spaces in perfect contact, during and after the stop."""
    times = ",".join(f'"{time:g} s"' for time in STOP_TIMES)
    result = run_starter(
        "stacked-blocks",
        *DEEP,
        'motion.history.time=["0 s", "4 s"]',
        "motion.history.factor=[1, 0]",
        f"analysis.output_times=[{times}]",
        without=("wear", "heat.temperature", "heat.conductance"),
    )
    both = UPPER.effusivity + LOWER.effusivity
    for time in STOP_TIMES:
        known = float(braking_rise(both, HEAT, STOP, time))
        for body in (1, 2):
            found = getattr(result.outputs[time], f"temperature_{body}").mean() - AMBIENT
            yield compare(f"rise of body {body} at {time:g} s [K]", found, known, 1e-3, FAZEKAS)
    highest, known = result.summary["peak_temperature_K"], braking_peak(both, HEAT, STOP)
    yield compare("highest rise [K]", highest - AMBIENT, known, 2e-3, FAZEKAS)
    slid = result.history[-1].sliding_distance
    yield compare("sliding distance [m]", slid, 0.1 * STOP / 2, 1e-12, "half of v t")
    yield _balance(result, "wide blocks")


def _insulated_disk() -> Iterator[Check]:
    """Disk that receives all of the heat without losses: its temperature becomes uniform."""
    result = run_starter(
        "disk-brake-stop",
        "heat.partition=0",
        'heat.conductance="1e-3 W/(m^2 K)"',
        'analysis.end_time="5000 s"',
        without=("heat.cooling",),
    )
    yield _balance(result, "insulated disk")
    made, last = result.summary["heat_in_J"], result.heat[-1]
    for which in ("mean", "max"):
        rise = getattr(last, f"{which}_temperature_2") - AMBIENT
        quantity = f"{which} rise of the insulated disk's face in the end [K]"
        yield compare(quantity, rise, made / DISK_CAPACITY, 1e-3, ENERGY)
    # torque for a uniform pressure, which is an approximation
    under_way = RISE / 2 - RISE**2 / (3 * STOP) + (STOP - RISE) ** 2 / (2 * STOP)
    work = FRICTION * FORCE * ARM * SPEED * under_way
    yield compare("friction heat, insulated disk [J]", made, work, 2e-2, "torque times angle")
