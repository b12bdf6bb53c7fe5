"""Friction, wear and conductance that depend on the state that they lead to."""

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import ComputationError
from thermowear.laws import LocalState

from ..case.starter import solved, tables

BLOCKS = "stacked-blocks"
COLD = 293.15
STEPS = ["steady", "initial"]


def mean_rise(result):
    i = result.interface
    return float((i.temperature_1 + i.temperature_2).mean() / 2) - COLD


@pytest.fixture(scope="module")
def nominal():
    return mean_rise(solved(BLOCKS))


def jump(nominal, start, end, factor, analysis):
    """Friction that changes between two parts of the rise that constant friction leads to."""
    at = [f"{20 + part * nominal} degC" for part in (start, end)]
    return {
        "contact.friction_factor.temperature": {"at": at, "factor": [1.0, factor]},
        "analysis": {"type": analysis},
    }


@pytest.mark.parametrize("analysis", STEPS)
@pytest.mark.parametrize(
    ("start", "end", "factor", "reached"),
    [(1.02, 1.05, 3.0, 1.0), (1.2, 1.3, 3.0, 1.0), (0.95, 0.99, 3.0, 3.0), (0.5, 2.5, 0.2, None)],
)
def test_of_several_states_the_one_that_slow_heating_reaches(
    nominal, start, end, factor, reached, analysis
):
    """requirement: the coolest one; only where it does not exist the hot one. Falling: the only."""
    rise = mean_rise(solved(BLOCKS, jump(nominal, start, end, factor, analysis))) / nominal
    if reached is None:  # rise = 1 - (rise - 0.5) 0.8/2
        reached = (1 + 0.5 * 0.4) / 1.4
    assert rise == pytest.approx(reached, rel=1e-8)


@pytest.mark.parametrize("analysis", STEPS)
def test_none_found(nominal, analysis):
    """requirement: friction that falls all at once leads back and forth; one line says so."""
    changes = jump(nominal, 0.9, 0.9001, 0.1, analysis)
    with pytest.raises(ComputationError, match="reduce the speed") as caught:
        solved(BLOCKS, changes)
    assert "\n" not in str(caught.value)


def test_runaway():
    """requirement: friction that rises steeply takes unworn faces beyond the critical speed."""
    rising = {"at": ["20 degC", "60 degC"], "factor": [1.0, 4000.0]}
    changes = {
        "motion.angular_velocity": "0.02 rad/s",
        "mesh.degree": 3,
        "contact.friction_factor.temperature": rising,
        "analysis": {"type": "initial"},
    }
    with pytest.raises(ComputationError) as caught:
        solved("annular-punch", changes)
    assert "\n" not in str(caught.value)


def test_changed_friction_enters_the_traction():
    """requirement: a factor by speed is the same as that much friction, in pressure and guide."""
    doubled = {"at": ["0 mm/s"], "factor": [2.0]}
    unworn = {"analysis": {"type": "initial"}, "mesh.degree": 3}
    changed = solved("punch-on-strip", unworn | {"contact.friction_factor.speed": doubled})
    nominal = solved("punch-on-strip", unworn | {"contact.friction": 0.6})
    half = solved("punch-on-strip", unworn)
    pressures = [result.interface.pressure for result in (changed, nominal, half)]
    np.testing.assert_allclose(pressures[0], pressures[1], rtol=1e-9)
    assert np.abs(pressures[0] - pressures[2]).max() > 0.01 * pressures[0].max()
    assert changed.summary["guide_force_N"] == pytest.approx(nominal.summary["guide_force_N"])
    assert changed.summary["equilibrium_relative_error"] < 1e-9
    assert changed.summary["friction_mean"] == pytest.approx(0.6)
    assert changed.summary["friction_min"] == changed.summary["friction_max"]
    assert "friction_mean" not in nominal.summary


def test_brake_fade():
    """requirement: hot linings rub less; the summary's mean friction is force over force."""
    result = solved("disk-brake-fading")
    summary, i = result.summary, result.interface
    case = tw.load(tables("disk-brake-fading"))
    mean = (i.temperature_1 + i.temperature_2) / 2
    state = LocalState(i.pressure, 20 * i.x, mean)
    friction = 0.4 * case.contact.friction_factor.multipliers.value(state)
    np.testing.assert_allclose(
        i.heat_flux_1 + i.heat_flux_2, friction * i.pressure * 20 * i.x, rtol=1e-8
    )
    assert summary["friction_min"] == pytest.approx(friction.min())
    assert summary["friction_max"] == pytest.approx(friction.max())
    ratio = summary["friction_force_N"] / summary["normal_force_N"]
    assert summary["friction_mean"] == pytest.approx(ratio)
    assert ratio < 0.3
