"""Meshes of a tube between supports."""

from __future__ import annotations

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.section import KeyFault
from thermowear.geometry.geometries.arcs.tube_between_supports import TubeBetweenSupports
from thermowear.geometry.geometries.arcs.tube_in_support import TubeInSupport

from .measure import edges, unnamed
from .sound import check_mesh

R, WALL, DEPTH = 4.75e-3, 0.6e-3, 2e-3
TWO = {"left": {"angle": "-90 deg", "clearance": "0.15 mm"}, "right": {"angle": "90 deg"}}
THREE = {"spring": {"angle": "10 deg"}, "one": {"angle": "150 deg"}, "two": {"angle": "-110 deg"}}


def tube(supports=None, **changes) -> TubeBetweenSupports:
    keys = {
        "tube_radius": "4.75 mm",
        "tube_wall": "0.6 mm",
        "support_clearance": "0.05 mm",
        "support_thickness": "2 mm",
        "support_arc": "90 deg",
        "zone": "1 mm",
        "supports": TWO if supports is None else supports,
    }
    return TubeBetweenSupports(type="tube-between-supports", **keys | changes)


def fault(**changes) -> tuple[str, str]:
    """Key and message of the fault that the geometry finds."""
    with pytest.raises(ValueError, match=r"must|missing|has a name") as error:
        tube(**changes)
    (found,) = error.value.errors()
    raised = found["ctx"]["error"]
    assert isinstance(raised, KeyFault)
    return raised.key, str(raised)


def clearance(geometry, name: str) -> float:
    return geometry.supports[name].clearance or geometry.support_clearance


@pytest.mark.parametrize("geometry", [tube(), tube(THREE), tube({"only": {"angle": "37 deg"}})])
def test_cells_are_well_shaped_and_fill_the_bodies(geometry):
    """requirement: areas of the tube and of the sectors; every edge has one name."""
    mesh = geometry.build(MeshTable(elements=16, grading=1.0))
    areas = {}
    for name in geometry.supports:
        hole = R + clearance(geometry, name)
        areas[name] = np.pi / 4 * ((hole + DEPTH) ** 2 - hole**2)
    areas["tube"] = np.pi * (R**2 - (R - WALL) ** 2)
    check_mesh(mesh, areas, rel=2e-5, shape=0.99)
    assert set(mesh.surfaces) == set(geometry.surfaces)
    assert unnamed(mesh) == 0


@pytest.mark.parametrize("geometry", [tube(), tube(THREE)])
def test_supports_touch_the_tube_at_their_angles(geometry):
    """requirement: faces on circles that touch the tube there; elements end at the zone."""
    mesh = geometry.build(MeshTable(elements=16, grading=1.0))
    for name, table in geometry.supports.items():
        out = np.array([np.sin(table.angle), np.cos(table.angle)])
        apart = clearance(geometry, name)
        for part, radius in {
            "face": R + apart,
            "hole": R + apart,
            "rim": R + apart + DEPTH,
        }.items():
            p = edges(mesh, f"{name}_{part}") + apart * out
            np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1]), radius, rtol=1e-12)
        assert np.abs(edges(mesh, f"{name}_face") - R * out).max(axis=-1).min() < 1e-12
        on_tube = edges(mesh, f"tube_{name}")
        np.testing.assert_allclose(np.hypot(on_tube[..., 0], on_tube[..., 1]), R, rtol=1e-12)
        across = on_tube @ [out[1], -out[0]]
        for end in (-1e-3, 1e-3):
            assert np.abs(across - end).min() < 1e-12
        assert (on_tube @ out > 0.0).all()


def test_one_support_is_that_of_the_pair():
    """requirement: the faces of the tube in its support, rolled to the bottom."""
    pair = TubeInSupport(
        type="tube-in-support",
        tube_radius="4.75 mm",
        tube_wall="0.6 mm",
        support_clearance="0.05 mm",
        support_thickness="2 mm",
        support_arc="90 deg",
    ).build(MeshTable(elements=16), (-1e-3, 1e-3))
    own = tube({"only": {"angle": "180 deg"}}).build(MeshTable(elements=16))
    for name, same in {
        "tube_only": "tube_face",
        "tube_outside": "tube_outside",
        "only_face": "support_face",
        "only_hole": "support_hole",
        "only_rim": "support_rim",
        "only_side": "support_side",
    }.items():
        found, known = edges(own, name) + [0.0, R], edges(pair, same)
        found, known = (np.unique(np.round(e.reshape(-1, 2), 12), axis=0) for e in (found, known))
        np.testing.assert_allclose(found, known, atol=2e-12)


def test_names_and_directions():
    """requirement: contacts named after supports; holders press towards the tube."""
    geometry = tube()
    assert geometry.bodies == ("left", "right", "tube")
    assert geometry.contacts == {
        "left": ("tube_left", "left_face"),
        "right": ("tube_right", "right_face"),
    }
    assert geometry.press_direction("left_rim") == pytest.approx((1.0, 0.0))
    assert geometry.press_direction("right_rim") == pytest.approx((-1.0, 0.0))
    assert geometry.press_direction("tube_bore") == pytest.approx((-1.0, 0.0))


@pytest.mark.parametrize(
    ("changes", "key", "text"),
    [
        ({"supports": {}}, "supports", "missing"),
        ({"tube_wall": "5 mm"}, "tube_wall", "must be less than tube_radius 0.00475 m"),
        ({"support_arc": "2 deg"}, "support_arc", "must be from 5 deg to 300 deg"),
        ({"zone": "3 mm"}, "zone", "must be at most 0.00264 m"),
        (
            {"supports": {"a": {"angle": "0 deg"}, "b": {"angle": "80 deg"}}},
            "supports.b.angle",
            "80 deg is too close to supports.a at 0 deg",
        ),
        (
            {"supports": {"a": {"angle": "-170 deg"}, "b": {"angle": "170 deg"}}},
            "supports.a.angle",
            "too close to supports.b",
        ),
        ({"supports": {"tube": {"angle": "0 deg"}}}, "supports", "has a name of the tube"),
        ({"supports": {"bore": {"angle": "0 deg"}}}, "supports", "has a name of the tube"),
    ],
)
def test_sizes_that_do_not_fit(changes, key, text):
    """requirement: one clear line with the key's path."""
    found, message = fault(**changes)
    assert found == key
    assert text in message
