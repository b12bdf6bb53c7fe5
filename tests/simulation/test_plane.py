"""Plane models: sliding with friction, thickness, halves of symmetric sections, heat and wear."""

from dataclasses import replace
from math import atan, pi

import numpy as np
import pytest

import thermowear as tw
from thermowear.geometry.mesh.nodes import turned
from thermowear.geometry.reading.export import write_mesh

from ..case.starter import FILE, HERTZ, PUNCH, solved, tables

FORCE, FRICTION, SPEED = 200.0, 0.3, 0.05
SLIDING = {"motion": {"velocity": "50 mm/s"}, "contact": {"friction": FRICTION}}
BACKWARDS = SLIDING | {"motion": {"velocity": "-50 mm/s"}}
SMALL = ("mesh.degree=3", "mesh.elements=8")
METHODS = ("condensed", "penalty", "nitsche")


def centre(interface):
    """Position of the resultant of the pressure [m]."""
    load = interface.weight * interface.pressure
    return load @ interface.x / load.sum()


def relative(found, known):
    """Largest difference, relative to the largest value."""
    return np.abs(found - known).max() / np.abs(known).max()


@pytest.fixture(scope="module")
def to_the_right():
    return solved(PUNCH, SLIDING, *SMALL)


@pytest.fixture(scope="module")
def to_the_left():
    return solved(PUNCH, BACKWARDS, *SMALL)


# ---- sliding ----


def test_the_guide_pushes_body_1_where_it_slides(to_the_right, to_the_left):
    """requirement: the guide force is mu times the normal force and has the velocity's sign."""
    for result, sign in ((to_the_right, 1), (to_the_left, -1)):
        assert result.summary["normal_force_N"] == pytest.approx(FORCE, rel=1e-10)
        assert result.summary["friction_force_N"] == pytest.approx(FRICTION * FORCE, rel=1e-10)
        assert result.summary["guide_force_N"] == pytest.approx(sign * FRICTION * FORCE, rel=1e-10)
        assert result.summary["equilibrium_relative_error"] < 1e-9


def test_the_other_way_is_the_mirror_image(to_the_right, to_the_left):
    """requirement: mirrored velocity gives the mirrored pressure."""
    one, other = to_the_right.interface, to_the_left.interface
    np.testing.assert_allclose(one.x, -other.x[::-1], atol=1e-12)
    assert relative(one.pressure, other.pressure[::-1]) < 1e-8
    assert relative(one.gap, other.gap[::-1]) < 1e-8
    assert to_the_right.summary["approach_m"] == pytest.approx(
        to_the_left.summary["approach_m"], rel=1e-10
    )


def test_without_friction_the_pressure_is_its_own_mirror_image():
    """requirement: what is symmetric stays symmetric, and needs no guide."""
    result = solved(PUNCH, {}, *SMALL)
    assert relative(result.interface.pressure, result.interface.pressure[::-1]) < 1e-8
    assert abs(result.summary["guide_force_N"]) < 1e-9 * FORCE


def test_the_pressure_moves_to_the_trailing_edge(to_the_right):
    """
    requirement: a rigid punch that slides on a half-plane has the pressure
    ``((a + x)/(a - x))^γ / √(a² - x²)``, tan πγ = mu (1 - 2ν)/(2 (1 - ν)) (Johnson, Contact
    Mechanics, 1985, section 2.8), whose centre lies 2 γ a behind the middle. The punch of the case
    bends forward and takes back some of it.
    """
    behind = 2 * atan(FRICTION * 0.2 / 1.2) / pi * 5e-3
    assert -behind < centre(to_the_right.interface) < -0.75 * behind
    wide = {"geometry.block_width": "800 mm", "geometry.block_height": "400 mm"}
    rigid = solved(PUNCH, SLIDING | wide | {"bodies.punch.young_modulus": "1e6 GPa"}, *SMALL)
    assert centre(rigid.interface) == pytest.approx(-behind, rel=0.02)


def test_units_do_not_matter():
    """requirement: a case in millimetres and the same in SI give the same numbers."""
    metres = {
        "geometry.width": "0.01 m",
        "geometry.height": "1e-2 m",
        "geometry.block_width": "0.2 m",
        "geometry.block_height": "0.1 m",
        "geometry.thickness": "1e-3 m",
        "geometry.edge_radius": "0 m",
        "bodies.punch.young_modulus": "6e11 Pa",
        "bodies.block.young_modulus": "3e9 N/m^2",
        "load.mean_pressure": "2e7 Pa",
        "motion": {"velocity": "0.05 m/s"},
    }
    one, other = (solved(PUNCH, SLIDING | more, *SMALL) for more in ({}, metres))
    assert relative(one.interface.pressure, other.interface.pressure) < 1e-9
    for key in ("normal_force_N", "guide_force_N", "approach_m", "contact_area_m2"):
        assert one.summary[key] == pytest.approx(other.summary[key], rel=1e-9)


# ---- models and thickness ----


def test_plane_stress_is_plane_strain_of_another_material():
    """
    requirement: plane stress with E and ν is plane strain with E (1 + 2ν)/(1 + ν)² and ν/(1 + ν),
    and gives way more than plane strain of the same material.
    """
    moduli = {"punch": (600e9, 0.22), "block": (3e9, 0.4)}
    changes = {"model": "plane-strain"}
    for body, (E, ν) in moduli.items():
        changes[f"bodies.{body}.young_modulus"] = f"{E * (1 + 2 * ν) / (1 + ν) ** 2!r} Pa"
        changes[f"bodies.{body}.poisson_ratio"] = ν / (1 + ν)
    stress = solved(PUNCH, SLIDING | {"model": "plane-stress"}, *SMALL)
    same = solved(PUNCH, SLIDING | changes, *SMALL)
    assert relative(stress.interface.pressure, same.interface.pressure) < 1e-9
    assert stress.summary["approach_m"] == pytest.approx(
        same.summary["approach_m"], rel=1e-9, abs=0.0
    )
    strain = solved(PUNCH, SLIDING, *SMALL)
    ratio = strain.summary["approach_m"] / stress.summary["approach_m"]
    assert 0.75 < ratio < 1 - 0.4**2


@pytest.mark.parametrize("model", ["plane-strain", "plane-stress"])
def test_thickness_only_scales_the_force(model):
    """requirement: twice the thickness carries twice the force at the same pressure."""
    thin, thick = (
        solved(PUNCH, SLIDING | {"model": model, "geometry.thickness": t}, *SMALL)
        for t in ("1 mm", "2 mm")
    )
    assert relative(thin.interface.pressure, thick.interface.pressure) < 1e-10
    assert thick.summary["approach_m"] == pytest.approx(
        thin.summary["approach_m"], rel=1e-10, abs=0.0
    )
    for key in ("normal_force_N", "guide_force_N", "friction_power_W", "contact_area_m2"):
        assert thick.summary[key] == pytest.approx(2 * thin.summary[key], rel=1e-10)


# ---- halves ----


def mirrored(mesh):
    """The whole of a mesh of x >= 0, without its surfaces on the axis."""
    n, axis = len(mesh.points), np.abs(mesh.points[:, 0]) < 1e-12
    other = np.where(axis, np.arange(n), n + np.arange(n))
    kind, order = mesh.cell_type, mesh.order
    outside = np.array(["axis" not in mesh.surfaces[tag - 1] for tag in mesh.facet_tags])
    facets, tags = mesh.facets[outside], mesh.facet_tags[outside]
    return replace(
        mesh,
        points=np.concatenate([mesh.points, mesh.points * [-1, 1]]),
        cells=np.concatenate([mesh.cells, other[mesh.cells][:, turned(kind, order)]]),
        cell_tags=np.tile(mesh.cell_tags, 2),
        facets=np.concatenate([facets, other[facets]]),
        facet_tags=np.tile(tags, 2),
        surfaces=tuple(name for name in mesh.surfaces if "axis" not in name),
    )


@pytest.mark.parametrize("method", METHODS)
def test_a_half_is_half_of_the_whole(method, tmp_path):
    """requirement: half model and whole of the same cells agree to rounding, by every method."""
    changes = {"contact": {"method": method}, "load": {"force": "1.5 kN"}}
    half = tw.load(tables(HERTZ, changes), SMALL)
    path = tmp_path / "whole.msh"
    write_mesh(mirrored(half.tagged_mesh()), path)
    bodies = {"cylinder": "cylinder", "block": "block"}
    geometry = FILE | {"path": str(path), "bodies": bodies, "thickness": "1 mm"}
    read = changes | {"geometry": geometry, "mesh": {"degree": half.mesh.degree}}
    results = tw.run(half), solved(HERTZ, read)
    one, whole = (result.interface for result in results)
    right = whole.x > -1e-12
    np.testing.assert_allclose(one.x, whole.x[right], atol=1e-12)
    rounding = 1e-8 if method == "condensed" else 1e-6  # a stiff penalty enlarges it
    assert relative(one.pressure, whole.pressure[right]) < rounding
    assert relative(whole.pressure, whole.pressure[::-1]) < rounding
    summary, known = (result.summary for result in results)
    for key in ("normal_force_N", "approach_m", "contact_area_m2", "max_pressure_Pa"):
        assert summary[key] == pytest.approx(known[key], rel=rounding)
    assert summary["guide_force_N"] == 0.0
    assert abs(known["guide_force_N"]) < 1e-8 * known["normal_force_N"]
    assert summary["equilibrium_relative_error"] < 1e-9


def test_meshes_of_half_and_whole_agree():
    """requirement: the same for the meshes of the geometry, which differ far from the contact."""
    changes = {"contact": {}, "load": {"approach": "50 um"}}
    half, whole = (solved(HERTZ, changes | {"geometry.half": h}, *SMALL) for h in (True, False))
    force = whole.summary["normal_force_N"]
    assert half.summary["normal_force_N"] == pytest.approx(force, rel=1e-5)
    x = np.linspace(0.0, 0.4e-3, 50)
    pressures = [np.interp(x, r.interface.x, r.interface.pressure) for r in (half, whole)]
    assert relative(*pressures) < 5e-5


# ---- heat and wear ----

HOT = {
    "bodies.punch.conductivity": "50 W/(m K)",
    "bodies.punch.expansion": "5e-6 1/K",
    "bodies.block.conductivity": "0.5 W/(m K)",
    "bodies.block.expansion": "1e-5 1/K",
    "heat": {
        "conductance": "1e5 W/(m^2 K)",
        "partition": 0.7,
        "ambient": "20 degC",
        "cooling": {"punch_top": "2000 W/(m^2 K)"},
        "temperature": {"block_bottom": "30 degC"},
    },
}


@pytest.mark.parametrize("model", ["plane-strain", "plane-stress"])
@pytest.mark.parametrize("way", [SLIDING, BACKWARDS], ids=["right", "left"])
def test_friction_heat_is_shared_and_kept(model, way):
    """requirement: heat balance, shares and the law of the contact conductance, plane models."""
    result = solved(PUNCH, way | HOT | {"model": model}, *SMALL)
    i, summary = result.interface, result.summary
    assert summary["heat_balance_relative_error"] < 1e-9
    assert summary["equilibrium_relative_error"] < 1e-9
    assert summary["friction_power_W"] == pytest.approx(FRICTION * FORCE * SPEED, rel=1e-9)
    heat = FRICTION * i.pressure * SPEED
    across = 1e5 * (i.temperature_1 - i.temperature_2)
    assert np.abs(i.heat_flux_1 - (0.7 * heat - across)).max() < 1e-9 * heat.max()
    assert np.abs(i.heat_flux_2 - (0.3 * heat + across)).max() < 1e-9 * heat.max()
    assert i.temperature_1.min() > 293.15
    sign = np.sign(summary["guide_force_N"])
    assert sign == (1 if way is SLIDING else -1)


def test_heat_of_both_ways_is_mirrored():
    """requirement: with friction heat."""
    one, other = (solved(PUNCH, way | HOT, *SMALL).interface for way in (SLIDING, BACKWARDS))
    assert relative(one.pressure, other.pressure[::-1]) < 1e-8
    assert relative(one.temperature_2, other.temperature_2[::-1]) < 1e-8


WEAR = {"wear": {"punch": {"coefficient": "1e-7 1/MPa"}}}


@pytest.mark.parametrize("hot", [{}, HOT], ids=["cold", "hot"])
def test_steady_pressure_of_a_translation_is_uniform(hot):
    """requirement: equal speed everywhere gives equal pressure, whatever friction and heat."""
    changes = SLIDING | WEAR | hot | {"analysis": {"type": "steady"}}
    result = solved(PUNCH, changes, *SMALL)
    i, summary = result.interface, result.summary
    np.testing.assert_allclose(i.pressure, 20e6, rtol=1e-9)
    np.testing.assert_allclose(i.wear_rate_1, 1e-13 * FRICTION * 20e6 * SPEED, rtol=1e-9)
    assert summary["mean_pressure_Pa"] == pytest.approx(20e6, rel=1e-9)
    assert summary["guide_force_N"] == pytest.approx(FRICTION * FORCE, rel=1e-9)
    assert summary["rigid_wear_velocity_m_per_s"] == pytest.approx(3e-8, rel=1e-9, abs=0.0)
    assert summary["equilibrium_relative_error"] < 1e-9
    # friction shears the faces: the worn shape is not symmetric
    assert relative(i.shape, i.shape[::-1]) > 1e-3


@pytest.mark.parametrize("method", METHODS)
def test_a_sliding_cylinder_carries_its_load(method):
    """requirement: on a round face pressure and friction together carry load and guide force."""
    changes = {
        "geometry.half": False,
        "motion": {"velocity": "1 m/s"},
        "contact": {"friction": 0.3, "method": method},
        "load": {"force": "1.5 kN"},
    }
    result = solved(HERTZ, changes, *SMALL)
    i, summary = result.interface, result.summary
    half = np.arcsin(i.x / 10e-3) / 2  # the common face of like bodies halves the angle
    across, down = np.sin(half), np.cos(half)
    load = i.weight * i.pressure
    assert load @ (down - 0.3 * across) == pytest.approx(1500.0, rel=1e-8)
    assert load @ (across + 0.3 * down) == pytest.approx(summary["guide_force_N"], rel=1e-8)
    resultant = np.hypot(load @ across, load @ down)
    assert summary["normal_force_N"] == pytest.approx(resultant, rel=1e-8)
    assert summary["equilibrium_relative_error"] < 1e-9
    pressing = i.pressure > 0.2 * i.pressure.max()
    assert np.abs(i.gap[pressing]).max() < 2e-3 * summary["approach_m"]
