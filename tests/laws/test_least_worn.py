"""Least wear at which faces conform."""

import numpy as np
import pytest

from thermowear.laws.principle.steady import least_worn


@pytest.mark.parametrize("modes", [1, 2])
def test_least_worn(modes):
    """requirement: nowhere is material added, and no less could be taken off."""
    rng = np.random.default_rng(3)
    x = np.linspace(-1.0, 1.0, 41)
    R = np.column_stack([np.ones_like(x), x])[:, :modes]
    opening, weights = rng.normal(size=41), rng.uniform(0.5, 1.0, 41)
    d = least_worn(R, opening, weights, np.ones(41, dtype=bool))
    lost = R @ d - opening
    assert lost.min() == pytest.approx(0.0, abs=1e-9)
    assert np.sum(lost < 1e-9) == modes
    for _ in range(200):
        other = R @ (d + 0.3 * rng.normal(size=modes)) - opening
        assert other.min() < 0 or weights @ other >= weights @ lost - 1e-9


def test_least_worn_of_a_symmetric_face():
    """requirement: of tilts that wear as little, the symmetric one; mirrored, the mirrored one."""
    x, y = (points.ravel() for points in np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9)))
    R, weights, all_points = (
        np.column_stack([np.ones_like(x), x, y]),
        np.ones(81),
        np.full(81, True),
    )
    opening = 1.0 - 0.2 * x - np.abs(y)  # a ridge along x may tilt about it
    d = least_worn(R, opening, weights, all_points)
    assert d == pytest.approx([1.0, -0.2, 0.0], abs=1e-8)
    skewed = opening + np.where(y > 0, 0.3 * y, 0.0)  # from -0.7 to 1 times the distance
    d, mirrored = (least_worn(R, way, weights, all_points) for way in (skewed, skewed[::-1]))
    assert d == pytest.approx([1.0, -0.2, 0.15], abs=1e-8)
    assert mirrored == pytest.approx(d * [1.0, -1.0, -1.0], abs=1e-8)


def test_least_squares_weigh_areas():
    """requirement: of tilts of least volume, the least squares of depth are those of the area.

    Two points on either side of a ridge; tilted by t about it, their depths are 1 - t and 2 + t.
    """
    y = np.array([-1.0, 0.0, 1.0])
    R, opening = np.column_stack([np.ones(3), y]), np.array([-1.0, 0.0, -2.0])
    weights = np.array([1.0, 1.0, 1.0])
    d = least_worn(R, opening, weights, np.full(3, True))
    assert d == pytest.approx([0.0, -0.5], abs=1e-8)
    R, opening = np.vstack([R, [1.0, 0.5]]), np.append(opening, -1.5)
    weights = np.array([3.0, 1.0, 1.0, 4.0])
    d = least_worn(R, opening, weights, np.full(4, True))
    # t of least 3 (1 - t)² + (2 + t)² + 4 (1.5 + t/2)²
    assert d == pytest.approx([0.0, -0.4], abs=1e-8)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("modes", [1, 2, 3])
def test_least_worn_of_curved_faces(modes, seed):
    """requirement: the vertex that no other motion undercuts, where there is one."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(-1, 1, (2, 85))
    R = np.column_stack([1 - 0.2 * x**2, x, y])[:, :modes]
    opening, weights = 1e-5 * rng.uniform(0, 1, 85), rng.uniform(0, 1, 85)
    d = least_worn(R, opening, weights, np.full(85, True))
    lost = R @ d - opening
    assert lost.min() == pytest.approx(0.0, abs=1e-14)
    assert np.sum(lost < 1e-14) == modes
    if modes == 1:
        assert d == pytest.approx((opening / R[:, 0]).max(), rel=1e-9)


def test_a_body_between_two_others():
    """requirement: where every motion needs material to be added somewhere, the least squares."""
    R, opening = np.repeat([[1.0], [-1.0]], 3, axis=0), np.repeat([0.2, -0.1], 3)
    d = least_worn(R, opening + 0.3, np.ones(6), np.ones(6, dtype=bool))
    assert d == pytest.approx([0.15], abs=1e-12)
