"""Temperatures in time: half-spaces that start to slide, against exact solutions."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from mpi4py import MPI

import numpy as np

from ...case.tables.schema import Case
from ...reference.step_flux import HalfSpace, surface_rises
from ...results import Result
from ...simulation.analyses.positioning import prepare
from ...simulation.from_case import model_of
from ...simulation.interface.factory import interface_problem
from ...simulation.interface.interface_problem import InterfaceProblem
from ...simulation.interface.sdirk import InterfaceState, advance
from ...timer import Phases
from ..check import Check, compare, compare_worst
from ..computed import computed
from ..starter import starter

SOURCE = "Carslaw and Jaeger, Conduction of Heat in Solids, 1959, section 2.9"
SCHEME = "Alexander, SIAM J. Numer. Anal. 14 (1977) 1006"
UPPER, LOWER = HalfSpace(50.0, 7800.0 * 460), HalfSpace(15.0, 8000.0 * 500)
HEAT, AMBIENT = 0.2 * 5e6 * 0.1, 293.15
TIMES = (0.1, 0.3, 1.0, 3.0)
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
STEPS = (2, 4, 8, 16)
FINEST = 64


def checks() -> Iterator[Check]:
    """Both faces over two decades of time, the heat balance, the order of the time integration."""
    for name, partition, conductance in HEATED:
        yield from _temperatures(
            computed(heated(partition, conductance)), name, partition, conductance
        )
    yield from _orders()


def heated(partition: float, conductance: float) -> Case:
    """Two half-spaces that start to slide, with a heat partition and conductance."""
    times = ",".join(f'"{t:g} s"' for t in TIMES)
    own = [f"heat.partition={partition}", f"analysis.output_times=[{times}]"]
    without = ["wear", "heat.temperature"]
    if conductance == inf:
        without.append("heat.conductance")
    else:
        own.append(f'heat.conductance="{conductance} W/(m^2 K)"')
    return starter("stacked-blocks", *DEEP, *own, without=tuple(without))


def _temperatures(
    result: Result, name: str, partition: float, conductance: float
) -> Iterator[Check]:
    """Face temperatures at the points of largest deviation from the exact solution."""
    states = result.outputs | {END: result.interface}
    for time, state in states.items():
        exact = surface_rises((UPPER, LOWER), HEAT, time, partition, conductance)
        for body, known in enumerate(map(float, exact), 1):
            if known < 1e-3 * float(np.max(exact)):  # of the body without heat input
                continue
            rises = getattr(state, f"temperature_{body}") - AMBIENT
            quantity = f"rise of body {body} at {time:g} s, {name} [K]"
            yield compare_worst(quantity, rises, known, 1e-3, SOURCE)
    yield balance(result, name)


def balance(result: Result, name: str) -> Check:
    """Energy balance in the step with the largest error."""
    worst = max(result.heat, key=lambda row: row.balance_error)
    gone = worst.heat_stored + worst.heat_lost
    quantity = f"heat stored and lost in the step of largest balance error, {name} [J]"
    return compare(quantity, gone, worst.heat_in, 1e-9, "energy balance")


def _orders() -> Iterator[Check]:
    """Convergence order in time, from equal steps that are halved successively."""
    problem = interface_problem(prepare(model_of(heated(0.5, 1e4)), MPI.COMM_WORLD, Phases()))
    start = problem.start()
    warm = _march(problem, start, 0.0, 1.0, FINEST)
    for name, state, begin in (("from 1 s on", warm, 1.0), ("from the start on", start, 0.0)):
        finest = _march(problem, state, begin, begin + 1.0, FINEST * STEPS[0])
        errors = [
            _difference(_march(problem, state, begin, begin + 1.0, steps), finest)
            for steps in STEPS
        ]
        order = float(np.log2(errors[-2] / errors[-1]))
        yield compare(f"order in time, {name} [1]", order, 2.0, 0.05, SCHEME)


def _march(
    problem: InterfaceProblem, state: InterfaceState, begin: float, end: float, steps: int
) -> InterfaceState:
    """State after equal steps from begin to end."""
    step = (end - begin) / steps
    for k in range(steps):
        state = advance(problem, state, begin + k * step, step)
    return state


def _difference(state: InterfaceState, other: InterfaceState) -> float:
    """Largest difference of the face temperatures [K]."""
    assert state.faces is not None
    assert other.faces is not None
    return float(np.abs(np.subtract(state.faces.rise, other.faces.rise)).max())
