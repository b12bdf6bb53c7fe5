"""Meshes of a block, a segment and a shoe whose whole face lies on a turning ring."""

from mpi4py import MPI

import numpy as np
import pytest
from scipy.integrate import quad

from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import kinematics_of
from thermowear.case.tables.mesh import MeshTable
from thermowear.contact.faces.face import gather_face
from thermowear.contact.search.pairing import pair
from thermowear.geometry.geometries.arcs.arc_contact import BlockOnDisk
from thermowear.geometry.geometries.arcs.inside_ring import DrumBrake, RingSegmentOnDisk

from .measure import edges, unnamed
from .sound import check_mesh, fault


def block(**changes):
    keys = {
        "disk_radius": "20 mm",
        "disk_bore": "8 mm",
        "block_height": "10 mm",
        "arc_start": "-0.5 rad",
        "arc_end": "0.5 rad",
        "thickness": "10 mm",
    }
    return BlockOnDisk(type="block-on-disk", **keys | changes)


def segment(**changes):
    keys = {
        "disk_radius": "40 mm",
        "disk_outer_radius": "55 mm",
        "segment_thickness": "10 mm",
        "arc_start": "-20 deg",
        "arc_end": "35 deg",
    }
    return RingSegmentOnDisk(type="ring-segment-on-disk", **keys | changes)


def shoe(**changes):
    keys = {
        "drum_radius": "100 mm",
        "drum_thickness": "12 mm",
        "lining_thickness": "8 mm",
        "shoe_thickness": "6 mm",
        "arc_start": "-50 deg",
        "arc_end": "60 deg",
        "pivot": ["-80 mm", "-20 mm"],
    }
    return DrumBrake(type="drum-brake", **keys | changes)


WIDE, ASIDE = {"arc_start": "-80 deg", "arc_end": "80 deg"}, {"arc_start": "10 deg"}
BELOW = {"arc_start": "130 deg", "arc_end": "230 deg", "pivot": ["70 mm", "-2 mm"]}
MESHES = [
    (block(), 12, 0.3),
    (block(arc_start="-11 deg", arc_end="40 deg"), 40, 1.0),
    (block(**WIDE), 20, 0.3),
    (block(**ASIDE, disk_bore="19 mm", block_height="0.5 mm"), 16, 0.1),
    (segment(), 12, 0.3),
    (segment(**WIDE, disk_outer_radius="41 mm", segment_thickness="30 mm"), 20, 0.3),
    (segment(**ASIDE), 12, 1.0),
    (shoe(), 16, 0.3),
    (shoe(**BELOW), 30, 1.0),
]


def sections(geometry) -> dict[str, float]:
    """Areas of both sections, by integration over the arc [m²]."""
    radius, (start, end) = geometry.radius, geometry.arc
    if isinstance(geometry, BlockOnDisk):
        top = radius + geometry.block_height
        upper, _ = quad(lambda a: (top - radius * np.cos(a)) * radius * np.cos(a), start, end)
    else:
        inner = radius - sum(geometry.layers)
        upper = (radius**2 - inner**2) / 2 * (end - start)
    ring = np.pi * abs(radius**2 - geometry.far_radius**2)
    found = dict(zip(geometry.bodies, (upper, ring), strict=True))
    for zone, body in geometry.zones.items():  # the outermost layer
        inner = radius - geometry.layers[0]
        found[zone] = (radius**2 - inner**2) / 2 * (end - start)
        found[body] -= found[zone]
    return found


@pytest.mark.parametrize(("geometry", "elements", "grading"), MESHES)
def test_cells_are_well_shaped_and_fill_the_bodies(geometry, elements, grading):
    """
    requirement: no inverted or slanted cell; areas to 1e-6, as cubic arcs of up to 12 degrees have
    them; every boundary edge has one name, and every name an edge.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), None)
    steepest = np.cos(np.abs(geometry.arc).max()) if isinstance(geometry, BlockOnDisk) else 1.0
    check_mesh(mesh, sections(geometry), rel=1e-6, shape=max(0.1, 0.999 * steepest))
    assert mesh.surfaces == geometry.surfaces
    assert unnamed(mesh) == 0


@pytest.mark.parametrize(("geometry", "elements", "grading"), MESHES)
def test_both_faces_are_the_same_arc(geometry, elements, grading):
    """
    requirement: all nodes on the circle exactly; the asked elements from edge to edge, and the
    same nodes on both faces.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), None)
    middle = sum(geometry.arc) / 2
    arcs = []
    for face in geometry.contact:
        p = edges(mesh, face).reshape(-1, 2)
        np.testing.assert_allclose(np.hypot(*p.T), geometry.radius, rtol=1e-14)
        turned = np.arctan2(p[:, 0], p[:, 1]) - middle
        angles = np.unique(np.round((turned + np.pi) % (2 * np.pi) - np.pi, 12)) + middle
        assert angles[0] == pytest.approx(geometry.arc_start, abs=1e-11)
        assert angles[-1] == pytest.approx(geometry.arc_end, abs=1e-11)
        assert len(edges(mesh, face)) == elements
        arcs.append(angles)
    np.testing.assert_allclose(arcs[0], arcs[1], atol=1e-11)
    for surface, radius in (
        (geometry.rest, geometry.radius),
        (geometry.fixed, geometry.far_radius),
    ):
        p = edges(mesh, surface)
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1]), radius, rtol=1e-14)


@pytest.mark.parametrize("geometry", [block(), segment(), shoe()])
def test_bodies_may_be_divided_differently(geometry):
    """
    requirement: elements and grading of each body; both faces still have the same ends.
    """
    ring = geometry.bodies[1]
    mesh = geometry.build(MeshTable(bodies={ring: {"elements": 17, "grading": 1.0}}), None)
    upper, lower = (edges(mesh, face) for face in geometry.contact)
    assert (len(upper), len(lower)) == (12, 17)
    for axis in range(2):
        assert np.ptp(upper[..., axis]) == pytest.approx(np.ptp(lower[..., axis]), rel=1e-2)
    assert upper[..., 0].min() == pytest.approx(lower[..., 0].min(), rel=1e-12)
    assert unnamed(mesh) == 0


@pytest.mark.parametrize(
    ("geometry", "outward"), [(block(), -1), (segment(), 1), (shoe(), 1), (shoe(**BELOW), 1)]
)
def test_faces_pair_and_the_press_closes_them(geometry, outward):
    """
    requirement: no gap; normals of body 1 along the radius, to the disk inside or to the ring
    outside; the nominal area is what a uniform pressure has along the press.
    """
    bodies = distribute(geometry.build(MeshTable(elements=32), None), MPI.COMM_SELF)
    faces = [gather_face(bodies, name) for name in geometry.contact]
    pairing = pair(*faces, kinematics_of("plane-strain", geometry.thickness_factor), 8)
    assert pairing.unpaired < 1e-12
    assert np.abs(pairing.gap).max() < 1e-12 * geometry.radius
    length = geometry.radius * (geometry.arc_end - geometry.arc_start)
    assert pairing.weights.sum() == pytest.approx(length * geometry.thickness, rel=1e-7)
    radial = pairing.points / np.linalg.norm(pairing.points, axis=1)[:, None]
    np.testing.assert_allclose(pairing.normals, outward * radial, atol=5e-5)
    along = pairing.normals @ geometry.press_direction
    assert np.linalg.norm(geometry.press_direction) == pytest.approx(1.0, rel=1e-15)
    assert np.all(along > 0)
    assert geometry.contact_area() == pytest.approx(pairing.weights @ along, rel=1e-7)


def test_the_nominal_area_is_that_of_the_chord():
    """
    requirement: seen along the press, the arc is as wide as its chord is across it.
    """
    assert block().contact_area() == pytest.approx(2 * 20e-3 * np.sin(0.5) * 10e-3, rel=1e-12)
    chord = 2 * 100e-3 * np.sin(np.radians(55.0))
    assert shoe().contact_area() == pytest.approx(chord * 1e-3, rel=1e-12)


@pytest.mark.parametrize(
    ("geometry", "radius"), [(block(), 20e-3), (segment(), 40e-3), (shoe(), 100e-3)]
)
def test_the_ring_turns_about_the_origin(geometry, radius):
    """
    requirement: body 2 turns about its centre, its track is the circumference where they touch.
    """
    assert geometry.rotation_center == (0.0, 0.0)
    assert geometry.track == pytest.approx(2 * np.pi * radius, rel=1e-15)
    assert geometry.thickness_factor == geometry.thickness
    assert geometry.symmetry == ()


@pytest.mark.parametrize("geometry", [block(), segment(), shoe()])
@pytest.mark.parametrize("span", [(-0.1, 0.3), (-2.0, 0.2), (-0.3, 0.0)])
def test_a_contact_may_end_inside_the_face(geometry, span):
    """
    requirement: the asked elements in the contact, with ends at its edges, on both faces; nothing
    else changes.
    """
    start, end = max(span[0], geometry.arc_start), min(span[1], geometry.arc_end)
    reach = np.clip(span, -np.pi / 2, np.pi / 2)
    assert geometry.follows_contact
    mesh = geometry.build(MeshTable(elements=12), tuple(geometry.radius * np.sin(reach)))
    for face in geometry.contact:
        angles = np.unique(np.round(np.arctan2(*edges(mesh, face)[:, :2].reshape(-1, 2).T), 10))
        assert np.abs(angles - start).min() < 2e-10
        assert np.abs(angles - end).min() < 2e-10
        assert ((angles > start - 1e-9) & (angles < end + 1e-9)).sum() == 13
        assert (angles[0], angles[-1]) == pytest.approx(geometry.arc, abs=2e-10)
    check_mesh(mesh, sections(geometry), rel=2e-6, shape=0.8)


def test_an_arc_that_turns_back_is_meshed_for_its_whole_face():
    """
    requirement: a range of x says nothing of an arc on the side of a drum.
    """
    assert not shoe(**BELOW).follows_contact


@pytest.mark.parametrize("make", [block, segment, shoe])
@pytest.mark.parametrize("arc", [("10 deg", "10 deg"), ("20 deg", "-20 deg")])
def test_an_arc_that_ends_before_it_starts_is_refused(make, arc):
    """
    requirement: one clear line with the key's path.
    """
    key, text = fault(make, arc_start=arc[0], arc_end=arc[1])
    assert key == "arc_end"
    assert "must be greater than arc_start" in text
