"""Temperatures and friction that are given over time, against closed forms."""

from functools import lru_cache

import numpy as np
import pytest

from ..case.starter import GONE, solved
from ..reference.heated_slab import HeatedSlab

BLOCKS, STRIP = "stacked-blocks", "punch-on-strip"
COLD, AREA = 293.15, 1e-4
STORING = {"density": "7800 kg/m^3", "specific_heat": "460 J/(kg K)"}
STEEL = {
    "young_modulus": "210 GPa",
    "poisson_ratio": 0.3,
    "conductivity": "50 W/(m K)",
    "expansion": "1.2e-5 1/K",
} | STORING
SLAB = HeatedSlab(0.03, 50.0, 7800 * 460.0)
RATE, DEPTH = 2.0, 0.01
RAMP = {"time": ["0 s", "100 s"], "temperature": ["20 degC", "220 degC"]}
OUTPUTS = (2.0, 5.0, 10.0, 20.0)
COLUMN = {
    "motion": GONE,
    "wear": GONE,
    "bodies": {"upper": STEEL, "lower": {"like": "upper"}},
    "heat": {"transient": True},
    "analysis": {
        "type": "transient",
        "end_time": "20 s",
        "output_times": {"values": list(OUTPUTS[:-1]), "unit": "s"},
        "tolerance": 1e-3,
    },
    "mesh.degree": 4,
    "mesh.elements": 4,
}
"""One slab of 30 mm, cut at 10 mm by a contact that lets all heat through; insulated below."""


def states(result):
    """Interfaces by time."""
    assert result.stopped is None
    return result.outputs | {result.history[-1].time: result.interface}


def column(rows, name):
    return np.array([getattr(row, name) for row in rows])


HEATED = {
    "ramp": ({"temperature": {"upper_top": RAMP}}, lambda t: SLAB.ramp(RATE, t, DEPTH), 40.0),
    "step": (
        {"temperature": {"upper_top": "120 degC"}},
        lambda t: SLAB.step(100.0, t, DEPTH),
        100.0,
    ),
    "power": ({"power": {"upper_top": "10 W"}}, lambda t: SLAB.flux(1e5, t, DEPTH), 40.0),
}
"""Heating of the top, temperature rise at the contact, and scale of the rise in 20 s [K]."""


@lru_cache
def heated(kind):
    """The column, heated at its top."""
    return solved(BLOCKS, COLUMN | {"heat": {"transient": True} | HEATED[kind][0]})


@pytest.mark.parametrize("kind", HEATED)
def test_heat_comes_through_the_joint_as_through_one_slab(kind):
    """
    requirement: a temperature history and a power in time: the closed form to the tolerance.
    """
    result, (_, exact, hottest) = heated(kind), HEATED[kind]
    found = states(result)
    assert tuple(found) == OUTPUTS
    for time, i in found.items():
        for temperature in (i.temperature_1, i.temperature_2):
            np.testing.assert_allclose(temperature - COLD, exact(time), rtol=0, atol=1e-3 * hottest)
    assert column(result.heat, "balance_error").max() < 1e-10


def test_heat_stored_under_a_ramp_is_that_of_the_closed_form():
    """requirement: heat that a given temperature brings in counts as lost, negative."""
    stored, result = SLAB.ramp_heat(RATE, 20.0) * AREA, heated("ramp")
    last = result.heat[-1]
    assert last.heat_stored == pytest.approx(stored, rel=1e-3)
    assert last.heat_lost == pytest.approx(-stored, rel=1e-3)
    assert last.heat_in == 0.0
    assert result.summary["heat_balance_relative_error"] < 1e-10


def test_a_power_over_time_is_its_integral():
    """requirement: 10 W for 20 s are heat put in; insulated bodies store it all."""
    rows = heated("power").heat
    np.testing.assert_allclose(column(rows, "heat_in"), 10 * column(rows, "time"), rtol=1e-12)
    assert rows[-1].heat_stored == pytest.approx(200.0, rel=1e-9)
    assert rows[-1].heat_lost == pytest.approx(0.0, abs=1e-9)


def test_heat_that_only_changes_places_is_in_balance():
    """requirement: what goes in at one end and out at the other: no error where sums vanish."""
    opposite = {"upper_top": "1e4 W/m^2", "lower_bottom": "-1e4 W/m^2"}
    result = solved(BLOCKS, COLUMN | {"heat": {"transient": True, "flux": opposite}})
    assert result.heat[-1].heat_in == 0.0
    assert column(result.heat, "balance_error").max() < 1e-9
    expected = SLAB.flux(1e4, 20.0, DEPTH) - SLAB.flux(1e4, 20.0, 0.03 - DEPTH)
    np.testing.assert_allclose(result.interface.temperature_1 - COLD, expected, atol=1e-2)


def test_surroundings_that_get_warmer():
    """
    requirement: in an ambient that rises by b, a small body follows: b (t - τ (1 - e^{-t/τ})).

    τ = ρ c L/h of 30 mm and 50 W/(m² K); conduction inside is fast: Biot number 3e-4.
    """
    soft = {"bodies.upper": STEEL | {"conductivity": "5000 W/(m K)"}}
    heat = {
        "transient": True,
        "cooling": {"upper_top": "50 W/(m^2 K)"},
        "ambient_history": RAMP,
    }
    end = {"analysis": {"type": "transient", "end_time": "100 s", "tolerance": 1e-4}}
    result = solved(BLOCKS, COLUMN | {"heat": heat} | soft | end)
    time, τ = column(result.heat, "time"), 7800 * 460.0 * 0.03 / 50
    expected = 7800 * 460.0 * 0.03 * AREA * RATE * (time - τ * (1 - np.exp(-time / τ)))
    lost, stored = column(result.heat, "heat_lost"), column(result.heat, "heat_stored")
    np.testing.assert_allclose(stored, expected, rtol=0, atol=3e-4 * expected[-1])
    np.testing.assert_allclose(stored, -lost, rtol=1e-9, atol=1e-9)
    assert column(result.heat, "balance_error").max() < 1e-10


@pytest.mark.parametrize("advection", ["resolved", "spread"])
def test_a_strip_brings_warm_air_along(advection):
    """
    requirement: what passes comes in as warm as the surroundings, and all is in balance.

    All at 60 °C from the start on: nothing but the little friction heat changes anything.
    """
    heat = {
        "transient": True,
        "advection": advection,
        "initial": "60 degC",
        "ambient_history": {"time": ["0 s"], "temperature": ["60 degC"]},
        "cooling": {"punch_top": "2000 W/(m^2 K)", "strip_bottom": "2000 W/(m^2 K)"},
    }
    changes = {f"bodies.punch.{key}": value for key, value in STORING.items()}
    changes |= {"heat": heat, "wear": GONE, "mesh.degree": 2, "mesh.elements": 4}
    changes |= {"motion.velocity": "1e-6 m/s"}
    changes |= {"analysis": {"type": "transient", "end_time": "5 s", "tolerance": 1e-3}}
    result = solved(STRIP, changes)
    temperature = result.fields.temperature
    np.testing.assert_allclose(temperature, 333.15, atol=2e-3)
    assert column(result.heat, "balance_error").max() < 1e-9
    assert abs(result.summary["heat_cooled_W"]) < 1e-3


def test_friction_that_switches():
    """
    requirement: friction by straight lines in time: heat made is the integral of mu p v, and wear
    per friction stress follows it; a step ends where it switches.
    """
    factor = {"time": ["0 s", "1 s", "1.5 s", "3 s"], "factor": [1, 1, 0.25, 0.25]}
    changes = {f"bodies.{body}.{k}": v for body in ("upper", "lower") for k, v in STORING.items()}
    changes |= {"contact.friction_history": factor, "heat.transient": True}
    changes |= {"mesh.degree": 2, "mesh.elements": 3}
    changes |= {"analysis": {"type": "transient", "end_time": "3 s", "tolerance": 1e-3}}
    result = solved(BLOCKS, changes)
    time = column(result.heat, "time")
    assert {1.0, 1.5, 3.0} <= set(time)
    factors = np.interp(time, [0.0, 1.0, 1.5], [1.0, 1.0, 0.25])
    power = 0.2 * 5e6 * 0.1 * AREA
    np.testing.assert_allclose(column(result.heat, "friction_power"), power * factors, rtol=1e-8)
    passed = np.concatenate([[0.0], np.cumsum(np.diff(time) * (factors[1:] + factors[:-1]) / 2)])
    np.testing.assert_allclose(column(result.heat, "heat_in"), power * passed, rtol=1e-8)
    assert passed[-1] == pytest.approx(1 + 0.5 * 0.625 + 1.5 * 0.25)
    rate = 1e-8 * 0.2 * 5 * 0.1 * AREA  # k mu p v A, in m³/s
    worn = column(result.history, "wear_volume_1")
    np.testing.assert_allclose(worn, rate * passed, rtol=1e-8)
    assert result.summary["friction_mean"] == pytest.approx(0.05)
    assert column(result.heat, "balance_error").max() < 1e-9


def test_friction_that_drags_changes_the_pressure():
    """requirement: in the section, the friction of a time is in the equilibrium of that time."""
    changes = {
        "heat": GONE,
        "analysis": {"type": "transient", "end_time": "2 s"},
        "mesh.degree": 2,
        "mesh.elements": 4,
        "wear.punch.coefficient": "1e-30 1/MPa",
    }
    switched = {"contact.friction_history": {"time": ["0 s", "1 s"], "factor": [1.0, 0.5]}}
    half = {"contact.friction": 0.15}
    found, known = solved(STRIP, changes | switched), solved(STRIP, changes | half)
    scale = known.interface.pressure.max()
    first = found.history[0].max_pressure
    assert abs(first - scale) > 1e-3 * scale
    np.testing.assert_allclose(
        found.interface.pressure, known.interface.pressure, atol=1e-6 * scale
    )


def test_heat_that_has_not_come_to_the_contact_yet():
    """requirement: the tolerance holds for the temperatures inside the bodies, too.

    After 0.3 s heat has gone 2 mm deep, and nothing has happened at the contact.
    """
    heat = {"transient": True, "flux": {"upper_top": "1e6 W/m^2"}}
    short = {"type": "transient", "end_time": "0.3 s", "tolerance": 1e-3}
    fine = {"mesh.degree": 3, "mesh.elements": 6}
    result = solved(BLOCKS, COLUMN | {"heat": heat, "analysis": short} | fine)
    hottest = result.fields.temperature.max() - COLD
    assert hottest == pytest.approx(float(SLAB.flux(1e6, 0.3, 0.0)), rel=3e-4)
    assert result.interface.temperature_1.max() - COLD < 1e-3 * hottest
