"""The three functionals."""

import numpy as np
import pytest

from thermowear.laws import PowerWear, friction_dissipation, wear_dissipation, wear_volume_rate

from .random_problems import curved_face

RNG = np.random.default_rng(1)
W, P, V = RNG.uniform(0.5, 1, 12), RNG.uniform(1e6, 9e6, 12), RNG.uniform(0.1, 2, 12)
LAWS = [PowerWear(1e-13, 1.0, 0.5), PowerWear(3e-20, 2.0, 1.5)]
C = RNG.uniform(0.8, 1.3, 12)


@pytest.mark.parametrize("q", [0.5, 1.0, 2.0, 7.0])
def test_definitions(q):
    """requirement: ``D_w^(q)``, ``D_F^(q)``, ``W^(q)`` as defined, body by body."""

    def norm(density):
        return (W @ density**q) ** (1 / q)

    rates = [1e-13 * P * V**0.5, 3e-20 * P**2 * V**1.5]
    D_w = sum(norm(C * P * rate) for rate in rates)
    assert wear_dissipation(W, LAWS, V, q, C)(P) == pytest.approx(D_w, rel=1e-12, abs=0.0)
    assert wear_volume_rate(W, LAWS, V, q)(P) == pytest.approx(
        sum(map(norm, rates)), rel=1e-12, abs=0.0
    )
    D_F = norm(0.3 * P * V)
    assert friction_dissipation(W, 0.3, V, q)(P) == pytest.approx(D_F, rel=1e-12)


@pytest.mark.parametrize("q", [0.6, 1.0, 3.0])
def test_gradients(q):
    """requirement: the derivative by the pressure, per area."""
    for functional in (
        wear_dissipation(W, LAWS, V, q, C),
        wear_volume_rate(W, LAWS, V, q),
        friction_dissipation(W, 0.3, V, q),
    ):
        gradient = functional.gradient(P)
        for i in range(len(P)):
            h = np.zeros(len(P))
            h[i] = 1e-5 * P[i]
            slope = (functional(P + h) - functional(P - h)) / (2 * h[i])
            assert slope == pytest.approx(W[i] * gradient[i], rel=1e-7)


def test_many_pressures_at_once():
    """requirement: values for arrays of pressures are those of each."""
    pressures = P * np.linspace(0.5, 2, 6).reshape(2, 3, 1)
    functional = wear_dissipation(W, LAWS, V, 2.0)
    values = functional(pressures)
    assert values.shape == (2, 3)
    assert values[1, 2] == pytest.approx(functional(2 * P), rel=1e-14)


def test_large_q_is_the_largest_density():
    """requirement: the powers stay in range."""
    for q in (50.0, 400.0):
        functional = friction_dissipation(W, 0.3, V, q)
        assert functional(P) == pytest.approx(np.max(0.3 * P * V), rel=10 / q)
        assert np.all(np.isfinite(functional.gradient(P)))
    assert friction_dissipation(W, 0.3, V, 2.0)(0 * P) == 0.0


def test_where_they_have_a_minimum():
    """requirement: q > 1/(b + 1), q > 1, q > 1/b."""
    law = [PowerWear(1.0, 0.5)]
    for build, bound in (
        (lambda q: wear_dissipation(W, law, V, q), 2 / 3),
        (lambda q: friction_dissipation(W, 0.3, V, q), 1.0),
        (lambda q: wear_volume_rate(W, law, V, q), 2.0),
    ):
        assert not build(bound * (1 - 1e-9)).defined
        assert build(bound * (1 + 1e-9)).defined


def test_first_of_the_steady_state_is_its_dissipation():
    """requirement: ``D_w^(1)`` with χ of the steady state is ``∫ p·w' dS``."""
    rng = np.random.default_rng(2)
    patch, load, laws = curved_face(rng, friction=0.4, eccentric=0.0, motions=1)
    steady = patch.steady(load, laws)
    assert np.all(steady.pressure > 0)
    factor = (patch.force_modes @ steady.velocity) / steady.approach
    functional = wear_dissipation(patch.weights, laws, patch.speed, 1.0, factor)
    assert functional(steady.pressure) == pytest.approx(steady.dissipation, rel=1e-10)
