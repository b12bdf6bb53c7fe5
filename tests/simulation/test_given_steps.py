"""Time steps of an earlier run, taken again without error control."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.simulation.analyses.run import run
from thermowear.simulation.from_case.analysis import analysis_of, model_of
from thermowear.simulation.interface import sdirk
from thermowear.simulation.interface.interface_problem import InterfaceProblem

from ..conftest import COLD_RUNNING_IN, DEMOS, HOT

SMALL = ("mesh.degree=3", "mesh.elements=3")
HEATED = (
    *SMALL,
    "analysis.type=transient",
    "analysis.end_time=200 s",
    'analysis.output_times=["20 s", "100 s"]',
)
IN_TIME = (
    "heat.transient=true",
    'bodies.punch.density="7800 kg/m^3"',
    'bodies.punch.specific_heat="500 J/kg/K"',
)
UPDATED = (*SMALL, "analysis.end_time=40 h", "analysis.output_times=[]")
CASES = {
    "cold": (COLD_RUNNING_IN, SMALL),
    "hot": (HOT, HEATED),
    "hot in time": (HOT, (*HEATED, *IN_TIME)),
    "growing": (
        DEMOS / "cylinder_on_block_growing.toml",
        ("analysis.end_time=1 s", "analysis.output_times=[]"),
    ),
    "reciprocating": (DEMOS / "punch_on_strip_reciprocating.toml", ("mesh.elements=6",)),
    "geometry updates": (DEMOS / "annular_punch_deep.toml", UPDATED),
}
DERIVED = ("cold", "hot", "hot in time")
COLUMNS = ("max_pressure", "wear_volume_1", "wear_volume_2", "max_temperature", "approach")


def case_of(name, *overrides):
    """Case by its name in `CASES`."""
    path, small = CASES[name]
    return tw.load(path, (*small, *overrides))


def solved(case, steps=()):
    """Result of a case, with given ends of steps [s]."""
    return run(model_of(case), replace(analysis_of(case), steps=tuple(steps)))


def ends(result):
    """Ends of the steps of a result [s]."""
    return tuple(row.time for row in result.history[1:])


def worn(result):
    """Worn volume and largest depth of body 1 at all output times and at the end."""
    of = [*result.outputs.values(), result.interface]
    return np.array([[one.weight @ one.wear_1, one.wear_1.max()] for one in of])


@pytest.mark.parametrize("name", CASES)
def test_given_steps_repeat_a_run(name):
    """requirement: all states of the run with error control, to rounding; no error is known."""
    case = case_of(name)
    first = solved(case)
    again = solved(case, ends(first))
    assert first.stopped is again.stopped is None
    assert len(first.history) > 6
    assert ends(again) == ends(first)
    assert list(again.outputs) == list(first.outputs)
    assert np.isnan([row.error for row in again.history[1:]]).all()
    updates = first.summary.get("geometry_updates", 0)
    assert again.summary.get("geometry_updates", 0) == updates
    assert (updates > 1) == (name == "geometry updates")
    tolerance = 1e-10 if updates else 1e-11 if name == "reciprocating" else 1e-12
    for key in COLUMNS:
        one, other = ([getattr(row, key) for row in of.history] for of in (again, first))
        largest = np.abs(other).max()
        np.testing.assert_allclose(one, other, rtol=0.0, atol=tolerance * largest, err_msg=key)
    for key in ("pressure", "wear_1", "temperature_1"):
        one, other = (getattr(of.interface, key) for of in (again, first))
        largest = np.abs(other).max()
        np.testing.assert_allclose(one, other, rtol=0.0, atol=tolerance * largest, err_msg=key)


@pytest.mark.parametrize("name", DERIVED)
def test_results_at_given_steps_are_smooth(name):
    """
    requirement: difference quotients of volumes and depths for changes of the wear coefficient by
    1e-6 and 1e-7 agree to 1e-5, at all output times.
    """
    first = solved(case_of(name))
    steps, before, quotients = ends(first), worn(first), []
    for change in (1e-6, 1e-7):
        coefficient = f'wear.punch.coefficient="{2e-7 * (1 + change)!r} 1/MPa"'
        after = worn(solved(case_of(name, coefficient), steps))
        quotients.append((after - before) / change)
    assert np.all(quotients[0] > 0.3 * before)
    np.testing.assert_allclose(quotients[0], quotients[1], rtol=1e-5)


def test_given_steps_need_no_further_solutions(monkeypatch):
    """requirement: four implicit stages a step, and no limit of the number of steps."""
    case, count = case_of("cold"), []
    steps = ends(solved(case))
    stage = InterfaceProblem.stage

    def counted(*arguments, **more):
        count.append(1)
        return stage(*arguments, **more)

    monkeypatch.setattr(InterfaceProblem, "stage", counted)
    settings = replace(analysis_of(case), steps=steps, max_steps=3)
    assert run(model_of(case), settings).stopped is None
    assert len(count) == 4 * len(steps)


def test_a_run_to_the_steady_state_is_repeated():
    """requirement: the last of the given steps ends the run, however far the steady state is."""
    case = case_of("cold", "analysis.until=steady", "analysis.steady_tolerance=0.02")
    steps = ends(solved(case))
    again = solved(case_of("cold", "analysis.until=steady"), steps)
    assert ends(again) == steps
    assert again.summary["distance_from_steady"] > 1e-3


@pytest.mark.parametrize(
    ("steps", "words"),
    [
        ((1.0, 5.0, 4.0), "must increase"),
        ((0.0, 1.0), "must increase"),
        ((1.0, 5.0, 20.0, 50.0, 100.0, 200.0, 201.0), "to the end time at most"),
        ((1.0, 4.0, 20.0), "none of the given time steps ends at 5 s"),
    ],
)
def test_wrong_steps_are_refused(steps, words):
    """requirement: steps that do not increase, go beyond the end, or miss an output time."""
    stopped = solved(case_of("cold"), steps).stopped
    assert isinstance(stopped, tw.ComputationError)
    assert words in str(stopped)


def test_a_given_step_that_fails_ends_the_run(monkeypatch):
    """requirement: the error names the step; the states before it are kept."""
    advance = sdirk.advance

    def failing(problem, state, time, step, last=True):
        if time >= 5.0:
            raise tw.ComputationError("no solution")
        return advance(problem, state, time, step, last)

    monkeypatch.setattr(sdirk, "advance", failing)
    found = solved(case_of("cold"), (1.0, 5.0, 20.0))
    assert "the given step from 5 to 20 s failed (no solution)" in str(found.stopped)
    assert ends(found) == (1.0, 5.0)
