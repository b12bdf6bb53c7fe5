"""Meshes of a tube in the wider hole of a support."""

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import kinematics_of
from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.pressing import Pressing
from thermowear.contact.faces.face import gather_face
from thermowear.contact.search.pairing import pair
from thermowear.errors import CaseError
from thermowear.geometry.geometries.arcs.tube_in_support import TubeInSupport

from .measure import edges, ends, unnamed
from .sound import check_mesh, fault

R = 10e-3


def tube(**changes):
    keys = {
        "tube_radius": "10 mm",
        "tube_wall": "2 mm",
        "support_clearance": "0.2 mm",
        "support_thickness": "10 mm",
    }
    return TubeInSupport(type="tube-in-support", **keys | changes)


MESHES = [
    (tube(), 12, 0.3, (-2e-4, 2e-4)),
    (tube(), 12, 0.3, (-1e-3, 1.4e-3)),
    (tube(tube_wall="0.3 mm", support_thickness="1 mm"), 20, 1.0, (-2e-3, 2e-3)),
    (tube(tube_wall="9 mm"), 7, 0.5, (1e-4, 6e-4)),
    (tube(support_clearance="1 um"), 12, 0.15, (-8e-3, 8e-3)),
    (tube(support_clearance="30 mm"), 6, 0.3, (-1e-3, 1e-3)),
    (tube(), 12, 0.3, (-9.6e-3, 9.6e-3)),
]


def sections(geometry) -> dict[str, float]:
    """Areas of both rings [m²]."""
    hole = R + geometry.support_clearance
    bore, rim = R - geometry.tube_wall, hole + geometry.support_thickness
    return {"tube": np.pi * (R**2 - bore**2), "support": np.pi * (rim**2 - hole**2)}


@pytest.mark.parametrize(("geometry", "elements", "grading", "zone"), MESHES)
def test_cells_are_well_shaped_and_fill_the_bodies(geometry, elements, grading, zone):
    """
    requirement: no inverted or slanted cell; areas to 1e-6, as cubic arcs of up to 12 degrees have
    them (2e-5 where an element is 28 degrees wide); every edge has one name, every name an edge.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), zone)
    check_mesh(mesh, sections(geometry), rel=2e-5 if zone[1] > 5e-3 else 1e-6, shape=0.99)
    assert mesh.surfaces == geometry.surfaces
    assert unnamed(mesh) == 0


@pytest.mark.parametrize(("geometry", "elements", "grading", "zone"), MESHES)
def test_elements_end_where_the_contact_ends(geometry, elements, grading, zone):
    """
    requirement: the asked elements in the zone, with ends at its ends; those of the support lie
    opposite, on the same normals.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), zone)
    x = ends(mesh, "tube_face")
    for end in zone:
        assert np.abs(x - end).min() < 2e-12
    assert ((x > zone[0] - 2e-12) & (x < zone[1] + 2e-12)).sum() == elements + 1
    assert x[0] < zone[0]
    assert x[-1] > zone[1]
    angles = []
    for face in geometry.contact:
        p = edges(mesh, face)[:, :2].reshape(-1, 2)
        angles.append(np.unique(np.round(np.arctan2(p[:, 0], R - p[:, 1]), 10)))
    np.testing.assert_allclose(angles[0], angles[1], atol=2e-10)


def test_every_surface_is_where_its_name_says():
    """
    requirement: nodes on circles about the centres of the tube and of the hole.
    """
    mesh = tube().build(MeshTable(), (-1e-3, 1e-3))
    hole = 10.2e-3
    circles = {
        "tube_face": (R, R),
        "tube_outside": (R, R),
        "tube_bore": (R, 8e-3),
        "support_face": (hole, hole),
        "support_hole": (hole, hole),
        "support_rim": (hole, 20.2e-3),
    }
    for surface, (height, radius) in circles.items():
        p = edges(mesh, surface)
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1] - height), radius, rtol=1e-13)


@pytest.mark.parametrize("zone", [(-1e-3, 1e-3), (-6e-3, 4e-3)])
def test_they_touch_at_the_bottom_and_gape_beside_it(zone):
    """
    requirement: the whole face pairs; the gap is that of two circles.
    """
    geometry = tube()
    bodies = distribute(geometry.build(MeshTable(elements=20), zone), MPI.COMM_SELF)
    faces = [gather_face(bodies, name) for name in geometry.contact]
    pairing = pair(*faces, kinematics_of("plane-strain", geometry.thickness_factor), 6)
    assert pairing.unpaired < 1e-12
    first, second = (side.face.points(side.facet, side.t) for side in pairing.sides)
    hole = R + geometry.support_clearance
    out_1, out_2 = (first - [0.0, R]) / R, -(second - [0.0, hole]) / hole
    normals = (out_1 - out_2) / np.linalg.norm(out_1 - out_2, axis=1, keepdims=True)
    np.testing.assert_allclose(pairing.normals, normals, atol=2e-4)
    exact = np.einsum("ni,ni->n", second - first, normals)
    assert exact.max() > 3e-6
    np.testing.assert_allclose(pairing.gap, exact, rtol=5e-4, atol=1e-7 * R)
    across = second - first - exact[:, None] * normals
    assert np.linalg.norm(across, axis=1).max() < 3e-4 * exact.max()
    assert pairing.gap[np.abs(first[:, 0]).argmin()] == pytest.approx(0.0, abs=1e-3 * exact.max())


def test_the_expected_zone_is_that_of_hertz_up_to_a_limit():
    """
    requirement: half-width of a cylinder in a wider one; not more than 60 degrees on either side.
    """
    geometry, modulus = tube(thickness="2 mm"), 115.4e9
    left, right = geometry.expected_zone(Pressing(100.0, None, modulus))
    relative = 1 / (1 / R - 1 / 10.2e-3)
    a = np.sqrt(4 * 100.0 / 2e-3 * relative / (np.pi * modulus))
    assert right == pytest.approx(a, rel=1e-3)
    assert left == -right
    widest = R * np.sin(np.radians(60.0))
    assert geometry.expected_zone(Pressing(1e7, None, modulus))[1] == pytest.approx(widest)
    approach = geometry.expected_zone(Pressing(None, 1e-7, modulus))[1]
    assert approach == pytest.approx(0.7 * np.sqrt(relative * 1e-7), rel=1e-3, abs=0.0)
    assert geometry.follows_contact
    assert geometry.contact_area() is None
    assert geometry.rotation_center is None


@pytest.mark.parametrize(
    ("zone", "text"),
    [
        ((-1e-3, 9.7e-3), "geometry.support_clearance: too small for the contact"),
        ((-9.7e-3, -1e-3), "geometry.support_clearance: too small for the contact"),
        ((1e-3, 1e-3), "geometry: the contact zone from x = 0.001 to 0.001 m is empty"),
    ],
)
def test_a_contact_that_cannot_be_meshed_is_refused(zone, text):
    """
    requirement: one clear line with the key's path.
    """
    with pytest.raises(CaseError) as error:
        tube().build(MeshTable(), zone)
    assert len(error.value.faults) == 1
    assert error.value.faults[0].startswith(text)


@pytest.mark.parametrize(
    ("changes", "key", "text"),
    [
        ({"tube_wall": "10 mm"}, "tube_wall", "must be less than tube_radius 0.01 m"),
        ({"support_clearance": "0 mm"}, "support_clearance", "must be greater than 0 m"),
    ],
)
def test_sizes_that_do_not_fit(changes, key, text):
    """
    requirement: one clear line with the key's path.
    """
    found, message = fault(tube, **changes)
    assert found == key
    assert text in message


def test_a_mesh_for_a_contact_that_travels():
    """requirement: the zone of the case, wherever the unworn bodies would touch; not too large."""
    wide = tube(zone="1.5 mm")
    assert wide.expected_zone(Pressing(1.0, None, 1e11)) == (-1.5e-3, 1.5e-3)
    mesh = wide.build(MeshTable(elements=10, grading=1.0), (-1.5e-3, 1.5e-3))
    x = ends(mesh, "tube_face")
    inside = x[np.abs(x) < 1.51e-3]
    assert len(inside) == 11
    with pytest.raises(CaseError, match=r"geometry.zone: too large for the contact"):
        tube(zone="9.9 mm").build(MeshTable(), (-9.9e-3, 9.9e-3))
