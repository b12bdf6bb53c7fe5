"""Wear of a disk along its track under a sector pad, in space."""

import math

import numpy as np
import pytest

import thermowear as tw

from ..case.starter import changed
from .space import BRAKE

FORCE, SPEED, FRICTION, ANGLE, INNER, OUTER = 1e4, 50.0, 0.35, math.pi / 3, 0.08, 0.12
PAD, DISK = 2e-13, 6e-13
WORN = changed(
    BRAKE,
    {
        "mesh": {"degree": 2, "elements": 4, "grading": 0.5},
        "wear.disk": {"coefficient": "6e-7 1/MPa", "spread": "track"},
    },
)
IN_TIME = {"analysis": {"type": "transient", "end_time": "20 s"}}
RING = {
    "model": "axisymmetric",
    "geometry.type": "disk-brake",
    "mesh": {"degree": 3, "elements": 6},
}


def run(*changes):
    case = WORN
    for change in changes:
        case = changed(case, change)
    return tw.run(tw.load(case))


@pytest.fixture(scope="module")
def in_time():
    """Pad and disk on matching meshes after 20 s."""
    return run(IN_TIME)


@pytest.fixture(scope="module")
def ring():
    """Pad and disk after 20 s, with the pads modelled as a ring."""
    return run(IN_TIME, RING)


def test_steady_wear_of_pad_and_disk():
    """
    requirement: p r = const; the pad wears by k mu p v, the disk by its own for the part of a turn
    for which it is under the pad.
    """
    result = run()
    i = result.interface
    r = np.hypot(i.x, i.y)
    pressure = FORCE / (ANGLE * (OUTER - INNER)) / r
    local = FRICTION * pressure * SPEED * r
    np.testing.assert_allclose(i.pressure, pressure, rtol=2e-5)
    np.testing.assert_allclose(i.wear_rate_1, PAD * local, rtol=2e-5)
    np.testing.assert_allclose(i.wear_rate_2, DISK * local / 6, rtol=2e-5)
    velocity = result.summary["rigid_wear_velocity_m_per_s"]
    assert velocity == pytest.approx((PAD + DISK / 6) * local.mean(), rel=2e-5)


@pytest.mark.parametrize("matching", [True, False])
def test_worn_volumes_are_those_of_the_ring(in_time, ring, matching):
    """
    requirement: both bodies lose volume in the ratio of their laws, exactly, as local rates are in
    it; the same volumes as those of pads modelled as a ring, within what the ends of the pad do.
    """
    pad = in_time if matching else run(IN_TIME, {"mesh.bodies": {"disk": {"elements": 3}}})
    for result in (pad, ring):
        first, second = (result.summary[f"wear_volume_{body}_m3"] for body in (1, 2))
        assert second / first == pytest.approx(DISK / PAD, rel=1e-9)
    lost = pad.summary["wear_volume_2_m3"]
    assert lost == pytest.approx(ring.summary["wear_volume_2_m3"], rel=2e-3)
    assert pad.summary["equilibrium_relative_error"] < 1e-9


def test_the_track_is_even_round_the_axis(in_time):
    """
    requirement: the disk's depth depends on the radius alone, while the pad's is uneven along it.
    """
    i = in_time.interface
    r = np.hypot(i.x, i.y)
    middle = np.abs(r - r[np.abs(r - 0.1).argmin()]) < 1e-5
    assert middle.sum() >= 4
    assert np.ptp(i.wear_1[middle]) > 0.01 * i.wear_1.max()
    assert np.ptp(i.wear_2[middle]) < 1e-4 * i.wear_2.max()


@pytest.mark.slow
def test_a_disk_that_wears_most_runs_in_to_the_steady_state():
    """
    requirement: steps of wear are solved at any size: transient and principle agree.
    """
    soft = {"wear.disk.coefficient": "2e-5 1/MPa", "mesh.degree": 3}
    until = {"analysis": {"type": "transient", "until": "steady", "steady_tolerance": 1e-3}}
    reached, direct = run(soft, until), run(soft)
    size = direct.interface.pressure.max()
    np.testing.assert_allclose(
        reached.interface.pressure, direct.interface.pressure, atol=3e-3 * size, rtol=0
    )
    assert reached.summary["steps"] < 200
