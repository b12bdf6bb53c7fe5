"""Growth of small perturbations, on matrices small enough for closed forms."""

import numpy as np
import pytest

from thermowear.laws.stability import PerturbationMatrices, leading, load_free, static_modes

ALL = load_free(np.zeros((2, 0)), np.zeros((2, 0)))


def test_static_modes_of_separate_coefficients():
    """requirement: ``A + V H`` loses its definiteness; what heat opens is never unstable."""
    elastic, thermal = np.diag([2.0, 3.0, 1.0]), -np.diag([1.0, 6.0, -4.0])
    every = load_free(np.zeros((3, 0)), np.zeros((3, 0)))
    found = static_modes(elastic, thermal, every)
    np.testing.assert_allclose(found.factors, [0.5, 2.0])
    np.testing.assert_allclose(np.abs(found.shapes), [[0, 1], [1, 0], [0, 0]], atol=1e-12)


def test_static_modes_carry_no_load():
    """requirement: with a free holder the bordered matrix is singular at each factor."""
    rng = np.random.default_rng(3)
    half = rng.standard_normal((6, 6))
    elastic, thermal = half @ half.T + np.eye(6), -np.diag(np.arange(1.0, 7.0))
    modes, forces = rng.random((6, 2)), rng.random((6, 2))
    found = static_modes(elastic, thermal, load_free(modes, forces))
    assert len(found.factors) >= 1
    for factor, shape in zip(found.factors, found.shapes.T, strict=True):
        np.testing.assert_allclose(forces.T @ shape, 0.0, atol=1e-12)
        effective = elastic + factor * thermal
        bordered = np.block([[effective, -modes], [forces.T, np.zeros((2, 2))]])
        singular = np.linalg.svd(bordered, compute_uv=False)
        assert singular[-1] < 1e-9 * singular[0]
        motion = np.linalg.lstsq(modes, effective @ shape, rcond=None)[0]
        np.testing.assert_allclose(effective @ shape, modes @ motion, atol=1e-9)


def test_static_modes_end_where_disturbances_swing():
    """requirement: none is given behind a pair of complex factors."""
    thermal = -np.array([[1.0, 0.5, 0.0], [-0.5, 1.0, 0.0], [0.0, 0.0, 0.1]])
    every = load_free(np.zeros((3, 0)), np.zeros((3, 0)))
    assert len(static_modes(np.eye(3), thermal, every).factors) == 0
    assert len(static_modes(np.eye(3), 20.0 * np.diag([0, 0, -1.0]) + thermal, every).factors) == 1


def test_the_leading_space_keeps_its_static_modes():
    """requirement: fewer kinds of disturbances leave the first critical speeds as they are."""
    rng = np.random.default_rng(5)
    half = rng.standard_normal((30, 30))
    elastic, thermal = half @ half.T + 30 * np.eye(30), -np.diag(np.linspace(9.0, 0.01, 30) ** 2)
    every = load_free(np.ones((30, 1)), np.ones((30, 1)))
    some = leading(elastic, thermal, np.eye(30), every, 6)
    assert some.pressures.shape == (30, 12)
    known, found = (static_modes(elastic, thermal, space).factors[:4] for space in (every, some))
    np.testing.assert_allclose(found, known, rtol=1e-9)
    assert leading(elastic, thermal, np.eye(30), every, 20) is every


def one(a=2.0, b=3.0, h=5.0, k=7.0, c=0.0, m=1.0):
    """One temperature and one pressure: ``λ = (b θ - ω)/a``."""
    return PerturbationMatrices(*(np.array([[v]]) for v in (a, -b, h, k, c, m)), diffusion_rate=0.3)


def test_growth_without_wear():
    """requirement: ``s = (V h b/a - k - V c)/m``, positive from ``k/(h b/a - c)`` on."""
    small = one(c=0.5, m=4.0)
    assert small.fastest(2.0).value == pytest.approx((2 * 7.5 - 7 - 1) / 4)
    assert small.growth(2.0) == pytest.approx((2 * 7.5 - 7 - 1) / 4)
    assert small.onset(0.01) == pytest.approx(1.0, rel=1e-7)
    assert small.onset(30.0) == pytest.approx(1.0, rel=1e-7)
    assert one(h=-5.0).onset(1.0) is None


def test_wear_makes_it_swing():
    """requirement: two rates, of ``s² + (k + w/a - V h b/a) s + k w/a = 0`` (speed in w too)."""
    small = one()
    for factor, w in ((0.5, 2.0), (1.2, 2.0), (6.0, 2.0)):
        sum_, product = factor * 7.5 - 7 - w / 2, 7 * w / 2
        rates = np.roots([1.0, -sum_, product])
        best = rates[np.argmax(rates.real)]
        found = small.fastest(factor, np.array([[w]]))
        assert found.value == pytest.approx(complex(best.real, abs(best.imag)))
    # k + V w/a = V h b/a
    onset = small.onset(0.01, lambda factor: np.array([[2.0 * factor]]))
    assert onset == pytest.approx(7 / (7.5 - 1), rel=1e-7)
    assert small.onset(0.01, lambda factor: np.array([[20.0 * factor]])) is None
    swinging = small.fastest(onset, np.array([[2.0 * onset]])).value
    assert swinging.imag == pytest.approx(np.sqrt(7 * onset), rel=1e-6)


def test_an_uneven_face_that_does_not_wear_is_no_disturbance():
    """requirement: rates that vanish are left out."""
    assert one().growth(0.5, np.array([[0.0]])) == pytest.approx(0.5 * 7.5 - 7)


def test_fast_rates_leave_slow_ones_accurate():
    """requirement: a slow decay to 1e-10 beside rates that are 1e14 times faster."""
    rng = np.random.default_rng(1)
    half = rng.standard_normal((8, 8))
    coupled, scales = half @ half.T + 8 * np.eye(8), np.geomspace(1.0, 1e7, 8)
    no = np.zeros((1, 8))
    small = PerturbationMatrices(
        elastic=np.eye(1),
        opening=no,
        heated=no.T,
        conducted=scales[:, None] * coupled * scales,
        carried=np.zeros((8, 8)),
        stored=np.eye(8),
        diffusion_rate=1.0,
    )
    # eigenvalues of the inverse of a scaled matrix, in which the slow one is the largest
    times = np.linalg.eigvalsh(np.linalg.inv(coupled) / scales[:, None] / scales)
    assert small.growth(1.0) == pytest.approx(-1 / times[-1], rel=1e-10)
    assert small.fastest(1.0).value == pytest.approx(-1 / times[-1], rel=1e-10)
