"""Admissible changes of a pressure."""

import numpy as np

from thermowear.laws import admissible_changes


def test_they_are_admissible_and_of_all_sizes():
    """requirement: no resultants, no tension, pressure also where there was none."""
    rng = np.random.default_rng(1)
    x = np.linspace(-1, 1, 40)
    modes = np.column_stack([np.ones(40), x, x**2 + 0.3 * x])
    weights, pressure = rng.uniform(0.5, 1, 40), np.maximum(0.0, 1.0 + x)
    pressure[:8] = 0.0
    changes = admissible_changes(rng, 500, weights, modes, pressure)
    resultants = changes @ (weights[:, None] * modes)
    assert np.abs(resultants).max() < 1e-12
    assert np.all(pressure + changes >= -1e-15)
    pressed = pressure > 0
    sizes = np.abs(changes[:, pressed] / pressure[pressed]).max(axis=1)
    assert sizes.min() < 2e-3
    assert 0.9 < sizes.max() <= 1 + 1e-12
    assert np.mean(changes[:, ~pressed] > 0) > 0.9
    assert np.linalg.matrix_rank(changes) == 40 - 3  # every admissible direction is tried
