"""Nodes of worn faces, moved by the depth at the contact points."""

from dataclasses import replace

import numpy as np
import pytest

from thermowear.bulk.kinematics import Axisymmetric, Spatial
from thermowear.contact.faces.face import Face
from thermowear.contact.search.pairing import pair, paired
from thermowear.contact.wear.worn_face import Paths, WornFace, curvatures, node_normals, nodes_of

from .solids import bent, gathered, straight, turned, two_solids

RADIUS = 0.1
MIDDLE = np.array((0.02, 0.015, RADIUS))


def domed(p):
    """Boxes that meet on a sphere, its centre above them."""
    x, y, z = np.moveaxis(p, -1, 0)
    height = RADIUS - np.sqrt(RADIUS**2 - (x - 0.02) ** 2 - (y - 0.015) ** 2)
    return np.stack([x, y, z + height], axis=-1)


def of_boxes(order=2, divisions=((3, 3, 2), (4, 3, 2)), maps=(straight, straight)):
    _, faces = gathered(two_solids(divisions, order, maps))
    return pair(*faces, Spatial(), 4)


def of_body_1(pairing, held=None):
    normals = node_normals(pairing.sides[0].face)
    none = np.zeros(len(normals), dtype=bool)
    return WornFace(pairing, 0, Paths(normals, none if held is None else held)), normals


@pytest.mark.parametrize("order", [1, 2, 3])
def test_nodes_of_a_surface_take_up_what_they_can(order):
    """A polynomial of their order, whichever way the facets run."""
    pairing = of_boxes(order, maps=(turned, turned))
    face, _ = of_body_1(pairing)
    nodes = nodes_of(pairing.sides[0].face)

    def depth(p):
        return (
            1e-5 * (2 + np.cos(20 * p[:, 0]) * p[:, 1] / 0.1)
            if order == 3
            else 1e-5 * np.ones(len(p))
        )

    amounts = face.offsets(depth(pairing.points))
    near = 1e-3 if order == 3 else 1e-7
    assert amounts == pytest.approx(depth(nodes), rel=near)
    assert face.depths(amounts) == pytest.approx(depth(pairing.points), rel=near)


def test_a_surface_loses_the_volume_even_where_its_nodes_cannot_follow():
    pairing = of_boxes(1)
    nodes = nodes_of(pairing.sides[0].face)
    face, _ = of_body_1(pairing, held=nodes[:, 0] < 1e-9)
    depth = 1e-5 * (1 + np.sin(300 * pairing.points[:, 0]))
    amounts = face.offsets(depth)
    assert np.all(amounts[nodes[:, 0] < 1e-9] == 0.0)
    volume = pairing.weights @ depth
    assert pairing.weights @ face.depths(amounts) == pytest.approx(volume, rel=1e-12)


def test_a_curved_surface_goes_along_its_normals():
    """Half a millimetre off a ball and its socket: a smaller ball and a larger socket are left."""
    depth, order = 5e-4, 3
    pairing = of_boxes(order, ((4, 3, 2), (4, 3, 2)), (domed, domed))
    surface = pairing.sides[0].face
    assert curvatures(surface) == pytest.approx(1 / RADIUS, rel=2e-3)
    face, normals = of_body_1(pairing)
    out = nodes_of(surface) - MIDDLE
    radius = np.linalg.norm(out, axis=1)
    assert radius == pytest.approx(RADIUS, rel=1e-12)
    assert normals == pytest.approx(out / RADIUS, abs=1e-3)
    assert normals[:, 2].max() < 0.0
    to = nodes_of(surface) + face.displacement(face.offsets(np.full(len(pairing.weights), depth)))
    assert np.linalg.norm(to - MIDDLE, axis=1) == pytest.approx(RADIUS - depth, abs=1e-3 * depth)
    below = pairing.sides[1].face
    paths = Paths(node_normals(below), np.zeros(len(nodes_of(below)), dtype=bool))
    socket = WornFace(pairing, 1, paths)
    to = nodes_of(below) + socket.displacement(socket.offsets(np.full(len(pairing.weights), depth)))
    assert np.linalg.norm(to - MIDDLE, axis=1) == pytest.approx(RADIUS + depth, abs=1e-3 * depth)


def test_nodes_that_are_hardly_seen_go_with_their_neighbours():
    """The other face ends slightly beyond a row of facets."""
    _, (upper, lower) = gathered(two_solids(((4, 3, 2), (1, 1, 1))))
    short = lower.nodes * (0.7501, 1, 1)
    pairing = pair(upper, replace(lower, nodes=short), Spatial(), 4)
    face, _ = of_body_1(pairing)
    rough = np.random.default_rng(1).normal(size=len(pairing.weights))
    amounts = face.offsets(1e-5 * (1 + 1e-3 * rough))
    assert amounts == pytest.approx(1e-5, rel=0.02)


@pytest.fixture
def at_an_axis():
    """A disk of one facet of order 3."""
    x = np.linspace(0.0, 0.01, 4)
    where = {"rank": [0], "cell": [0], "local_facet": [0], "reversed": [False]}
    where = {key: np.array(value) for key, value in where.items()}
    nodes = np.column_stack([x, 0 * x])[None]
    upper = Face(nodes=nodes, outward=np.array([1.0]), **where)
    assert upper.normals(np.array([0]), np.array([0.5]))[0] == pytest.approx((0.0, -1.0))
    lower = Face(nodes=nodes, outward=np.array([-1.0]), **where)
    return pair(upper, lower, Axisymmetric(), 8)


def test_a_node_at_an_axis_is_one_of_them(at_an_axis):
    """Though no area belongs to it."""
    face, _ = of_body_1(at_an_axis)
    depth = 1e-5 * (1 - (at_an_axis.points[:, 0] / 0.01) ** 2)
    assert face.depths(face.offsets(depth)) == pytest.approx(depth, abs=1e-9)


def test_worn_faces_are_paired_at_the_same_points():
    """Points do not wander on their facets, nor do slivers appear, when faces are not opposite."""
    _, (upper, lower) = gathered(two_solids(((3, 3, 2), (4, 2, 2)), 2, (bent, bent)))
    before = pair(upper, lower, Spatial(), 4)
    worn = replace(upper, nodes=upper.nodes + (1e-4, 0, 0) + 1e-2 * upper.nodes[..., [2, 2, 0]])
    after = paired(worn, lower, Spatial(), before.pieces)
    assert np.array_equal(after.sides[0].facet, before.sides[0].facet)
    assert np.array_equal(after.sides[0].t, before.sides[0].t)
    assert after.weights.sum() == pytest.approx(worn.sizes.sum(), rel=1e-4)
    assert after.gap == pytest.approx(before.gap + 1e-2 * before.points[:, 0], abs=1e-5)
