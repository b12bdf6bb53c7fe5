"""Derivatives of predictions by finite differences, and their principal directions."""

from __future__ import annotations

import numpy as np

from ..errors import ComputationError
from .forward import ForwardModel
from .parameters import ParameterSpace

NOISE = 1e-5
"""Noise of derivatives relative to the largest ones, by which they count as zero."""
AT_BOUND = 1e-3
"""Distance to a bound, relative to the distance of both, up to which a parameter is held by it."""
_ROOM = 0.25  # largest step relative to the distance of the bounds


def forward_jacobian(
    space: ParameterSpace, model: ForwardModel, internal: np.ndarray, predicted: np.ndarray
) -> np.ndarray:
    """Jacobian by forward differences, or backward ones at upper bounds: p predictions.

    Parameters
    ----------
    internal : ndarray, shape (p,)
        Internal coordinates of a point within the bounds.
    predicted : ndarray, shape (n,)
        Prediction there.

    Returns
    -------
    ndarray, shape (n, p)
        Derivatives with respect to the internal coordinates.
    """
    steps = steps_within(space, model.step)
    steps = np.where(internal + steps > space.bounds[1], -steps, steps)
    moved = _moved(space, model, internal, np.diag(steps))
    return _finite(space, (moved - predicted).T / steps)


def central_jacobian(
    space: ParameterSpace, model: ForwardModel, internal: np.ndarray, predicted: np.ndarray
) -> np.ndarray:
    """Jacobian of second order: 2 p predictions; parameters as in `forward_jacobian`.

    Differences are central, or one-sided with two steps into the interior at bounds::

        f' ≈ (4 f(z + h) - f(z + 2 h) - 3 f(z))/(2 h)
    """
    steps = steps_within(space, model.step)
    below = internal - steps < space.bounds[0]
    above = internal + steps > space.bounds[1]
    central = ~(below | above)
    steps = np.where(above, -steps, steps)
    offsets = np.concatenate([np.diag(steps), np.diag(np.where(central, -steps, 2 * steps))])
    one, two = np.split(_moved(space, model, internal, offsets), 2)
    centred, sided = one - two, 4 * one - two - 3 * predicted
    return _finite(space, np.where(central[:, None], centred, sided).T / (2 * steps))


def principal_directions(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Singular values of a Jacobian (n, p), and all p directions, also those without effect.

    Returns
    -------
    singular_values : ndarray, shape (p,)
        In descending order, with zeros where n < p.
    directions : ndarray, shape (p, p)
        Orthonormal right singular vectors, in columns.
    """
    triangle = np.linalg.qr(rows, mode="r")
    _, found, transposed = np.linalg.svd(triangle, full_matrices=True)
    singular_values = np.zeros(rows.shape[1])
    singular_values[: len(found)] = found
    return singular_values, transposed.T


def without_effect(singular_values: np.ndarray, noise: float = NOISE) -> np.ndarray:
    """True for singular values within the noise of the derivatives, shape (p,)."""
    return singular_values <= noise * singular_values.max(initial=0.0)


def distance_to_optimum(
    space: ParameterSpace,
    internal: np.ndarray,
    rows: np.ndarray,
    residuals: np.ndarray,
    noise: float,
) -> float:
    """Length of the Gauss-Newton step within the bounds, in standard errors.

    Parameters
    ----------
    internal : ndarray, shape (p,)
        Internal coordinates of a point within the bounds.
    rows : ndarray, shape (n, p)
        Weighted Jacobian there, of observations and priors.
    residuals : ndarray, shape (n,)
        Weighted residuals there.
    noise : float
        Relative noise of the derivatives.
    """
    (lower, upper), slope = space.bounds, rows.T @ residuals
    to_bound = np.where(slope > 0, internal - lower, upper - internal)
    held = (to_bound < AT_BOUND * space.widths) & (slope != 0)
    singular_values, directions = principal_directions(rows[:, ~held])
    seen = ~without_effect(singular_values, noise)
    inside = directions[:, seen].T @ slope[~held] / singular_values[seen]
    return float(np.hypot(np.linalg.norm(rows[:, held] @ to_bound[held]), np.linalg.norm(inside)))


def steps_within(space: ParameterSpace, step: float) -> np.ndarray:
    """Steps of finite differences, of which two fit between the bounds to one side, shape (p,)."""
    return np.minimum(step, _ROOM * space.widths)


def _moved(
    space: ParameterSpace, model: ForwardModel, internal: np.ndarray, offsets: np.ndarray
) -> np.ndarray:
    """Predictions at points moved by offsets (m, p), shape (m, n)."""
    others = list(space.admissible(internal + offsets))
    return np.array(model.neighbours(space.admissible(internal), others), dtype=float)


def _finite(space: ParameterSpace, jacobian: np.ndarray) -> np.ndarray:
    failed = ~np.isfinite(jacobian).all(axis=0)
    if failed.any():
        names = ", ".join(np.array(space.names)[failed])
        raise ComputationError(
            f"derivatives with respect to {names}: predictions beside the point could not be "
            "computed; narrow the bounds, or start elsewhere"
        )
    return jacobian
