"""The mesh of a block beside its pivot, on a strip."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.on_strip import PivotedBlock

from .measure import ends, unnamed
from .sound import check_mesh, check_surfaces, fault

SIZES = {
    "face_start": "50 mm",
    "face_end": "150 mm",
    "block_height": "30 mm",
    "pivot_height": "40 mm",
    "strip_length": "240 mm",
    "strip_height": "25 mm",
    "thickness": "10 mm",
}


def block(**changes):
    return PivotedBlock(type="pivoted-block", **SIZES | changes)


@pytest.mark.parametrize("zone", [None, (0.05, 0.12), (0.0713, 0.15)])
@pytest.mark.parametrize("settings", [{}, {"elements": 5, "grading": 1.0}, {"elements": 1}])
def test_block_and_strip(settings, zone):
    """
    requirement: well-shaped cells fill both bodies; every boundary edge named.
    """
    mesh = block().build(MeshTable(**settings), zone)
    check_mesh(mesh, {"block": 0.1 * 0.03, "strip": 0.24 * 0.025}, shape=0.999)
    assert unnamed(mesh) == 0
    places = {
        "block_face": (1, 0.0),
        "block_top": (1, 0.03),
        "block_left": (0, 0.05),
        "block_right": (0, 0.15),
        "strip_face": (1, 0.0),
        "strip_top": (1, 0.0),
        "strip_bottom": (1, -0.025),
        "strip_left": (0, -0.02),
        "strip_right": (0, 0.22),
    }
    check_surfaces(mesh, places)
    faces = [ends(mesh, face) for face in block().contact]
    np.testing.assert_allclose(*faces, atol=1e-12)
    for edge in zone or ():
        assert np.abs(faces[0] - edge).min() < 1e-12


def test_pivot():
    """
    requirement: x is measured from the pivot, which lies above the face.
    """
    assert block().pivot_point == pytest.approx((0.0, 0.04))
    assert block(pivot_height="0 mm").pivot_point == (0.0, 0.0)
    assert block().contact_area() == pytest.approx(0.1 * 0.01, rel=1e-12)
    assert block().track == pytest.approx(0.24, rel=1e-12)
    assert block().held == "block_top"
    assert block().fixed == "strip_bottom"


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"face_start": "150 mm"}, "face_start"),
        ({"strip_length": "99 mm"}, "strip_length"),
        ({"face_start": "-10 mm"}, "face_start"),
        ({"pivot_height": "-1 mm"}, "pivot_height"),
    ],
)
def test_sizes_that_do_not_fit(changes, key):
    """
    requirement: one clear line with the key's path.
    """
    assert fault(block, **changes)[0] == key
