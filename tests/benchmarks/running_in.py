"""What a running-in costs: condensed and implicit, against a contact solution at every increment.

The usual way to compute wear solves the finite-element contact problem anew after every explicit
increment. Its cost is bounded from below by one factorisation and one solution of the stiffness
matrix an increment; its increments by stability on this mesh. Both are measured here in one run:

    scripts/env python3 tests/benchmarks/running_in.py
"""

import time

from mpi4py import MPI

import numpy as np

import thermowear as tw
from thermowear.bulk.solvers.direct import DirectSolver
from thermowear.simulation.from_case import analysis_of, model_of
from thermowear.simulation.interface.interface_problem import interface_problem
from thermowear.simulation.interface.steady import steady_state
from thermowear.simulation.system.building import build
from thermowear.simulation.time_loop import moments
from thermowear.timer import Phases


def seconds(action, repeat=3):
    """Median wall time."""
    times = []
    for _ in range(repeat):
        began = time.perf_counter()
        action()
        times.append(time.perf_counter() - began)
    return float(np.median(times))


def largest_stable_increment(system) -> float:
    """Time step at which explicit wear stops converging: 2 over the fastest rate of decay [s]."""
    contact = system.contact
    (law,) = system.laws.values()
    mass = contact.weighted.T @ (law.factor(system.speed)[:, None] * contact.basis)
    rates = np.linalg.eigvals(np.linalg.solve(contact.compliance, mass)).real
    return 2.0 / float(rates.max())


def main():
    case = tw.load("demos/annular_punch_running_in.toml")
    system, settings = build(model_of(case), MPI.COMM_WORLD, Phases()), analysis_of(case)
    condensation = seconds(lambda: system.contact, repeat=1)
    steady = steady_state(system)
    problem = interface_problem(system)
    steps = len(list(moments(problem, settings, steady))) - 1
    implicit = seconds(lambda: list(moments(problem, settings, steady)))

    elastic = system.elastic
    rows = np.flatnonzero(elastic.fixed).astype(np.int32)

    def one_increment():
        matrix = elastic.stiffness.copy()
        matrix.zeroRowsColumns(rows, diag=1e12)
        DirectSolver(matrix).solve(system.trace @ (system.weights * steady.wear.pressure))

    increment = seconds(one_increment)
    explicit_steps = case.analysis.end_time / largest_stable_increment(system)
    print(f"displacement values                {elastic.fixed.size}")
    print(f"condensation, once                 {condensation:.3f} s")
    print(f"implicit running-in, {steps} steps     {implicit:.3f} s")
    print(f"one contact solution an increment  {increment:.3f} s")
    print(f"explicit increments needed         {explicit_steps:.0f}")
    usual = increment * explicit_steps
    print(f"all of them                        {usual:.0f} s")
    print(f"ratio                              {usual / (condensation + implicit):.0f}")


if __name__ == "__main__":
    main()
