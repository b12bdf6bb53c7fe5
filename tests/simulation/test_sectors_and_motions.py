"""Pads that cover a sector of a ring, and pads that turn as well, against closed forms."""

import math

import numpy as np
import pytest

import thermowear as tw
from thermowear.verification.cases.assembly.pad_disk_pad import FORCE, FRICTION, SPEED, Brake

from ..case.starter import GONE, changed

INNER, OUTER = 0.08, 0.13
"""Radii of the pads [m]."""
TORQUE = FRICTION * FORCE * (INNER + OUTER) / 2
"""Of a face that wears uniformly: its pressure times the radius is constant [N m]."""
PADS = Brake("floating", 9.0, elements=3)
SECTOR = {"geometry.angle": "60 deg", "geometry.whole": ["disk"]}
RIM, HEIGHT, COOLING = 0.135, 0.012, 20.0


@pytest.mark.parametrize("pad", [0.2, 0.7, -0.3])
def test_pads_that_turn(pad):
    """requirement: power and sense of the torque by the relative speed of each contact."""
    moved = {"motions.left": {"angular_velocity": f"{pad} rad/s"}}
    found = tw.run(tw.load(changed(PADS.tables("steady"), moved))).summary
    contacts, bodies = found["contacts"], found["bodies"]
    slips = {"left": SPEED - pad, "right": SPEED}
    for name, slip in slips.items():
        power = TORQUE * abs(slip)
        assert contacts[name]["friction_power_W"] == pytest.approx(power, rel=1e-9)
        dragged = math.copysign(TORQUE, slip)
        assert bodies[name]["friction_torque_Nm"] == pytest.approx(dragged, rel=1e-9)
    both = sum(math.copysign(TORQUE, slip) for slip in slips.values())
    assert bodies["disk"]["friction_torque_Nm"] == pytest.approx(-both, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("state", ["unworn", "after running-in"])
def test_a_pad_that_turns_with_the_disk(state):
    """requirement: no friction and no wear where nothing slides."""
    moved = {"motions.left": {"angular_velocity": f"{SPEED} rad/s"}}
    contacts = tw.run(tw.load(changed(PADS.tables(state), moved))).summary["contacts"]
    left, right = contacts["left"], contacts["right"]
    assert left["normal_force_N"] == pytest.approx(FORCE, rel=1e-9)
    assert left["friction_torque_Nm"] == left["friction_power_W"] == left["wear_volume_1_m3"] == 0.0
    assert right["friction_power_W"] > 0.0


def test_a_whole_ring_is_cooled_all_round():
    """requirement: a disk that conducts well loses the power through the rim of its whole ring."""
    changes = {
        "heat": {"partition": 0.0, "conductance": "1e-6 W/(m^2 K)", "ambient": "20 degC"},
        "heat.cooling": {
            "disk_outside": f"{COOLING} W/(m^2 K)",
            "left_top": "1 W/(m^2 K)",
            "right_bottom": "1 W/(m^2 K)",
        },
        "bodies.disk.conductivity": "1e6 W/(m K)",
    }
    found = tw.run(tw.load(changed(PADS.tables("steady"), SECTOR | changes)))
    rise = 2 * TORQUE * SPEED / (COOLING * 2 * math.pi * RIM * HEIGHT)
    np.testing.assert_allclose(found.interface.temperature_2 - 293.15, rise, rtol=1e-4)


@pytest.mark.parametrize(("spread", "share"), [("track", 1 / 6), ("in-place", 1.0)])
def test_a_track_wears_by_the_part_of_the_ring_under_the_pads(spread, share):
    """requirement: one sixth of the rate at a point under the pads, where the ring wears evenly."""
    law = {"coefficient": "1e-7 1/MPa", "per": "pressure"}
    wear = {"wear": {"left": law, "right": law, "disk": law | {"spread": spread}}, "heat": GONE}
    case = changed(Brake("floating", 9.0, heated=True, elements=3).tables("steady"), SECTOR | wear)
    found = tw.run(tw.load(case)).interface
    np.testing.assert_allclose(found.wear_rate_2, share * found.wear_rate_1, rtol=1e-12)
    force_per_radius = 6 * FORCE / (2 * math.pi * (OUTER - INNER))
    np.testing.assert_allclose(found.pressure * found.x, force_per_radius, rtol=1e-9)
