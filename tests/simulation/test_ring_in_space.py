"""Quarter of a ring in space, from a mesh of tetrahedra: convergence, and hot spots round it."""

import numpy as np
import pytest

from thermowear.verification.cases.steady.ring_in_space import (
    FACE_ENDS,
    RUNNING_IN,
    STEADY,
    compared_running_in,
    compared_steady,
    in_space,
    write_ring,
)
from thermowear.verification.check import along, run_starter

COARSE_ENDS = 1e-3 * np.array([20, 22, 26, 34, 50, 75, 98, 112, 118, 120])
BELOW, BETWEEN = "0.06 rad/s", "0.1 rad/s"
"""Speeds below the critical one of the quarter, and between it and the axisymmetric one."""

_QUANTITIES = ("worn shape", "temperature rise", "pressure at", "wear depth")


@pytest.fixture(scope="module")
def coarse(tmp_path_factory):
    """Mesh of a quarter with long elements round the circumference."""
    path = tmp_path_factory.mktemp("ring") / "quarter.msh"
    return write_ring(path, COARSE_ENDS, sectors=3, ratio=3.0)


def running_in(speed):
    analysis = {"type": "transient", "end_time": "1000 s", "tolerance": 1e-3}
    return {"motion": {"angular_velocity": speed}, "analysis": analysis}


def test_hot_spots_round_the_ring_come_first(coarse):
    """requirement: the first mode of a quarter has two waves round the ring, at half the critical
    speed of axisymmetric modes.
    """
    flat = run_starter(
        STEADY,
        "analysis={type='stability'}",
        "mesh={degree=4, elements=8, grading=0.4}",
        "bodies.punch.density=7800 kg/m^3",
        "bodies.punch.specific_heat=460 J/(kg K)",
    )
    assert flat.summary["critical_angular_velocity_rad_per_s"] == pytest.approx(0.1369, rel=2e-3)
    found = in_space(coarse, STEADY, {"analysis": {"type": "stability"}})
    assert found.summary["critical_angular_velocity_rad_per_s"] == pytest.approx(0.0678, rel=2e-3)
    first = found.modes.mode == 1
    x, y, p = found.modes.x[first], found.modes.y[first], found.modes.pressure[first]
    r, angle = np.hypot(x, y), np.arctan2(y, x)
    profile = np.vander((r - 0.07) / 0.05, 5)
    parts = [profile * np.cos(waves * angle)[:, None] for waves in (0, 2, 4)]
    weights = np.linalg.lstsq(np.hstack(parts), p, rcond=None)[0].reshape(3, -1)
    sizes = [np.linalg.norm(part @ w) for part, w in zip(parts, weights, strict=True)]
    assert sizes[1] > 0.98 * np.linalg.norm(p)
    assert max(sizes[0], sizes[2]) < 0.05 * sizes[1]


def unevenness(result):
    """Largest over smallest pressure round the middle of the ring."""
    i = result.interface
    middle = np.abs(np.hypot(i.x, i.y) - 0.07) < 0.01
    return i.pressure[middle].max() / max(i.pressure[middle].min(), 1e-6 * i.pressure.max())


def test_hot_spots_beyond_their_critical_speed(coarse):
    """requirement: running-in keeps the symmetry of rotation below the critical speed of hot
    spots; between it and the axisymmetric one they carry the load, though that model runs.
    """
    below, between = (in_space(coarse, STEADY, running_in(v)) for v in (BELOW, BETWEEN))
    assert below.history[-1].time == between.history[-1].time == 1000.0
    assert unevenness(below) < 1.3
    assert unevenness(between) > 10.0
    flat = run_starter(STEADY, "analysis={type='transient', end_time='1000 s', tolerance=1e-3}")
    assert flat.history[-1].time == 1000.0


@pytest.mark.slow
def test_meshes_of_tetrahedra_follow_deep_wear(coarse):
    """requirement: geometry updates as in the axisymmetric run; worn volume that of the mesh."""
    tables = {
        "wear": {"update": 0.02, "punch": {"coefficient": "2e-7 1/MPa", "per": "friction-stress"}},
        "analysis": {"type": "transient", "end_time": "1500 s", "tolerance": 1e-3},
    }
    found = in_space(coarse, RUNNING_IN, tables)
    flat = run_starter(
        RUNNING_IN,
        "wear.update=0.02",
        "analysis={type='transient', end_time='1500 s', tolerance=1e-3}",
    )
    assert found.summary["geometry_updates"] == flat.summary["geometry_updates"] >= 2
    lost = found.summary["wear_volume_1_m3"]
    assert lost == pytest.approx(found.summary["geometry_volume_1_m3"], rel=1e-5, abs=0.0)
    assert found.summary["geometry_volume_error"] < 1e-9
    assert lost == pytest.approx(flat.summary["wear_volume_1_m3"] / 4, rel=5e-4, abs=0.0)
    i = found.interface
    known = along(flat.interface, np.hypot(i.x, i.y), flat.interface.wear_1)
    np.testing.assert_allclose(i.wear_1, known, rtol=2e-3)


@pytest.mark.slow
def test_errors_fall_with_the_size_of_the_elements(tmp_path):
    """requirement: steady shape, temperature and pressures of the running-in converge."""
    fine = np.sort(np.append(FACE_ENDS, (FACE_ENDS[1:] + FACE_ENDS[:-1]) / 2))
    flat, errors = run_starter(RUNNING_IN), []
    for ends, sectors, ratio, rows in (
        (FACE_ENDS[::2], 2, 4.0, 2),
        (FACE_ENDS, 3, 2.5, 3),
        (fine, 6, 1.6, 6),
    ):
        path = write_ring(tmp_path / "quarter.msh", ends, sectors, ratio=ratio, rows=rows)
        checks = list(compared_steady(in_space(path, STEADY), 0.25))
        checks += compared_running_in(in_space(path, RUNNING_IN), flat, 0.25, "")
        found = {key: [c.error for c in checks if key in c.quantity] for key in _QUANTITIES}
        errors.append([max(found[key]) for key in _QUANTITIES])
    errors = np.array(errors)
    assert np.all(errors[1] < 0.75 * errors[0])
    assert np.all(errors[2] < 0.75 * errors[1])
