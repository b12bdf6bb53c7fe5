"""Whole runs in space: special case 2, a brake pad, running-in, fields, two ranks."""

import numpy as np
import pytest
import tomli_w

import thermowear as tw

from ..case.starter import changed, solved
from ..test_parallel import summaries
from .space import BRAKE, PUNCH


def run(tables, **changes):
    return tw.run(tw.load(changed(tables, {k.replace("__", "."): v for k, v in changes.items()})))


TABLE = {
    0.5: (3.213694, 2.038987, 1.130360),
    1.0: (3.125000, 2.083333, 1.041667),
    2.0: (2.980545, 2.170253, 0.732357),
}
"""Pressure at x = -30, 0 and 30 mm [MPa]: p^b is linear in x, and p in equilibrium."""


@pytest.mark.parametrize("exponent", TABLE)
def test_steady_pressure_under_an_eccentric_force(exponent):
    """requirement: special case 2, the pressure to all digits of the table, any b."""
    law = {"pressure_exponent": exponent, "coefficient": f"2e-7 1/MPa^{exponent}"}
    result = run(PUNCH, wear__punch=law, mesh__elements=6)
    i = result.interface
    for x, expected in zip((-0.03, 0.0, 0.03), TABLE[exponent], strict=True):
        at = np.abs(i.x - x) < 1e-9
        assert at.sum() > 4
        np.testing.assert_allclose(i.pressure[at] / 1e6, expected, rtol=0, atol=1e-3)
    w, p = i.weight, i.pressure
    assert w @ p == pytest.approx(1e4, rel=1e-9)
    np.testing.assert_allclose([w @ (p * i.x), w @ (p * i.y)], [-50.0, 0.0], atol=1e-8)
    assert result.summary["guide_force_N"] == pytest.approx(2500.0)
    assert result.summary["contact_area_m2"] == pytest.approx(0.0048)
    assert result.summary["contact_zones_m"] == []


def test_moments_act_as_an_eccentric_force():
    """requirement: moments by the right-hand rule: a force down at x < 0 turns about -y."""
    off, turned = (
        run(PUNCH, load=load)
        for load in (
            {"force": "10 kN", "point": ["-5 mm", "3 mm"]},
            {"force": "10 kN", "moments": ["-30 N m", "-50 N m"]},
        )
    )
    np.testing.assert_allclose(turned.interface.pressure, off.interface.pressure, rtol=1e-10)


def test_running_in_ends_at_the_principle():
    """requirement: the same pressure and shape by wearing as directly; volumes add up."""
    until = {"type": "transient", "until": "steady", "tolerance": 1e-4}
    worn, steady = run(PUNCH, analysis=until), run(PUNCH)
    np.testing.assert_allclose(
        worn.interface.pressure, steady.interface.pressure, atol=3e-3 * 3.125e6
    )
    w, depth = steady.interface.weight, worn.interface.wear_1
    # both shapes are the same but for a rigid motion
    rigid = np.column_stack([np.ones_like(w), steady.interface.x, steady.interface.y])
    difference = worn.interface.shape - steady.interface.shape
    left = difference - rigid @ np.linalg.lstsq(rigid, difference, rcond=None)[0]
    assert np.abs(left).max() < 2e-2 * np.ptp(depth)
    assert worn.summary["wear_volume_1_m3"] == pytest.approx(w @ depth, rel=1e-12, abs=0.0)
    assert worn.summary["max_pressure_Pa"] < 0.8 * worn.history[0].max_pressure


def test_friction_does_not_tilt_a_held_pad():
    """requirement: special case 9, p = F/(θ ri (ro - ri)) ri/r; the drag is held by the guide."""
    result = run(BRAKE)
    i, s = result.interface, result.summary
    r = np.hypot(i.x, i.y)
    # the arcs of the mesh are of order 2
    np.testing.assert_allclose(i.pressure, 1e4 / (np.pi / 3 * 0.04 * r), rtol=5e-4)
    assert s["friction_torque_Nm"] == pytest.approx(0.35 * 1e4 * 0.1, rel=1e-4)
    drag = 0.35 * i.weight @ (i.pressure * i.x / r)
    assert s["guide_force_N"] == pytest.approx(0.0, abs=1e-6 * drag)
    assert s["guide_force_y_N"] == pytest.approx(-drag, rel=1e-9)


def test_a_pad_that_may_tilt():
    """requirement: p v = a plane, in equilibrium at the centroid of the pad."""
    result = run(BRAKE, holder={"free": ["z", "rotation-x", "rotation-y"]})
    i = result.interface
    plane = np.column_stack([np.ones_like(i.x), i.x, i.y])
    rate = i.pressure * np.hypot(i.x, i.y)
    left = rate - plane @ np.linalg.lstsq(plane, rate, rcond=None)[0]
    assert np.abs(left).max() < 1e-8 * rate.max()
    middle = (i.weight * i.pressure) @ np.column_stack([i.x, i.y]) / 1e4
    centroid = tw.load(BRAKE).geometry.pivot_point[:2]
    np.testing.assert_allclose(middle, centroid, atol=1e-9)


@pytest.mark.slow
def test_faces_need_not_match():
    """requirement: approach and curvature of the worn shape are those on matching faces."""
    same = run(PUNCH, mesh__degree=3)
    other = run(PUNCH, mesh__degree=3, mesh__bodies={"block": {"elements": 5}})
    assert other.summary["contact_points"] > same.summary["contact_points"]
    assert other.summary["approach_m"] == pytest.approx(
        same.summary["approach_m"], rel=1e-3, abs=0.0
    )
    np.testing.assert_allclose(curvature(other), curvature(same), rtol=0.05)


def curvature(result):
    """Coefficients of x² and y² of the shape away from the edges, best in the mean."""
    i = result.interface
    inner = (np.abs(i.x) < 0.025) & (np.abs(i.y) < 0.035)
    terms = np.column_stack([i.x**j * i.y**k for j in range(4) for k in range(4 - j)])
    root = np.sqrt(i.weight * inner)
    found = np.linalg.lstsq(root[:, None] * terms, root * i.shape, rcond=None)[0]
    return found[7], found[2]


def test_fields_fill_the_bodies():
    """requirement: small hexahedra of positive volume; the holder's motion where it holds."""
    result = run(PUNCH)
    fields = result.fields
    corners = fields.points[:, fields.pieces]
    first, a, b, c = (corners[:, :, k] for k in (0, 1, 3, 4))
    volumes = np.einsum("cpi,cpi->cp", np.cross(a - first, b - first), c - first)
    assert volumes.min() > 0
    assert volumes[fields.body == 1].sum() == pytest.approx(0.06 * 0.08 * 0.05, rel=1e-9, abs=0.0)
    assert volumes[fields.body == 2].sum() == pytest.approx(0.12 * 0.14 * 0.06, rel=1e-9, abs=0.0)
    z, u = fields.points[..., 2], fields.displacement
    np.testing.assert_allclose(u[np.abs(z + 0.06) < 1e-12], 0.0, atol=1e-6 * np.abs(u).max())
    held = np.abs(z - 0.05) < 1e-12
    places = fields.points[held]
    rigid = np.column_stack([np.ones(len(places)), places[:, :2]])
    motion = np.linalg.lstsq(rigid, u[held][:, 2], rcond=None)[0]
    np.testing.assert_allclose(rigid @ motion, u[held][:, 2], atol=1e-6 * np.abs(u).max())
    assert motion[0] == pytest.approx(-result.summary["approach_m"], rel=1e-5, abs=0.0)
    assert fields.von_mises.min() >= 0


@pytest.mark.slow
def test_two_ranks_give_the_serial_numbers(tmp_path):
    """requirement: in space, every number of the summary to 1e-8 of the serial run."""
    case = tmp_path / "case.toml"
    ending = {"type": "transient", "end_time": "1000 s"}
    other = {"analysis": ending, "mesh.bodies": {"block": {"elements": 3}}}
    case.write_text(tomli_w.dumps(changed(PUNCH, other)), encoding="utf-8")
    (serial, _), (parallel, _) = summaries(tmp_path, case)
    for key, value in serial.items():
        if "error_estimate" in key:  # by an inner iteration
            assert parallel[key] == pytest.approx(value, rel=1e-2), key
        elif isinstance(value, float) and not key.endswith("relative_error"):
            near = 1e-8 * abs(serial["normal_force_N"] if key.endswith("_N") else value)
            assert parallel[key] == pytest.approx(value, rel=1e-8, abs=max(near, 1e-18)), key


HOT = (
    "bodies.punch.conductivity=50 W/(m K)",
    "bodies.punch.expansion=1.2e-5 1/K",
    "contact.friction=0.2",
    "motion.velocity=0.5 mm/s",
    "heat={conductance='1e5 W/(m^2 K)', ambient='20 degC', cooling={punch_top='2000 W/(m^2 K)',"
    " block_bottom='2000 W/(m^2 K)'}}",
)


@pytest.mark.parametrize(
    "analysis", ["{type='steady'}", "{type='transient', until='steady'}"], ids=["steady", "worn"]
)
def test_heat_in_space(analysis):
    """requirement: heat balances; it changes the worn shape and not the steady pressure."""
    coarse = ("mesh.degree=2", "mesh.elements=4", f"analysis={analysis}")
    hot = solved("rectangular-punch", None, *coarse, *HOT)
    assert hot.stopped is None
    summary = hot.summary
    assert summary["heat_balance_relative_error"] < 1e-9
    assert summary["friction_power_W"] == pytest.approx(0.2 * 1e4 * 0.5e-3, rel=1e-9)
    assert 293.2 < summary["max_temperature_K"] < 294.0
    # friction tilts it further: mu F acts in the face, about the pivot at its middle
    assert summary["max_pressure_Pa"] == pytest.approx(3.125e6, rel=3e-3)
