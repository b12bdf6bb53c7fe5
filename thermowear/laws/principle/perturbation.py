"""Pressures near a given one that carry the same load: the test of a minimum."""

from __future__ import annotations

import numpy as np


def admissible_changes(
    rng: np.random.Generator,
    count: int,
    weights: np.ndarray,
    force_modes: np.ndarray,
    pressure: np.ndarray,
    sizes: tuple[float, float] = (1e-3, 1.0),
) -> np.ndarray:
    """Random changes of a pressure that have no resultants and leave no tension.

    Where there is pressure it rises or falls, where there is none it can only rise; multiples
    ``p T c`` of the pressure then take the resultants out.

    Parameters
    ----------
    rng : numpy.random.Generator
    count : int
        m.
    weights, force_modes, pressure
        w, T, p at n points; p has a part that T takes to any load.
    sizes : tuple of float
        Smallest and largest relative change where it is largest; drawn evenly in the logarithm.

    Returns
    -------
    ndarray, shape (m, n) [Pa]
        δ with ``Tᵀ w δ = 0`` and ``p + δ >= 0``.
    """
    noise = rng.standard_normal((count, len(pressure)))
    raised = np.abs(noise) * (weights @ pressure / weights.sum()) * rng.random((count, 1)) ** 2
    change = np.where(pressure > 0, noise * pressure, raised)
    weighted = weights[:, None] * force_modes
    resultants = change @ weighted
    gram = force_modes.T @ (pressure[:, None] * weighted)
    change -= pressure * (np.linalg.solve(gram, resultants.T).T @ force_modes.T)
    relative = np.max(
        np.abs(np.divide(change, pressure, out=np.zeros_like(change), where=pressure > 0)), axis=1
    )
    low, high = np.log(sizes)
    size = np.exp(rng.uniform(low, high, count))
    return change * (size / relative)[:, None]
