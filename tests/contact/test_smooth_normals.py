"""Normals that are continuous across the facets of a face."""

import numpy as np
import pytest
from numpy.polynomial import polynomial

from thermowear.contact.faces.normals import corner_corrections, smooth_normals
from thermowear.lagrange import gauss

ENDS = np.radians([-40.0, -22.0, -2.0, 11.0, 30.0])
"""End angles of facets of unequal length on a circle of radius 1."""


def arc(order):
    """Nodes and corrections of the facets; body below, chain in the sense of rising x."""
    angles = np.linspace(ENDS[:-1], ENDS[1:], order + 1, axis=1)
    nodes = np.stack([np.sin(angles), np.cos(angles)], axis=-1)
    corners = np.arange(len(nodes))[:, None] + np.arange(2)
    outward = -np.ones(len(nodes))
    return nodes, outward, corner_corrections("interval", nodes, outward, corners)


def facet_normals(nodes, outward, corrections, t):
    """Normals and turning at parameters (n,) of all facets, shapes (n_facets, n, 2)."""
    facet = np.repeat(np.arange(len(nodes)), len(t))
    at = np.tile(t, len(nodes))[:, None]
    normals, turning = smooth_normals("interval", nodes, outward, corrections, facet, at)
    return normals.reshape(len(nodes), -1, 2), turning.reshape(len(nodes), -1, 2)


@pytest.mark.parametrize(("order", "off"), [(1, 1e-3), (2, 7e-4), (3, 5e-5)])
def test_normals_on_an_arc(order, off):
    """requirement: continuous where facets meet, near to those of the circle, unit vectors."""
    t = np.linspace(0.0, 1.0, 11)
    normals, _ = facet_normals(*arc(order), t)
    np.testing.assert_allclose(normals[1:, 0], normals[:-1, -1], atol=1e-14)
    angles = ENDS[:-1, None] + np.diff(ENDS)[:, None] * t
    exact = np.stack([np.sin(angles), np.cos(angles)], axis=-1)
    inner = slice(1, -1)  # long straight facets are off at the ends of the face
    np.testing.assert_allclose(normals[inner], exact[inner], atol=off)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=2), 1.0, rtol=1e-14)


def slopes(nodes, t):
    """Derivatives of the coordinates of a facet along its parameter, shape (2, n)."""
    knots, degree = np.linspace(0.0, 1.0, len(nodes)), len(nodes) - 1
    return polynomial.polyval(t, polynomial.polyder(polynomial.polyfit(knots, nodes, degree)))


@pytest.mark.parametrize("order", [2, 3])
def test_a_uniform_pressure_bears_on_the_covered_length(order):
    """requirement: the resultant is that of the chord, however coarse the curved facets are."""
    nodes, outward, corrections = arc(order)
    t, w = gauss(12)
    smooth, _ = facet_normals(nodes, outward, corrections, t)
    own, _ = facet_normals(nodes, outward, np.zeros_like(corrections), t)
    sizes = np.array([np.hypot(*slopes(n, t)) for n in nodes])
    resultant = np.einsum("q,fq,fqi->i", w, sizes, smooth)
    chord = nodes[-1, -1] - nodes[0, 0]
    assert np.abs(smooth - own).max() > 1e-4  # they do differ
    np.testing.assert_allclose(resultant, [-chord[1], chord[0]], rtol=2e-6)


def test_turning_is_the_derivative():
    """Against differences of the normals."""
    face, t, step = arc(3), np.array([0.1, 0.5, 0.8]), 1e-6
    _, turning = facet_normals(*face, t)
    ahead, behind = (facet_normals(*face, t + way)[0] for way in (step, -step))
    np.testing.assert_allclose(turning, (ahead - behind) / (2 * step), atol=1e-8)
