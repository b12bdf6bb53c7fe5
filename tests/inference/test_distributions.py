"""Distributions of uncertain inputs."""

import numpy as np
import pytest

from thermowear.inference import (
    LogNormal,
    LogUniform,
    Normal,
    Triangular,
    TruncatedNormal,
    Uniform,
)

HALF = np.sqrt(2 / np.pi)
"""Mean of the half-normal distribution of deviation 1."""
Q = (np.arange(200000) + 0.5) / 200000


@pytest.mark.parametrize(
    ("distribution", "mean", "deviation"),
    [
        (Normal(3.0, 0.5), 3.0, 0.5),
        (Uniform(1.0, 4.0), 2.5, 3 / np.sqrt(12)),
        (Triangular(1.0, 1.5, 4.0), 6.5 / 3, np.sqrt((1 + 2.25 + 16 - 1.5 - 4 - 6) / 18)),
        (LogUniform(1.0, np.e), np.e - 1, np.sqrt((np.e**2 - 1) / 2 - (np.e - 1) ** 2)),
        (LogNormal.from_mean(2.0, 0.6), 2.0, 0.6),
        (TruncatedNormal(1.0, 0.5, lower=1.0), 1 + 0.5 * HALF, 0.5 * np.sqrt(1 - HALF**2)),
    ],
    ids=["normal", "uniform", "triangular", "loguniform", "lognormal", "half-normal"],
)  # fmt: skip
def test_quantiles_have_mean_and_deviation(distribution, mean, deviation):
    """requirement: moments of the closed form, by sums over quantiles."""
    values = distribution.ppf(Q)
    assert values.mean() == pytest.approx(mean, rel=1e-4)
    assert values.std() == pytest.approx(deviation, rel=1e-3)
    assert distribution.expected == pytest.approx(mean, rel=1e-9)
    assert distribution.spread == pytest.approx(deviation, rel=1e-9)
    assert distribution.size == 1


def test_a_factor_about_a_median():
    """requirement: 95 % between median/factor and median·factor."""
    found = LogNormal.from_factor(1e-15, 3.0)
    ends = found.ppf([0.025, 0.5, 0.975])
    assert ends == pytest.approx([1e-15 / 3, 1e-15, 3e-15], rel=1e-9, abs=0.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Normal(1.0, 0.0), "standard deviation 0; must be positive"),
        (lambda: Uniform(2.0, 1.0), "width of the interval -1; must be positive"),
        (lambda: LogUniform(0.0, 1.0), "lower end 0; must be positive"),
        (lambda: LogUniform(1.0, np.inf), "must be positive and finite"),
        (lambda: Triangular(0.0, 3.0, 2.0), "mode 3; must be between 0 and 2"),
        (lambda: LogNormal(-1.0, 1.0), "median -1; must be positive"),
        (lambda: LogNormal.from_factor(1.0, 0.5), "must be above 1"),
        (lambda: TruncatedNormal(1.0, 1.0, 2.0, 1.0), "must be below the upper end"),
    ],
)
def test_invalid_distributions_are_refused(make, message):
    """requirement: one sentence with the fault."""
    with pytest.raises(ValueError, match=message):
        make()
