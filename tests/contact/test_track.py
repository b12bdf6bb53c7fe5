"""The worn profile along which a body slides to and fro, and contacts that share it."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from thermowear import ComputationError
from thermowear.contact.solvers.coupled_positions import CoupledContacts, solve_coupled
from thermowear.contact.solvers.signorini import solve_contact
from thermowear.contact.wear.worn_profile import track


def close(value, rel=1e-6):
    """Equal numbers, however small: pytest's own allowance of 1e-12 would hide volumes."""
    return pytest.approx(value, rel=rel, abs=0.0)


def placed(*positions):
    """Something like a pairing, with contact points at lengths along the face of body 2."""
    places = np.array(positions, dtype=float)
    return SimpleNamespace(opposite=SimpleNamespace(position=places))


def test_the_grid_covers_what_is_touched():
    """requirement: from the first to the last point, half of the way of each further."""
    grid = track([placed(2.0, 3.0), placed(3.5, 5.0)], [0.5, 1.0], 0.4, 2.0)
    assert grid.position[[0, -1]] == close([1.75, 5.5])
    assert np.diff(grid.position).max() <= 0.4
    assert grid.areas.sum() == close(3.75 * 2.0)


@pytest.mark.parametrize("length", [0.0, 0.8])
def test_points_see_the_mean_of_what_they_pass_over(length):
    """requirement: straight profiles are seen exactly; weights are positive and sum to one."""
    s = np.linspace(2.0, 4.0, 9)
    grid = track([placed(*s)], [1.0], 0.3, 1.0)
    hats = grid.hats(placed(*s), length)
    np.testing.assert_allclose(hats @ grid.position, s)
    np.testing.assert_allclose(hats.sum(axis=1), 1.0)
    assert np.all(hats >= 0)


def test_means_over_the_way():
    """requirement: a parabola is seen higher by its curvature times the way squared over 24."""
    grid = track([placed(0.0, 10.0)], [0.0], 0.005, 1.0)
    at, length = placed(5.0), 2.0
    seen = grid.hats(at, length) @ grid.position**2 - grid.hats(at) @ grid.position**2
    assert seen[0] == close(length**2 / 12, rel=1e-2)


def random_contacts(rng, k, count=4, m=7, depths=9, symmetric=True):
    """Contacts with full coupling by depths; gains are the adjoint of what is seen."""
    root = rng.normal(size=(count, m, m))
    compliance = root @ root.mT + 0.5 * np.eye(m)
    if not symmetric:
        compliance = compliance + 0.2 * rng.normal(size=(count, m, m))
    arms = np.linspace(-1.0, 1.0, m) + 0.1 * rng.random((count, m))
    modes = np.stack([np.ones((count, m)), arms], axis=-1)[..., :k]  # a translation, a tilt
    load = np.array([2.0, 0.3])[:k]
    seen = rng.random((count, m, depths))
    gap = rng.normal(size=(count, m)) - (0.0 if k else 2.0)
    force_modes = modes if symmetric else modes * (1 + 0.1 * rng.random(modes.shape))
    contacts = CoupledContacts(compliance, gap, seen, modes, force_modes, load)
    gains = rng.random(count)[:, None, None] * seen.mT
    return contacts, rng.normal(size=depths), gains


def stacked(contacts, start, gains):
    """Coupled contacts stacked into one large contact problem."""
    count, m, k = contacts.modes.shape
    size, motions = count * m, count * k
    seen = contacts.gap_per_depth.reshape(size, -1)
    compliance = seen @ gains.transpose(1, 0, 2).reshape(-1, size)
    modes, force_modes = np.zeros((size, motions)), np.zeros((size, motions))
    for j in range(count):
        here, free = slice(j * m, (j + 1) * m), slice(j * k, (j + 1) * k)
        compliance[here, here] += contacts.compliance[j]
        modes[here, free], force_modes[here, free] = contacts.modes[j], contacts.force_modes[j]
    gap, load = contacts.gap.ravel() + seen @ start, np.tile(contacts.load, count)
    return solve_contact(compliance, gap, modes, load, force_modes=force_modes)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("k", "symmetric"), [(1, True), (0, True), (2, True), (1, False)])
def test_coupled_contacts_are_one_large_contact(seed, k, symmetric):
    """requirement: pressures, motions and depths of the stacked problem."""
    rng = np.random.default_rng(seed)
    contacts, start, gains = random_contacts(rng, k, symmetric=symmetric)
    everywhere = np.ones(contacts.gap.shape, dtype=bool)
    found = solve_coupled(contacts, start, gains, everywhere)
    known = stacked(contacts, start, gains)
    λ = known.coefficients.reshape(contacts.gap.shape)
    np.testing.assert_allclose(found.coefficients, λ, atol=1e-9 * λ.max())
    np.testing.assert_allclose(found.motion.ravel(), known.motion, rtol=1e-8)
    worn = start + np.einsum("jnm,jm->n", gains, λ)
    np.testing.assert_allclose(found.depths, worn, atol=1e-9 * np.abs(worn).max())
    assert 0 < (λ == 0).sum() < λ.size


def test_any_first_guess_will_do():
    """requirement: where the active sets run dry, the stacked problem is solved."""
    rng = np.random.default_rng(1)
    contacts, start, gains = random_contacts(rng, 1)
    nowhere = np.zeros(contacts.gap.shape, dtype=bool)
    found, known = (solve_coupled(contacts, start, gains, guess) for guess in (nowhere, ~nowhere))
    np.testing.assert_allclose(found.coefficients, known.coefficients, atol=1e-9)
    np.testing.assert_allclose(found.depths, known.depths, rtol=1e-8)


def test_a_load_that_nothing_carries_is_an_error():
    """requirement: no numbers where there is no solution."""
    contacts, start, gains = random_contacts(np.random.default_rng(1), 1)
    pulled = dataclasses.replace(contacts, load=-contacts.load)
    everywhere = np.ones(contacts.gap.shape, dtype=bool)
    with pytest.raises(ComputationError, match="contact:"):
        solve_coupled(pulled, start, gains, everywhere)
