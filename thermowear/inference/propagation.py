"""Uncertainty of predictions: linear bands, and quantiles of samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .jacobian import NOISE
from .joint_normal import JointNormal


@dataclass(frozen=True)
class Band:
    """Bands of n predictions by linear propagation of errors (delta method).

    Attributes
    ----------
    predicted, deviations : ndarray, shape (n,)
        Predictions and their standard deviations; infinite where they depend on an undetermined
        direction of the parameters.
    lower, upper : ndarray, shape (n,)
    """

    predicted: np.ndarray
    deviations: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


def linear_band(
    predicted: np.ndarray,
    jacobian: np.ndarray,
    normal: JointNormal,
    level: float = 0.95,
    noise: float = NOISE,
) -> Band:
    """Bands of predictions with derivatives (n, p) with respect to the internal coordinates."""
    deviations = np.linalg.norm(jacobian @ normal.factor, axis=1)
    affected = np.linalg.norm(jacobian @ normal.null, axis=1)
    deviations[affected > noise * np.linalg.norm(jacobian, axis=1)] = np.inf
    reach = normal.quantile(level) * deviations
    return Band(predicted, deviations, predicted - reach, predicted + reach)


@dataclass(frozen=True)
class SampleQuantiles:
    """Quantiles of k outputs over the points of a sample that did not fail.

    Attributes
    ----------
    levels : ndarray, shape (m,)
    values : ndarray, shape (m, k)
        Quantiles; NaN for an output that failed at all points.
    mean, deviation : ndarray, shape (k,)
    counts, failed : ndarray of int, shape (k,)
        Number of points used, and of those that failed.
    """

    levels: np.ndarray
    values: np.ndarray
    mean: np.ndarray
    deviation: np.ndarray
    counts: np.ndarray
    failed: np.ndarray


def sample_quantiles(
    outputs: np.ndarray, levels: Sequence[float] = (0.025, 0.25, 0.5, 0.75, 0.975)
) -> SampleQuantiles:
    """Quantiles of outputs (n, k) at the points of a sample; NaN and infinities have failed."""
    outputs = np.asarray(outputs, dtype=float)
    used = np.isfinite(outputs)
    counts = used.sum(axis=0)
    values = np.full((len(levels), outputs.shape[1]), np.nan)
    mean, deviation = np.full((2, outputs.shape[1]), np.nan)
    for count in np.unique(counts[counts > 0]):  # one pass unless outputs failed differently
        columns = counts == count
        kept = outputs[:, columns].T[used[:, columns].T].reshape(-1, count)
        values[:, columns] = np.quantile(kept, levels, axis=1)
        mean[columns] = kept.mean(axis=1)
        deviation[columns] = kept.std(axis=1, ddof=1) if count > 1 else np.nan
    return SampleQuantiles(
        np.asarray(levels), values, mean, deviation, counts, len(outputs) - counts
    )
