"""The part of a gap that no basis function of the pressure sees."""

from types import SimpleNamespace

import numpy as np
import pytest

from thermowear.contact.operators.pressure import unresolved_gap
from thermowear.contact.search.pairing import Contacts

FACETS, DEGREE = 4, 3


@pytest.fixture
def face():
    """A straight face of equal facets with Gauss points, and C⁰ polynomials on it."""
    t, w = np.polynomial.legendre.leggauss(DEGREE + 3)
    t, count = (t + 1) / 2, len(t)
    facet = np.repeat(np.arange(FACETS), count)
    local = np.vander(np.tile(t, FACETS), DEGREE + 1, increasing=True)
    nodes = np.vander(np.linspace(0, 1, DEGREE + 1), increasing=True)
    shapes = local @ np.linalg.inv(nodes)
    basis = np.zeros((len(facet), FACETS * DEGREE + 1))
    np.put_along_axis(basis, facet[:, None] * DEGREE + np.arange(DEGREE + 1), shapes, axis=1)
    pairing = SimpleNamespace(
        weights=np.tile(w / 2, FACETS),
        carrying=SimpleNamespace(face=SimpleNamespace(sizes=np.ones(FACETS))),
        pieces=SimpleNamespace(facet=facet, point=np.arange(len(facet))),
    )
    return pairing, basis, facet + np.tile(t, FACETS)


def test_its_means_over_basis_functions_vanish(face):
    pairing, basis, _ = face
    gap = np.random.default_rng(1).normal(size=len(basis))
    part = unresolved_gap(gap, np.ones(len(gap), dtype=bool), Contacts((pairing,)), basis)
    assert np.abs(basis.T @ (pairing.weights * part)).max() < 1e-14
    # and what is left is in the space: nothing of it is orthogonal to it
    again = unresolved_gap(gap - part, np.ones(len(gap), dtype=bool), Contacts((pairing,)), basis)
    assert np.abs(again).max() < 1e-13
    assert np.abs(part).max() > 0.1


def test_facets_that_are_partly_open_keep_their_gap(face):
    pairing, basis, x = face
    gap = np.abs(np.sin(7 * x))
    pressing = x < 2.5
    part = unresolved_gap(gap, pressing, Contacts((pairing,)), basis)
    assert np.all(part[x > 2] == 0.0)
    assert np.abs(part[x < 2]).max() > 1e-3
    # the functions of the third facet reach into the second: their means hold, too
    assert np.abs(basis.T @ (pairing.weights * part)).max() < 1e-14


def test_nothing_presses(face):
    pairing, basis, x = face
    assert np.all(
        unresolved_gap(x, np.zeros(len(x), dtype=bool), Contacts((pairing,)), basis) == 0.0
    )
