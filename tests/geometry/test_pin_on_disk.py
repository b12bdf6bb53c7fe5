"""The mesh of a pin on a disk, in space."""

import math

from mpi4py import MPI

import numpy as np
import pytest
import ufl
from dolfinx import fem

from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import Spatial
from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.pressing import Pressing
from thermowear.contact.faces.face import gather_face
from thermowear.contact.search.pairing import pair
from thermowear.errors import CaseError
from thermowear.geometry.geometries.pin_on_disk import PinOnDisk
from thermowear.geometry.mesh.tagged import scaled_jacobians
from thermowear.parallel import sum_over_ranks

from .measure import edges
from .sound import fault

COMM = MPI.COMM_WORLD
SIZES = {
    "pin_radius": "3 mm",
    "pin_height": "8 mm",
    "track_radius": "20 mm",
    "disk_inner_radius": "8 mm",
    "disk_outer_radius": "30 mm",
    "disk_thickness": "6 mm",
}
BALL = {"end": "spherical", "end_radius": "3 mm"}
DISK = math.pi * (0.03**2 - 0.008**2) * 0.006
ZONE = (0.02 - 4e-4, 0.02 + 4e-4)


def pin(**changes):
    return PinOnDisk(type="pin-on-disk", **(SIZES | changes))


def built(geometry, zone=None, degree=2, elements=6, **keys):
    return geometry.build(MeshTable(degree=degree, elements=elements, grading=0.6, **keys), zone)


def measured(mesh):
    """Volume of each body [m³]."""
    bodies = distribute(mesh if COMM.rank == 0 else None, COMM)
    volumes = {
        name: fem.form(body.per_part({name: 1.0}) * ufl.dx)
        for body in bodies.each
        for name in body.parts
    }
    return {name: sum_over_ranks(COMM, fem.assemble_scalar(form)) for name, form in volumes.items()}


def rounded(radius, height):
    """Volume of a pin of radius 3 mm and a height, less what a spherical end lacks [m³]."""
    top = radius - math.sqrt(radius**2 - 0.003**2)
    cap = math.pi * top**2 * (radius - top / 3)
    return cap + math.pi * 0.003**2 * (height - top)


@pytest.mark.parametrize(("degree", "order", "allowed"), [(1, 1, 3e-2), (2, 2, 2e-4), (3, 2, 2e-4)])
def test_flat_end(degree, order, allowed):
    """requirement: bodies of tetrahedra of known volumes; surfaces lie where they should."""
    mesh = built(pin(), degree=degree)
    assert (mesh.cell_type, mesh.order) == ("tetrahedron", order)
    found = measured(mesh)
    assert found["pin"] == pytest.approx(math.pi * 0.003**2 * 0.008, rel=allowed)
    assert found["disk"] == pytest.approx(DISK, rel=allowed)
    assert scaled_jacobians(mesh).min() > 0.05
    heights = {"pin_face": 0, "pin_top": 8e-3, "disk_face": 0, "disk_rest": 0, "disk_bottom": -6e-3}
    for surface, z in heights.items():
        np.testing.assert_allclose(edges(mesh, surface)[..., 2], z, atol=1e-12)
    for surface, radius in {"disk_inside": 0.008, "disk_outside": 0.03}.items():
        p = edges(mesh, surface)
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1]), radius, rtol=1e-7)
    side = edges(mesh, "pin_side")
    away = np.hypot(side[..., 0] - 0.02, side[..., 1])
    np.testing.assert_allclose(away, 0.003, rtol=1e-7)
    facets = np.sort(mesh.facets[:, :3], axis=1)
    assert len(np.unique(facets, axis=0)) == len(facets)


@pytest.mark.parametrize("radius", [3e-3, 4e-3, 10e-3])
def test_spherical_end(radius):
    """requirement: the nodes of the face lie on the sphere, whose volume is that of a cap."""
    mesh = built(pin(end="spherical", end_radius=f"{radius} m"), ZONE)
    face = edges(mesh, "pin_face")
    off = np.linalg.norm(face - np.array([0.02, 0.0, radius]), axis=-1) - radius
    assert np.abs(off).max() < 1e-12
    away = np.hypot(face[..., 0] - 0.02, face[..., 1])
    assert away.max() == pytest.approx(1.4 * 4e-4, rel=1e-6)
    found = measured(mesh)
    assert found["pin"] == pytest.approx(rounded(radius, 0.008), rel=2e-3)
    assert found["disk"] == pytest.approx(DISK, rel=2e-4)
    assert scaled_jacobians(mesh).min() > 0.05
    near, size = edges(mesh, "disk_face"), np.ptp(away, axis=1).max()
    assert size < 3 * 8e-4 / 6
    assert near[..., 2].max() < 1e-12


def test_both_faces_have_the_same_triangles():
    """requirement: matching faces; for unequal numbers of elements the pairing fills the face."""
    mesh = built(pin())
    first, second = (edges(mesh, surface).mean(axis=1) for surface in ("pin_face", "disk_face"))
    np.testing.assert_allclose(
        first[np.lexsort(np.round(first, 9).T)],
        second[np.lexsort(np.round(second, 9).T)],
        atol=1e-9,
    )
    other = built(pin(), bodies={"disk": {"elements": 5}})
    assert len(edges(other, "disk_face")) < len(edges(other, "pin_face"))
    bodies = distribute(other if COMM.rank == 0 else None, COMM)
    faces = gather_face(bodies, "pin_face"), gather_face(bodies, "disk_face")
    pairing = pair(*faces, Spatial(), 4)
    assert pairing.weights.sum() == pytest.approx(math.pi * 0.003**2, rel=1e-3)
    middle = pairing.weights @ pairing.points / pairing.weights.sum()
    np.testing.assert_allclose(middle, pin().pivot_point, atol=1e-5)


def test_zone_of_a_ball():
    """requirement: radius of Hertz for a force; `zone` may be larger, but not smaller."""
    modulus, force, radius = 115e9, 10.0, 3e-3
    hertz = (3 * force * radius / (4 * modulus)) ** (1 / 3)
    first, last = pin(**BALL).expected_zone(Pressing(force, None, modulus))
    assert (last - first) / 2 == pytest.approx(hertz, rel=1e-9)
    assert (last + first) / 2 == pytest.approx(0.02)
    assert pin().expected_zone(Pressing(force, None, modulus)) is None
    wide = pin(**BALL, zone="0.2 mm").expected_zone(Pressing(force, None, modulus))
    assert wide == pytest.approx((0.0198, 0.0202))
    with pytest.raises(CaseError, match=r"geometry\.zone: .* at least"):
        pin(**BALL, zone="0.02 mm").expected_zone(Pressing(force, None, modulus))
    with pytest.raises(CaseError, match="it can be meshed from"):
        pin(**BALL).check_zone((0.018, 0.022))


def test_too_many_cells_are_counted_first():
    with pytest.raises(CaseError, match="cells in one body"):
        built(pin(), elements=400)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"end_radius": "3 mm"}, "end_radius"),
        ({"zone": "1 mm"}, "zone"),
        ({"end": "spherical"}, "end_radius"),
        ({"end": "spherical", "end_radius": "2 mm"}, "end_radius"),
        (BALL | {"pin_height": "3.1 mm"}, "pin_height"),
        ({"track_radius": "27 mm"}, "track_radius"),
        ({"track_radius": "11 mm"}, "track_radius"),
    ],
)
def test_sizes_that_do_not_fit_are_refused(changes, key):
    assert fault(pin, **changes)[0] == key
