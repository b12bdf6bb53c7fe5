"""Accuracy to expect from planned measurements, before any is made.

The covariance of the parameters after measurements follows from the derivatives of the predictions
and the standard deviations of the measurements alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .jacobian import NOISE
from .joint_normal import JointNormal
from .parameters import ParameterSpace


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
