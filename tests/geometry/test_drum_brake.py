"""A shoe in a drum: what is its own."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable

from .measure import edges
from .sound import fault
from .test_arc_contact import BELOW, shoe


def test_the_shoe_is_held_inside_and_turns_about_its_pivot_in_a_drum_fixed_outside():
    """
    requirement: names and places that cases rely on, at the radii of the keys.
    """
    geometry = shoe()
    assert geometry.bodies == ("shoe", "drum")
    assert geometry.contact == ("shoe_face", "drum_face")
    assert geometry.pivot_point == pytest.approx((-80e-3, -20e-3), rel=1e-12)
    mesh = geometry.build(MeshTable(), None)
    radii = {"shoe_face": 0.1, "shoe_inside": 86e-3, "drum_inside": 0.1, "drum_rim": 112e-3}
    assert {*radii, "shoe_side", "drum_face"} == set(mesh.surfaces)
    assert (geometry.held, geometry.fixed) == ("shoe_inside", "drum_rim")
    for surface, radius in radii.items():
        p = edges(mesh, surface)
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1]), radius, rtol=1e-13)


def test_the_lining_is_a_zone_of_the_shoe():
    """
    requirement: the lining may have a material of its own; its cells end where it ends.
    """
    geometry = shoe()
    assert geometry.zones == {"lining": "shoe"}
    assert geometry.parts_of("shoe") == ("shoe", "lining")
    mesh = geometry.build(MeshTable(), None)
    assert mesh.bodies == geometry.parts == ("shoe", "drum", "lining")
    radii = {}
    for tag, part in enumerate(mesh.bodies, start=1):
        corners = mesh.points[mesh.cells[mesh.cell_tags == tag, :4]]
        radii[part] = np.hypot(corners[..., 0], corners[..., 1])
    assert radii["lining"].min() == pytest.approx(92e-3, rel=1e-12)
    assert radii["shoe"].max() == pytest.approx(92e-3, rel=1e-12)
    assert min(len(radii["lining"]), len(radii["shoe"])) >= 24


def test_it_is_pressed_outwards_in_the_middle_of_the_lining():
    """
    requirement: the direction of the press follows the arc round the drum.
    """
    middle = np.radians(5.0)
    assert shoe().press_direction == pytest.approx((np.sin(middle), np.cos(middle)), rel=1e-12)
    assert shoe(**BELOW).press_direction == pytest.approx((0.0, -1.0), abs=1e-12)


def test_turning_about_the_pivot_presses_the_whole_lining():
    """
    requirement: the normal part of the face's motion, by the cross product, has one sign.
    """
    geometry = shoe()
    for angle in np.linspace(*geometry.arc, 7):
        normal = np.array([np.sin(angle), np.cos(angle)])
        arm = 0.1 * normal - geometry.pivot
        turned = np.array([-arm[1], arm[0]])
        assert geometry.shoe.normal_arm(angle) == pytest.approx(turned @ normal, rel=1e-12)
        assert geometry.shoe.normal_arm(angle) > 0


@pytest.mark.parametrize(("end", "sign"), [("arc_start", 1), ("arc_end", -1)])
def test_a_lining_may_begin_on_the_line_of_the_pivot(end, sign):
    """
    requirement: an arm of zero at one end is legal, a degree beyond it is not.
    """
    angle = getattr(shoe(), end)
    pivot = [f"{length:.17g} mm" for length in (50 * np.sin(angle), 50 * np.cos(angle))]
    geometry = shoe(pivot=pivot)
    arms = sign * np.array([geometry.shoe.normal_arm(angle) for angle in geometry.arc])
    assert abs(arms.min()) < 1e-15
    beyond = f"{np.degrees(angle) - sign:.17g} deg"
    assert fault(shoe, pivot=pivot, **{end: beyond})[0] == "pivot"


@pytest.mark.parametrize(
    ("changes", "key", "text"),
    [
        (
            {"shoe_thickness": "92 mm"},
            "shoe_thickness",
            "must be thinner together than drum_radius",
        ),
        ({"arc_start": "-111 deg"}, "arc_end", "must be at most 170 deg"),
        ({"pivot": ["-80 mm", "-60 mm"]}, "pivot", "must be less than drum_radius"),
        ({"pivot": ["0 mm", "0 mm"]}, "pivot", "lift the other"),
        ({"pivot": ["20 mm", "80 mm"]}, "pivot", "lift the other"),
        ({"pivot": ["10 mm", "-80 mm"]}, "pivot", "lift the other"),
    ],
)
def test_sizes_that_do_not_fit(changes, key, text):
    """
    requirement: one clear line with the key's path.
    """
    found, message = fault(shoe, **changes)
    assert found == key
    assert text in message
