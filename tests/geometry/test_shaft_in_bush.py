"""Meshes of a shaft in a bush."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.arcs.shaft_in_bush import ShaftInBush
from thermowear.geometry.geometries.arcs.tube_in_support import TubeInSupport

from .measure import edges, unnamed
from .sound import check_mesh, fault

R, HOLE = 10e-3, 10.06e-3


def bush(**changes):
    keys = {
        "shaft_radius": "10 mm",
        "shaft_depth": "6 mm",
        "bush_clearance": "60 um",
        "bush_thickness": "3 mm",
    }
    return ShaftInBush(type="shaft-in-bush", **keys | changes)


@pytest.mark.parametrize("zone", [(-1e-3, 1e-3), (-7e-3, 6e-3)])
def test_cells_are_well_shaped_and_fill_the_bodies(zone):
    """requirement: areas of both rings; every edge has one name, and lies on its circle."""
    mesh = bush().build(MeshTable(elements=20, grading=1.0), zone)
    areas = {
        "bush": np.pi * ((HOLE + 3e-3) ** 2 - HOLE**2),
        "shaft": np.pi * (R**2 - 4e-3**2),
    }
    check_mesh(mesh, areas, rel=2e-5, shape=0.99)
    assert mesh.bodies == ("bush", "shaft")
    assert sorted(mesh.surfaces) == sorted(bush().surfaces)
    assert unnamed(mesh) == 0
    circles = {
        "shaft_face": (R, R),
        "shaft_outside": (R, R),
        "shaft_bore": (R, 4e-3),
        "bush_face": (HOLE, HOLE),
        "bush_hole": (HOLE, HOLE),
        "bush_rim": (HOLE, HOLE + 3e-3),
    }
    for surface, (height, radius) in circles.items():
        p = edges(mesh, surface)
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1] - height), radius, rtol=1e-13)


def test_the_mesh_is_that_of_a_tube_in_its_support():
    """requirement: the same rings, with the roles of the bodies exchanged."""
    tube = TubeInSupport(
        type="tube-in-support",
        tube_radius="10 mm",
        tube_wall="6 mm",
        support_clearance="60 um",
        support_thickness="3 mm",
    )
    zone = (-3e-3, 3e-3)
    own, other = (g.build(MeshTable(elements=20), zone) for g in (bush(), tube))
    for name, same in {"bush_face": "support_face", "shaft_face": "tube_face"}.items():
        np.testing.assert_array_equal(edges(own, name), edges(other, same))


def test_the_shaft_turns_about_its_centre():
    """requirement: centre, track and load direction."""
    assert bush().rotation_center == (0.0, R)
    assert bush().pivot_point == (0.0, R)
    assert bush().track == pytest.approx(2 * np.pi * R)
    assert bush().press_direction == (0.0, 1.0)
    assert bush().contact == ("bush_face", "shaft_face")


def test_a_core_that_does_not_fit():
    """requirement: one clear line with the key's path."""
    key, message = fault(bush, shaft_depth="10 mm")
    assert key == "shaft_depth"
    assert "must be less than shaft_radius 0.01 m" in message
