"""Pressure spaces with a pressure for each point at the edge of the wear."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp

from thermowear.contact.operators.condensation import CondensedContact
from thermowear.contact.wear.wear_edge import edge_points, edge_space, has_passed, rough_points

FACETS, POINTS = 5, 4


@pytest.fixture
def face():
    """Hats on a straight face of equal facets, and a compliance that is no diagonal one."""
    t, w = np.polynomial.legendre.leggauss(POINTS)
    t = (t + 1) / 2
    x = np.repeat(np.arange(FACETS), POINTS) + np.tile(t, FACETS)
    facets = sp.csr_array(np.arange(FACETS)[:, None] == np.floor(x))
    basis = np.maximum(1 - np.abs(x[:, None] - np.arange(FACETS + 1)), 0.0)
    weighted = np.tile(w / 2, FACETS)[:, None] * basis
    apart = np.abs(np.subtract.outer(np.arange(FACETS + 1.0), np.arange(FACETS + 1.0)))
    modes = np.ones((len(x), 1))
    holder = SimpleNamespace(modes=modes, force_modes=modes)
    means = weighted.T @ modes
    contact = CondensedContact(basis, weighted, np.exp(-apart), means, means)
    return facets, x, contact, holder


def test_the_edge_is_where_wear_ends_and_in_two_facets_beyond(face):
    facets, x, contact, _ = face
    for end, edge in ((2.5, (2, 3, 4)), (2.0, (2, 3)), (0.0, ()), (5.0, ())):
        points = edge_points(facets, contact.basis, x < end)
        assert set(np.flatnonzero(facets @ points)) == set(edge)
        assert points.sum() == POINTS * len(edge)


def test_forces_stay_and_a_smooth_pressure_is_weak_contact(face):
    """requirement: resultants to rounding; what is in the space answers with the same means."""
    facets, x, contact, holder = face
    space = edge_space(contact, edge_points(facets, contact.basis, x < 2.5), holder)
    amounts = np.random.default_rng(1).random(space.basis.shape[1])
    pressure = space.basis @ amounts
    assert space.force_modes.T @ amounts == pytest.approx(contact.weak(pressure).sum(), rel=1e-13)
    assert contact.weighted.sum(axis=0) @ (space.projection @ amounts) == pytest.approx(
        contact.weak(pressure).sum(), rel=1e-12
    )
    smooth = 2.0 + 3.0 * x
    amounts = np.linalg.lstsq(space.basis, smooth, rcond=None)[0]
    np.testing.assert_allclose(space.basis @ amounts, smooth, rtol=1e-12)
    np.testing.assert_allclose(space.local_compliance @ amounts, 0.0, atol=1e-11)
    work = amounts @ space.compliance(contact.compliance) @ amounts
    nodal = 2.0 + 3.0 * np.arange(FACETS + 1)
    assert work == pytest.approx(nodal @ contact.compliance @ nodal, rel=1e-10)


def test_a_jump_is_rough_where_it_lies(face):
    facets, x, contact, _ = face
    assert not rough_points(facets, contact.basis, contact.weighted.sum(axis=1), 1.0 + x).any()
    jump = np.where(x < 2.5, 1.0, 0.0)
    rough = rough_points(facets, contact.basis, contact.weighted.sum(axis=1), jump)
    assert (facets @ rough)[2]


def test_an_edge_that_leaves_its_points_in_a_step_is_noticed(face):
    """requirement: beyond them a jump overshoots by a quarter; a contact elsewhere is no edge."""
    facets, x, contact, _ = face
    before = x < 0.5
    points = edge_points(facets, contact.basis, before)
    for after, passed in ((x < 2.9, False), (x < 3.5, True), (before | (x > 4.5), False)):
        assert has_passed(contact.basis, points, before, after) is passed


def test_weak_gaps_of_single_points_are_gaps(face):
    """requirement: by their areas, at their points, and nowhere else."""
    facets, x, contact, holder = face
    points = edge_points(facets, contact.basis, x < 2.5)
    space = edge_space(contact, points, holder)
    found = space.at_points(space.weighted.T @ x)
    np.testing.assert_allclose(found[points], x[points], rtol=1e-12)
    assert np.all(np.isnan(found[~points]))
