"""The mesh of a ball in a socket, in space."""

import math

import numpy as np
import pytest
from pydantic import ValidationError

from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.balls.ball_in_socket import BallInSocket
from thermowear.geometry.mesh.tagged import scaled_jacobians

from .test_pin_on_disk import measured

RADIUS, ANGLE, OUTSIDE, BELOW = 10e-3, math.radians(70.0), 18e-3, 5e-3
SIZES = {
    "radius": "10 mm",
    "clearance": "0.2 mm",
    "socket_angle": "70 deg",
    "socket_radius": "18 mm",
    "socket_thickness": "5 mm",
}
RISE = RADIUS * (1 - math.cos(ANGLE))
BALL = 2 / 3 * math.pi * RADIUS**3
SOCKET = math.pi * OUTSIDE**2 * (BELOW + RISE) - math.pi * RISE**2 * (RADIUS - RISE / 3)


def geometry(**changes):
    return BallInSocket(type="ball-in-socket", **(SIZES | changes))


def built(**changes):
    mesh = MeshTable(degree=2, elements=10, grading=0.7, **changes.pop("mesh", {}))
    return geometry(**changes).build(mesh)


def corners(mesh, surface):
    """Coordinates of the nodes of a surface."""
    chosen = mesh.facet_tags == mesh.surfaces.index(surface) + 1
    return mesh.points[np.unique(mesh.facets[chosen])]


@pytest.mark.parametrize("half", [False, True])
def test_bodies_have_their_volumes(half):
    """requirement: curved cells of good shape fill half a ball and a socket, or halves of them."""
    mesh = built(half=half, clearance="1 um")
    part = 0.5 if half else 1.0
    volumes = measured(mesh)
    assert volumes["ball"] == pytest.approx(part * BALL, rel=2e-3)
    assert volumes["socket"] == pytest.approx(part * SOCKET, rel=2e-3)
    assert scaled_jacobians(mesh).min() > 0.05
    tags = np.bincount(mesh.facet_tags, minlength=len(mesh.surfaces) + 1)[1:]
    assert np.all(tags > 0)


@pytest.mark.parametrize("own", [{}, {"bodies": {"socket": {"elements": 14}}}])
def test_faces_are_spheres_that_touch_at_the_origin(own):
    """requirement: both radii are exact at the nodes, and only the lowest points touch."""
    mesh = built(mesh=own)
    for surface, radius in (("ball_face", RADIUS), ("socket_face", RADIUS + 2e-4)):
        away = np.linalg.norm(corners(mesh, surface) - [0, 0, radius], axis=1)
        np.testing.assert_allclose(away, radius, rtol=1e-6)
        angle = np.arccos(1 - corners(mesh, surface)[:, 2].max() / radius)
        assert angle == pytest.approx(ANGLE, abs=0.02)
    assert np.ptp(corners(mesh, "ball_top")[:, 2]) == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(corners(mesh, "socket_bottom")[:, 2], -BELOW)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"clearance": "6 mm"}, "at most half of the radius"),
        ({"socket_radius": "9 mm"}, "greater than that of the rim"),
        ({"socket_angle": "85 deg"}, "socket_angle"),
    ],
)
def test_impossible_dimensions_are_refused(changes, message):
    """requirement: the reason is given."""
    with pytest.raises(ValidationError, match=message):
        geometry(**changes)
