"""Thermoelastic stability of contacts: closed forms, and runs in time that settle or do not."""

import warnings

from mpi4py import MPI

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import ComputationError
from thermowear.simulation import Observer
from thermowear.simulation.analyses.positioning import prepare
from thermowear.simulation.analyses.stability import PerturbedContact, base_state
from thermowear.simulation.from_case import model_of
from thermowear.timer import Phases

from ..case.starter import GONE, STEADY, solved, tables

SEAL = "face-seal"
BLOCKS, STRIP, DISK = "stacked-blocks", "punch-on-strip", "disk-brake-stability"
STABILITY = {"analysis": {"type": "stability"}}
STORING = {"density": "7800 kg/m^3", "specific_heat": "460 J/(kg K)"}
WAVE, DEPTH = 0.02, 0.03
MESHES = ((1, 80, 1.0), (2, 40, 1.0), (3, 40, 1.0), (4, 20, 1.0), (6, 16, 1.0), (8, 10, 0.3))
"""Degree, number of elements along the face, and grading."""
CONVERGING = {
    DISK: {"motion.angular_velocity": "70 rad/s"},
    STEADY: {
        **{f"bodies.punch.{key}": value for key, value in STORING.items()},
        "motion.angular_velocity": "0.2 rad/s",
    },
    BLOCKS: {
        **{f"bodies.{body}.{k}": v for body in ("upper", "lower") for k, v in STORING.items()},
        "motion.velocity": "7 mm/s",
    },
    STRIP: {
        **{f"bodies.punch.{key}": value for key, value in STORING.items()},
        "motion.velocity": "-6 mm/s",
    },
    SEAL: {
        **{f"bodies.{body}.{k}": v for body in ("ring", "seat") for k, v in STORING.items()},
        "motions.seat.angular_velocity": "9000 rpm",
    },
}
"""Five starters, below and above their critical speeds."""
COARSE = {"mesh": {"degree": 4, "elements": 6, "grading": 0.3}}


def half_wave(**changes):
    """Two conducting blocks of half a wave, deep enough."""
    sizes = {"geometry.width": f"{WAVE / 2} m", "geometry.upper_height": f"{DEPTH} m"}
    sizes["geometry.lower_height"] = f"{DEPTH} m"
    sizes |= {f"bodies.{b}.{key}": v for b in ("upper", "lower") for key, v in STORING.items()}
    found = {key.replace("__", "."): value for key, value in changes.items()}
    return solved(BLOCKS, {**STABILITY, **sizes, "wear": GONE, **found})


@pytest.mark.parametrize("conductance", [1e-3, 3e3, 3e4, None])
@pytest.mark.parametrize("share", [0.3, 1.0])
def test_two_conductors(conductance, share):
    """requirement: heat that crosses decides which body swells; in closed form for waves.

    Of friction heat q body 1 takes ``[f + h/(m k2)]/(1 + h/(m k1) + h/(m k2))``; what a body takes
    lifts its face by ``α (1 + ν)/(k m²)`` times it, and ``2 p/(E* m)`` flattens them.
    """
    result = half_wave(
        heat__conductance=f"{conductance} W/(m^2 K)" if conductance else GONE,
        heat__partition=share,
    )
    m, ν = 2 * np.pi / WAVE, 0.3
    k1, k2, α1, α2, E1, E2 = 50.0, 15.0, 1.2e-5, 1.6e-5, 210e9, 200e9
    h = conductance or 1e12
    taken = (share + h / (m * k2)) / (1 + h / (m * k1) + h / (m * k2))
    lift = (1 + ν) / m**2 * (α1 * taken / k1 + α2 * (1 - taken) / k2)
    flat = 2 * (1 - ν**2) * (1 / E1 + 1 / E2) / m
    critical = flat / (0.2 * lift)
    assert result.summary["critical_speed_m_per_s"] == pytest.approx(critical, rel=2e-4)
    assert result.summary["critical_speed_factor"] == pytest.approx(critical / 0.1, rel=2e-4)
    static = result.summary["static_speed_factors"][0]
    assert result.summary["critical_speed_factor"] == pytest.approx(static, rel=1e-8)
    modes = result.modes
    first = modes.speed_factor == static
    wave = np.cos(m * modes.x[first])
    np.testing.assert_allclose(modes.pressure[first] * modes.pressure[first][0], wave, atol=1e-3)


def rate_and_critical(case, changes):
    """Growth rate without wear [1/s], and first static critical factor (0.0 if none)."""
    model = model_of(tw.load(tables(case, {**STABILITY, **changes})))
    end, _ = base_state(prepare(model, MPI.COMM_WORLD, Phases()), Observer())
    contact = PerturbedContact(end.system, end.contact.pressure, end.contact.conditions)
    return contact.fastest(False).rate.value.real, *np.append(contact.static.factors, 0.0)[:1]


@pytest.mark.parametrize("part", [1e-4, 2.0])
def test_perfect_contact_is_the_limit_of_conductance(part):
    """requirement: the same rates on a fine uneven mesh; what hardly expands only diffuses."""
    found = []
    for conductance in (GONE, "1e9 W/(m^2 K)"):
        mesh = {"degree": 2, "elements": 30, "grading": 1.0}
        changes = {"mesh": mesh, "heat.conductance": conductance}
        changes |= {"bodies.disk.expansion": f"{part * 1.1e-5} 1/K", **CONVERGING[DISK]}
        changes |= {"bodies.pad.expansion": f"{part * 1e-5} 1/K"}
        found.append(rate_and_critical(DISK, changes))
    np.testing.assert_allclose(*found, rtol=1e-6)
    assert (found[0][0] > 0) == (part > 1)


@pytest.mark.slow
@pytest.mark.parametrize("case", CONVERGING)
def test_growth_converges_to_that_of_perfect_contact(case):
    """requirement: growth rates agree on all meshes, and perfect contact is the limit to 1e-4."""
    for conductance in (tables(case)["heat"].get("conductance", "1e4 W/(m^2 K)"), GONE):
        found = []
        for degree, elements, grading in MESHES:
            mesh = {"degree": degree, "elements": elements, "grading": grading}
            changes = {"mesh": mesh, **CONVERGING[case], "heat.conductance": conductance}
            found.append(rate_and_critical(case, changes))
            print(case, conductance or "perfect", degree, elements, *found[-1])  # with pytest -s
            if conductance is GONE:
                limit = rate_and_critical(case, changes | {"heat.conductance": "1e10 W/(m^2 K)"})
                np.testing.assert_allclose(found[-1], limit, rtol=1e-4)
        for (degree, *_), values in zip(MESHES, found, strict=True):
            np.testing.assert_allclose(values, found[-1], rtol=0.08 if degree == 1 else 0.02)


def test_rates_need_capacities():
    """requirement: without them the static speeds, and a word about what may be missed."""
    said = []

    class Listener(tw.simulation.Observer):
        def note(self, text):
            said.append(text)

    summary = solved(BLOCKS, {**STABILITY}, observer=Listener()).summary
    assert summary["critical_speed_factor"] == summary["static_speed_factors"][0]
    assert summary["growth_rate_per_s"] is None
    assert summary["critical_speed_factor_with_wear"] is None
    assert any("density and specific_heat" in text for text in said)


@pytest.mark.parametrize(("part", "settles"), [(0.97, True), (1.03, False)])
def test_hot_contact_exists_below_the_critical_speed(part, settles):
    """requirement: pressed by an approach, blocks carry it; above, heat has no equilibrium."""
    pressed = {"load": {"approach": "1 um"}, "wear": GONE}
    critical = solved(BLOCKS, {**STABILITY, **pressed}).summary["static_speed_factors"][0]
    velocity = f"{0.1 * part * critical!r} m/s"
    changes = {**pressed, "analysis": {"type": "initial"}, "motion.velocity": velocity}
    if settles:
        assert solved(BLOCKS, changes).summary["normal_force_N"] > 0
    else:
        with pytest.raises(ComputationError, match=r"critical sliding speed|did not converge"):
            solved(BLOCKS, changes)


def ring(speed, **analysis):
    changes = {f"bodies.punch.{key}": value for key, value in STORING.items()}
    changes |= {**COARSE, "motion.angular_velocity": f"{speed} rad/s", "analysis": analysis}
    return tables(STEADY, changes)


@pytest.mark.slow
def test_running_in_settles_below_the_critical_speed_only():
    """requirement: heat and wear in time, nothing linearised, agree; what swings is found to swing.

    Beyond it the pressure goes on swinging with about the period of the disturbance.
    """
    summary = tw.run(tw.load(ring(0.1, type="stability"))).summary
    critical = summary["critical_angular_velocity_with_wear_rad_per_s"]
    assert critical == pytest.approx(0.146, rel=0.01)
    assert critical > summary["critical_angular_velocity_rad_per_s"]
    timed = {"type": "transient", "end_time": "6000 s", "tolerance": 3e-3}
    settled, swinging = (
        tw.run(tw.load(ring(f * critical, **timed), ("heat.transient=true",))) for f in (0.9, 1.15)
    )
    assert settled.summary["distance_from_steady"] < 0.02
    assert swinging.summary["distance_from_steady"] > 0.2
    time, peak = np.array([(row.time, row.max_pressure) for row in swinging.history]).T
    t = np.linspace(3000, 6000, 1500)
    p = np.interp(t, time, peak)
    rising = t[1:][(p[:-1] < p.mean()) & (p[1:] >= p.mean())]
    period = 2 * np.pi / summary["critical_frequency_with_wear_rad_per_s"]
    assert np.diff(rising).mean() == pytest.approx(period, rel=0.15)


@pytest.mark.slow
def test_rates_at_the_critical_speed_vanish():
    """requirement: at the speed found nothing grows or dies out, where heat is carried along too.

    Friction in the section: the operators are not symmetric.
    """
    for advection in ("none", "resolved"):
        changes = {f"bodies.{body}.{k}": v for body in ("punch",) for k, v in STORING.items()}
        changes |= {**STABILITY, "mesh": {"degree": 3, "elements": 6}, "heat.advection": advection}
        changes |= {"heat.partition": 0.5}
        factor = solved(STRIP, changes).summary["critical_speed_factor"]
        rates = [
            solved(STRIP, changes | {"motion.velocity": f"{-3e-3 * part * factor} m/s"}).summary[
                "growth_rate_without_wear_per_s"
            ]
            for part in (0.99, 1.01)
        ]
        assert rates[0] < 0 < rates[1]


def test_wear_holds_hot_bands_back():
    """requirement: the brake is unstable without wear and stable with it; more wear, more so."""
    summary = solved(DISK, {**COARSE}).summary
    assert summary["growth_rate_without_wear_per_s"] > 0 > summary["growth_rate_per_s"]
    assert summary["critical_speed_factor"] < 1 < summary["critical_speed_factor_with_wear"]
    more = solved(DISK, {**COARSE, "wear.pad.coefficient": "2e-7 1/MPa"}).summary
    worn = "critical_speed_factor_with_wear"
    assert more[worn] > 1.1 * summary[worn]
    assert more["critical_speed_factor"] == pytest.approx(summary["critical_speed_factor"])


def test_the_load_does_not_matter():
    """requirement: all is linear in the pressure."""
    found = [
        solved(DISK, {**COARSE, "load.force": force}).summary["critical_speed_factor_with_wear"]
        for force in ("300 N", "3 kN")
    ]
    assert found[0] == pytest.approx(found[1], rel=1e-7)


@pytest.mark.parametrize("speed", [20.0, 50.0])
def test_hot_states_tell_their_critical_speed(speed):
    """requirement: the static one of a stability analysis; an unstable state is noted."""
    changes = {**COARSE, "motion.angular_velocity": f"{speed} rad/s"}
    found = solved(DISK, changes)
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always")
        summary = solved(DISK, {**changes, "analysis": {"type": "steady"}}).summary
    factor = found.summary["static_speed_factors"][0]
    assert summary["critical_speed_factor"] == pytest.approx(factor, rel=1e-6)
    critical = summary["critical_angular_velocity_rad_per_s"]
    assert critical == pytest.approx(factor * speed, rel=1e-6)
    said = any("hot state is unstable" in str(note.message) for note in notes)
    assert said == (factor < 1)


def test_in_space():
    """requirement: a contact that is a surface has its critical speed and its shapes."""
    changes = {**STABILITY, "mesh": {"degree": 2, "elements": 3}, "motion.velocity": "5 mm/s"}
    changes |= {f"bodies.punch.{key}": v for key, v in STORING.items()}
    changes |= {"bodies.punch.conductivity": "50 W/(m K)", "bodies.punch.expansion": "1.2e-5 1/K"}
    changes |= {"contact.friction": 0.3}
    changes["heat"] = {"ambient": "20 degC", "temperature": {"block_bottom": "20 degC"}}
    result = solved("rectangular-punch", changes)
    assert result.summary["critical_speed_factor"] > 0
    weights, modes = result.interface.weight, result.modes
    for number in np.unique(modes.mode):
        assert abs(weights @ modes.pressure[modes.mode == number]) < 1e-9 * weights.sum()
