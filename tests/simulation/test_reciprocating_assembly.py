"""Reciprocating sliding in several contacts: the pair, the half model, worn volumes."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.model.conditions import Motion
from thermowear.simulation.analyses.run import run
from thermowear.simulation.cycles.stroke import strokes
from thermowear.simulation.from_case import analysis_of, model_of

from ..case.starter import RECIPROCATING, changed, tables

FORCE, AMPLITUDE, FREQUENCY, CYCLES = 2000.0, 5e-3, 2.0, 2000
WEAR = {"upper": 1e-13, "strip": 1e-13, "lower": 4e-14}
SLIDING = {"amplitude": "5 mm", "frequency": "2 Hz"}
CASE = {
    "model": "plane-strain",
    "geometry": {
        "type": "strip-between-punches",
        "width": "10 mm",
        "height": "10 mm",
        "strip_length": "60 mm",
        "strip_height": "20 mm",
        "stroke": "5 mm",
        "thickness": "10 mm",
    },
    "mesh": {"degree": 2, "elements": 8, "grading": 1.0},
    "bodies": {
        "upper": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
        "strip": {"like": "upper"},
        "lower": {"like": "upper"},
    },
    "contact": {"friction": 0.2},
    "holders": {
        "press": {"surface": "upper_top", "force": "2 kN"},
        "slide": {"surface": "strip_right"},
        "base": {"surface": "lower_bottom", "free": []},
    },
    "motions": {"strip": SLIDING},
    "wear": {
        name: {"coefficient": f"{k * 1e6!r} 1/MPa", "per": "pressure"} for name, k in WEAR.items()
    },
    "analysis": {
        "type": "reciprocating",
        "cycles": CYCLES,
        "positions": 6,
        "output_times": ["100 s"],
    },
}
EQUAL = {"wear.lower": CASE["wear"]["upper"]}
HALF = {
    "geometry.half": True,
    "bodies.lower": None,
    "bodies.strip": {"like": "upper", "rollers": "strip_middle"},
    "holders.base": None,
    "holders.slide.free": [],
    "wear.lower": None,
}


def computed(changes):
    result = tw.run(tw.load(changed(CASE, changes)))
    assert result.stopped is None
    return result


@functools.cache
def unequal():
    return computed({})


def assert_alike(found, expected, tolerance=1e-8):
    """Compare columns of a contact, sorted along x."""
    here, there = np.argsort(found["x_m"]), np.argsort(expected["x_m"])
    for key, values in expected.items():
        if key in ("y_m", "s_m", "x_m") or not np.any(values) or np.isnan(values).all():
            continue
        atol = tolerance * np.abs(values).max()
        np.testing.assert_allclose(found[key][here], values[there], rtol=0, atol=atol, err_msg=key)


def test_a_pair_as_an_assembly():
    """requirement: pressures, depths and the track of the pair to 1e-9, by the joint path."""
    case = tw.load(tables(RECIPROCATING), ("mesh.degree=2", "analysis.positions=6"))
    model = model_of(case)
    named = replace(
        model,
        interfaces=(replace(model.interface, name="only"),),
        holders=(replace(model.holder, name="arm"),),
    )
    pair, joint = (run(each, analysis_of(case)) for each in (model, named))
    for table in ("interface", "track"):
        assert_alike(joint.columns(f"{table}_only"), pair.columns(table), tolerance=1e-9)
    history, known = joint.columns("history"), pair.columns("history")
    for key in ("time_s", "max_pressure_Pa", "wear_volume_1_m3", "wear_volume_2_m3", "approach_m"):
        np.testing.assert_allclose(history[key], known[key], rtol=1e-9, err_msg=key)
    contact = joint.summary["contacts"]["only"]
    for key in ("wear_volume_1_m3", "mean_wear_rate_1_m_per_s", "mean_wear_rate_2_m_per_s"):
        assert contact[key] == pytest.approx(pair.summary[key], rel=1e-9, abs=0.0)


def test_a_strip_between_equal_punches_is_twice_its_half():
    """requirement: pressures, depths and tracks of both contacts are those of the half on its line
    of symmetry, to 1e-8; the press moves twice as far, the strip as far as the half.
    """
    whole, half = computed(EQUAL), computed(EQUAL | HALF)
    for side in ("upper", "lower"):
        for table in ("interface", "track"):
            ours, theirs = whole.columns(f"{table}_{side}"), half.columns(f"{table}_upper")
            assert theirs["wear_2_m"].max() > 1e-6
            assert_alike(ours, theirs)
    press, slide = (whole.summary["holders"][name]["approach_m"] for name in ("press", "slide"))
    alone = half.summary["holders"]["press"]["approach_m"]
    assert (press, slide) == pytest.approx((2 * alone, alone), rel=1e-8, abs=0.0)
    assert whole.summary["wear_volume_2_m3"] == pytest.approx(
        2 * half.summary["wear_volume_2_m3"], rel=1e-8, abs=0.0
    )


def test_the_volumes_are_those_of_the_laws():
    """requirement: V = k F s of each face by its own law, also of the strip on both sides; mean
    forces and friction powers of the contacts.
    """
    friction = {"upper": 0.2, "lower": 0.1}
    changes = {f"contacts.{k}": {"friction": mu} for k, mu in friction.items()}
    changes["wear.lower"] = {"rate": "4e-13 1/Pa * mu * p * v"}  # of 0.1, that of WEAR
    result = computed(changes)
    slid = 4 * AMPLITUDE * CYCLES
    for side in ("upper", "lower"):
        contact = result.summary["contacts"][side]
        for number, body in ((1, side), (2, "strip")):
            volume = contact[f"wear_volume_{number}_m3"]
            assert volume == pytest.approx(WEAR[body] * FORCE * slid, rel=1e-9, abs=0.0)
    bodies = result.summary["bodies"]
    assert bodies["strip"]["wear_volume_m3"] == pytest.approx(
        2 * WEAR["strip"] * FORCE * slid, rel=1e-9, abs=0.0
    )
    rows = result.columns("contacts")
    speed = 4 * AMPLITUDE * FREQUENCY
    np.testing.assert_allclose(rows["normal_force_N"], FORCE, rtol=1e-9)
    for number, mu in enumerate(friction.values(), start=1):
        power = rows["friction_power_W"][rows["contact"] == number]
        np.testing.assert_allclose(power, mu * FORCE * speed, rtol=1e-9)
    (total,) = set(result.columns("history")["friction_power_W"].round(6))
    assert total == pytest.approx(sum(friction.values()) * FORCE * speed, rel=1e-9)
    held = result.summary["holders"]
    assert abs(held["slide"]["guide_force_N"]) == pytest.approx((0.2 + 0.1) * FORCE, rel=1e-9)


def test_it_does_not_matter_which_bodies_move():
    """requirement: both punches over the strip at rest: the same depths, seen from the strip."""
    moving = {"motions": {"upper": SLIDING, "lower": SLIDING}}
    found, expected = computed(moving), unequal()
    for side in ("upper", "lower"):
        for table, worn in (("interface", "wear_1_m"), ("track", "wear_2_m")):
            ours, theirs = (
                {key: r.columns(f"{table}_{side}")[key] for key in ("x_m", worn)}
                for r in (found, expected)
            )  # the pressure in the middle of the stroke is that of the other direction
            assert_alike(ours, theirs)


def test_a_contact_at_rest_and_a_stroke_too_long():
    """requirement: bodies at rest or alike, and a punch that leaves the strip, are refused."""
    both = {"motions": {"upper": SLIDING, "strip": SLIDING}}
    alone = {"motions": {"upper": SLIDING}}
    with pytest.raises(tw.CaseError, match=r"contacts\.lower: its bodies do not slide"):
        tw.run(tw.load(changed(CASE, alone)))
    with pytest.raises(tw.CaseError, match=r"contacts\.upper: its bodies do not slide"):
        computed(both)
    long = {"motions.strip.amplitude": "6 mm"}
    with pytest.raises(tw.CaseError, match=r"contacts\.upper: .* of upper_face leaves strip_upper"):
        computed(long)


def test_the_only_contact_at_rest():
    """requirement: bodies that move alike do not slide, also where no other contact does."""
    case = tw.load(tables(RECIPROCATING))
    model, settings = model_of(case), analysis_of(case)
    still = replace(model, interfaces=(replace(model.interface, name="only", motion=Motion()),))
    with pytest.raises(tw.CaseError, match=r"contacts\.only: its bodies do not slide"):
        strokes(still, settings)
    assert abs(strokes(model, settings)) == pytest.approx([1.0], rel=1e-12)


def test_bodies_on_both_sides_of_a_slower_one():
    """requirement: strokes have the sense of the first body over the second one."""
    faster = {"amplitude": "8 mm", "frequency": "2 Hz"}
    case = tw.load(changed(CASE, {"motions.upper": faster}))
    settings = analysis_of(case)
    amplitudes = strokes(model_of(case), settings) * settings.amplitude
    assert amplitudes == pytest.approx([3e-3, -5e-3], rel=1e-12)


def test_bodies_with_different_strokes():
    """requirement: a punch that moves with the strip slides by the difference: V = k F s, and the
    length of its track.
    """
    moving = {"motions.upper": {"amplitude": "2 mm", "frequency": "2 Hz"}}
    result = computed(moving)
    for side, amplitude in (("upper", 3e-3), ("lower", 5e-3)):
        slid = 4 * amplitude * CYCLES
        volume = result.summary["contacts"][side]["wear_volume_1_m3"]
        assert volume == pytest.approx(WEAR[side] * FORCE * slid, rel=1e-9, abs=0.0)
        track = result.columns(f"track_{side}")["x_m"]
        assert np.ptp(track) == pytest.approx(10e-3 + 2 * amplitude, rel=1e-9)
