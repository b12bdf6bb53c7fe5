"""The common face of bodies of unlike stiffness, and closed faces that are opened."""

import numpy as np
import pytest

from thermowear.contact.faces.face import Face, _opened
from thermowear.contact.search.common_face import opposite

RADIUS = 0.1
FACETS = 24
NARROW = np.radians(12.0)


def arc(begin, end, body_inside, softness=1.0, radius=RADIUS, middle=(0.0, RADIUS), facets=FACETS):
    """Quadratic facets of a circle between two angles from its lowest point, cubic in accuracy."""
    ends = np.linspace(begin, end, facets + 1)
    angles = np.linspace(ends[:-1], ends[1:], 3, axis=1)
    nodes = np.stack([np.sin(angles), -np.cos(angles)], axis=-1) * radius + middle
    onward = 1.0 if end > begin else -1.0  # counter-clockwise: outward is right of the chain
    count = np.arange(facets)
    nobody = np.zeros(facets, dtype=int)
    outward = np.full(facets, onward if body_inside else -onward)
    soft = np.full(facets, softness)
    return Face(nodes, outward, nobody, count, nobody, np.zeros(facets, dtype=bool), softness=soft)


def flat(softness):
    """The line y = 0, its body below it."""
    ends = np.linspace(-0.05, 0.05, 11)
    nodes = np.zeros((10, 2, 2))
    nodes[:, :, 0] = np.column_stack([ends[:-1], ends[1:]])
    nobody = np.zeros(10, dtype=int)
    straight = np.zeros(10, dtype=bool)
    return Face(
        nodes, -np.ones(10), nobody, np.arange(10), nobody, straight, softness=np.full(10, softness)
    )


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.8, 1.0])
def test_the_common_face_is_that_of_the_stiffer_body(share):
    """requirement: n ∝ s_2 n_1 - s_1 n_2, and the gap along it between points that lie along
    n_1 - n_2, by hand for a cylinder on a flat.

    With the share 0 the cylinder is rigid, with the share 1 the flat.
    """
    cylinder = arc(-NARROW, NARROW, body_inside=True, softness=share)
    at, t = np.array([0, 5, 12, 23]), np.array([0.2, 0.7, 0.4, 0.9])
    found = opposite(cylinder, at, t, flat(1.0 - share))
    x, y = cylinder.points(at, t).T
    angle = np.arctan2(x, RADIUS - y)
    out = np.column_stack([np.sin(angle), -np.cos(angle)])
    normal = (1 - share) * out - share * np.array([0.0, 1.0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    np.testing.assert_allclose(found.share, share, atol=1e-14)
    np.testing.assert_allclose(found.normals, normal, atol=1e-6)
    between = out - np.array([0.0, 1.0])
    gap = -y / between[:, 1] * np.einsum("ni,ni->n", between, normal)
    np.testing.assert_allclose(found.gap, gap, rtol=1e-5, atol=1e-15)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.7])
def test_the_way_back_leads_to_the_same_points(share):
    """requirement: exchanging the bodies turns the normal round and changes nothing else."""
    one = arc(-NARROW, NARROW, body_inside=True, softness=share)
    other = arc(
        -NARROW,
        NARROW,
        body_inside=False,
        softness=1.0 - share,
        radius=1.5 * RADIUS,
        middle=(0.0, 1.5 * RADIUS),
    )
    at, t = np.array([7, 10, 13, 17]), np.array([0.1, 0.5, 0.8, 0.3])
    there = opposite(one, at, t, other)
    back = opposite(other, there.facet, there.t, one)
    np.testing.assert_allclose(
        one.points(back.facet, back.t), one.points(at, t), atol=1e-12 * RADIUS
    )
    np.testing.assert_allclose(back.normals, -there.normals, atol=1e-12)
    np.testing.assert_allclose(back.gap, there.gap, atol=1e-13 * RADIUS)


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("start", [0.0, 1.0, 2.5])
def test_a_closed_face_begins_far_from_the_other_one(clockwise, start):
    """requirement: whatever the order of a whole pin's facets, they run from its top past its
    bottom, normals outward, each facet with the cell behind it."""
    turn = -2 * np.pi if clockwise else 2 * np.pi
    pin = arc(start, start + turn, body_inside=True)
    pin.nodes[-1, -1] = pin.nodes[0, 0]
    bush = arc(-NARROW, NARROW, body_inside=False, radius=1.1 * RADIUS, middle=(0.0, 1.1 * RADIUS))
    face = _opened(pin, bush)
    every, middle = np.arange(FACETS), np.full(FACETS, 0.5)
    assert face.nodes[0, 0, 1] > 1.95 * RADIUS
    np.testing.assert_array_equal(face.nodes[1:, 0], face.nodes[:-1, -1])
    lowest = face.nodes[:, 1, 1].argmin()
    assert face.nodes[lowest, -1, 0] > face.nodes[lowest, 0, 0]
    out = face.points(every, middle) - [0.0, RADIUS]
    np.testing.assert_allclose(face.normals(every, middle), out / RADIUS, atol=1e-3)
    np.testing.assert_array_equal(
        face.points(every, middle), pin.points(face.cell, np.full(FACETS, 0.5))
    )
    np.testing.assert_array_equal(face.reversed, clockwise)
