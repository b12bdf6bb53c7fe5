"""Stick and slip in several contacts: the pair and the half model, closed forms, holders' loads."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.simulation.analyses.run import run
from thermowear.simulation.from_case import analysis_of, model_of

from ..app.test_resume import assert_the_same
from ..case.starter import FRETTING, GONE, TUBE, solved, tables
from ..test_parallel import pytestmark as needs_mpirun
from ..test_parallel import thermowear

RIG, SUPPORTS, SLIDING = (
    "strip-between-cylinders-fretting",
    "tube-between-supports",
    "cylinder-fretting",
)
FORCE, WEAR = 60.0, {"upper": 2e-14, "strip": 2e-14, "lower": 1e-14}
CYCLE = ["0 ms", "12.5 ms", "25 ms", "37.5 ms", "50 ms"]
COARSE = {
    "mesh.elements": 24,
    "analysis": {"type": "fretting", "increments": 4, "jump": 500, "output_times": []},
    "wear.cycles": 1500,
}
EQUAL = {"wear.lower.coefficient": "2e-8 1/MPa"}
HALF = {
    "geometry.half": True,
    "bodies.lower": GONE,
    "bodies.strip": {"like": "upper", "rollers": "strip_middle"},
    "holders.base": GONE,
    "holders.grip.free": [],
    "wear.lower": GONE,
}


FRICTION = {"upper": 0.8, "lower": 0.5}
UNEQUAL = {f"contacts.{side}": {"friction": friction} for side, friction in FRICTION.items()}


@functools.cache
def rig():
    """The starter with fewer elements and cycles, and less friction below."""
    return solved(RIG, COARSE | UNEQUAL)


@functools.cache
def symmetric():
    """The rig with equal cylinders, and its upper half."""
    both = COARSE | EQUAL
    return solved(RIG, both), solved(RIG, both | HALF)


def assert_alike(found, expected, keys, tolerance=1e-8, scale=1.0):
    for key in keys:
        allowed = tolerance * np.abs(scale * expected[key]).max()
        np.testing.assert_allclose(
            found[key], scale * expected[key], rtol=0, atol=allowed, err_msg=key
        )


AT_POINTS = ("weight_m2", "pressure_Pa", "shear_Pa", "dissipated_J_per_m2", "status", "x_m")
WORN = ("wear_1_m", "wear_2_m", "gap_m", "wear_rate_1_m_per_s", "wear_rate_2_m_per_s")


# ---- a pair, and the half of a symmetric rig ----


@pytest.mark.parametrize(
    ("starter", "overrides"),
    [
        (FRETTING, ("mesh.elements=16", "analysis.increments=5")),
        (SLIDING, ("mesh.elements=24", "wear.cycles=300", "analysis.output_times=[]")),
        (TUBE, ("mesh.elements=24", "analysis.cycles=6000", "analysis.output_times=[]")),
    ],
)
def test_a_pair_as_an_assembly(starter, overrides):
    """requirement: the same forces, energy, stick and worn depths to 1e-9, by the joint path."""
    case = tw.load(tables(starter), overrides)
    model = model_of(case)
    named = replace(
        model,
        interfaces=(replace(model.interface, name="only"),),
        holders=(replace(model.holder, name="arm"),),
    )
    assert named.named
    pair, joint = (run(each, analysis_of(case)) for each in (model, named))
    assert_alike(joint.columns("loads"), pair.columns("loads"), pair.columns("loads"), 1e-9)
    assert_alike(joint.columns("friction_only"), pair.columns("friction"), AT_POINTS, 1e-9)
    assert_alike(joint.columns("interface_only"), pair.columns("interface"), WORN[:3], 1e-9)
    held, contact = joint.summary["holders"]["arm"], joint.summary["contacts"]["only"]
    for key in ("approach_m", "normal_force_N", "tangential_force_N", "tangential_displacement_m"):
        known = (contact | pair.summary)[key]
        assert held[key] == pytest.approx(known, rel=1e-9, abs=1e-9 * held["normal_force_N"])
    for key in ("stick_area_m2", "dissipated_energy_J", "friction_force_N", "wear_volume_1_m3"):
        assert contact[key] == pytest.approx(pair.summary[key], rel=1e-9, abs=0.0), key


def test_a_strip_between_equal_cylinders_is_twice_its_half():
    """requirement: stick zones, shear, slip and wear of both contacts are those of the half on its
    line of symmetry, to 1e-8; the grip takes twice the force, and twice the energy is lost.
    """
    whole, half = symmetric()
    for side in ("upper", "lower"):
        ours, theirs = (
            (whole.columns(f"{table}_{side}"), half.columns(f"{table}_upper"))
            for table in ("friction", "interface")
        )
        order = np.argsort(ours[0]["x_m"]), np.argsort(ours[1]["x_m"])
        for found, keys in ((ours, AT_POINTS), (theirs, WORN)):
            sorted_ = [{k: v[by] for k, v in t.items()} for t, by in zip(found, order, strict=True)]
            assert_alike(*sorted_, keys)
        assert set(ours[0]["status"]) == {0.0, 1.0, 2.0}  # partial slip
    loads, of_half = whole.columns("loads"), half.columns("loads")
    same = ("time_s", "tangential_displacement_m", "max_pressure_Pa")
    assert_alike(loads, of_half, same)
    twice = ("tangential_force_N", "dissipated_J", "stick_area_m2", "contact_area_m2")
    assert_alike(loads, of_half, twice, scale=2.0)
    moved, alone = (r.summary["holders"]["press"]["approach_m"] for r in (whole, half))
    assert moved == pytest.approx(2.0 * alone, rel=1e-8, abs=0.0)
    assert whole.summary["holders"]["grip"]["approach_m"] == pytest.approx(alone, rel=1e-8, abs=0.0)


# ---- the tube between its supports ----

MOVED = {"time": CYCLE, "tangential_displacement": ["0 um", "5 um", "0 um", "-5 um", "0 um"]}
ROLLING = {"type": "fretting", "increments": 4, "cycles": 3, "jump": 1}
SOFTER = "2e-8 1/MPa"  # than the tube: the shares of the common face are elastic, not those of wear
ON_TUBE = {"mesh.elements": 24, "geometry.zone": "0.8 mm", "analysis": ROLLING}


@functools.cache
def in_one_support():
    return solved(
        TUBE, ON_TUBE | {"geometry.support_arc": "90 deg", "wear.support.coefficient": SOFTER}
    )


@pytest.mark.parametrize(
    ("angles", "along"),
    [(("-90 deg", "90 deg"), "y_m"), (("0 deg", "180 deg"), "x_m")],
)
def test_a_tube_that_slides_on_both_supports(angles, along):
    """requirement: each contact is that of the tube in one support, for which the other side of
    the tube is far away: pressure, shear, slip, wear of both faces to 1e-8, also along y.
    """
    equal = {f"wear.{side}.coefficient": SOFTER for side in ("left", "right")}
    equal |= {"motions": GONE, "holders.rod.history": MOVED}
    places = {n: {"angle": a} for n, a in zip(("left", "right"), angles, strict=True)}
    result = solved(SUPPORTS, ON_TUBE | equal | {"geometry.supports": places})
    pair = in_one_support()
    for side in ("left", "right"):
        for table, keys in (("friction", AT_POINTS[:-1]), ("interface", WORN[:3])):
            ours, theirs = result.columns(f"{table}_{side}"), pair.columns(table)
            here, there = np.argsort(ours[along]), np.argsort(theirs["x_m"])
            sorted_ = (
                {k: v[here] for k, v in ours.items()},
                {k: v[there] for k, v in theirs.items()},
            )
            assert_alike(*sorted_, keys)
    rows, row = result.columns("holders"), pair.columns("loads")
    rod = rows["holder"] == 2
    assert_alike(
        {"f": rows["tangential_force_N"][rod]}, {"f": row["tangential_force_N"]}, "f", scale=2.0
    )


# ---- balances and closed forms ----


def test_worn_volume_is_that_of_the_energy():
    """requirement: V = k E / mu of each face of each contact, exactly, by its own law."""
    result = rig()
    for side in ("upper", "lower"):
        contact = result.summary["contacts"][side]
        for body, number in ((side, 1), ("strip", 2)):
            known = WEAR[body] / FRICTION[side] * contact["dissipated_energy_J"]
            found = contact[f"wear_volume_{number}_m3"]
            assert found == pytest.approx(known, rel=1e-9, abs=0.0)
            assert found > 0.0
    assert result.summary["equilibrium_relative_error"] < 1e-9


def test_it_does_not_matter_which_bodies_move():
    """requirement: a strip that slides farther than the contacts are wide, and both cylinders over
    a strip at rest: the same worn profiles of all faces, seen from each body.
    """
    far = ["0 um", "60 um", "0 um", "-60 um", "0 um"]
    back = ["0 um", "-60 um", "0 um", "60 um", "0 um"]
    wide = {"geometry.zone": "0.2 mm", "wear.cycles": 1500}
    moved = solved(RIG, COARSE | wide | {"holders.grip.history.tangential_displacement": far})
    still = solved(
        RIG,
        COARSE
        | wide
        | {
            "holders.grip.history": GONE,
            "holders.press.history": {"time": CYCLE, "tangential_displacement": back},
            "holders.base.history": {"time": CYCLE, "tangential_displacement": back},
        },
    )
    for side in ("upper", "lower"):
        ours, theirs = (r.columns(f"interface_{side}") for r in (still, moved))
        assert np.ptp(theirs["x_m"][theirs["wear_2_m"] > 1e-9]) > 1.5e-4
        assert_alike(ours, theirs, ("wear_1_m", "wear_2_m", "pressure_Pa"), 1e-7)


def test_a_wear_rate_with_the_friction_of_its_contact():
    """requirement: V = k E of a rate k mu p v, whatever the laws of the other faces."""
    rate = {"wear.lower": {"rate": "1e-14 1/Pa * mu * p * v"}}
    result = solved(RIG, COARSE | UNEQUAL | rate)
    contact = result.summary["contacts"]["lower"]
    known = 1e-14 * contact["dissipated_energy_J"]
    assert contact["wear_volume_1_m3"] == pytest.approx(known, rel=1e-9, abs=0.0)


def test_every_holder_is_in_balance():
    """requirement: forces of the holders on the bodies sum to zero in every increment, and those
    of the cylinders are those of their contacts.
    """
    held, contacts, stuck = map(rig().columns, ("holders", "contacts", "sticking"))
    press, grip, base = (held["holder"] == number for number in (1, 2, 3))
    upper, lower = (contacts["contact"] == number for number in (1, 2))
    pull, normal = held["tangential_force_N"], held["normal_force_N"]
    np.testing.assert_allclose(pull[press] + pull[grip] + pull[base], 0.0, atol=1e-9 * FORCE)
    np.testing.assert_allclose(normal[grip], 0.0, atol=1e-9 * FORCE)
    np.testing.assert_allclose(normal[press][4:], FORCE, rtol=1e-9)
    for cylinder, contact in ((press, upper), (base, lower)):
        np.testing.assert_allclose(contacts["normal_force_N"][contact], normal[cylinder], rtol=1e-9)
        np.testing.assert_allclose(
            stuck["friction_force_N"][contact], -pull[cylinder], atol=1e-9 * FORCE
        )
    power, lost = contacts["friction_power_W"][upper], stuck["dissipated_J"][upper]
    cycle = slice(4, 20)  # the increments of the first one, all of the same duration
    assert power[cycle].sum() * 50e-3 / 16 == pytest.approx(lost[19] - lost[3], rel=1e-9, abs=0.0)
    assert power[cycle].min() >= 0.0


def history(**loads):
    return {"time": list(loads.pop("time", ("0 s", "1 s", "2 s"))), **loads}


def test_each_holder_has_a_history_of_its_own():
    """requirement: force, tangential force and displacement follow their own instants."""
    changes = {
        "holders.press.force": GONE,
        "holders.press.history": history(force=["40 N", "60 N", "50 N"]),
        "holders.grip.history": history(
            time=("0 s", "0.5 s", "3 s"), tangential_force=["0 N", "30 N", "-10 N"]
        ),
        "holders.base.free": [],
        "holders.base.history": history(tangential_displacement=["0 um", "0 um", "0.5 um"]),
        "wear": {},
        "analysis": {"type": "fretting", "increments": 4},
    }
    result = solved(RIG, {"mesh.elements": 24} | changes)
    assert result.stopped is None
    rows, steps = result.columns("holders"), result.columns("loads")["time_s"]
    press, grip, base = (rows["holder"] == number for number in (1, 2, 3))
    time, later = steps[4:], slice(4, None)
    assert set(time) >= {0.5, 1.0, 2.0, 3.0}
    expected = np.interp(time, [0, 1, 2], [40, 60, 50])
    np.testing.assert_allclose(rows["normal_force_N"][press][later], expected, rtol=1e-9)
    expected = np.interp(time, [0, 0.5, 3], [0, 30, -10])
    np.testing.assert_allclose(rows["tangential_force_N"][grip][later], expected, atol=1e-7)
    expected = np.interp(time, [0, 1, 2], [0, 0, 0.5e-6])
    found = rows["tangential_displacement_m"][base][later]
    np.testing.assert_allclose(found, expected, atol=1e-15)


def test_a_holder_beyond_the_limit_of_friction():
    """requirement: both contacts together carry their mu N; the holder that slides is named."""
    pulled = {"time": ["0 s", "1 s"], "tangential_force": ["0 N", "100 N"]}
    changes = {"holders.grip.history": pulled, "wear": {}, "mesh.elements": 24}
    changes["analysis"] = {"type": "fretting", "increments": 10}
    result = solved(RIG, changes | UNEQUAL)
    assert isinstance(result.stopped, tw.ComputationError)
    assert "holders.grip: the holder slides; friction carries 7" in str(result.stopped)
    carried = float(str(result.stopped).split("carries ")[1].split()[0])
    assert carried == pytest.approx(sum(FRICTION.values()) * FORCE, rel=2e-3)
    last = result.columns("loads")["tangential_force_N"][-1]
    assert 0.8 * carried < last < 1.05 * carried  # a displaced cylinder climbs


def test_a_free_rotation_is_in_balance():
    """requirement: a cylinder that may rotate bears no moment, and rolls with the strip."""
    free = {"holders.press.free": ["z", "rotation"], "holders.press.pivot": ["0 mm", "11 mm"]}
    result = rig_of(free)
    held = result.columns("holders")
    press = held["holder"] == 1
    assert np.abs(held["moment_Nm"][press]).max() < 1e-9 * FORCE * 6e-3
    assert np.abs(held["rotation_rad"][press]).max() > 1e-5
    turned = result.columns("sticking")
    small, large = (
        np.abs(turned["friction_force_N"][turned["contact"] == number]).max() for number in (1, 2)
    )
    assert small < 1e-3 * large  # only rolling friction is left


def test_a_moment_with_a_history():
    """requirement: the moment of a cylinder about its centre is that of the friction force alone,
    M = T R, as pressure on a circle has none.
    """
    turned = {
        "holders.press.free": ["z", "rotation"],
        "holders.press.pivot": ["0 mm", "11 mm"],
        "holders.press.history": history(moment=["0 N m", "0.1 N m", "-0.05 N m"]),
        "holders.grip.history.tangential_displacement": ["0 um"] * 5,
    }
    result = rig_of(turned)
    rows, stuck = result.columns("holders"), result.columns("sticking")
    moment = rows["moment_Nm"][rows["holder"] == 1]
    expected = np.interp(rows["time_s"][rows["holder"] == 1], [0, 1, 2], [0, 0.1, -0.05])
    np.testing.assert_allclose(moment, expected, atol=1e-9)
    force = stuck["friction_force_N"][stuck["contact"] == 1]
    np.testing.assert_allclose(np.abs(force) * 6e-3, np.abs(moment), atol=2e-4)
    assert rows["rotation_rad"][rows["holder"] == 1].max() > 1e-5


def rig_of(changes):
    cut = {"wear": {}, "analysis": {"type": "fretting", "increments": 4}, "mesh.elements": 24}
    return solved(RIG, cut | changes)


# ---- from the command line ----


def written(tmp_path, name="case.toml", **changes):
    file = tmp_path / name
    small = {"mesh.elements": 16, "wear.cycles": 400}
    case = tables(RIG, COARSE | small | {"analysis.output_times": ["10 s"]} | changes)
    file.write_text(tomli_w.dumps(case), encoding="utf-8")
    return file


def test_a_run_goes_on_from_its_checkpoint(tmp_path, capsys):
    """requirement: a run to fewer cycles that is continued has the tables of the whole run."""
    whole, folder = tmp_path / "whole", tmp_path / "begun"
    case = written(tmp_path)
    jump = "--set=analysis.jump=100"
    assert main(["run", str(case), "-o", str(whole), "--no-pictures", jump]) == 0
    begun = ["run", str(case), "-o", str(folder), "--no-pictures", jump]
    assert main([*begun, "--set=wear.cycles=200"]) == 0
    assert main([*begun, "--resume"]) == 0
    capsys.readouterr()
    assert_the_same(folder, whole)
    names = {path.name for path in whole.glob("*_upper*.csv")}
    assert names == {
        *("interface_upper.csv", "interface_upper_at_10.csv", "profile_upper.csv"),
        *("friction_upper.csv", "friction_upper_at_10.csv"),
    }


@pytest.mark.slow
@needs_mpirun
def test_two_ranks(tmp_path):
    """requirement: the worn depths and forces of the serial run on two ranks, to 1e-8."""
    case, tables_of = written(tmp_path), []
    for ranks in (1, 2):
        folder = tmp_path / f"on{ranks}"
        words = ["run", str(case), "-o", str(folder), "--no-pictures"]
        assert (main(words) if ranks == 1 else thermowear(ranks, *words).returncode) == 0
        read = (
            np.genfromtxt(folder / f"{n}.csv", delimiter=",", names=True)
            for n in ("holders", "interface_lower")
        )
        tables_of.append(tuple(read))
    for serial, parallel in zip(*tables_of, strict=True):
        for key in serial.dtype.names:
            atol = 1e-8 * np.nanmax(np.abs(serial[key]), initial=0.0)
            np.testing.assert_allclose(parallel[key], serial[key], rtol=0, atol=atol, err_msg=key)
