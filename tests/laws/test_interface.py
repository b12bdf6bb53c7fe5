"""Contact patches."""

import numpy as np
import pytest

from thermowear.laws import contact_patch, rotation, translation


def test_modes_of_a_plane_point():
    """requirement: ``R = m·n``, ``T = m·(n + mu e)``; plane vectors are embedded."""
    patch = contact_patch(
        [[3.0, 1.0]], [2.0], [0.0, -5.0],
        [translation((0, -1)), rotation((0, 0, 1), (1.0, -1.0)), translation((1, 0))],
        speed=0.5, friction=0.4, sliding=(-1.0, 0.0),
    )  # fmt: skip
    # about (1, -1) the point moves by (-2, 2) per radian
    np.testing.assert_allclose(patch.normals, [[0, -1, 0]])
    np.testing.assert_allclose(patch.normal_modes, [[1, -2, 0]], atol=1e-15)
    np.testing.assert_allclose(patch.force_modes, [[1, -2 + 0.8, -0.4]], atol=1e-15)
    np.testing.assert_allclose(patch.velocity(np.array([3.0, 1.0, 0.5])), [[-1.5, -1.0, 0]])
    assert patch.speed.shape == (1,)


def test_transverse_friction():
    """requirement: ``ñ = n + mu e_1 + mu_d e_2``."""
    patch = contact_patch(
        np.zeros((2, 3)), np.ones(2), (0, 0, -1), [translation((0, 0, -1))], 1.0,
        0.3, (0, 1, 0), 0.2, [[1, 0, 0], [0.6, 0, -0.8]],
    )  # fmt: skip
    np.testing.assert_allclose(patch.traction, [[0.2, 0.3, -1], [0.12, 0.3, -1.16]])
    np.testing.assert_allclose(patch.force_modes, [[1], [1.16]])


def test_resultants():
    """requirement: force and moment of ``p ñ``, and their power with any rigid motion."""
    rng = np.random.default_rng(1)
    points, normals = rng.normal(size=(5, 3)), rng.normal(size=(5, 3))
    pivot = np.array([0.3, -2.0, 1.0])
    turn, move = rng.normal(size=3), rng.normal(size=3)
    patch = contact_patch(
        points, rng.uniform(1, 2, 5), normals, [translation(move), rotation(turn, pivot)], 1.0,
        0.5, rng.normal(size=(5, 3)),
    )  # fmt: skip
    p = rng.uniform(1, 2, 5)
    powers = patch.force_modes.T @ (patch.weights * p)
    assert powers[0] == pytest.approx(patch.force(p) @ move, rel=1e-12)
    assert powers[1] == pytest.approx(patch.moment(p, pivot) @ turn, rel=1e-12)


def test_parts():
    """requirement: some of the points make a patch of their own."""
    rng = np.random.default_rng(1)
    patch = contact_patch(
        rng.normal(size=(4, 3)), np.arange(4.0), (0, 0, 1), [translation((0, 0, 1))],
        np.arange(1.0, 5.0), 0.1, rng.normal(size=(4, 3)),
    )  # fmt: skip
    part = patch.part(np.array([True, False, True, False]))
    np.testing.assert_array_equal(part.weights, [0, 2])
    np.testing.assert_array_equal(part.speed, [1, 3])
    np.testing.assert_array_equal(part.traction, patch.traction[[0, 2]])
    np.testing.assert_array_equal(part.force_modes, patch.force_modes[[0, 2]])
