"""Faces, contact points, pressure space and trace operators."""

import itertools
from dataclasses import replace
from types import SimpleNamespace

from mpi4py import MPI

import numpy as np
import pytest

from thermowear import CaseError
from thermowear.bulk.bodies import distribute
from thermowear.bulk.kinematics import Axisymmetric, Spatial
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.face import Face, gather_face
from thermowear.contact.faces.projection import project
from thermowear.contact.operators.condensation import gap_trace, value_trace
from thermowear.contact.operators.pressure import contact_zones, pressure_basis
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.parallel import sum_over_ranks

from ..bulk.fields import interpolated
from ..conftest import two_blocks
from .solids import two_solids

COMM = MPI.COMM_WORLD


def blocks(columns=(3, 3), growth=(1.0, 1.0)):
    tagged = two_blocks(columns=columns, growth=growth) if COMM.rank == 0 else None
    return distribute(tagged, COMM)


def faces(bodies):
    return gather_face(bodies, "upper_face"), gather_face(bodies, "lower_face")


MATCHES = [((3, 3), (1.0, 1.0)), ((3, 5), (1.0, 1.0)), ((7, 2), (0.7, 1.5)), ((1, 4), (1.0, 2.0))]


def test_face_runs_along_its_chain():
    """requirement: facets in order, parameter along the chain, normals outward."""
    upper, lower = faces(blocks((4, 6)))
    for face, count, normal in ((upper, 4, -1.0), (lower, 6, 1.0)):
        assert len(face.nodes) == count
        np.testing.assert_allclose(face.nodes[1:, 0], face.nodes[:-1, -1], atol=1e-14)
        assert face.nodes[0, 0, 0] == pytest.approx(0.05)
        every = np.arange(count)
        np.testing.assert_allclose(
            face.normals(every, every / count), [[0.0, normal]] * count, atol=1e-12
        )


@pytest.mark.parametrize(("columns", "growth"), MATCHES)
def test_weights_integrate_over_the_ring(columns, growth):
    """requirement: areas include 2πr; polynomials are integrated exactly."""
    pairing = pair(*faces(blocks(columns, growth)), Axisymmetric(), 6)
    r, w = pairing.points[:, 0], pairing.weights
    assert w.sum() == pytest.approx(np.pi * (0.09**2 - 0.05**2), rel=1e-13)
    assert w @ r**5 == pytest.approx(2 * np.pi * (0.09**7 - 0.05**7) / 7, rel=1e-13)
    assert np.all(np.diff(pairing.position) > 0)
    np.testing.assert_allclose(pairing.position, r - 0.05, atol=1e-14)
    np.testing.assert_allclose(pairing.gap, 0.0, atol=1e-15)
    for side in pairing.sides:
        np.testing.assert_allclose(side.face.points(side.facet, side.t), pairing.points, atol=1e-13)


def test_pieces_end_where_elements_of_either_face_end():
    """requirement: integration on the common refinement."""
    pairing = pair(*faces(blocks((3, 4))), Axisymmetric(), 4)
    ends = np.unique(
        np.round(np.concatenate([np.linspace(0.05, 0.09, 4), np.linspace(0.05, 0.09, 5)]), 9)
    )
    assert len(pairing.weights) == 3 * (len(ends) - 1) + 1
    for end in ends:
        assert np.abs(pairing.points[:, 0] - end).min() < 1e-9


def test_faces_that_do_not_meet_are_reported():
    upper, lower = faces(blocks())
    apart = Face(
        lower.nodes + [1.0, 0.0],
        lower.outward,
        lower.rank,
        lower.cell,
        lower.local_facet,
        lower.reversed,
    )
    with pytest.raises(CaseError, match="opposite"):
        pair(upper, apart, Axisymmetric(), 4)


def moved(face, by):
    """The face of a body that has been shifted."""
    return Face(
        face.nodes + by, face.outward, face.rank, face.cell, face.local_facet, face.reversed
    )


@pytest.mark.parametrize("distance", [1e-4, -2e-5])
def test_initial_gap_is_open_where_positive(distance):
    """requirement: the sign of the gap, g0 = (x2 - x1)·n."""
    upper, lower = faces(blocks((3, 4)))
    pairing = pair(upper, moved(lower, [0.0, -distance]), Axisymmetric(), 4)
    np.testing.assert_allclose(pairing.gap, distance, rtol=1e-9)


def test_points_without_a_partner_are_outside_the_contact():
    """requirement: where body 2 ends, contact ends, exactly there."""
    upper, lower = faces(blocks((3, 4)))
    pairing = pair(upper, moved(lower, [0.013, 0.0]), Axisymmetric(), 5)
    assert pairing.points[:, 0].min() == pytest.approx(0.063, abs=1e-12)
    assert pairing.weights.sum() == pytest.approx(np.pi * (0.09**2 - 0.063**2), rel=1e-9)


@pytest.mark.parametrize("height", [1e-3, 10e-3])
def test_shared_points_get_the_mean_normal(height):
    """requirement: where two facets meet at an angle, the point has the normal between them.

    Beside it the normal turns smoothly where the facets stand for a smooth face, and at once at an
    edge.
    """
    upper, lower = faces(blocks((2, 2)))
    nodes = upper.nodes.copy()
    nodes[0, 1] = nodes[1, 0] = [0.07, height]
    roof = replace(upper, nodes=nodes)
    pairing = pair(roof, lower, Axisymmetric(), 5)
    ridge = np.argmin(np.abs(pairing.position - pairing.position[-1] / 2))
    angle = np.arctan(height / 0.02)
    last = pairing.position[ridge - 1] / pairing.position[ridge]
    beside = angle / 2 * (1.0 if height > 5e-3 else 1.0 - last)
    first = np.array([np.sin(beside), -np.cos(beside)])
    np.testing.assert_allclose(pairing.normals[ridge], [0.0, -1.0], atol=1e-12)
    np.testing.assert_allclose(pairing.normals[ridge - 1], first, atol=1e-4)
    np.testing.assert_allclose(pairing.normals[ridge + 1], first * [-1, 1], atol=1e-4)
    assert pairing.gap.max() == pytest.approx(height, rel=1e-2 if height < 5e-3 else 0.1)


def test_projection_on_a_curved_face():
    """requirement: closest points of curved facets, by Newton's method."""
    angles = np.linspace(0.2, 1.2, 5)
    nodes = np.array(
        [
            [[np.sin(φ), -np.cos(φ)] for φ in np.linspace(a, b, 5)]
            for a, b in itertools.pairwise(angles)
        ]
    )
    n = len(nodes)
    zeros = np.zeros(n, dtype=int)
    face = Face(nodes, np.ones(n), zeros, zeros, zeros, np.zeros(n, dtype=bool))
    φ = np.linspace(0.21, 1.19, 40)
    points = 1.3 * np.column_stack([np.sin(φ), -np.cos(φ)])
    facet, t, offset = project(face, points)
    np.testing.assert_allclose(np.linalg.norm(offset, axis=1), 0.3, rtol=1e-5)
    np.testing.assert_allclose(face.normals(facet, t), points / 1.3, atol=1e-4)


@pytest.mark.parametrize("degree", [1, 3, 7])
@pytest.mark.parametrize(("columns", "growth"), MATCHES)
def test_pressure_basis(columns, growth, degree):
    """requirement: Ψ >= 0, sums to one, and is complete to its degree."""
    pairing = pair(*faces(blocks(columns, growth)), Axisymmetric(), degree + 3)
    basis = pressure_basis(pairing, degree)
    assert basis.min() >= 0.0
    np.testing.assert_allclose(basis.sum(axis=1), 1.0, rtol=1e-13)
    r = pairing.points[:, 0] / 0.07
    best = np.linalg.lstsq(basis, r**degree, rcond=None)[0]
    np.testing.assert_allclose(basis @ best, r**degree, rtol=1e-9)
    assert basis.shape[1] == columns[0] * degree + 1


@pytest.mark.parametrize("degree", [1, 3])
@pytest.mark.parametrize("cells", [None, "hexahedron", "tetrahedron"])
def test_pressure_at_ends_of_facets(cells, degree):
    """
    requirement: points at an end of a facet, up to rounding, have no part of the functions that
    vanish there; else heat passes points whose pressure is rounding.
    """
    model = Spatial() if cells else Axisymmetric()
    bodies = distribute(two_solids(cell_type=cells), COMM) if cells else blocks()
    pairing = pair(*faces(bodies), model, degree + 3)
    pieces, known = pairing.pieces, pressure_basis(pairing, degree)
    for rounding in (-1e-15, 1e-15):
        moved = replace(pairing, pieces=replace(pieces, t=pieces.t + rounding))
        found = pressure_basis(moved, degree)
        assert len(found.nonzero()[0]) == len(known.nonzero()[0])
        assert abs(found - known).max() < 1e-13


@pytest.mark.parametrize("degree", [1, 2, 5, 8])
@pytest.mark.parametrize(("columns", "growth"), MATCHES)
def test_traces(columns, growth, degree):
    """requirement: E evaluates fields at the points; B = (u2 - u1)·n, open positive."""
    bodies = blocks(columns, growth)
    pairing = pair(*faces(bodies), Axisymmetric(), degree + 2)
    scalar, vector = lagrange_spaces(bodies, degree), lagrange_spaces(bodies, degree, 2)
    field = interpolated(scalar, lambda x: (x[0] / 0.07) ** degree + 0 * x[1])
    u = interpolated(vector, lambda x: np.stack([7 + 0 * x[0], x[0] ** degree]))
    lifted = elevated(bodies, vector)
    r = pairing.points[:, 0]
    for side in pairing.sides:
        values = value_trace(scalar, side).T @ field
        np.testing.assert_allclose(sum_over_ranks(COMM, values), (r / 0.07) ** degree, rtol=1e-12)
    back = gap_trace(vector, Contacts((pairing,))).T
    assert np.abs(sum_over_ranks(COMM, back @ u)).max() < 1e-12
    np.testing.assert_allclose(sum_over_ranks(COMM, back @ lifted), 1e-3, rtol=1e-12)


def elevated(bodies, spaces):
    """Body 1 lifted by 1 mm: the gap opens by 1 mm."""
    return np.outer(spaces.nodes_of(bodies, "upper"), (0.0, 1e-3)).ravel()


def test_unpaired_is_a_part_of_the_length():
    """requirement: what has nothing opposite is told as a part of the face's length."""
    upper, lower = faces(blocks((3, 4), (1.6, 1.0)))  # facets of unlike length
    pairing = pair(upper, moved(lower, [0.013, 0.0]), Axisymmetric(), 5)
    assert pairing.unpaired == pytest.approx(0.013 / 0.04, rel=1e-9)


def test_a_symmetric_pressure_has_a_symmetric_zone():
    """requirement: points between facets count alike at both ends."""
    x = np.linspace(0.0, 12.0, 37)  # of 12 facets; those between two are on the first
    facet = np.maximum(np.ceil(x) - 1, 0)
    carrying = SimpleNamespace(face=None, facet=facet, t=x - facet)
    from_middle = (x - 6) / 5.1
    squared = np.maximum(1 - from_middle**2, 0.0) * (1 + 0.1 * from_middle**2)
    zones = contact_zones(SimpleNamespace(carrying=carrying, position=x), np.sqrt(squared))
    ((start, end),) = zones
    assert start + end == pytest.approx(12.0, rel=1e-12)
    assert end - start == pytest.approx(10.2, rel=0.1)
