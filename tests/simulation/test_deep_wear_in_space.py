"""Pin with a spherical end, of tetrahedra, worn by several elements."""

import math
from dataclasses import replace

import numpy as np
import pytest
import tomli_w
from scipy.spatial import cKDTree

import thermowear as tw
from thermowear.case import as_plain
from thermowear.geometry.mesh.nodes import boundary
from thermowear.geometry.mesh.tagged import quality
from thermowear.geometry.moving.moved import cells_of
from thermowear.geometry.reading.export import write_mesh
from thermowear.simulation.from_case import run as run_case
from thermowear.verification.spherical_pin import NAMES, SphericalPin

from ..case.starter import changed
from ..test_parallel import summaries
from .test_checkpoint import Watched, assert_the_same

SPHERE, RADIUS, SPEED, WEAR, FORCE = 10e-3, 6e-3, 0.5, 1e-12, 100.0


def cap(depth):
    """Volume that a flat cuts off the end of the whole pin [m³]."""
    return math.pi * depth**2 * (SPHERE - depth / 3)


def case(path, depth, size, order=2, **changes):
    """Quarter of a pin that loses the cap of a depth, on a rigid block."""
    SphericalPin(SPHERE, RADIUS, 10e-3, (9e-3, 6e-3), size, order).write(path)
    end = cap(depth) / (WEAR * FORCE * SPEED)
    tables = {
        "title": "worn pin",
        "model": "3d",
        "geometry": {"type": "file", "path": str(path)} | NAMES,
        "mesh": {"degree": 2},
        "bodies": {
            "pin": {"young_modulus": "2 GPa", "poisson_ratio": 0.4},
            "block": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
        },
        "load": {"force": f"{FORCE / 4} N"},
        "motion": {"velocity": f"{SPEED} m/s"},
        "wear": {"update": 0.02, "pin": {"coefficient": f"{WEAR} 1/Pa", "per": "pressure"}},
        "analysis": {"type": "transient", "end_time": f"{end} s", "tolerance": 3e-2},
    }
    return tw.load(tables | changes)


@pytest.mark.parametrize(("order", "size"), [(1, 2e-3), (2, 2e-3)])
def test_tetrahedra_follow_the_worn_face(tmp_path, order, size):
    """requirement: the mesh loses the worn volume, k F s, in each update; the scar is a flat."""
    depth = 0.4e-3
    result = tw.run(case(tmp_path / "pin.msh", depth, size, order))
    summary, i = result.summary, result.interface
    assert summary["geometry_updates"] >= 3
    assert summary["geometry_volume_error"] < 1e-9
    assert summary["geometry_smallest_scaled_jacobian"] > 0.1
    assert summary["wear_volume_1_m3"] == pytest.approx(cap(depth) / 4, rel=1e-9, abs=0.0)
    lost = summary["geometry_volume_1_m3"]
    assert lost == pytest.approx(cap(depth) / 4, rel=1e-6, abs=0.0)
    # a flat but for the faceted sphere of linear cells, and the elastic deflection
    known = np.maximum(depth - SPHERE + np.sqrt(SPHERE**2 - i.x**2 - i.y**2), 0.0)
    off = np.sqrt(i.weight @ (i.wear_1 - known) ** 2 / (i.weight @ known**2))
    assert off < (0.1 if order == 1 else 0.05)


def squeezed(path, order, sphere=1.0):
    """Pin, by default with an almost flat end, whose inner nodes lie too high, in a file."""
    mesh = SphericalPin(sphere, RADIUS, 10e-3, (9e-3, 6e-3), 3e-3, order).write(path)
    cells = cells_of(mesh, ("pin",))
    inside = np.setdiff1d(cells, boundary("tetrahedron", order, cells))
    points = mesh.points.copy()
    points[inside, 2] = 10e-3 - 0.95 * (10e-3 - points[inside, 2])
    bad = replace(mesh, points=points)
    assert 0.0 < quality(bad, ("pin",)) < 0.09
    write_mesh(bad, path)


def flat(path, **changes):
    """A quarter of the pin on a block that rotates about its axis, worn by time."""
    tables = {
        "title": "worn pin",
        "model": "3d",
        "geometry": {"type": "file", "path": str(path), "rotation_center": ["0 mm", "0 mm"]}
        | NAMES,
        "mesh": {"degree": 2},
        "bodies": {
            "pin": {"young_modulus": "2 GPa", "poisson_ratio": 0.4},
            "block": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
        },
        "load": {"force": f"{FORCE / 4} N"},
        "motion": {"angular_velocity": "1 rad/s"},
        "contact": {"friction": 0.2},
        "wear": {
            "update": 0.03,
            "pin": {"coefficient": "1e-12 m/(s Pa)", "velocity_exponent": 0.0, "per": "pressure"},
        },
        "analysis": {"type": "transient", "end_time": "1000 s", "tolerance": 3e-2},
    }
    return tw.load(changed(tables, changes))


@pytest.mark.filterwarnings("ignore:.*planes of symmetry cut a sector")
def test_a_remeshed_body_goes_on(tmp_path):
    """requirement: distorted cells are remeshed inside the worn surface; pressure, wear and
    volumes do not depend on it, and a run goes on from a checkpoint after it to the last bit."""
    path = tmp_path / "pin.msh"
    squeezed(path, 2)
    case = flat(path, **{"analysis.checkpoint_every": "1e-9 s"})
    watched = Watched()
    whole = run_case(case, None, watched)
    summary, i = whole.summary, whole.interface
    assert whole.stopped is None
    assert summary["geometry_meshed_anew"] == 1
    assert summary["geometry_updates"] >= 3
    assert summary["geometry_volume_error"] < 1e-9
    assert summary["geometry_remeshing_error"] < 1e-6
    assert summary["geometry_change"] < 0.02
    volume = 1e-12 * FORCE / 4 * 1000
    assert summary["geometry_volume_1_m3"] == pytest.approx(volume, rel=1e-6, abs=0.0)
    assert i.weight @ i.wear_1 == pytest.approx(volume, rel=1e-3, abs=0.0)
    # the whole face at the rate of the mean pressure
    mean = FORCE / (math.pi * RADIUS**2)
    assert i.weight @ np.abs(i.pressure - mean) < 0.01 * FORCE / 4
    saved = watched.checkpoints[-2].state(rank=0)
    assert_the_same(whole, run_case(case, None, Watched(), None, saved))


@pytest.mark.filterwarnings("ignore:.*planes of symmetry cut a sector")
def test_a_curved_face_goes_on_after_remeshing(tmp_path):
    """requirement: as on a mesh that needs none, at the same contact points."""
    path, results = tmp_path / "pin.msh", []
    squeezed(path, 2, 20e-3)
    results.append(tw.run(flat(path, **{"analysis.end_time": "300 s"})))
    SphericalPin(20e-3, RADIUS, 10e-3, (9e-3, 6e-3), 3e-3).write(path)
    results.append(tw.run(flat(path, **{"analysis.end_time": "300 s"})))
    assert [result.summary["geometry_meshed_anew"] for result in results] == [1, 0]
    assert min(result.summary["geometry_updates"] for result in results) >= 4
    one, other = (result.interface for result in results)
    points = [np.column_stack([i.x, i.y]) for i in (one, other)]
    _, same = cKDTree(points[1]).query(points[0])
    assert points[0] == pytest.approx(points[1][same], abs=2e-6)
    for field, within in (("wear_1", 2e-3), ("z", 2e-3), ("gap", 5e-3)):
        ours, theirs = getattr(one, field), getattr(other, field)[same]
        assert np.abs(ours - theirs).max() < within * np.abs(theirs).max(), field


HOT = {
    "heat": {
        "transient": True,
        "conductance": "1e5 W/(m^2 K)",
        "ambient": "20 degC",
        "cooling": {"pin_top": "1000 W/(m^2 K)", "block_bottom": "1000 W/(m^2 K)"},
    },
    "motion.angular_velocity": "20 rad/s",
    "wear.pin.coefficient": "4e-11 m/(s Pa)",
    "analysis.end_time": "25 s",
}


@pytest.mark.filterwarnings("ignore:.*planes of symmetry cut a sector")
def test_temperatures_are_carried_over_to_new_cells(tmp_path):
    """requirement: with the error measured; the run agrees with one on a good mesh."""
    heat = {"conductivity": "10 W/(m K)", "expansion": "1e-5 1/K"}
    heat |= {"density": "2000 kg/m^3", "specific_heat": "1000 J/(kg K)"}
    hot = HOT | {f"bodies.{b}.{k}": v for b in ("pin", "block") for k, v in heat.items()}
    path = tmp_path / "pin.msh"
    squeezed(path, 2)
    found = tw.run(flat(path, **hot))
    SphericalPin(1.0, RADIUS, 10e-3, (9e-3, 6e-3), 3e-3).write(path)
    known = tw.run(flat(path, **hot))
    counts = [result.summary["geometry_meshed_anew"] for result in (found, known)]
    assert counts == [1, 0]
    assert 0.0 < found.summary["geometry_temperature_error"] < 0.02
    rises = [result.interface.temperature_1 - 293.15 for result in (found, known)]
    assert rises[1].max() > 5.0
    weight = known.interface.weight / known.interface.weight.sum()
    assert abs(weight @ (rises[0] - rises[1])) < 0.01 * (weight @ rises[1])
    assert max(row.balance_error for row in found.heat if row.time > 0.1) < 1e-9


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*planes of symmetry cut a sector")
def test_two_ranks_give_the_serial_numbers(tmp_path):
    """Also after remeshing, by gmsh on one of them."""
    squeezed(tmp_path / "pin.msh", 2)
    case = tmp_path / "case.toml"
    tables = as_plain(flat(tmp_path / "pin.msh", **{"analysis.end_time": "500 s"}))
    case.write_text(tomli_w.dumps(tables), encoding="utf-8")
    (serial, _), (parallel, _) = summaries(tmp_path, case)
    assert serial["geometry_meshed_anew"] == parallel["geometry_meshed_anew"] == 1
    for key in ("max_pressure_Pa", "wear_volume_1_m3", "geometry_volume_1_m3", "shape_range_m"):
        assert parallel[key] == pytest.approx(serial[key], rel=1e-6, abs=0.0), key
