"""Interpolation between places in a plane."""

import numpy as np
import pytest

from thermowear.contact.friction.worn_surface import PlaneCells

X, Y = np.linspace(0.0, 4.0, 6) ** 1.2, np.linspace(-1.0, 1.0, 5)
GRID = np.stack(np.meshgrid(X, Y), axis=2).reshape(-1, 2)
NOISE = 1e-16 * np.random.default_rng(3).normal(size=(4, *GRID.shape))


def turned(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


@pytest.mark.parametrize("noise", NOISE)
def test_rounding_decides_nothing(noise):
    """requirement: on a grid, turned by any angle, products of the hats along its axes."""
    rng = np.random.default_rng(4)
    points = np.column_stack([rng.uniform(-0.5, X[-1] + 0.5, 300), rng.uniform(-1.5, 1.5, 300)])
    turn = turned(rng.uniform(0.0, 6.0))
    found = PlaneCells(GRID @ turn.T + noise).hats(points @ turn.T)
    along = [np.interp(points[:, 0], X, one) for one in np.eye(len(X))]
    across = [np.interp(points[:, 1], Y, one) for one in np.eye(len(Y))]
    expected = np.einsum("yn,xn->nyx", across, along).reshape(len(points), -1)
    np.testing.assert_allclose(found, expected, atol=1e-12)


@pytest.mark.parametrize("bend", [0.0, 1e-16, 1e-9, 0.02])
def test_a_place_of_the_outline_is_seen_from_beyond_it(bend):
    """requirement: 1 at and beside each place, also where those beside it are further out."""
    places = np.array([[0, 0], [1, 0], [2, 0], [3, 0], [0, 1], [1.2, 1], [2.1, 1], [3, 1]], float)
    places[[1, 2], 1] += bend
    for away in (0.0, 1e-14, -1e-14):
        found = PlaneCells(places).hats(places - (0.0, away))
        np.testing.assert_allclose(found, np.eye(len(places)), atol=1e-10)
    below = PlaneCells(places).hats(np.array([[1.0, -0.3], [2.0, -0.3]]))
    np.testing.assert_allclose(below, np.eye(len(places))[[1, 2]], atol=2 * bend)


@pytest.mark.parametrize("count", [3, 4, 5, 12, 300])
def test_places_on_a_circle(count):
    """requirement: a linear function is itself, also on the edges, in a cell of any number."""
    angles = np.sort(np.random.default_rng(count).uniform(0.0, 2 * np.pi, count))
    if count <= 5:
        angles = np.arange(count) * 2 * np.pi / count + 0.3
    places = 1e-3 * np.column_stack([np.cos(angles), np.sin(angles)])
    middles = (places + np.roll(places, 1, axis=0)) / 2
    points = np.vstack([0.2 * places, middles, places, [[0.0, 0.0]]])
    cells = PlaneCells(places)
    found = cells.hats(points)
    assert np.all(found >= 0.0)
    np.testing.assert_allclose(found @ places, points, atol=1e-13)
    np.testing.assert_allclose(found[-1 - count : -1], np.eye(count), atol=1e-9)


def test_beyond_the_outline_the_nearest_values_hold():
    """requirement: constant beyond the ends, as along a line."""
    square = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    hats = PlaneCells(square).hats(np.array([[2.0, 0.25], [-1.0, -1.0], [0.25, 3.0]]))
    np.testing.assert_allclose(hats @ square, [[1.0, 0.25], [0.0, 0.0], [0.25, 1.0]], atol=1e-12)
