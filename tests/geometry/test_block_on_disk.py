"""A block on a disk: what is its own."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable

from .measure import edges
from .sound import fault
from .test_arc_contact import block


def test_the_block_has_vertical_sides_and_a_flat_top():
    """
    requirement: sides where the arc ends, the top above the highest point of the disk by its key.
    """
    geometry = block(arc_start="-11 deg", arc_end="40 deg")
    mesh = geometry.build(MeshTable(), None)
    ends = 20e-3 * np.sin(geometry.arc)
    x, y = edges(mesh, "block_side").reshape(-1, 2).T
    assert np.abs(x[:, None] - ends).min(axis=1).max() < 1e-15
    assert y.min() == pytest.approx(20e-3 * np.cos(geometry.arc_end), rel=1e-12)
    top = edges(mesh, "block_top")
    np.testing.assert_allclose(top[..., 1], 30e-3, rtol=1e-14)
    assert (top[..., 0].min(), top[..., 0].max()) == pytest.approx(tuple(ends), rel=1e-12)


def test_it_is_held_on_top_and_pressed_down_on_a_disk_fixed_at_its_bore():
    """
    requirement: names and directions that cases rely on.
    """
    geometry = block()
    assert geometry.bodies == ("block", "disk")
    assert geometry.contact == ("block_face", "disk_face")
    assert (geometry.held, geometry.fixed) == ("block_top", "disk_bore")
    assert geometry.press_direction == (0.0, -1.0)
    assert geometry.surfaces == (
        "block_face",
        "block_top",
        "block_side",
        "disk_face",
        "disk_rim",
        "disk_bore",
    )


@pytest.mark.parametrize(
    ("changes", "key", "text"),
    [
        ({"disk_bore": "20 mm"}, "disk_bore", "must be less than disk_radius 0.02 m"),
        ({"arc_end": "81 deg"}, "arc_end", "81 deg must be within 80 deg of 12 o'clock"),
        ({"arc_start": "-1.5 rad"}, "arc_start", "must be within 80 deg"),
    ],
)
def test_sizes_that_do_not_fit(changes, key, text):
    """
    requirement: one clear line with the key's path.
    """
    found, message = fault(block, **changes)
    assert found == key
    assert text in message


def test_angles_need_a_unit_of_angle():
    """
    requirement: a bare number or a length is no angle.
    """
    for wrong in (0.5, "0.5", "5 mm"):
        with pytest.raises(ValueError, match="deg"):
            block(arc_end=wrong)
    assert block(arc_end="30 deg").arc_end == pytest.approx(np.pi / 6, rel=1e-15)
