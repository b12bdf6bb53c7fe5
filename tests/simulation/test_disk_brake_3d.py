"""Disk brake in space: steady pressure, wear of the disk, and the hot starter."""

import numpy as np
import pytest

import thermowear as tw

from ..case.starter import tables
from ..geometry.test_disk_brake_3d import brake
from .space import changed

NAME, FORCE, SPEED = "disk-brake-3d", 900.0, 10.0
COARSE = {"mesh": {"degree": 2, "elements": 4, "grading": 1.0}}


def run(**changes):
    return tw.run(tw.load(changed(tables(NAME), COARSE | changes)))


@pytest.fixture(scope="module")
def cold():
    """Whole disk without heat, worn ten times as fast as the pad under equal conditions."""
    wear = {"wear.disk.coefficient": "3e-7 1/MPa"}
    return run(**{"heat": None, "wear.pad.coefficient": "3e-8 1/MPa"}, **wear)


def test_steady_wear_of_pad_and_disk(cold):
    """
    requirement: the pad approaches evenly: p r (k_1 + k_2 duty(r)) is uniform, where the disk is
    under the pad for a part of a turn that depends on the radius, at rounded corners.
    """
    i, outline = cold.interface, brake().outline
    r = np.hypot(i.x, i.y)
    duty = outline.half_angle_at(np.clip(r, outline.inner, outline.outer)) / np.pi
    assert np.ptp(duty) > 0.1 * duty.max()
    rate = i.pressure * SPEED * r * (3e-14 + 3e-13 * duty)
    velocity = cold.summary["rigid_wear_velocity_m_per_s"]
    np.testing.assert_allclose(rate, velocity, rtol=0.03)  # the duty is steep in the corners
    assert np.quantile(np.abs(rate / velocity - 1), 0.95) < 1e-3
    assert np.ptp(i.pressure * r) > 0.03 * (i.pressure * r).max()
    assert i.weight @ i.pressure == pytest.approx(FORCE, rel=1e-9)
    assert i.weight.sum() == pytest.approx(outline.area, rel=1e-3)


def test_the_other_pad_balances_the_force(cold):
    """requirement: without it, the pad bends the disk away from it; the ring tilts."""
    alone = run(heat=None, **{"load.pressure": None, "wear.disk": None})
    bent, straight = (
        np.abs(r.fields.displacement[r.fields.body == 2][..., 2]).max() for r in (alone, cold)
    )
    assert bent > 5 * straight


@pytest.mark.slow
def test_worn_volumes():
    """requirement: both bodies lose k F s at every place: their volumes are in the ratio of k."""
    after = {"type": "transient", "end_time": "2000 s", "tolerance": 1e-2}
    summary = run(heat=None, analysis=after).summary
    first, second = (summary[f"wear_volume_{body}_m3"] for body in (1, 2))
    assert second / first == pytest.approx(5e-16 / 3e-14, rel=1e-9)
    # the mean sliding distance is that of a radius within the pad
    for radius, sign in ((0.098, 1), (0.107, -1)):
        assert sign * first > sign * 3e-14 * FORCE * SPEED * radius * 2000


def test_hot_starter():
    """requirement: heat balance; the disk is hottest on its track, its flange is cold."""
    result = run()
    summary = result.summary
    assert summary["heat_balance_relative_error"] < 1e-9
    assert summary["equilibrium_relative_error"] < 1e-9
    assert summary["prescribed_heat_W"] == pytest.approx(340.0)
    r = summary["friction_torque_Nm"] / (0.38 * FORCE)
    assert summary["friction_power_W"] == pytest.approx(0.38 * FORCE * SPEED * r, rel=1e-9)
    fields = result.fields
    on_disk = fields.body == 2
    points, rise = fields.points[on_disk], fields.temperature[on_disk] - 293.15
    away = np.hypot(points[..., 0], points[..., 1])
    hottest = away.ravel()[rise.argmax()]
    assert 0.1 < hottest < 0.126
    assert rise.min() > 0
    hub = (away < 0.04) & (points[..., 2] > 0.025)
    assert rise[hub].max() < 0.4 * rise.max()
    # both faces of the ring rub: nearly the same temperatures on the other side
    track = np.abs(away - 0.1) < 0.01
    faces = [rise[track & (np.abs(points[..., 2] - z) < 1e-9)].mean() for z in (0.0, -0.012)]
    assert faces[0] == pytest.approx(faces[1], rel=0.03)


HALF = {
    "geometry.half": True,
    "load.pressure": None,
    "heat.power": None,
    "heat.cooling.disk_back": None,
}


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
def test_hot_half_disk(solver):
    """
    requirement: the middle of the ring stays flat and expands freely in its plane, the hub is at
    rest; the hat, where it is bolted, takes the moment of friction; no heat passes the middle.
    """
    coarse = {"degree": 2, "elements": 4, "grading": 1.0, "solver": solver}
    result = run(**HALF, mesh=coarse, **{"motion.angular_velocity": "1 rad/s"})
    assert result.summary["heat_balance_relative_error"] < 1e-6
    assert result.summary["equilibrium_relative_error"] < 1e-6
    fields = result.fields
    at, u, rise = (
        values[fields.body == 2]
        for values in (fields.points, fields.displacement, fields.temperature - 293.15)
    )
    r = np.hypot(at[..., 0], at[..., 1])
    middle, top = (np.abs(at[..., 2] - z) < 1e-9 for z in (-0.006, 0.026))
    largest = np.linalg.norm(u, axis=-1).max()
    assert np.abs(u[middle, 2]).max() < 1e-4 * largest  # sampled slightly inside of the cells
    assert np.abs(u[top & (r < 0.0541)]).max() < 1e-4 * largest
    assert np.abs(u[top & (r > 0.056), 2]).max() > 0.05 * largest
    grown = np.einsum("...i,...i->...", u[..., :2], at[..., :2]) / r
    rim = middle & (r > 0.13 - 1e-9)
    turned = (at[..., 0] * u[..., 1] - at[..., 1] * u[..., 0])[rim].mean() / 0.13
    free = 1.1e-5 * 0.13 * rise[middle].mean()
    assert grown[rim].mean() == pytest.approx(free, rel=0.05)
    assert turned < 0
