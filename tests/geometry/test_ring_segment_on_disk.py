"""A segment inside a ring-shaped disk: what is its own."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable

from .measure import edges
from .sound import fault
from .test_arc_contact import segment


def test_the_segment_is_held_inside_and_pressed_up_on_a_disk_fixed_outside():
    """
    requirement: names and directions that cases rely on, at the radii of the keys.
    """
    geometry = segment()
    assert geometry.bodies == ("segment", "disk")
    assert geometry.contact == ("segment_face", "disk_face")
    assert geometry.press_direction == (0.0, 1.0)
    mesh = geometry.build(MeshTable(), None)
    radii = {
        "segment_face": 40e-3,
        "segment_inside": 30e-3,
        "disk_inside": 40e-3,
        "disk_rim": 55e-3,
    }
    assert {*radii, "segment_side", "disk_face"} == set(mesh.surfaces)
    assert (geometry.held, geometry.fixed) == ("segment_inside", "disk_rim")
    for surface, radius in radii.items():
        p = edges(mesh, surface)
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1]), radius, rtol=1e-13)


def test_its_sides_are_radial():
    """
    requirement: both ends of the segment lie at the angles of the arc.
    """
    geometry = segment()
    side = edges(geometry.build(MeshTable(), None), "segment_side").reshape(-1, 2)
    angles = np.arctan2(*side.T)
    assert np.abs(angles[:, None] - geometry.arc).min(axis=1).max() < 1e-12


@pytest.mark.parametrize(
    ("changes", "key", "text"),
    [
        ({"disk_outer_radius": "40 mm"}, "disk_outer_radius", "must be greater than disk_radius"),
        ({"segment_thickness": "40 mm"}, "segment_thickness", "must be less than disk_radius"),
        ({"arc_end": "86 deg"}, "arc_end", "must be within 85 deg of 12 o'clock"),
    ],
)
def test_sizes_that_do_not_fit(changes, key, text):
    """
    requirement: one clear line with the key's path.
    """
    found, message = fault(segment, **changes)
    assert found == key
    assert text in message
