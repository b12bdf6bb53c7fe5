"""Worn profiles on a face in space that slide along it."""

import numpy as np
import pytest

from thermowear.contact.friction.worn_surface import WornSurface

X, Y = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-1, 1, 6))
PLACES = np.column_stack([X.ravel(), Y.ravel()])
PLACES = PLACES + 0.05 * np.random.default_rng(1).normal(size=PLACES.shape)
AREAS = np.random.default_rng(2).uniform(0.5, 1.5, len(PLACES))
INNER = (np.abs(PLACES[:, 0]) < 1.4) & (np.abs(PLACES[:, 1]) < 0.7)
SLIPS = [(0.0, 0.0, 0.0), (0.1, -0.2, 0.0), (0.0, 0.0, 0.1), (0.3, 0.1, -0.2), (9.0, 9.0, 0.0)]


@pytest.mark.parametrize("slip", SLIPS)
def test_profiles_slide_along_and_lose_no_volume(slip):
    """requirement: means of neighbours with weights that sum to one, and the adjoint with areas."""
    own = WornSurface(PLACES, AREAS, 1.0)
    seen, lost = own.interpolation(np.array(slip)), own.wear_transfer(np.array(slip))
    np.testing.assert_allclose(seen.sum(axis=1), 1.0)
    assert np.all(seen >= 0)
    np.testing.assert_allclose(AREAS @ lost, AREAS)


@pytest.mark.parametrize("share", [1.0, 0.4, -0.6])
def test_a_plane_profile_is_moved_exactly(share):
    """requirement: W(x - s) for shifts and turns, by the share of the body in them."""
    own = WornSurface(PLACES, AREAS, share)
    profile = 3.0 + PLACES @ (2.0, -1.0)
    for slip in ((0.1, -0.2, 0.0), (0.0, 0.0, 0.05)):
        x, y = PLACES.T
        # a turn about the normal of body 1, which looks down: clockwise seen from above
        moved = np.column_stack([slip[0] + slip[2] * y, slip[1] - slip[2] * x])
        expected = 3.0 + (PLACES - share * moved) @ (2.0, -1.0)
        found = own.interpolation(np.array(slip)) @ profile
        np.testing.assert_allclose(found[INNER], expected[INNER], rtol=1e-12)
