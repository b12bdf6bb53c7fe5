"""Runs of meshes in space made by gmsh, compared with axisymmetric runs."""

import math
from functools import cache

import numpy as np
import pytest

import thermowear as tw

from ..case.starter import SPHERE, STEADY, tables
from ..rings_and_spheres import GLUED, NAMES, QUARTER, write_quarter_sphere, write_ring
from ..solid_meshes import BLOCKS, write_blocks

SIZES = {"block_radius": "12 mm", "block_height": "12 mm"}
"""Of the block of `write_quarter_sphere`."""
PRESSURE, AREA = 50e6, math.pi * (0.12**2 - 0.02**2)
"""Mean pressure of the starter, and area of the ring [Pa, m²]."""


@cache
def axisymmetric(kind):
    """Result of the starter of an annular punch."""
    case = tables(STEADY)
    case["analysis"], case["motion"] = ANALYSES[kind], MOTIONS[kind]
    return tw.run(tw.load(case))


ANALYSES = {
    "initial": {"type": "initial"},
    "steady": {"type": "steady"},
    "transient": {"type": "transient", "end_time": "2000 s"},
}
MOTIONS = {
    kind: {"angular_velocity": "0.1 rad/s" if kind == "steady" else "0.02 rad/s"}
    for kind in ANALYSES
}
"""Below the critical speed, unless the faces are worn to the steady state at once."""


def ring(path, kind, **geometry):
    """The starter of an annular punch with a mesh in space, of a quarter unless whole."""
    case = tables(STEADY)
    share = 0.25 if geometry else 1.0
    case |= {"model": "3d", "mesh": {"degree": 2}}
    case |= {"analysis": ANALYSES[kind], "motion": MOTIONS[kind]}
    case["geometry"] = {"type": "file", "path": str(path)} | GLUED | geometry
    case["geometry"]["rotation_center"] = ["0 mm", "0 mm"]
    case["load"] = {"force": f"{PRESSURE * AREA * share!r} N"}
    return case


def run(case):
    with pytest.warns(tw.errors.CaseNote, match="planes of symmetry cut a sector"):
        loaded = tw.load(case)
    return tw.run(loaded)


def worst_shape(found, expected):
    """Largest difference of the worn shapes, less its mean, relative to the range expected."""
    i, r = found.interface, np.hypot(found.interface.x, found.interface.y)
    order = np.argsort(expected.interface.x)
    known = np.interp(r, expected.interface.x[order], expected.interface.shape[order])
    off = i.shape - known
    off -= off.mean()
    return np.abs(off).max() / expected.summary["shape_range_m"]


def compare(found, expected, share, shape, rise):
    """Compare a part of a ring in space with the whole axisymmetric one."""
    one, two = found.summary, expected.summary
    assert worst_shape(found, expected) < shape
    hot = two["max_temperature_K"] - 293.15
    assert one["max_temperature_K"] - 293.15 == pytest.approx(hot, rel=rise)
    assert one["rigid_wear_velocity_m_per_s"] == pytest.approx(
        two["rigid_wear_velocity_m_per_s"], rel=1e-6
    )
    for key in ("normal_force_N", "friction_torque_Nm"):
        assert one[key] == pytest.approx(share * two[key], rel=2e-4)
    assert one["heat_balance_relative_error"] < 1e-9
    assert one["equilibrium_relative_error"] < 1e-9


def test_quarter_of_a_hot_ring(tmp_path):
    """
    requirement: from a user's coarse mesh of quadratic tetrahedra, cut by planes x and y = const.
    """
    path = write_ring(tmp_path / "ring.msh", near=8.0)
    compare(run(ring(path, "steady", **QUARTER)), axisymmetric("steady"), 0.25, 0.02, 0.002)


@pytest.mark.slow
def test_quarter_of_a_hot_ring_within_a_percent(tmp_path):
    """
    requirement: steady worn shape within 1 % of its range of the axisymmetric one, temperature rise
    within 0.5 %.
    """
    path = write_ring(tmp_path / "ring.msh", near=4.0)
    compare(run(ring(path, "steady", **QUARTER)), axisymmetric("steady"), 0.25, 0.01, 0.0005)


@pytest.mark.slow
def test_whole_hot_ring(tmp_path):
    """
    requirement: the whole ring, twisted by friction, agrees as well.
    """
    path = write_ring(tmp_path / "ring.msh", turn=2 * math.pi, near=10.0)
    found = tw.run(tw.load(ring(path, "steady")))
    compare(found, axisymmetric("steady"), 1.0, 0.03, 0.002)


@pytest.mark.parametrize("kind", ["initial", "transient"])
def test_analyses_of_a_ring(tmp_path, kind):
    """
    requirement: contact of the unworn faces, and running-in, of the same mesh; worn volume within
    1 % of that of the whole ring.
    """
    path = write_ring(tmp_path / "ring.msh", near=8.0)
    found, expected = run(ring(path, kind, **QUARTER)).summary, axisymmetric(kind).summary
    assert found["normal_force_N"] == pytest.approx(expected["normal_force_N"] / 4, rel=2e-4)
    rise = expected["max_temperature_K"] - 293.15
    assert found["max_temperature_K"] - 293.15 == pytest.approx(rise, rel=0.02)
    if kind == "transient":
        volume = expected["wear_volume_1_m3"] / 4
        assert found["wear_volume_1_m3"] == pytest.approx(volume, rel=0.01)


@pytest.mark.parametrize(
    ("near", "within"), [(0.08, 0.01), pytest.param(0.05, 0.003, marks=pytest.mark.slow)]
)
def test_quarter_of_a_sphere(tmp_path, near, within):
    """
    requirement: Hertz's contact from a mesh of quadratic tetrahedra that does not match: peak and
    radius as in the axisymmetric run; the radius follows from the second moment of the pressure,
    a² = 5/2 ∫p r² dA / F.
    """
    case = tables(SPHERE)
    case["geometry"] |= SIZES
    expected = tw.run(tw.load(case))
    path = write_quarter_sphere(tmp_path / "sphere.msh", near=near, zone=0.45)
    case |= {"model": "3d", "mesh": {"degree": 2}, "contact": {}, "load": {"force": "125 N"}}
    case["geometry"] = {"type": "file", "path": str(path)} | NAMES | QUARTER
    case["bodies"] = {"punch": case["bodies"]["sphere"], "plate": {"like": "punch"}}
    found = tw.run(tw.load(case))
    peaks = [result.summary["max_pressure_Pa"] for result in (found, expected)]
    assert peaks[0] == pytest.approx(peaks[1], rel=within)
    i = found.interface
    moment = np.sum(i.weight * i.pressure * (i.x**2 + i.y**2)) / np.sum(i.weight * i.pressure)
    radius = math.sqrt(expected.summary["contact_area_m2"] / math.pi)
    assert math.sqrt(2.5 * moment) == pytest.approx(radius, rel=within)


def test_sliding_along_a_plane_of_symmetry(tmp_path):
    """
    requirement: half of a block that slides along the plane y = 0 is half of the whole; sliding
    across a plane of symmetry is refused.
    """
    path = write_blocks(tmp_path / "a.msh", 1, glued=False, size=10.0)
    case = {
        "model": "3d",
        "geometry": {"type": "file", "path": str(path), "length_unit": "1 mm"} | BLOCKS,
        "mesh": {"degree": 2},
        "bodies": {"pad": {"young_modulus": "100 GPa", "poisson_ratio": 0.3}},
        "load": {"force": "1 kN"},
        "motion": {"velocity": "1 m/s"},
        "contact": {"friction": 0.3},
        "analysis": {"type": "initial"},
    }
    case["bodies"]["disk"] = {"like": "pad"}
    assert tw.run(tw.load(case)).summary["normal_force_N"] == pytest.approx(1e3)
    case["geometry"]["symmetry"] = ["SIDES"]
    with pytest.raises(tw.errors.CaseError, match=r"geometry.symmetry: sliding friction along x"):
        tw.load(case)
    case["geometry"]["rollers"] = case["geometry"].pop("symmetry")
    case["holder"] = {"free": ["z", "rotation-x"]}
    with pytest.raises(tw.errors.CaseError, match="'rotation-x' contradicts the planes of"):
        tw.load(case)
