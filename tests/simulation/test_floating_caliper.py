"""Floating caliper: the reaction of the piston's force acts on the caliper, and presses its pad."""

import numpy as np
import pytest

from thermowear.case import load
from thermowear.errors import CaseError
from thermowear.verification.cases.assembly.pad_disk_pad import at_contact

from ..case.starter import GONE, changed, solved, tables

CALIPER, FORCE = "disk-brake-floating-caliper", 500.0
COARSE = {"mesh": {"degree": 3, "elements": 6, "grading": 0.3}}
STORING = {
    f"bodies.{body}.{key}": value
    for body in ("inner_plate", "inner_pad", "disk")
    for key, value in (("density", "2500 kg/m^3"), ("specific_heat", "900 J/(kg K)"))
}
IN_TIME = {"heat.transient": True} | STORING
UNWORN = {"analysis": {"type": "initial"}}
WORN = {"analysis": {"type": "transient", "end_time": "2000 s", "tolerance": 1e-2}}
HISTORY = {"time": ["0 s", "10 s"], "force": ["100 N", "500 N"]}
RAMP = {"holders.piston": {"surface": "inner_plate_top", "reaction": "caliper", "history": HISTORY}}


def name_of(state):
    """Name of a state for the list of tests."""
    kind = state.get("analysis", {}).get("type", "steady")
    return f"{kind} in time" if "heat.transient" in state else kind


def brake(changes):
    return solved(CALIPER, COARSE | changes)


def forces(summary, contacts=("inner", "outer")):
    """Normal forces of both contacts [N]."""
    return [summary["contacts"][name]["normal_force_N"] for name in contacts]


def assert_same_contacts(found, expected, tolerance=1e-9):
    for side in ("inner", "outer"):
        ours, theirs = (at_contact(result, side) for result in (found, expected))
        for name in ("pressure", "wear_1", "wear_2", "shape", "temperature_1", "heat_flux_2"):
            values = getattr(theirs, name)
            atol = tolerance * np.abs(values).max(initial=0.0)
            np.testing.assert_allclose(getattr(ours, name), values, rtol=0, atol=atol)


@pytest.mark.parametrize("state", [UNWORN, {}, WORN, WORN | IN_TIME], ids=name_of)
def test_both_pads_are_pressed_with_the_force_of_the_piston(state):
    """requirement: both contacts carry F to 1e-12, and the hub nothing, though the pads differ."""
    result = brake(state)
    assert forces(result.summary) == pytest.approx([FORCE, FORCE], rel=1e-12)
    assert abs(result.summary["holders"]["hub"]["guide_force_z_N"]) < 1e-9 * FORCE
    pressures = [at_contact(result, side).pressure for side in ("inner", "outer")]
    if state == UNWORN:  # pads of other heights
        assert np.abs(pressures[0] - pressures[1]).max() > 1e-4 * pressures[0].max()


@pytest.mark.parametrize("state", [UNWORN, {}, WORN | IN_TIME], ids=name_of)
def test_it_is_a_brake_with_two_forces(state):
    """requirement: the reaction is a force of the same size on the caliper."""
    two = {"holders.piston.reaction": GONE, "holders.caliper.force": f"{FORCE} N"}
    assert_same_contacts(brake(state), brake(state | two))


@pytest.mark.parametrize("state", [UNWORN, WORN, WORN | IN_TIME], ids=name_of)
def test_action_and_reaction(state):
    """requirement: a floating disk in a fixed caliper has the same pressures, to 1e-9."""
    fixed = {"holders.piston.reaction": GONE, "holders.caliper.free": []}
    floating = brake(state | fixed | {"holders.hub": {"surface": "disk_inside", "force": "0 N"}})
    assert_same_contacts(brake(state), floating)


def test_both_sides_wear_alike():
    """requirement: in the steady state of equal linings; the caliper follows at that rate."""
    summary = brake({}).summary
    key, holders = "rigid_wear_velocity_m_per_s", summary["holders"]
    assert holders["piston"][key] == pytest.approx(holders["caliper"][key], rel=1e-9)
    volumes = [summary["contacts"][side]["wear_dissipation_W"] for side in ("inner", "outer")]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-9)


def test_histories_of_the_force():
    """requirement: the reaction follows the history of the piston, not that of the caliper."""
    times = {"output_times": ["5 s", "10 s"], "end_time": "20 s", "tolerance": 1e-2}
    timed = {"analysis": {"type": "transient"} | times}
    pulled = {"holders.caliper.force": "60 N"}
    result = brake(RAMP | timed | pulled)
    weights = {side: at_contact(result, side).weight for side in ("inner", "outer")}
    for time, force in ((5.0, 300.0), (10.0, FORCE)):
        for side, more in (("inner", 0.0), ("outer", 60.0)):
            pressure = result.outputs[time].pressure[result.contacts[side]]
            assert weights[side] @ pressure == pytest.approx(force + more, rel=1e-9)
    assert result.summary["holders"]["hub"]["guide_force_z_N"] == pytest.approx(-60.0, rel=1e-9)


def test_a_force_that_drops():
    """requirement: a force that has dropped has dropped on the caliper, too."""
    falling = RAMP["holders.piston"] | {"history": {**HISTORY, "force": ["500 N", "100 N"]}}
    timed = {"analysis": {"type": "transient", "end_time": "10 s", "tolerance": 1e-2}}
    summary = brake(timed | {"holders.piston": falling}).summary
    assert abs(summary["holders"]["hub"]["guide_force_z_N"]) < 1e-9 * FORCE
    assert summary["contacts"]["outer"]["normal_force_N"] == pytest.approx(100.0, rel=1e-9)


PISTON = "holders.piston.reaction"


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({PISTON: "clamp"}, "holders.piston.reaction: found 'clamp'; must be another holder: "),
        ({PISTON: "piston"}, "holders.piston.reaction: a holder cannot bear its own force"),
        ({"holders.caliper.free": []}, "holders.piston.reaction: the holder 'caliper' is not free"),
        ({"holders.caliper.approach": "1 um"}, "holders.piston.reaction: the holder 'caliper'"),
        (
            {"holders.caliper.direction": [1.0, 0.0]},
            "holders.piston.reaction: the holder 'caliper' is not free",
        ),
        ({"holders.piston.force": GONE}, "holders.piston.reaction: needs a force to bear"),
        ({PISTON: 3}, "holders.piston.reaction: "),
    ],
)
def test_faults(changes, line):
    """requirement: in one line with the path of the key."""
    with pytest.raises(CaseError) as caught:
        load(changed(tables(CALIPER), changes))
    (found,) = [text for text in str(caught.value).splitlines() if PISTON in text]
    assert found.strip().startswith(line)


def test_a_caliper_that_slides_aside_bears_no_force_along_the_axis():
    """requirement: of several free motions the force must lie within."""
    from thermowear.laws.motions import spans

    down = (0.0, -1.0)
    assert spans([(0.0, 2.0)], down)
    assert not spans([(1.0, 0.0)], down)
    assert not spans([], down)
    assert spans([(1.0, 0.0), (1.0, 1.0)], down)
    assert not spans([(1.0, 0.0, 0.0), (1.0, 1.0, 0.0)], (0.0, 0.0, 1.0))


def test_moments_of_a_force_beside_the_axis():
    """requirement: in space the guides of caliper and piston take opposite moments of the force."""
    case, pivot, found = tables("two-pads-3d"), {"pivot": ["100 mm", "0 m", "0 m"]}, []
    for x in (100, 110):
        changes = {
            "holders.piston": case["holders"]["piston"]
            | {"reaction": "caliper", "point": [f"{x} mm", "20 mm", "0 m"]}
            | pivot,
            "holders.caliper": case["holders"]["caliper"]
            | {"free": ["z"], "direction": [0.0, 0.0, 1.0]}
            | pivot,
            "holders.hub": {"surface": "DISK_INSIDE", "free": []},
            "mesh.degree": 2,
            "analysis": {"type": "initial"},
        }
        summary = solved("two-pads-3d", changes).summary
        holders = summary["holders"]
        found.append([holders[name]["guide_moment_y_Nm"] for name in ("piston", "caliper")])
        assert forces(summary, ("upper", "lower")) == pytest.approx([1e3, 1e3], rel=1e-9)
    piston, caliper = np.subtract(*found)
    assert piston == pytest.approx(-caliper, rel=1e-9)
    assert abs(piston) == pytest.approx(0.01 * 1e3, rel=1e-6)
