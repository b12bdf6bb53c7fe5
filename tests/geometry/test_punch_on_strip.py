"""The mesh of a punch on a strip."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.on_strip import PunchOnStrip

from .measure import edges, ends, unnamed
from .sound import check_mesh, check_surfaces, fault, spans

SIZES = {
    "width": "30 mm",
    "height": "20 mm",
    "strip_length": "120 mm",
    "strip_height": "15 mm",
    "thickness": "10 mm",
}


def punch(**changes):
    return PunchOnStrip(type="punch-on-strip", **SIZES | changes)


@pytest.mark.parametrize("zone", [None, (-0.015, 0.004), (-0.002, 0.015)])
@pytest.mark.parametrize(
    "settings", [{}, {"elements": 5, "grading": 1.0}, {"elements": 1}, {"elements": 30}]
)
def test_punch_and_strip(settings, zone):
    """
    requirement: well-shaped cells fill both bodies; every boundary edge named.
    """
    mesh = punch().build(MeshTable(**settings), zone)
    check_mesh(mesh, {"punch": 0.03 * 0.02, "strip": 0.12 * 0.015}, shape=0.999)
    assert unnamed(mesh) == 0
    places = {
        "punch_face": (1, 0.0),
        "punch_top": (1, 0.02),
        "punch_left": (0, -0.015),
        "punch_right": (0, 0.015),
        "strip_face": (1, 0.0),
        "strip_top": (1, 0.0),
        "strip_bottom": (1, -0.015),
        "strip_left": (0, -0.06),
        "strip_right": (0, 0.06),
    }
    check_surfaces(mesh, places)
    assert spans(mesh, "strip_face") == [pytest.approx((-0.015, 0.015))]
    assert len(spans(mesh, "strip_top")) == 2


def test_faces_are_divided_alike_up_to_the_edge_of_contact():
    """
    requirement: element ends agree on both faces, and lie at the ends of the contact.
    """
    mesh = punch().build(MeshTable(), None)
    assert len(ends(mesh, "punch_face")) == 13
    np.testing.assert_allclose(ends(mesh, "punch_face"), ends(mesh, "strip_face"), atol=1e-15)
    tilted = punch().build(MeshTable(), (-0.015, 0.0037))
    for face in tilted.surfaces[0], tilted.surfaces[4]:
        assert np.abs(ends(tilted, face) - 0.0037).min() < 1e-12


def test_mesh_is_symmetric():
    """
    requirement: nothing tilts a punch but friction.
    """
    x = ends(punch().build(MeshTable(), None), "strip_bottom")
    np.testing.assert_allclose(x, -x[::-1], atol=1e-12)


def test_a_long_strip_costs_little():
    """
    requirement: far from the contact elements grow to the height of the strip, however fine.
    """
    mesh = punch(strip_length="2 m").build(MeshTable(elements=40, grading=1.0), None)
    x = np.unique(edges(mesh, "strip_bottom")[:, :2, 0].round(12))
    assert len(x) < 40 + 2 * 100
    sizes = np.diff(x[x > 0.015])
    assert np.all(sizes[1:] < 1.5 * sizes[:-1])
    assert sizes.max() < 1.01 * 0.015


def test_area_and_track():
    """
    requirement: a mean pressure presses on the whole face; wear spreads over the strip.
    """
    assert punch().contact_area() == pytest.approx(0.03 * 0.01, rel=1e-12)
    assert punch().track == pytest.approx(0.12, rel=1e-12)
    assert punch().thickness_factor == pytest.approx(0.01, rel=1e-12)


def test_sizes_that_do_not_fit():
    """
    requirement: one clear line with the key's path.
    """
    assert fault(punch, strip_length="29 mm")[0] == "strip_length"


def test_a_strip_that_is_rubbed_to_and_fro():
    """
    requirement: its face goes on by the stroke on both sides, in elements as large as the punch's.
    """
    mesh = punch(stroke="10 mm").build(MeshTable(elements=6, grading=1.0), None)
    check_mesh(mesh, {"punch": 0.03 * 0.02, "strip": 0.12 * 0.015}, shape=0.999)
    assert unnamed(mesh) == 0
    assert spans(mesh, "strip_face") == [pytest.approx((-0.025, 0.025))]
    assert spans(mesh, "punch_face") == [pytest.approx((-0.015, 0.015))]
    np.testing.assert_allclose(np.diff(ends(mesh, "strip_face")), 0.005, rtol=1e-9)
    key, said = fault(punch, stroke="46 mm")
    assert key == "strip_length"
    assert "0.12 m" in said


def test_a_punch_as_wide_as_its_strip():
    """
    requirement: edges in line; nothing is left of the strip's top.
    """
    geometry = punch(strip_length="0.03 m")
    mesh = geometry.build(MeshTable(), None)
    assert mesh.surfaces == geometry.surfaces
    assert "strip_top" not in mesh.surfaces
    assert unnamed(mesh) == 0
    assert np.bincount(mesh.facet_tags)[1:].min() > 0
