"""Brake pad with back plate on a disk with hat: sizes, surfaces, and rows of cells."""

import math

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.heat.advection import Passage
from thermowear.bulk.heat.paths import EvenPaths
from thermowear.bulk.kinematics import Spatial
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.case.tables.mesh import MeshTable
from thermowear.contact.faces.face import gather_face
from thermowear.contact.search.pairing import pair
from thermowear.errors import CaseError
from thermowear.geometry.geometries.brakes.disk_brake_3d import DiskBrakeInSpace
from thermowear.geometry.geometries.brakes.pad_outline import PadOutline
from thermowear.geometry.mesh.tagged import scaled_jacobians

from .measure import edges
from .sound import fault
from .test_pin_on_disk import measured

COMM = MPI.COMM_WORLD
SIZES = {
    "pad_inner_radius": "80 mm",
    "pad_outer_radius": "125 mm",
    "pad_angle": "56 deg",
    "pad_corner_radius": "8 mm",
    "pad_thickness": "11 mm",
    "plate_thickness": "5 mm",
    "piston_radius": "16 mm",
    "disk_outer_radius": "130 mm",
    "disk_thickness": "12 mm",
    "hat_radius": "72 mm",
    "hat_height": "32 mm",
    "hat_thickness": "6 mm",
    "bore_radius": "32 mm",
    "hub_radius": "54 mm",
}
CHAMFER = {"chamfer_length": "10 mm", "chamfer_depth": "4 mm"}
SHARP = math.radians(56) / 2 * (0.125**2 - 0.08**2)


def brake(**changes):
    return DiskBrakeInSpace(type="disk-brake-3d", **(SIZES | changes))


def built(geometry, degree=2, elements=8, **keys):
    return geometry.build(MeshTable(degree=degree, elements=elements, grading=0.7, **keys))


def ring(outer, inner, height):
    return math.pi * (outer**2 - inner**2) * height


def test_area_of_the_outline():
    """requirement: the area within the curve of the outline, by Green's theorem."""
    inner, outer, c, a = 0.08, 0.125, 0.008, math.radians(28)

    def arc(x, y, radius, start, end):
        """``∮ (x dy - y dx) / 2`` along an arc."""
        turn = x * (math.sin(end) - math.sin(start)) - y * (math.cos(end) - math.cos(start))
        return radius / 2 * turn + radius**2 / 2 * (end - start)

    def corner(center, off, start, end):
        angle = a - off
        return arc(center * math.cos(angle), center * math.sin(angle), c, start, end)

    low, high = math.asin(c / (inner + c)), math.asin(c / (outer - c))
    area = arc(0, 0, outer, 0, a - high) + corner(outer - c, high, a - high, a + math.pi / 2)
    area += corner(inner + c, low, a + math.pi / 2, a - low + math.pi)
    area -= arc(0, 0, inner, 0, a - low)
    assert brake().outline.area == pytest.approx(2 * area, rel=1e-6)
    assert brake(pad_corner_radius="1e-3 mm").outline.area == pytest.approx(SHARP, rel=1e-6)
    assert PadOutline(inner, outer, a).area == pytest.approx(SHARP, rel=1e-9)


@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize(("degree", "allowed"), [(1, 2e-2), (2, 1e-4)])
def test_volumes_and_surfaces(half, degree, allowed):
    """requirement: bodies of known volumes; surfaces lie where they should, once each."""
    geometry = brake(half=half)
    mesh, area = built(geometry, degree), geometry.outline.area
    assert (mesh.cell_type, mesh.order) == ("tetrahedron", degree)
    found, depth = measured(mesh), 0.006 if half else 0.012
    assert found["lining"] == pytest.approx(area * 0.011, rel=5 * allowed)
    assert found["pad"] == pytest.approx(area * 0.005, rel=5 * allowed)
    disk = ring(0.13, 0.066, depth) + ring(0.072, 0.066, 0.032) + ring(0.066, 0.032, 0.006)
    assert found["disk"] == pytest.approx(disk, rel=allowed)
    assert scaled_jacobians(mesh).min() > 2e-3
    heights = {"pad_face": 0, "pad_piston": 0.016, "pad_back": 0.016, "disk_face": 0}
    heights |= {"disk_rest": 0, "disk_hub": 0.026}
    far = ("disk_middle",) if half else ("disk_opposite", "disk_back")
    for surface, z in (heights | dict.fromkeys(far, -depth)).items():
        np.testing.assert_allclose(edges(mesh, surface)[..., 2], z, atol=1e-9)
    for surface, radius in {"disk_inside": 0.066, "disk_outside": 0.13}.items():
        p = edges(mesh, surface)
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1]), radius, rtol=1e-9)
    piston, hub = edges(mesh, "pad_piston"), edges(mesh, "disk_hub")
    assert np.hypot(piston[..., 0] - 0.1025, piston[..., 1]).max() == pytest.approx(0.016)
    assert np.hypot(hub[..., 0], hub[..., 1]).max() == pytest.approx(0.054)
    facets = np.sort(mesh.facets[:, :3], axis=1)
    assert len(np.unique(facets, axis=0)) == len(facets)
    assert (geometry.fixed, geometry.mid_plane) == ("disk_hub", ("disk_middle",) if half else ())
    assert {geometry.fixed, *geometry.mid_plane} <= set(mesh.surfaces)
    assert set(mesh.facet_tags) == set(range(1, len(mesh.surfaces) + 1))


@pytest.mark.parametrize("keys", [{}, CHAMFER, {"pad_corner_radius": None}])
@pytest.mark.parametrize("elements", [{}, {"disk": {"elements": 6}}, {"pad": {"elements": 5}}])
def test_the_pad_is_all_on_the_disk(keys, elements):
    """requirement: the flat face of the pad, of known area and centroid, meets the disk."""
    geometry = brake(**keys)
    mesh = built(geometry, bodies=elements)
    bodies = distribute(mesh if COMM.rank == 0 else None, COMM)
    faces = gather_face(bodies, "pad_face"), gather_face(bodies, "disk_face")
    pairing = pair(*faces, Spatial(), 4)
    outline = geometry.outline
    assert pairing.weights.sum() == pytest.approx(outline.area, rel=5e-4)
    assert pairing.unpaired < 2e-4
    middle = pairing.weights @ pairing.points / pairing.weights.sum()
    np.testing.assert_allclose(middle, geometry.pivot_point, atol=2e-5)


def test_duty_by_radius():
    """requirement: rings of the disk under the pad, times the duty factor, are its face."""
    geometry = brake(**CHAMFER)
    radii, duty = map(np.array, geometry.duty_by_radius)
    area = np.trapezoid(2 * np.pi * radii * duty, radii)
    assert area == pytest.approx(geometry.outline.area, rel=1e-4)
    assert duty.min() > 0
    plain = brake(pad_corner_radius=None)
    np.testing.assert_allclose(plain.duty_by_radius[1], 28 / 180, rtol=1e-12)


@pytest.mark.parametrize("degree", [1, 2])
def test_cells_of_the_disk_are_in_rows(degree):
    """requirement: nodes lie on circles, as a uniform temperature round the axis needs them."""
    mesh = built(brake(), degree)
    bodies = distribute(mesh if COMM.rank == 0 else None, COMM)
    passage = Passage(("disk",), (0.0, 0.0), 1.0, spread=True)
    paths = EvenPaths(bodies, lagrange_spaces(bodies, degree), passage)
    assert paths is not None
    points = mesh.points[np.unique(mesh.cells[mesh.cell_tags == 2])]
    places = np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
    circles = np.unique(np.round(places, 9), axis=0)
    assert len(points) > 20 * len(circles)


def test_too_many_cells_are_counted_first():
    with pytest.raises(CaseError, match="cells in one body"):
        built(brake(), elements=600)
    with pytest.raises(CaseError, match="cells in one body"):
        built(brake(), elements=8, bodies={"disk": {"elements": 600}})


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"pad_inner_radius": "130 mm"}, "pad_inner_radius"),
        ({"disk_outer_radius": "125 mm"}, "pad_outer_radius"),
        ({"hat_radius": "80 mm"}, "hat_radius"),
        ({"hub_radius": "67 mm"}, "hub_radius"),
        ({"bore_radius": "54 mm"}, "bore_radius"),
        ({"hat_height": "6 mm"}, "hat_height"),
        ({"pad_angle": "0 deg"}, "pad_angle"),
        ({"pad_angle": "170 deg"}, "pad_angle"),
        ({"pad_corner_radius": "23 mm"}, "pad_corner_radius"),
        ({"pad_angle": "8 deg", "piston_radius": "5 mm"}, "pad_corner_radius"),
        ({"piston_radius": "23 mm"}, "piston_radius"),
        ({"chamfer_length": "10 mm"}, "chamfer_depth"),
        (CHAMFER | {"chamfer_depth": "11 mm"}, "chamfer_depth"),
        (CHAMFER | {"chamfer_length": "5 mm"}, "chamfer_length"),
        (CHAMFER | {"chamfer_length": "40 mm"}, "chamfer_length"),
    ],
)
def test_sizes_that_do_not_fit_are_refused(changes, key):
    assert fault(brake, **changes)[0] == key
