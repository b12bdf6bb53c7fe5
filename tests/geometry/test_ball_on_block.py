"""The mesh of a sphere on a round block, in space."""

import math

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import Spatial
from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.pressing import Pressing
from thermowear.contact.faces.face import gather_face
from thermowear.contact.search.pairing import pair
from thermowear.errors import CaseError
from thermowear.geometry.geometries.balls.ball_on_block import BallOnBlock
from thermowear.geometry.mesh.tagged import scaled_jacobians

from .test_pin_on_disk import measured

RADIUS, ZONE = 10e-3, (-4e-4, 4e-4)
SIZES = {"radius": "10 mm", "block_radius": "12 mm", "block_height": "8 mm"}
BALL, BLOCK = 2 / 3 * math.pi * RADIUS**3, math.pi * 0.012**2 * 0.008


def ball(**changes):
    return BallOnBlock(type="ball-on-block", **(SIZES | changes))


def built(geometry, zone=ZONE, degree=2, elements=6, **keys):
    return geometry.build(MeshTable(degree=degree, elements=elements, grading=0.6, **keys), zone)


def corners(mesh, surface):
    """Coordinates of the nodes of a surface."""
    chosen = mesh.facet_tags == mesh.surfaces.index(surface) + 1
    return mesh.points[np.unique(mesh.facets[chosen])]


@pytest.mark.parametrize("half", [False, True])
def test_bodies_have_their_volumes(half):
    """requirement: curved cells of good shape fill half a ball and a block, or halves of them."""
    mesh = built(ball(half=half))
    part = 0.5 if half else 1.0
    volumes = measured(mesh)
    assert volumes["sphere"] == pytest.approx(part * BALL, rel=2e-3)
    assert volumes["block"] == pytest.approx(part * BLOCK, rel=2e-3)
    assert scaled_jacobians(mesh).min() > 0.1
    tags = np.bincount(mesh.facet_tags, minlength=len(mesh.surfaces) + 1)[1:]
    assert np.all(tags > 0)


def test_surfaces_lie_where_they_should():
    """requirement: names of faces, planes and ends."""
    mesh = built(ball(half=True))
    for surface, axis, value in (
        ("sphere_top", 2, RADIUS),
        ("block_bottom", 2, -8e-3),
        ("block_face", 2, 0.0),
        ("sphere_middle", 1, 0.0),
        ("block_middle", 1, 0.0),
    ):
        np.testing.assert_allclose(corners(mesh, surface)[:, axis], value, atol=1e-9)
    assert mesh.points[:, 1].min() > -1e-9
    face = corners(mesh, "sphere_face")
    away = np.hypot(face[:, 0], face[:, 1])
    np.testing.assert_allclose(np.hypot(away, face[:, 2] - RADIUS), RADIUS, rtol=1e-9)
    assert away.max() == pytest.approx(1.4 * ZONE[1], rel=1e-3)


def test_elements_of_the_mesh_table():
    """requirement: mesh.elements across the contact, also of each body."""
    coarse, fine = (built(ball(), elements=n) for n in (4, 8))
    own = built(ball(), elements=4, bodies={"block": {"elements": 8}})
    counts = {}
    for name, mesh in {"coarse": coarse, "fine": fine, "own": own}.items():
        tags = [mesh.surfaces.index(f"{body}_face") + 1 for body in ("sphere", "block")]
        counts[name] = [int((mesh.facet_tags == tag).sum()) for tag in tags]
    assert counts["coarse"][0] == counts["coarse"][1]
    assert counts["own"][0] < 0.5 * counts["own"][1]
    assert counts["fine"][0] > 2.5 * counts["coarse"][0]


def test_faces_are_opposite_each_other():
    """requirement: gap of a sphere over a flat at all contact points."""
    bodies = distribute(built(ball()) if MPI.COMM_WORLD.rank == 0 else None, MPI.COMM_WORLD)
    faces = (gather_face(bodies, f"{body}_face") for body in ("sphere", "block"))
    pairing = pair(*faces, Spatial(), order=3)
    r = np.hypot(pairing.points[:, 0], pairing.points[:, 1])
    assert pairing.gap == pytest.approx(
        r**2 / (2 * RADIUS), abs=2e-3 * (1.4 * ZONE[1]) ** 2 / RADIUS
    )
    assert pairing.unpaired < 1e-2


def test_expected_contact():
    """requirement: Hertz's radius, of the whole sphere under twice the force on a half."""
    whole, half = Pressing(20.0, None, 1.1e11), Pressing(10.0, None, 1.1e11)
    a = (3 * 20.0 * RADIUS / (4 * 1.1e11)) ** (1 / 3)
    assert ball().expected_zone(whole) == pytest.approx((-a, a))
    assert ball(half=True).expected_zone(half) == pytest.approx((-a, a))
    assert ball(zone="0.3 mm").expected_zone(whole) == pytest.approx((-3e-4, 3e-4))
    with pytest.raises(CaseError, match=r"geometry\.zone: found 5e-05 m; must be at least"):
        ball(zone="0.05 mm").expected_zone(whole)
    for zone in ((-1e-7, 1e-7), (-5e-3, 5e-3)):
        with pytest.raises(CaseError, match=r"geometry\.radius: the contact is expected"):
            built(ball(), zone)
