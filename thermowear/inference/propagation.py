"""Uncertainty of predictions, and accuracy to expect from planned measurements.

The covariance of the parameters after measurements follows from the derivatives of the predictions
and the standard deviations of the measurements alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from .fit import NOISE, JointNormal
from .parameters import ParameterSpace

INDEPENDENT: Literal["weibull"] = "weibull"
"""Rule for quantiles of independent values, see `quantiles`."""


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
    outputs: np.ndarray,
    levels: Sequence[float] = (0.025, 0.25, 0.5, 0.75, 0.975),
    stratified: bool = False,
) -> SampleQuantiles:
    """Quantiles of outputs (n, k) at the points of a sample; NaN and infinities have failed.

    Parameters
    ----------
    stratified : bool
        True for one point in each stratum of equal probability, False for independent points; see
        `quantiles`.
    """
    outputs = np.asarray(outputs, dtype=float)
    mean, deviation = np.full((2, outputs.shape[1]), np.nan)
    for columns, kept in _by_count(outputs):
        mean[columns] = kept.mean(axis=1)
        deviation[columns] = kept.std(axis=1, ddof=1) if kept.shape[1] > 1 else np.nan
    values = quantiles(outputs, levels, stratified)
    counts = np.isfinite(outputs).sum(axis=0)
    return SampleQuantiles(
        np.asarray(levels), values, mean, deviation, counts, len(outputs) - counts
    )


def quantiles(values: np.ndarray, levels: Sequence[float], stratified: bool) -> np.ndarray:
    """Quantiles of columns (n, k) over their finite values, shape (m, k); NaN without any.

    The k-th of n independent values lies at the probability k/(n + 1) in the mean (Weibull), that
    of a stratified sample in the middle of its stratum, (k - 1/2)/n (Hazen): intervals contain the
    share of the distribution that they are said to. Where values are missing, so are strata.
    """
    found = np.full((len(levels), values.shape[1]), np.nan, dtype=values.dtype)
    for columns, kept in _by_count(values):
        complete = stratified and kept.shape[1] == len(values)
        rule: Literal["hazen", "weibull"] = "hazen" if complete else INDEPENDENT
        found[:, columns] = np.quantile(kept, levels, axis=1, method=rule)
    return found


def _by_count(values: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Columns that have equally many finite values, and these (columns, count)."""
    used = np.isfinite(values)
    counts = used.sum(axis=0)
    for count in np.unique(counts[counts > 0]):  # one pass unless outputs failed differently
        columns = counts == count
        yield columns, values[:, columns].T[used[:, columns].T].reshape(-1, count)


@dataclass(frozen=True)
class ExpectedAccuracy:
    """Accuracy of the parameters after some measurements.

    Attributes
    ----------
    labels : tuple of str
        Measurements that are made.
    normal : JointNormal
        Distribution of the parameters about the assumed ones, with priors.
    """

    labels: tuple[str, ...]
    normal: JointNormal

    @property
    def standard_errors(self) -> np.ndarray:
        """Standard errors, relative ones of logarithmic parameters, shape (p,)."""
        return self.normal.standard_errors

    @property
    def correlation(self) -> np.ndarray:
        """Correlation of the internal coordinates, shape (p, p)."""
        return self.normal.correlation

    def intervals(self, level: float = 0.95) -> np.ndarray:
        """Intervals of the values, shape (p, 2)."""
        return self.normal.intervals(level)

    @property
    def d_criterion(self) -> float:
        """Logarithm of the determinant of the covariance; infinite if one is undetermined."""
        if self.normal.null.size:
            return np.inf
        return float(2 * np.sum(np.log(np.linalg.svd(self.normal.factor, compute_uv=False))))

    @property
    def a_criterion(self) -> float:
        """Trace of the covariance of the internal coordinates; infinite if one is undetermined."""
        return float(np.sum(self.normal.deviations**2))


@dataclass(frozen=True)
class MeasurementDesign:
    """Accuracy with all measurements, with each one alone, and with all but each one.

    Attributes
    ----------
    complete : ExpectedAccuracy
    alone, without : dict of str to ExpectedAccuracy
        By label of the measurement.
    """

    complete: ExpectedAccuracy
    alone: dict[str, ExpectedAccuracy]
    without: dict[str, ExpectedAccuracy]

    def worth(self, label: str) -> np.ndarray:
        """Factors by which standard errors grow without a measurement, shape (p,)."""
        reduced, complete = self.without[label].standard_errors, self.complete.standard_errors
        with np.errstate(invalid="ignore"):
            return np.where(np.isinf(complete), 1.0, reduced / complete)


def expected_accuracy(
    space: ParameterSpace,
    internal: np.ndarray,
    jacobian: np.ndarray,
    deviations: np.ndarray,
    labels: tuple[str, ...],
    noise: float = NOISE,
) -> MeasurementDesign:
    """Accuracy to expect at assumed parameters.

    Parameters
    ----------
    internal : ndarray, shape (p,)
        Internal coordinates of the assumed parameters.
    jacobian : ndarray, shape (n, p)
        Derivatives of the predictions with respect to the internal coordinates.
    deviations : ndarray, shape (n,)
        Standard deviations of the measured values.
    labels : tuple of str
        Measurement of each value.
    """
    rows = np.asarray(jacobian) / np.asarray(deviations)[:, None]
    of_value, names = np.array(labels), tuple(dict.fromkeys(labels))

    def expected(chosen: tuple[str, ...]) -> ExpectedAccuracy:
        kept = rows[np.isin(of_value, chosen)]
        return ExpectedAccuracy(chosen, JointNormal.from_jacobian(space, internal, kept, noise))

    return MeasurementDesign(
        expected(names),
        {name: expected((name,)) for name in names},
        {name: expected(tuple(other for other in names if other != name)) for name in names},
    )
