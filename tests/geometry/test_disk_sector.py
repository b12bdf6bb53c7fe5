"""The mesh of a brake pad on a disk, in space."""

import math

from mpi4py import MPI

import numpy as np
import pytest
import ufl
from dolfinx import fem

from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import Spatial
from thermowear.case.tables.mesh import MeshTable
from thermowear.contact.faces.face import gather_face
from thermowear.contact.search.pairing import pair
from thermowear.geometry.geometries.brakes.disk_brake import DiskSector
from thermowear.parallel import sum_over_ranks

from ..simulation.space import BRAKE
from .measure import edges
from .sound import fault

COMM = MPI.COMM_WORLD
FACE = math.pi / 6 * (0.12**2 - 0.08**2)


def brake(**changes):
    return DiskSector(**BRAKE["geometry"] | changes)


def built(degree, **keys):
    return brake().build(MeshTable(degree=degree, elements=6, grading=0.5, **keys))


@pytest.mark.parametrize(("degree", "order", "allowed"), [(1, 1, 5e-2), (2, 2, 2e-4), (5, 3, 3e-5)])
def test_bodies_and_surfaces(degree, order, allowed):
    """requirement: curved cells of the displacement's degree, 3 at most; half a disk all round."""
    mesh = built(degree)
    assert mesh.order == order
    bodies = distribute(mesh if COMM.rank == 0 else None, COMM)
    volumes = {"pad": FACE * 0.015, "disk": math.pi * (0.13**2 - 0.06**2) * 0.01}
    for body, (name, expected) in zip(bodies.each, volumes.items(), strict=True):
        assert body.parts == (name,)
        volume = fem.Constant(body.mesh, 1.0) * ufl.dx
        found = sum_over_ranks(COMM, fem.assemble_scalar(fem.form(volume)))
        assert found == pytest.approx(expected, rel=allowed)
    radii = {"pad_inside": 0.08, "pad_outside": 0.12, "disk_inside": 0.06, "disk_outside": 0.13}
    for surface, radius in radii.items():
        p = edges(mesh, surface)
        np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1]), radius, rtol=1e-12)
    heights = {
        "pad_face": 0,
        "pad_back": 0.015,
        "disk_face": 0,
        "disk_rest": 0,
        "disk_middle": -0.01,
    }
    for surface, z in heights.items():
        np.testing.assert_allclose(edges(mesh, surface)[..., 2], z, atol=1e-15)
    ends = edges(mesh, "pad_ends")
    angles = np.degrees(np.abs(np.arctan2(ends[..., 1], ends[..., 0])))
    np.testing.assert_allclose(angles, 30.0, atol=1e-9)
    facets = np.sort(mesh.facets[:, :4], axis=1)
    assert len(np.unique(facets, axis=0)) == len(facets)
    assert len(edges(mesh, "disk_outside")) * 2 < len(edges(mesh, "disk_middle"))


@pytest.mark.parametrize("keys", [{}, {"bodies": {"disk": {"elements": 4}}}])
def test_the_pad_is_all_on_the_disk(keys):
    """requirement: the face of the disk is what lies under the pad, matching or not."""
    mesh = built(3, **keys)
    bodies = distribute(mesh if COMM.rank == 0 else None, COMM)
    faces = (gather_face(bodies, "pad_face"), gather_face(bodies, "disk_face"))
    pairing = pair(*faces, Spatial(), 5)
    assert pairing.weights.sum() == pytest.approx(FACE, rel=1e-4)
    assert pairing.unpaired < (1e-4 if keys else 1e-12)
    middle = pairing.weights @ pairing.points / pairing.weights.sum()
    np.testing.assert_allclose(middle, brake().pivot_point, atol=1e-5)


@pytest.mark.parametrize("wide", [("inner",), ("outer",), ("inner", "outer")])
def test_a_pad_as_wide_as_the_disk(wide):
    """requirement: edges shared on either side or both; matching faces, and no empty surface."""
    radii = {"inner": "8 cm", "outer": "0.12 m"}
    geometry = brake(**{f"disk_{side}_radius": radii[side] for side in wide})
    mesh = geometry.build(MeshTable(degree=2, elements=6, grading=0.3))
    counts = dict(zip(mesh.surfaces, np.bincount(mesh.facet_tags)[1:], strict=True))
    assert counts["disk_face"] == counts["pad_face"] == 12
    assert min(counts.values()) > 0
    for surface, radius in {"disk_inside": 0.08, "disk_outside": 0.12}.items():
        if surface[5:-4] + "er" in wide:
            p = edges(mesh, surface)
            np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1]), radius, rtol=1e-12)


def test_the_geometry_says_how_it_moves():
    geometry = brake()
    assert geometry.press_direction == (0.0, 0.0, -1.0)
    assert geometry.rotation_center == (0.0, 0.0)
    assert geometry.contact_area() == pytest.approx(FACE)
    half = geometry.pad_angle / 2
    centroid = 2 / 3 * math.sin(half) / half * (0.12**3 - 0.08**3) / (0.12**2 - 0.08**2)
    assert geometry.pivot_point == pytest.approx((centroid, 0.0, 0.0))


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"pad_inner_radius": "120 mm"}, "pad_inner_radius"),
        ({"pad_outer_radius": "131 mm"}, "pad_outer_radius"),
        ({"disk_inner_radius": "81 mm"}, "disk_inner_radius"),
        ({"pad_angle": "301 deg"}, "pad_angle"),
        ({"pad_angle": "-10 deg"}, "pad_angle"),
    ],
)
def test_sizes_that_do_not_fit_are_refused(changes, key):
    assert fault(brake, **changes)[0] == key


@pytest.mark.parametrize(
    ("hub", "fixed", "mid_plane"),
    [(False, "disk_middle", ()), (True, "disk_inside", ("disk_middle",))],
)
def test_supports(hub, fixed, mid_plane):
    """requirement: the middle plane is clamped, or a plane of symmetry of a disk on a hub."""
    assert (brake(hub=hub).fixed, brake(hub=hub).mid_plane) == (fixed, mid_plane)
