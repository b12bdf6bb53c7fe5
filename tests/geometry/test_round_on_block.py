"""Meshes of a cylinder and of a sphere on a block."""

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
from thermowear.geometry.geometries.on_block import CylinderOnBlock, SphereOnBlock

from .measure import areas, dofs, edges, ends, scaled_jacobians, unnamed

R = 10e-3


def cylinder(**changes):
    keys = {"radius": "10 mm", "block_width": "40 mm", "block_height": "20 mm"} | changes
    return CylinderOnBlock(type="cylinder-on-block", **keys)


def sphere(**changes):
    keys = {"radius": "10 mm", "block_radius": "20 mm", "block_height": "20 mm"} | changes
    return SphereOnBlock(type="sphere-on-block", **keys)


MESHES = [
    (cylinder(half=True), 6, 0.3, (-5e-4, 5e-4)),
    (cylinder(half=True), 6, 0.3, (-1e-5, 1e-5)),
    (cylinder(half=True), 8, 0.15, (-4e-3, 4e-3)),
    (cylinder(half=True), 1, 1.0, (-5e-4, 5e-4)),
    (cylinder(half=True), 30, 1.0, (-2e-3, 2e-3)),
    (cylinder(), 12, 0.3, (-5e-4, 5e-4)),
    (cylinder(), 7, 0.5, (1e-4, 6e-4)),
    (cylinder(), 5, 0.3, (-4e-3, 5e-3)),
    (cylinder(block_width="400 mm"), 6, 0.3, (-5e-4, 5e-4)),
    (cylinder(block_height="100 mm"), 6, 0.3, (-6e-4, 5e-4)),
    (cylinder(block_height="0.5 mm"), 10, 0.3, (-5e-4, 5e-4)),
    (sphere(), 9, 0.3, (-3e-4, 3e-4)),
]


@pytest.mark.parametrize(("geometry", "elements", "grading", "zone"), MESHES)
def test_cells_are_well_shaped_and_fill_the_bodies(geometry, elements, grading, zone):
    """
    requirement: no inverted or degenerate cell, curved nodes included; every boundary edge named.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), zone)
    assert scaled_jacobians(mesh).min() > 0.12
    part = 0.5 if geometry.right_only else 1.0
    upper, lower = (areas(mesh, body) for body in mesh.bodies)
    assert upper.min() > 0
    assert upper.sum() == pytest.approx(part * np.pi * R**2 / 2, rel=4e-4)
    rectangle = 2 * part * geometry.block_reach * geometry.block_height
    assert lower.sum() == pytest.approx(rectangle, rel=1e-12)
    on_axis = mesh.points[mesh.points[:, 0] == 0.0] if geometry is MESHES[-1][0] else ()
    assert unnamed(mesh) == max(0, len(on_axis) - 2) // 3  # an axis of revolution has no name


def test_a_fine_mesh_has_the_area_of_the_disc():
    """
    requirement: curved cells; the area converges with the fourth power of the element size.
    """
    mesh = cylinder(half=True).build(MeshTable(elements=120, grading=1.0), (-2e-3, 2e-3))
    assert areas(mesh, "cylinder").sum() == pytest.approx(np.pi * R**2 / 4, rel=1e-6)


@pytest.mark.parametrize(("geometry", "elements", "grading", "zone"), MESHES)
def test_elements_end_where_the_contact_ends(geometry, elements, grading, zone):
    """
    requirement: both faces have the asked elements in the zone, and element ends at its ends.
    """
    mesh = geometry.build(MeshTable(elements=elements, grading=grading), zone)
    left = 0.0 if geometry.right_only else zone[0]
    for face in geometry.contact:
        x = ends(mesh, face)
        for end in (left, zone[1]):
            assert np.abs(x - end).min() < 1e-12, face
        inside = ((x > left - 1e-12) & (x < zone[1] + 1e-12)).sum() - 1
        assert inside == (-(-elements // 2) if geometry.right_only else elements)
        beyond = x.max() - zone[1]
        half_width = (zone[1] - zone[0]) / 2
        room = 0.65 * R - zone[1]
        assert 0.6 * min(half_width, room) < beyond < 1.3 * half_width


@pytest.mark.parametrize("half", [True, False])
def test_elements_shrink_towards_the_end_of_contact_from_both_sides(half):
    """
    requirement: `mesh.grading` inside the zone; beyond it they start alike and grow threefold.
    """
    mesh = cylinder(half=half).build(MeshTable(elements=8, grading=0.3), (-5e-4, 5e-4))
    x = ends(mesh, "block_face")
    h, edge = np.diff(x), int(np.argmin(np.abs(x - 5e-4)))
    inside, outside = h[edge - 4 : edge][::-1], h[edge : edge + 4]
    np.testing.assert_allclose(inside[1:] / inside[:-1], 1 / 0.3, rtol=1e-3)
    np.testing.assert_allclose(outside[0], inside[0], rtol=1e-3)
    np.testing.assert_allclose(outside[1:] / outside[:-1], 3.0, rtol=1e-3)


def test_ungraded_elements_go_on_with_the_same_size():
    """
    requirement: grading 1 means equal elements in the zone, and no jump at its end.
    """
    mesh = cylinder().build(MeshTable(elements=20, grading=1.0), (-5e-4, 5e-4))
    x = ends(mesh, "cylinder_face")
    h = np.diff(x)
    edge = int(np.argmin(np.abs(x - 5e-4)))
    np.testing.assert_allclose(h[edge - 20 : edge + 1], 5e-5, rtol=1e-6)
    assert h.max() < 5 * 5e-5


def test_bodies_may_be_divided_differently():
    """
    requirement: elements and grading of each body; the faces need not match.
    """
    division = {"block": {"elements": 14, "grading": 1.0}}
    mesh = cylinder().build(MeshTable(elements=6, grading=0.3, bodies=division), (-5e-4, 5e-4))
    for face, elements in (("cylinder_face", 6), ("block_face", 14)):
        x = ends(mesh, face)
        assert (np.abs(x) < 5e-4 + 1e-12).sum() == elements + 1


def test_nodes_of_the_arc_lie_on_the_circle():
    """
    requirement: every node of a curved edge is on the circle, not only the corners.
    """
    mesh = cylinder().build(MeshTable(elements=6), (-5e-4, 5e-4))
    for surface in ("cylinder_face", "cylinder_side"):
        p = edges(mesh, surface)
        assert p.shape[1] > 2
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1] - R), R, rtol=1e-14)
    assert np.all(edges(mesh, "cylinder_top")[..., 1] == pytest.approx(R, rel=1e-14))


def test_the_axis_is_at_zero_exactly():
    """
    requirement: symmetry, and the axis of revolution, are found by x = 0.
    """
    half = cylinder(half=True).build(MeshTable(elements=6), (-5e-4, 5e-4))
    for surface in ("cylinder_axis", "block_axis"):
        assert np.all(edges(half, surface)[..., 0] == 0.0)
    assert cylinder(half=True).symmetry == ("cylinder_axis", "block_axis")
    assert cylinder(half=True).thickness_factor == 2 * cylinder().thickness_factor
    assert cylinder().symmetry == ()
    ball = sphere().build(MeshTable(elements=6), (-5e-4, 5e-4))
    on_axis = np.abs(ball.points[:, 0]) < 1e-6
    assert on_axis.sum() > 10
    assert np.all(ball.points[on_axis, 0] == 0.0)
    assert ball.points[:, 0].min() == 0.0


def test_the_full_mesh_is_symmetric():
    """
    requirement: a symmetric zone gives a mesh that is its own mirror image.
    """
    mesh = cylinder().build(MeshTable(elements=14, grading=0.3), (-5e-4, 5e-4))
    mirrored = mesh.points * [-1.0, 1.0]
    both = [np.unique(np.round(p / 1e-10).astype(int), axis=0) for p in (mesh.points, mirrored)]
    assert np.abs(both[0] - both[1]).max() <= 1


def test_meshes_are_as_small_as_promised():
    """
    requirement: three graded elements of degree 6 in the half zone within 5000 displacements; a
    smooth mesh of degree 2 with 46 equal ones about 27000.
    """
    coarse = cylinder(half=True).build(MeshTable(elements=6, grading=0.3), (-5e-4, 5e-4))
    assert len(coarse.cells) <= 62
    assert dofs(coarse, 6) <= 5000
    fine = cylinder(half=True).build(MeshTable(elements=92, grading=1.0), (-5e-4, 5e-4))
    assert 2.2e4 < dofs(fine, 2) < 3.2e4


@pytest.mark.parametrize(
    ("geometry", "model"), [(cylinder(half=True), "plane-strain"), (cylinder(), "plane-stress")]
)
def test_the_gap_is_that_of_a_circle(geometry, model):
    """
    requirement: faces chain and pair along the common normal, which halves the angle between the
    faces of like bodies; the initial gap is exact to 1e-8 of the radius.
    """
    division = MeshTable(elements=6, grading=0.3, bodies={"block": {"elements": 10}})
    bodies = distribute(geometry.build(division, (-5e-4, 5e-4)), MPI.COMM_SELF)
    faces = [gather_face(bodies, name) for name in geometry.contact]
    pairing = pair(*faces, kinematics_of(model, geometry.thickness_factor), 8)
    first, second = (side.face.points(side.facet, side.t) for side in pairing.sides)
    x, y = first.T
    assert x.max() > 9e-4
    np.testing.assert_allclose(np.hypot(x, y - R), R, atol=1e-9 * R)
    half = np.arcsin(x / R) / 2
    normals = np.column_stack([np.sin(half), -np.cos(half)])
    gap = (R - R * np.cos(2 * half)) / np.cos(half)
    np.testing.assert_allclose(pairing.normals, normals, atol=1e-6)
    np.testing.assert_allclose(pairing.gap, gap, atol=1e-8 * R)
    np.testing.assert_allclose(second, first + gap[:, None] * normals, atol=1e-8 * R)
    np.testing.assert_allclose(pairing.points, (first + second) / 2, atol=1e-12)


def test_expected_zones_are_those_of_hertz():
    """
    requirement: half-widths of Hertz's theory for a given force, an estimate for an approach.
    """
    steel = 115.4e9
    left, right = cylinder(thickness="2 mm").expected_zone(Pressing(1000.0, None, steel))
    assert right == pytest.approx(np.sqrt(4 * 5e5 * R / (np.pi * steel)), rel=1e-12)
    assert left == -right
    assert cylinder().expected_zone(Pressing(None, 5e-5, steel))[1] == pytest.approx(5e-4, rel=0.1)
    assert sphere().expected_zone(Pressing(100.0, None, steel))[1] == pytest.approx(
        (3 * 100 * R / (4 * steel)) ** (1 / 3), rel=1e-12
    )
    assert sphere().expected_zone(Pressing(None, 1e-5, steel))[1] == pytest.approx(
        3.16e-4, rel=0.01
    )


@pytest.mark.parametrize(
    ("geometry", "outer", "key"),
    [
        (cylinder(), 5.1e-3, "geometry.radius"),
        (cylinder(block_width="8 mm"), 3.1e-3, "geometry.block_width"),
        (sphere(), 6e-3, "geometry.radius"),
    ],
)
def test_a_contact_too_large_for_the_bodies_is_refused(geometry, outer, key):
    """
    requirement: one clear line with the key's path.
    """
    with pytest.raises(CaseError) as error:
        geometry.build(MeshTable(), (-outer, outer))
    assert len(error.value.faults) == 1
    assert error.value.faults[0].startswith(f"{key}: too small for the contact")


@pytest.mark.parametrize(("geometry", "shape"), [(cylinder, (-3e-4, 3e-4)), (sphere, (0.0, 3e-4))])
def test_a_zone_that_grows_is_meshed_where_it_will_be(geometry, shape):
    """
    requirement: geometry.zone replaces the contact expected of the unworn bodies.
    """
    light = Pressing(10.0, None, 115.4e9)
    expected = geometry().expected_zone(light)[1]
    assert expected < 1e-4
    wide = geometry(zone="0.3 mm")
    assert wide.expected_zone(light) == (-3e-4, 3e-4)
    x = ends(
        wide.build(MeshTable(elements=30, grading=1.0), wide.expected_zone(light)), "block_face"
    )
    inside = x[(x > shape[0] - 1e-9) & (x < shape[1] + 1e-9)]
    np.testing.assert_allclose(np.diff(inside), 2e-5, rtol=1e-6)
    assert (inside[0], inside[-1]) == pytest.approx(shape, abs=1e-12)


@pytest.mark.parametrize("geometry", [cylinder, sphere])
def test_a_zone_smaller_than_the_contact_is_refused(geometry):
    """
    requirement: one clear line with the key's path.
    """
    small = geometry(zone="0.01 mm")
    with pytest.raises(CaseError) as error:
        small.expected_zone(Pressing(100.0, None, 115.4e9))
    assert len(error.value.faults) == 1
    said = "geometry.zone: found 1e-05 m; must be at least the expected half-width"
    assert error.value.faults[0].startswith(said)
