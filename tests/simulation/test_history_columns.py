"""Columns of ``history.csv`` compared with the summary and the contact faces at the end."""

import numpy as np
import pytest

import thermowear as tw

from ..conftest import COLD_RUNNING_IN, DEMOS

SMALL = ("mesh.degree=2", "mesh.elements=3")
CASES = {
    "ring": (COLD_RUNNING_IN, (*SMALL, "analysis.output_times=[]", "analysis.end_time=10 s")),
    "geometry updates": (
        DEMOS / "annular_punch_deep.toml",
        (*SMALL, "analysis.output_times=[]", "analysis.end_time=20 h"),
    ),
    "in time": (DEMOS / "disk_brake_stop.toml", ("mesh.degree=2",)),
    "translation": (
        DEMOS / "stacked_blocks_at_rest.toml",
        ("analysis.end_time=1 s", "analysis.output_times=[]"),
    ),
    "turning disk": (
        DEMOS / "block_on_disk.toml",
        ("mesh.degree=2", "analysis.type=transient", "analysis.end_time=1 s"),
    ),
}


@pytest.fixture(scope="module", params=CASES)
def result(request):
    path, overrides = CASES[request.param]
    return tw.run(tw.load(path, overrides))


def test_the_last_row_agrees_with_the_summary(result):
    """requirement: friction power, force and torque of the summary; NaN where it has none."""
    row, summary = result.history[-1], result.summary
    assert row.friction_power == summary["friction_power_W"]
    assert row.friction_force == summary["friction_force_N"]
    torque = summary["friction_torque_Nm"]
    assert np.isnan(row.friction_torque) if torque is None else row.friction_torque == torque


def test_depths_are_those_of_the_faces(result):
    """requirement: largest depth since the start, with that which geometry updates have moved."""
    row, interface = result.history[-1], result.interface
    assert (row.max_wear_1, row.max_wear_2) == (interface.wear_1.max(), interface.wear_2.max())
    depths = np.array([row.max_wear_1 for row in result.history])
    assert np.all(np.diff(depths) >= 0.0)


def test_worn_volumes_are_those_of_the_summary(result):
    """requirement: volumes since the start, also where meshes follow the wear."""
    row, summary = result.history[-1], result.summary
    found = row.wear_volume_1, row.wear_volume_2
    expected = [summary[f"wear_volume_{body}_m3"] for body in (1, 2)]
    assert found == pytest.approx(expected, rel=1e-9, abs=0.0)


def test_worn_volume_is_that_of_the_friction_work():
    """
    requirement: k times the friction work for wear in proportion to the friction stress, to the
    trapezoidal rule of the friction power, through several geometry updates.
    """
    path, overrides = CASES["geometry updates"]
    found = tw.run(tw.load(path, overrides))
    assert found.summary["geometry_updates"] > 1
    time, power, volume = (
        np.array([getattr(row, key) for row in found.history])
        for key in ("time", "friction_power", "wear_volume_1")
    )
    work = np.trapezoid(power, time)
    assert volume[-1] == pytest.approx(2e-13 * work, rel=1e-3)


def test_friction_power_is_that_of_heat():
    """requirement: the same friction power in both tables."""
    path, overrides = CASES["in time"]
    found = tw.run(tw.load(path, overrides))
    for row, heat in zip(found.history, found.heat, strict=True):
        assert row.friction_power == pytest.approx(heat.friction_power, rel=1e-12)
    assert max(row.friction_torque for row in found.history) > 0.0


def test_several_bodies():
    """requirement: power of all contacts; forces and torques are those of single contacts."""
    case = tw.load(
        DEMOS / "disk_brake_two_pads.toml",
        ("mesh.degree=2", "analysis.type=transient", "analysis.end_time=1 s"),
    )
    found = tw.run(case)
    row = found.history[-1]
    assert row.friction_power == pytest.approx(found.summary["friction_power_W"], rel=1e-12)
    assert np.isnan([row.friction_force, row.friction_torque]).all()
    assert row.max_wear_1 == found.interface.wear_1.max()


def test_a_cycle():
    """
    requirement: in reciprocating sliding mean power and force of the cycle, mu F v and mu F, and
    the largest depths of the face and of the track.
    """
    found = tw.run(tw.load(DEMOS / "punch_on_strip_reciprocating.toml", ("mesh.elements=6",)))
    row, summary = found.history[-1], found.summary
    pressing = summary["friction"] * summary["normal_force_N"]
    assert row.friction_force == pytest.approx(pressing, rel=1e-9)
    speed = row.sliding_distance / row.time
    assert row.friction_power == pytest.approx(pressing * speed, rel=1e-2)
    assert row.max_wear_1 == pytest.approx(found.interface.wear_1.max(), rel=1e-12)
    assert row.max_wear_2 == found.track.last.wear_2.max()
    assert np.isnan(row.friction_torque)
