"""Admissible perturbations of a pressure, to test a minimum."""

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
    """Random changes of a pressure without resultants and without tension.

    Positive pressures increase or decrease, zero pressures only increase; multiples ``p T c`` of
    the pressure then cancel the resultants.

    Parameters
    ----------
    rng : numpy.random.Generator
    count : int
        Number m of changes.
    weights, force_modes, pressure
        w, T, p at n points; the pressed points can balance any load on T.
    sizes : tuple of float
        Bounds of the maximum relative change, drawn log-uniformly.

    Returns
    -------
    ndarray, shape (m, n) [Pa]
        Changes δ with ``Tᵀ w δ = 0`` and ``p + δ >= 0``.
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
