"""Meshes of a punch on a block."""

from mpi4py import MPI

import numpy as np
import pytest
from scipy.integrate import quad

from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import kinematics_of
from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.pressing import Pressing
from thermowear.contact.faces.face import gather_face
from thermowear.contact.search.pairing import pair
from thermowear.errors import CaseError
from thermowear.geometry.geometries.punch_on_block import PunchOnBlock

from .measure import areas, edges, ends, scaled_jacobians, unnamed


def punch(edge_radius="0 mm", **changes):
    keys = {
        "width": "12 mm",
        "height": "15 mm",
        "edge_radius": edge_radius,
        "block_width": "40 mm",
        "block_height": "20 mm",
    }
    return PunchOnBlock(type="punch-on-block", **keys | changes)


SHARP = [(punch(half=True), 8, 0.3, None), (punch(), 12, 0.3, None), (punch(), 5, 1.0, None)]
ROUNDED = [
    (punch("1 mm", half=True), 8, 0.3, (-5.1e-3, 5.1e-3)),
    (punch("1 mm", half=True), 8, 0.3, (-4.2e-3, 4.2e-3)),
    (punch("1 mm"), 12, 0.3, (-5.1e-3, 5.3e-3)),
    (punch("1 mm"), 20, 1.0, (-5.2e-3, 5.2e-3)),
    (punch("0.1 mm", half=True), 12, 0.3, (-5.93e-3, 5.93e-3)),
    (punch("5.5 mm", half=True), 12, 0.3, (-2e-3, 2e-3)),
]


@pytest.mark.parametrize(("geometry", "elements", "grading", "zone"), SHARP + ROUNDED)
def test_cells_are_well_shaped_and_fill_the_bodies(geometry, elements, grading, zone):
    """
    requirement: no inverted or degenerate cell; the areas are right; every boundary edge named.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), zone)
    assert scaled_jacobians(mesh).min() > 0.12
    part = 0.5 if geometry.half else 1.0
    corners = (2 - np.pi / 2) * geometry.edge_radius**2
    section = geometry.width * geometry.height - corners
    assert areas(mesh, "punch").sum() == pytest.approx(part * section, rel=5e-5)
    block = geometry.block_width * geometry.block_height
    assert areas(mesh, "block").sum() == pytest.approx(part * block, rel=1e-12)
    assert unnamed(mesh) == 0
    tags = np.bincount(mesh.facet_tags, minlength=len(mesh.surfaces) + 1)[1:]
    assert np.all(tags > 0), dict(zip(mesh.surfaces, tags, strict=True))


@pytest.mark.parametrize(("geometry", "elements", "grading", "zone"), SHARP)
def test_faces_of_a_sharp_punch_end_at_its_edges(geometry, elements, grading, zone):
    """
    requirement: the asked elements on both faces, which end at the edges of the punch.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), (-1e-3, 1e-3))
    for face in geometry.contact:
        x = ends(mesh, face)
        assert x[0] == pytest.approx(0.0 if geometry.half else -6e-3, abs=1e-15)
        assert x[-1] == pytest.approx(6e-3, rel=1e-12)
        assert len(x) - 1 == (elements // 2 if geometry.half else elements)


@pytest.mark.parametrize(("geometry", "elements", "grading", "zone"), ROUNDED)
def test_elements_of_a_rounded_punch_end_where_it_matters(geometry, elements, grading, zone):
    """
    requirement: ends of elements at the ends of contact and of the flat, on both faces.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), zone)
    places = [zone[1], geometry.flat] + ([0.0] if geometry.half else [zone[0], -geometry.flat])
    for face in geometry.contact:
        x = ends(mesh, face)
        for place in places:
            assert np.abs(x - place).min() < 2e-12, (face, place)


@pytest.mark.parametrize("half", [True, False])
def test_the_face_of_a_rounded_punch_follows_the_rounding(half):
    """
    requirement: nodes on the flat and on the arc exactly, the face up to 45 degrees of it.
    """
    geometry = punch("1 mm", half=half)
    mesh = geometry.build(MeshTable(elements=12), (-5.1e-3, 5.1e-3))
    x, y = np.abs(edges(mesh, "punch_face")).reshape(-1, 2).T
    on_flat = x <= geometry.flat * (1 + 1e-12)
    assert np.all(y[on_flat] == 0.0)
    np.testing.assert_allclose(np.hypot(x[~on_flat] - 5e-3, y[~on_flat] - 1e-3), 1e-3, rtol=1e-12)
    assert x.max() == pytest.approx(5e-3 + 1e-3 * np.sin(np.pi / 4), rel=1e-12)


@pytest.mark.parametrize("geometry", [punch(), punch("1 mm"), punch("1 mm", half=True)])
def test_faces_pair(geometry):
    """
    requirement: faces are chains that lie opposite each other; the gap is the rounding's height.
    """
    tagged = geometry.build(MeshTable(elements=10), (-5.1e-3, 5.1e-3))
    faces = [gather_face(distribute(tagged, MPI.COMM_SELF), name) for name in geometry.contact]
    pairing = pair(*faces, kinematics_of("plane-strain", geometry.thickness_factor), 6)
    side = pairing.sides[0]
    x, y = side.face.points(side.facet, side.t).T
    over = np.clip(np.abs(x) - geometry.flat, 0.0, None)
    radius = geometry.edge_radius
    exact = radius - np.sqrt(radius**2 - over**2)
    np.testing.assert_allclose(y, exact, atol=3e-5 * 1e-3)
    contact = np.abs(x) < 5.15e-3
    np.testing.assert_allclose(y[contact], exact[contact], atol=1e-7 * 1e-3)
    half = np.arcsin(over / max(radius, 1e-9)) / 2  # of the angle between the faces of like bodies
    np.testing.assert_allclose(pairing.gap, exact / np.cos(half), rtol=1e-3, atol=3e-5 * 1e-3)


def test_contact_area_and_symmetry():
    """
    requirement: nominal area of the flat; halves stand for the whole.
    """
    assert punch(thickness="2 mm").contact_area() == pytest.approx(12e-3 * 2e-3, rel=1e-12)
    rounded = punch("1 mm", half=True, thickness="2 mm")
    assert rounded.contact_area() == pytest.approx(10e-3 * 2e-3, rel=1e-12)
    assert rounded.thickness_factor == pytest.approx(4e-3)
    assert rounded.symmetry == ("punch_axis", "block_axis")


def test_expected_zone_carries_the_load():
    """
    requirement: the half-width of a flat punch with rounded edges on a half-plane.

    Its pressure balances the load: ``P = E*/2 ∫ h'(x) x / sqrt(a² - x²) dx``.
    """
    geometry, modulus = punch("1 mm"), 115.4e9
    a = geometry.expected_zone(Pressing(1000.0, None, modulus))[1]
    assert geometry.flat < a < 5.6e-3
    load, _ = quad(
        lambda s: (a * np.sin(s) - 5e-3) / 1e-3 * a * np.sin(s), np.arcsin(5e-3 / a), np.pi / 2
    )
    assert modulus * load == pytest.approx(1000.0 / 1e-3, rel=1e-6)
    assert punch().expected_zone(Pressing(1000.0, None, modulus)) == (-6e-3, 6e-3)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"edge_radius": "6 mm"}, "edge_radius"),
        ({"edge_radius": "5 mm", "height": "4 mm"}, "edge_radius"),
        ({"block_width": "15 mm"}, "block_width"),
    ],
)
def test_sizes_that_do_not_fit(changes, key):
    """
    requirement: one clear line with the key's path.
    """
    with pytest.raises(ValueError, match="must be") as error:
        punch(**changes)
    assert error.value.errors()[0]["ctx"]["error"].key == key


def test_a_contact_beyond_the_rounding_is_refused():
    """
    requirement: one clear line with the key's path.
    """
    with pytest.raises(CaseError) as error:
        punch("1 mm").build(MeshTable(), (-5.8e-3, 5.8e-3))
    assert error.value.faults[0].startswith("geometry.edge_radius: too small for the contact")
