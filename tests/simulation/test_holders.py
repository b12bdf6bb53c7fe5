"""Holders that turn, slide across, or are fixed: against statics and closed forms."""

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import ComputationError, RunNote

from ..case.starter import GONE, solved
from .random_pads import random_scene

BLOCK, TILTING, DRUM, DISK = (
    "pivoted-block",
    "punch-on-strip-tilting",
    "drum-brake",
    "block-on-disk",
)
COARSE = ("mesh.degree=3", "mesh.elements=8")
INITIAL = "analysis={type='initial'}"


@pytest.mark.parametrize(
    ("velocity", "first", "last"),
    [("-50 mm/s", 0.831025e6, 2.493075e6), ("50 mm/s", 1.038062e6, 3.114187e6)],
)
def test_a_block_on_a_pivot(velocity, first, last):
    """requirement: special case 5, both senses; the table's digits."""
    result = solved(BLOCK, None, *COARSE, f"motion.velocity={velocity}")
    pressure = result.interface.pressure
    assert (pressure[0], pressure[-1]) == pytest.approx((first, last), rel=1e-6)
    exact = first + (last - first) * (result.interface.x - 0.05) / 0.1
    assert pressure == pytest.approx(exact, rel=1e-6)


def test_it_locks_where_friction_carries_more_than_the_lever():
    """requirement: self-locking is reported as such, not answered by a pressure."""
    with pytest.raises(ComputationError, match="lock"):
        solved(BLOCK, None, *COARSE, "motion.velocity=50 mm/s", "geometry.pivot_height=400 mm")


def test_a_cold_punch_that_locks_says_nothing_of_heat():
    """requirement: the reason for no equilibrium is the case's own: friction, not its heat."""
    small = ("mesh.degree=2", "mesh.elements=8", INITIAL)
    with pytest.raises(ComputationError, match="friction along the faces") as caught:
        solved(TILTING, None, *small, "contact.friction=20.0")
    assert "heat" not in str(caught.value)


@pytest.mark.parametrize("friction", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("sense", [-1, 1])
def test_a_block_that_tilts(friction, sense):
    """requirement: special case 6; the straight line that balances force and moment of friction."""
    law = "wear.punch={coefficient='1e-7 1/MPa', per='pressure'}"
    speed = f"motion.velocity={50 * sense} mm/s"
    result = solved(TILTING, None, *COARSE, law, speed, f"contact.friction={friction}")
    force, width, thickness, pin, offset = 3e3, 0.06, 0.01, 0.015, 2e-3
    # the drag -sense mu F at the face, 15 mm below the pin, adds to the moment of the load
    eccentricity = offset + sense * friction * pin
    exact = force / (thickness * width) * (1 + 12 * eccentricity * result.interface.x / width**2)
    assert result.interface.pressure == pytest.approx(exact, rel=1e-6)
    assert result.summary["guide_force_N"] == pytest.approx(sense * friction * force, abs=1e-6)


def test_the_trailing_edge_lifts_off():
    """requirement: partial contact is the triangle that carries force and moment."""
    result = solved(TILTING, None, "mesh.elements=40", "contact.friction=0.9")
    force, width, thickness = 3e3, 0.06, 0.01
    eccentricity = 2e-3 - 0.9 * 0.015
    length = 3 * (width / 2 + eccentricity)
    peak = 2 * force / (thickness * length)
    x = result.interface.x + width / 2
    exact = np.maximum(peak * (1 - x / length), 0.0)
    assert result.interface.pressure == pytest.approx(exact, abs=2e-3 * peak)


@pytest.mark.parametrize("name", [BLOCK, TILTING, DRUM, DISK])
def test_what_the_guides_hold(name):
    """requirement: contact, load and guides are in equilibrium, and friction has its moment."""
    result = solved(name, None, "mesh.degree=3", "mesh.elements=16", INITIAL)
    summary, i, profile = result.summary, result.interface, result.profile
    assert summary["equilibrium_relative_error"] < 1e-9
    tangent = np.array([-profile.normal_y, profile.normal_x])
    friction = {BLOCK: 0.3, TILTING: 0.3, DRUM: 0.35, DISK: 0.3}[name]
    # of body 1: along -x over strips, clockwise over what turns anticlockwise
    sense = {BLOCK: -1, TILTING: -1, DRUM: -1, DISK: 1}[name]
    if name in (BLOCK, TILTING):
        e = np.array([sense * np.ones_like(i.x), np.zeros_like(i.x)])
    else:
        radius = np.hypot(i.x, i.y)
        e = sense * np.array([i.y, -i.x]) / radius
    assert np.abs((e * tangent).sum(axis=0)) == pytest.approx(1.0, abs=1e-5)
    normals = np.array([profile.normal_x, profile.normal_y])
    on_body_1 = -(i.weight * i.pressure * (normals + friction * e)).sum(axis=1)
    loads = {BLOCK: (0.0, -1e3), TILTING: (0.0, -3e3), DRUM: (0.0, 0.0), DISK: (0.0, -1e3)}[name]
    held = -on_body_1 - np.array(loads)
    near = 1e-5 * np.abs(on_body_1).max()  # curved cells follow arcs to this
    assert summary["guide_force_N"] == pytest.approx(held[0], abs=near)
    free_z = name in (TILTING, DISK)
    assert held[1] == pytest.approx(0.0 if free_z else summary["guide_force_z_N"], abs=near)


def test_a_leading_shoe_brakes_more_than_a_trailing_one():
    """requirement: the ratio of torques is that of the closed form of the long shoe."""
    leading, trailing = (
        solved(DRUM, None, f"motion.angular_velocity={w} rad/s").summary["friction_torque_Nm"]
        for w in (-5, 5)
    )
    friction, radius, pivot = 0.35, 0.1, 0.075
    α = np.linspace(*np.radians([35, 145]), 20001)
    arm = pivot * np.sin(α)  # of the normal force about the pivot
    # friction acts along the circle: its arm is the radius plus the pivot's depth along the normal
    drag = friction * (radius + pivot * np.cos(α))
    normal, of_friction = np.trapezoid(arm**2, α), np.trapezoid(arm * drag, α)
    exact = (normal + of_friction) / (normal - of_friction)
    assert leading / trailing == pytest.approx(exact, rel=1e-3)
    assert leading > trailing


def test_a_block_that_is_pushed_in_place_of_guided():
    """requirement: the force of the guide, given as a load, leaves the steady state as it is."""
    guided = solved(DISK, None, *COARSE)
    push = guided.summary["guide_force_N"]
    free = ("holder.free=['z','x']", f"load.tangential_force={push!r} N")
    pushed = solved(DISK, None, *COARSE, *free)
    assert pushed.interface.pressure == pytest.approx(guided.interface.pressure, rel=1e-8)
    assert pushed.summary["normal_force_N"] == pytest.approx(1e3, rel=1e-9)
    assert "guide_force_N" in pushed.summary
    assert pushed.summary["guide_force_N"] is None
    drift = pushed.summary["rigid_wear_velocity_x_m_per_s"]
    assert abs(drift) < 1e-8 * pushed.summary["rigid_wear_velocity_m_per_s"]
    # with a little less of it the block wears to one side as well
    less = ("holder.free=['z','x']", f"load.tangential_force={0.9 * push!r} N")
    drifting = solved(DISK, None, *COARSE, *less).summary
    assert abs(drifting["rigid_wear_velocity_x_m_per_s"]) > 1e-2 * abs(
        drifting["rigid_wear_velocity_m_per_s"]
    )


def test_lever_point_and_moment_say_the_same():
    """requirement: a force down at x turns clockwise; a moment for a mere turn presses."""
    point, lever, moment = (
        solved(TILTING, {"load": {"force": "3 kN"} | more}, *COARSE).interface.pressure
        for more in (
            {"point": ["2 mm"]},
            {"lever": "2 mm"},
            {"moment": "-6 N m"},  # anticlockwise is positive
        )
    )
    assert lever == pytest.approx(point, rel=1e-12)
    assert moment == pytest.approx(point, rel=1e-12)
    by_lever = solved(BLOCK, None, *COARSE).interface.pressure
    by_moment = solved(BLOCK, {"load": {"moment": "200 N m"}}, *COARSE).interface.pressure
    assert by_moment == pytest.approx(by_lever, rel=1e-12)


def test_a_soft_layer_takes_the_edges_off():
    """requirement: a Winkler layer between stiff bodies spreads the force evenly; it closes."""
    stiff = {"bodies.punch.young_modulus": "2e5 GPa"}
    layer = ("contact.compliance=1e-3 mm/MPa", "contact.friction=0.0")
    cold = stiff | {"heat": GONE, "wear": GONE}
    soft = solved("punch-on-strip", cold, *COARSE, INITIAL, *layer)
    assert soft.interface.pressure == pytest.approx(10e6, rel=1e-3)
    assert soft.summary["approach_m"] == pytest.approx(1e-5, rel=1e-2, abs=0.0)
    assert np.abs(soft.interface.gap).max() < 1e-3 * 1e-5


def test_a_pad_that_touches_right_below_its_pivot(tmp_path):
    """requirement: the load is carried; a note says that the pressure leaves the tilt free."""
    with pytest.warns(RunNote, match="pad0: the pressure does not determine the tilt"):
        tw.run(tw.load(random_scene(30).case(tmp_path)))


def test_a_hot_pad_that_tips_says_so(tmp_path):
    """requirement: the reason is not its heat where it has no equilibrium without heat either."""
    with pytest.raises(ComputationError, match="tips it over an edge"):
        tw.run(tw.load(random_scene(24).case(tmp_path)))
