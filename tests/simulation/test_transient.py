"""Running-in of the annular punch."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

import thermowear as tw
from thermowear.reference import annular_punch as reference
from thermowear.simulation import time_loop as transient
from thermowear.simulation.interface.sdirk import TrialStep
from thermowear.simulation.time_loop import next_step

from ..conftest import COLD_RUNNING_IN, HOT, cold_tables, wear_law
from ..systems import built

FORCE = 50e6 * np.pi * (0.12**2 - 0.02**2)


def states(result):
    """Interfaces by time, the end included."""
    return result.outputs | {result.history[-1].time: result.interface}


def test_few_steps(running_in):
    """requirement: 8T in at most 200 steps (its table is a verification case)."""
    assert len(running_in.history) - 1 <= 200


def test_output_times_are_hit_exactly(running_in):
    """requirement: results at output times exactly."""
    times = [row.time for row in running_in.history]
    assert set(running_in.outputs) == {1.0, 5.0, 20.0, 50.0, 100.0}
    assert set(running_in.outputs) < set(times)
    assert times[-1] == 200.0
    steps = np.array([row.step for row in running_in.history[1:]])
    np.testing.assert_allclose(np.diff(times), steps, rtol=1e-9)


def test_wear_never_goes_back_and_contact_stays_admissible(running_in):
    """requirement: p >= 0 at every point, wear grows, no penetration to 1e-3 of it."""
    ordered = [state for _, state in sorted(states(running_in).items())]
    for before, after in itertools.pairwise(ordered):
        assert np.all(after.wear_1 >= before.wear_1)
    for state in ordered:
        assert state.pressure.min() >= 0.0
        assert state.gap.min() > -1e-3 * np.ptp(state.shape)
        assert state.weight @ state.pressure == pytest.approx(FORCE, rel=1e-10)


def test_volume_follows_archard(running_in):
    """requirement: V = k ∫∫ p v dA dt; the rate at the end is that of the steady state."""
    i = running_in.interface
    volume = np.array([row.wear_volume_1 for row in running_in.history])
    time = np.array([row.time for row in running_in.history])
    assert i.weight @ i.wear_1 == pytest.approx(volume[-1], rel=1e-12, abs=0.0)
    area = np.pi * (0.12**2 - 0.02**2)
    rate = (volume[-1] - volume[-2]) / (time[-1] - time[-2])
    assert rate == pytest.approx(1.75e-6 * area, rel=1e-4)


def test_tolerance_rules_the_error():
    """requirement: a tighter tolerance moves the result by no more than promised."""

    def pressures(tolerance):
        case = tw.load(
            COLD_RUNNING_IN,
            (
                "mesh.degree=4",
                "analysis.end_time=5 s",
                'analysis.output_times=["1 s"]',
                f"analysis.tolerance={tolerance}",
            ),
        )
        result = tw.run(case)
        return result.outputs[1.0].pressure, len(result.history)

    (loose, few), (good, some), (exact, many) = map(pressures, (1e-3, 1e-4, 1e-7))
    errors = [np.abs(p - exact).max() / exact.max() for p in (loose, good)]
    assert errors[1] < 1e-3
    assert errors[1] < errors[0] / 2
    assert few < some < many


def test_second_order_in_time():
    """requirement: the error of the wear step falls with the square of its size."""
    from thermowear.simulation.interface.interface_problem import interface_problem
    from thermowear.simulation.interface.sdirk import advance

    case = tw.load(COLD_RUNNING_IN, ("mesh.degree=3", "mesh.elements=8"))
    problem = interface_problem(built(case))
    state = problem.start()
    for _ in range(40):  # let the singular start pass
        state = advance(problem, state, 0.0, 0.05)

    def after(steps):
        run = state
        for _ in range(steps):
            run = advance(problem, run, 0.0, 4.0 / steps)
        return run.worn

    exact = after(256)
    errors = [np.abs(after(n) - exact).max() for n in (4, 8, 16)]
    slopes = np.diff(np.log(errors)) / np.log(0.5)
    assert slopes == pytest.approx([2.0, 2.0], abs=0.25)


@pytest.mark.parametrize("b", [pytest.param(0.5, marks=pytest.mark.slow), 2.0])
def test_other_exponents_end_at_their_steady_pressure(b):
    """requirement: the loop over time and the principle end at the same pressure, any b."""
    tables = cold_tables(COLD_RUNNING_IN)
    tables["analysis"] = {"type": "transient", "until": "steady", "steady_tolerance": 2e-4}
    result = tw.run(tw.load(tables, (*wear_law(b), "mesh.degree=6")))
    i = result.interface
    exact = reference.steady_pressure(i.x, FORCE, 0.02, 0.12, b)
    assert np.abs(i.pressure - exact).max() <= 1e-3 * exact.max()
    assert result.summary["distance_from_steady"] <= 2e-4


def test_both_bodies_wear_in_time():
    """requirement: two wearing bodies: depths in the ratio of their coefficients."""
    tables = cold_tables(COLD_RUNNING_IN)
    tables["wear"]["plate"] = dict(tables["wear"]["punch"]) | {"coefficient": "1e-7 1/MPa"}
    tables["analysis"] = {"type": "transient", "end_time": "10 s"}
    result = tw.run(tw.load(tables, ("mesh.degree=3",)))
    i, last = result.interface, result.history[-1]
    np.testing.assert_allclose(i.wear_1, 2 * i.wear_2, rtol=1e-9)
    volumes = (i.weight @ i.wear_1, i.weight @ i.wear_2)
    assert (last.wear_volume_1, last.wear_volume_2) == pytest.approx(volumes, rel=1e-12, abs=0.0)
    summary = result.summary
    assert (summary["wear_volume_1_m3"], summary["wear_volume_2_m3"]) == pytest.approx(volumes)
    assert min(volumes) > 0


@pytest.fixture(scope="module")
def hot_running_in():
    import tomllib

    tables = tomllib.loads(HOT.read_text(encoding="utf-8"))
    tables["analysis"] = {"type": "transient", "until": "steady", "steady_tolerance": 2e-4}
    return tw.run(tw.load(tables, ("mesh.degree=5",)))


def test_hot_running_in_ends_where_the_principle_says(hot_running_in):
    """requirement: same pressure as cold (1e-3), shape of the direct hot steady state (1e-3)."""
    end = hot_running_in.interface
    cold = reference.steady_pressure(end.x, FORCE, 0.02, 0.12, 1.0)
    assert np.abs(end.pressure / cold - 1).max() <= 1e-3
    shape = tw.run(tw.load(HOT, ("mesh.degree=5",))).interface.shape
    difference = end.shape - shape
    difference -= np.average(difference, weights=end.weight)
    assert np.abs(difference).max() <= 1e-3 * np.ptp(shape)


def test_hot_running_in_separates_and_closes(hot_running_in):
    """requirement: the active set changes on the way; heat and forces balance at the end."""
    areas = np.array([row.contact_area for row in hot_running_in.history])
    full = np.pi * (0.12**2 - 0.02**2)
    assert areas[0] < 0.9 * full
    assert areas[-1] == pytest.approx(full, rel=1e-9)
    temperatures = [row.max_temperature for row in hot_running_in.history]
    assert temperatures[0] > temperatures[-1] > 293.15
    assert hot_running_in.summary["heat_balance_relative_error"] < 1e-9
    assert hot_running_in.summary["equilibrium_relative_error"] < 1e-9


def unworn(speed, *more):
    """Contact of the unworn hot ring at a speed [rad/s]."""
    changes = (f'motion.angular_velocity="{speed} rad/s"', "analysis.type=initial", *more)
    return tw.run(tw.load(HOT, ("mesh.degree=3", *changes)))


@pytest.mark.parametrize("speed", [pytest.param(0.3, marks=pytest.mark.slow), 0.6])
def test_contact_that_heat_makes_small(speed):
    """
    requirement: beyond the critical speed of the full face (0.14 rad/s) the ring stands on its
    inner edge; Nitsche's method on the full system finds the same state by Newton's method.
    """
    fine = ("mesh.elements=24",)
    expected = unworn(speed, *fine, "contact.method=nitsche")
    found = unworn(speed, *fine)
    assert np.ptp(found.interface.x[found.interface.pressure > 0]) < 0.045  # of 0.1 m
    hottest, hotter = (each.summary["max_temperature_K"] for each in (found, expected))
    assert hottest - 293.15 == pytest.approx(hotter - 293.15, rel=3e-3)
    assert found.summary["approach_m"] == pytest.approx(expected.summary["approach_m"], rel=5e-3)


def test_contact_that_heat_makes_small_is_similar():
    """requirement: a ring of twice the size with half the conductances and a quarter of the speed
    has the same pressures and temperatures; the lengths are doubled.
    """
    sizes = {"inner_radius": 40, "outer_radius": 240, "punch_height": 100}
    sizes |= {"plate_radius": 280, "plate_height": 200}
    doubled = [f'geometry.{key}="{size} mm"' for key, size in sizes.items()]
    doubled.append('heat.conductance="5e5 W/(m^2 K)"')
    doubled += [f'heat.cooling.{at}="1000 W/(m^2 K)"' for at in ("punch_top", "plate_bottom")]
    one, two = unworn(0.6).summary, unworn(0.15, *doubled).summary
    assert one["contact_area_m2"] < 0.1 * FORCE / 50e6
    ratios = {"contact_area_m2": 4.0, "max_pressure_Pa": 1.0, "max_temperature_K": 1.0}
    for key, ratio in (ratios | {"approach_m": 2.0, "friction_power_W": 2.0}).items():
        assert two[key] == pytest.approx(ratio * one[key], rel=1e-7)


def test_far_beyond_the_critical_speed_the_run_says_so():
    """requirement: a contact zone below the size of an element is an error or a large estimate."""
    assert unworn(5.0).summary["max_pressure_error_estimate_relative"] > 0.1
    with pytest.raises(tw.ComputationError, match="instability"):
        unworn(50.0)


def test_too_few_steps_keep_what_was_computed():
    """requirement: failures keep what was computed."""
    result = tw.run(tw.load(COLD_RUNNING_IN, ("mesh.degree=2", "analysis.max_steps=5")))
    assert isinstance(result.stopped, tw.ComputationError)
    assert "max_steps" in str(result.stopped)
    assert len(result.history) == 6
    assert 0 < result.summary["time_s"] < 200


def test_a_first_time_may_be_tiny():
    """requirement: a time to be hit that is smaller than any step ends no run."""
    small = ("mesh.degree=2", "mesh.elements=2", "analysis.end_time=1 s")
    times = 'analysis.output_times=["1e-30 s"]'
    result = tw.run(tw.load(COLD_RUNNING_IN, (*small, times)))
    assert result.stopped is None
    assert [row.time for row in result.history][:2] == [0.0, 1e-30]


@pytest.mark.parametrize("pointwise", [None, np.ones(3, dtype=bool)])
def test_a_jump_of_the_pressure_is_located_and_passed(monkeypatch, pointwise):
    """requirement: what no step makes small ends the run, but for points that press at once where
    contact holds point by point; then the step that is taken is far smaller than the first."""
    state = SimpleNamespace(pointwise=pointwise)
    tried = []

    def advanced(problem, before, time, step):
        tried.append(step)
        return TrialStep(state, 0.1)

    monkeypatch.setattr(transient, "advance_with_error", advanced)
    settings = SimpleNamespace(tolerance=1e-3, type="transient")
    last = SimpleNamespace(state=state, time=0.0, step=0.0, error=0.0, wanted=1.0)
    steps = transient._Steps(None, settings, None, SimpleNamespace(rounding=1.0))
    words = last, lambda wanted: wanted, 1e-12
    if pointwise is None:
        with pytest.raises(tw.ComputationError, match="no step is small enough at 0 s"):
            steps._accept(*words)
        return
    trial, step, following = steps._accept(*words)
    assert trial.state is state
    assert trial.error == 0.1
    assert step == tried[-1] <= 1e-3 * tried[0] < tried[-2]
    assert following > step


def test_steps_grow_by_what_errors_have_done():
    """requirement: third power of smooth errors; where they grow less, steps grow more."""
    smooth = next_step(2.0, 8e-5, 1e-3, (1.0, 1e-5))
    assert smooth == pytest.approx(2.0 * 0.9 * (1e-3 / 8e-5) ** (1 / 3), rel=1e-12)
    assert next_step(2.0, 6e-5, 1e-3, (1.0, 6e-5)) == pytest.approx(
        4.0 * 0.9 * (1e-3 / 6e-5) ** (1 / 3), rel=1e-12
    )
    assert next_step(2.0, 2e-6, 1e-3, (1.0, 6e-5)) == pytest.approx(10.0)
    assert next_step(2.0, 8e-3, 1e-3, (1.0, 6e-2)) == pytest.approx(0.9)
    assert next_step(2.0, 8e-4, 1e-3) == pytest.approx(1.8 * 1.25 ** (1 / 3))
