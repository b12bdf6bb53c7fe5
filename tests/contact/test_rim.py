"""Rim of a contact face: sharp edges, and those beyond which the surface of the body goes on."""

import numpy as np
import pytest

from thermowear.contact.faces.rim import edges_of, near_chosen, on_edges

from ..test_parallel import same_on_two_ranks
from .rim_on_ranks import BORDER, found
from .solids import SIZE


def length(face, edges):
    """Total length of some edges of the facets of a face."""
    first, last = np.moveaxis(face.corner_points[:, edges_of(face.kind)], 2, 0)
    return np.linalg.norm(last - first, axis=2)[edges].sum()


@pytest.mark.parametrize("cell_type", ["hexahedron", "tetrahedron"])
@pytest.mark.parametrize("order", [1, 2])
def test_face_that_ends_in_a_plane(cell_type, order):
    """requirement: the border in the plane is open, the other sides of the half face are sharp."""
    face, sharp, goes_on = found(cell_type, order, 0.0)
    assert length(face, goes_on) == pytest.approx(SIZE[1], rel=1e-12)
    assert length(face, sharp) == pytest.approx(2 * BORDER + SIZE[1], rel=1e-12)
    middles = face.corner_points[:, edges_of(face.kind)].mean(axis=2)
    np.testing.assert_allclose(middles[goes_on][:, 0], BORDER, rtol=1e-12)


@pytest.mark.parametrize(("degrees", "smooth"), [(8.0, True), (17.0, False), (-8.0, True)])
def test_kinks(degrees, smooth):
    """requirement: a chamfer of 17° ends a face, a kink of 8° does not, up or down."""
    face, sharp, goes_on = found("hexahedron", 1, degrees)
    assert length(face, goes_on) == pytest.approx(smooth * SIZE[1], rel=1e-12)
    assert length(face, sharp) == pytest.approx(2 * BORDER + (2 - smooth) * SIZE[1], rel=1e-12)


def test_a_surface_in_contact_does_not_go_on():
    """requirement: where another contact or a joint begins, contact does not end unseen."""
    face, sharp, goes_on = found("tetrahedron", 1, 0.0, ("upper_face", "upper_end"))
    assert not goes_on.any()
    assert length(face, sharp) == pytest.approx(2 * BORDER + 2 * SIZE[1], rel=1e-12)


@pytest.mark.parametrize("cell_type", ["hexahedron", "tetrahedron"])
def test_points_on_edges(cell_type):
    """requirement: points along each edge are on it and on no other, inner points on none."""
    face, *_ = found(cell_type, 1, 0.0)
    corners = face.corner_points[0]
    for number, (a, b) in enumerate(edges_of(face.kind)):
        place = 0.3 * corners[a] + 0.7 * corners[b]
        tangents = face.tangents(np.zeros(1, dtype=int), np.zeros((1, 2)))[0]
        t = np.linalg.lstsq(tangents.T, place - face.points(np.zeros(1, int), np.zeros((1, 2)))[0])
        at = on_edges(face, t[0][None])
        assert at.tolist() == [[k == number for k in range(len(edges_of(face.kind)))]]
    assert not on_edges(face, np.array([[0.3, 0.3]])).any()


def test_facets_that_share_only_a_corner_with_the_rim():
    """requirement: a point at the end of an edge counts, whichever facet it belongs to."""
    face, sharp, _ = found("tetrahedron", 1, 0.0)
    ends = np.unique(face.corner_numbers[:, edges_of(face.kind)][sharp])
    inside = ~sharp.any(axis=1)
    shared = inside[:, None] & np.isin(face.corner_numbers, ends)
    facet, corner = np.nonzero(np.repeat(inside[:, None], 3, axis=1))
    t = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]])[corner]
    assert shared.any()
    np.testing.assert_array_equal(near_chosen(face, sharp, facet, t), shared[facet, corner])


def test_two_ranks(tmp_path):
    """requirement: the same edges on distributed meshes."""
    _, sharp, goes_on = found("hexahedron", 2, 5.0)
    expected = {"sharp": 1.0 * sharp, "goes_on": 1.0 * goes_on}
    same_on_two_ranks("tests.contact.rim_on_ranks", tmp_path, expected)
