"""Wear as vectors."""

import numpy as np

from thermowear.laws import (
    InPlace,
    PowerWear,
    contact_patch,
    rotation,
    translation,
    uniform_track,
    wear_vectors,
)

from .random_problems import curved_face


def test_block_on_disk():
    """requirement: a vertical wear rate, the same everywhere, whose tangential part is tan χ."""
    α = np.linspace(-0.7, 0.9, 40)
    outward = np.column_stack([np.sin(α), np.cos(α)])
    patch = contact_patch(
        0.02 * outward, np.full(40, 1e-5), -outward, [translation((0, -1))], 0.3,
        0.3, np.column_stack([np.cos(α), -np.sin(α)]),
    )  # fmt: skip
    steady = patch.steady([1000.0], [PowerWear(1e-13, 2.0, 0.5)])
    vectors = wear_vectors(patch, steady)
    np.testing.assert_allclose(vectors.direction, np.tile([0, -1, 0], (40, 1)), atol=1e-15)
    np.testing.assert_allclose(vectors.inclination, np.abs(α), atol=1e-8)
    descent = np.tile([0, -steady.velocity[0], 0], (40, 1))
    np.testing.assert_allclose(vectors.rates[0], descent, rtol=1e-10, atol=1e-25)
    down_the_slope = np.column_stack([np.cos(α), -np.sin(α), 0 * α])  # for α > 0
    expected = (steady.rates[0] * np.tan(α))[:, None] * down_the_slope
    np.testing.assert_allclose(vectors.tangential[0], expected, atol=1e-12 * abs(descent).max())


def test_collinear_with_the_rigid_motion():
    """requirement: ``w'_i = w'_Ri e_R``, both together the rigid-body wear velocity."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        patch, load, laws = curved_face(rng, friction=0.3, eccentric=6.0)
        steady = patch.steady(load, laws)
        vectors = wear_vectors(patch, steady)
        touching = steady.pressure > 0
        total = sum(vectors.rates)
        scale = np.abs(vectors.rigid).max()
        np.testing.assert_allclose(total[touching], vectors.rigid[touching], atol=1e-9 * scale)
        for rate, vector, flat in zip(steady.rates, vectors.rates, vectors.tangential, strict=True):
            assert np.all(np.isfinite(vector))
            np.testing.assert_allclose(
                np.sum(vector * patch.normals, axis=1), rate, rtol=1e-9, atol=1e-12 * scale
            )
            np.testing.assert_allclose(np.sum(flat * patch.normals, axis=1), 0.0, atol=1e-9 * scale)
            length = np.linalg.norm(flat, axis=1)[touching]
            np.testing.assert_allclose(
                length, (rate * np.tan(vectors.inclination))[touching], atol=1e-6 * scale
            )
        assert np.all(vectors.inclination[touching] < np.pi / 2)
        assert np.all(vectors.inclination[~touching] > np.pi / 2 - 1e-6)


def test_dissipation_is_traction_times_wear():
    """requirement: ``D_w = Σ ∫ p_i·w'_i dS`` with the vectors, friction's part included."""
    rng = np.random.default_rng(5)
    for _ in range(10):
        patch, load, laws = curved_face(rng, friction=0.4, eccentric=2.0)
        steady = patch.steady(load, laws)
        total = sum(wear_vectors(patch, steady).rates)
        power = patch.weights @ (steady.pressure * np.sum(patch.traction * total, axis=1))
        np.testing.assert_allclose(steady.dissipation, power, rtol=1e-8)


def test_where_the_faces_part_a_track_wears_along_its_normal():
    """requirement: a strip wears all over its track, also where nothing touches it."""
    z = np.linspace(-0.05, 0.05, 41)
    patch = contact_patch(
        np.column_stack([np.full(41, 0.03), 0 * z, z]), np.full(41, 1e-5), (1, 0, 0),
        [translation((1, 0, 0)), rotation((0, 1, 0), (0, 0, 0))], 1.0,
    )  # fmt: skip
    laws, track = [PowerWear(1e-13), PowerWear(1e-13)], uniform_track(np.full(41, 1e-3))
    steady = patch.steady([1e3, 30.0], laws, [InPlace(), track])
    vectors = wear_vectors(patch, steady)
    away = steady.approach <= 0
    assert away.any()
    assert steady.rates[1][0] > 0
    np.testing.assert_allclose(vectors.rates[1][away], steady.rates[1][away, None] * [1, 0, 0])
    np.testing.assert_allclose(vectors.tangential[1][away], 0.0)
