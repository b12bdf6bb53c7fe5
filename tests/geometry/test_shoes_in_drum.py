"""Several shoes in one drum."""

from __future__ import annotations

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.section import KeyFault
from thermowear.geometry.geometries.arcs.shoes_in_drum import ShoesInDrum
from thermowear.geometry.geometries.stack import Stack

from .measure import edges, unnamed
from .sound import check_mesh

RIGHT = {"arc_start": "30 deg", "arc_end": "150 deg", "pivot": ["50 mm", "-112 mm"]}
LEFT = {"arc_start": "-150 deg", "arc_end": "-40 deg", "pivot": ["-50 mm", "-112 mm"]}
THREE = {
    name: {
        "arc_start": f"{120 * k + 5} deg",
        "arc_end": f"{120 * k + 85} deg",
        "pivot": [f"{100 * f(np.radians(120 * k + 100)):.17g} mm" for f in (np.sin, np.cos)],
    }
    for k, name in enumerate(("one", "two", "three"))
}


def drum(shoes=None, **changes) -> ShoesInDrum:
    keys = {
        "drum_radius": "150 mm",
        "drum_thickness": "10 mm",
        "lining_thickness": "6 mm",
        "shoe_thickness": "9 mm",
        "shoes": shoes or {"right": RIGHT, "left": LEFT},
    }
    return ShoesInDrum(type="shoes-in-drum", **keys | changes)


def fault(**changes) -> tuple[str, str]:
    """Key and message of the fault that the geometry finds."""
    with pytest.raises(ValueError, match=r"must|missing|has a name") as error:
        drum(**changes)
    (found,) = error.value.errors()
    inner = found["ctx"]["error"]
    assert isinstance(inner, KeyFault)
    return ".".join((*map(str, found["loc"]), inner.key)), str(inner)


def angles(mesh, surface: str) -> np.ndarray:
    """Angles of the nodes of a surface, clockwise from +y within 0 and 2 π, shape (n_facets, k)."""
    p = edges(mesh, surface)
    return np.arctan2(p[..., 0], p[..., 1]) % (2 * np.pi)


def test_shoes_are_bodies_by_their_names_in_one_drum():
    """requirement: names that cases rely on; a contact and a lining for each shoe."""
    geometry = drum()
    assert geometry.bodies == ("right", "left", "drum")
    assert geometry.zones == {"right_lining": "right", "left_lining": "left"}
    assert geometry.contacts == {
        "right": ("right_face", "drum_right"),
        "left": ("left_face", "drum_left"),
    }
    own = {f"{shoe}_{part}" for shoe in ("right", "left") for part in ("face", "inside", "side")}
    assert set(geometry.surfaces) == own | {"drum_right", "drum_left", "drum_inside", "drum_rim"}
    assert [geometry.body_of(s) for s in ("drum_left", "left_face")] == ["drum", "left"]


@pytest.mark.parametrize("shoes", [None, {"left": LEFT, "right": RIGHT}, {"only": RIGHT}, THREE])
@pytest.mark.parametrize(("elements", "grading"), [(12, 0.3), (5, 1.0)])
def test_meshes_fill_shoes_and_drum(shoes, elements, grading):
    """requirement: sections of known areas; every edge of the boundary belongs to one surface."""
    geometry = drum(shoes)
    mesh = geometry.build(MeshTable(elements=elements, grading=grading))
    spans = {name: np.ptp(shoe.arc) for name, shoe in geometry.shoes.items()}
    ring = np.pi * (160e-3**2 - 150e-3**2)
    sections = {n: (144e-3**2 - 135e-3**2) / 2 * span for n, span in spans.items()}
    sections |= {"drum": ring}
    sections |= {f"{n}_lining": (150e-3**2 - 144e-3**2) / 2 * span for n, span in spans.items()}
    check_mesh(mesh, sections, rel=1e-5)
    assert unnamed(mesh) == 0


@pytest.mark.parametrize("shoes", [None, {"left": LEFT, "right": RIGHT}, THREE])
def test_each_shoe_lies_on_its_part_of_the_drum(shoes):
    """requirement: both faces of a contact lie on one arc, with as many equal elements."""
    geometry = drum(shoes)
    mesh = geometry.build(MeshTable(elements=7))
    for name, (face, under) in geometry.contacts.items():
        np.testing.assert_allclose(np.hypot(*edges(mesh, under).T), 150e-3, rtol=1e-13)
        ends = [np.unique(np.round(angles(mesh, surface), 9)) for surface in (face, under)]
        np.testing.assert_allclose(*ends, atol=1e-9)
        start, end = (angle % (2 * np.pi) for angle in geometry.shoes[name].arc)
        assert (ends[0].min(), ends[0].max()) == pytest.approx((start, end), abs=1e-8)
        assert len(angles(mesh, under)) == 7


def test_holders_of_shoes_have_pivots_and_directions():
    """requirement: a holder of a shoe rotates about its pivot and presses its middle outwards."""
    geometry = drum()
    assert geometry.pivot("left_inside") == pytest.approx((-50e-3, -112e-3), rel=1e-12)
    assert geometry.pivot("drum_rim") is None
    assert geometry.press_direction("right_inside") == pytest.approx((1.0, 0.0), abs=1e-12)
    middle = np.radians(-95.0)
    found = geometry.press_direction("left_inside")
    assert found == pytest.approx((np.sin(middle), np.cos(middle)), rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "key", "text"),
    [
        (
            {"shoes": {"left": LEFT | {"arc_start": "-100 deg", "arc_end": "30 deg"}}},
            "shoes.left.pivot",
            "neither within the lining, -100 deg to 30 deg",
        ),
        (
            {"shoes": {"left": LEFT | {"arc_end": "30 deg"}}},
            "shoes.left.arc_end",
            "covers 180 deg",
        ),
        ({"shoes": {"left": LEFT | {"arc_end": "-150 deg"}}}, "arc_end", "must be greater"),
        (
            {"shoes": {"right": RIGHT, "other": RIGHT | {"arc_start": "100 deg"}}},
            "shoes.other.arc_start",
            "150 deg; linings must be 1 deg apart",
        ),
        ({"shoes": {"a": RIGHT, "b": RIGHT}}, "arc_start", "linings must be 1 deg apart"),
        ({"shoes": {"drum": RIGHT}}, "shoes", "has a name of the drum"),
        ({"shoes": {"inside": RIGHT}}, "shoes", "has a name of the drum"),
        ({"shoes": {"a_face": RIGHT, "drum_a": LEFT}}, "shoes", "of a part of another"),
        ({"shoes": {"a": RIGHT, "a_lining": LEFT}}, "shoes", "of a part of another"),
        ({"shoe_thickness": "145 mm"}, "shoe_thickness", "must be thinner together"),
        ({"shoes": {"right": RIGHT | {"pivot": ["50 mm", "-150 mm"]}}}, "pivot", "must be less"),
    ],
)
def test_places_that_do_not_fit(changes, key, text):
    """requirement: one clear line with the key's path."""
    found, message = fault(**changes)
    assert found.endswith(key)
    assert text in message


def test_a_body_may_begin_with_the_name_of_another():
    """requirement: a surface belongs to the body with the longest name that it begins with."""
    layers = {name: {"x": ["1 mm", "2 mm"], "height": "1 mm"} for name in ("disk_plate", "disk")}
    mesh = Stack(type="stack", layers=layers).build(MeshTable(elements=4))
    for surface, y in (("disk_plate_bottom", 0.0), ("disk_top", 0.0), ("disk_bottom", -1e-3)):
        assert len(edges(mesh, surface)) >= 4
        np.testing.assert_allclose(edges(mesh, surface)[..., 1], y, atol=1e-12)
