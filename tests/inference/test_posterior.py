"""Posterior distribution by an ensemble sampler."""

import sys

import numpy as np
import pytest

from tests.inference.models import FunctionModel
from thermowear.errors import ComputationError
from thermowear.inference import (
    Normal,
    Observations,
    Parameter,
    ParameterSpace,
    Posterior,
    fit,
    log_posterior,
    sample_posterior,
)

LINE = np.column_stack([np.ones(6), np.arange(6.0)])


def line(points):
    return [LINE @ values for values in points]


def line_fit(upper=5.0):
    space = ParameterSpace((
        Parameter("a", 0.5, -10.0, 10.0, prior=Normal(1.0, 0.2)), Parameter("b", 1.0, -5.0, upper)
    ))  # fmt: skip
    observed = Observations([1.0, 2.9, 5.2, 6.8, 9.1, 11.3], 0.3, ("y",) * 6)
    return fit(space, observed, FunctionModel(lambda values: LINE @ values))


def test_density_of_batches():
    """requirement: half the sum of squares with priors; zero probability outside and on failure."""
    found = line_fit()
    batches = []

    def predictions(points):
        batches.append(len(points))
        return [np.full(6, np.nan) if values[0] > 5 else LINE @ values for values in points]

    density = log_posterior(found.space, found.observations, predictions)
    points = found.space.internal([found.values, [20.0, 2.0], [6.0, 2.0]])
    assert density(points) == pytest.approx([-found.chi2 / 2, -np.inf, -np.inf])
    assert density(points[1:2]) == pytest.approx([-np.inf])
    assert batches == [2]


def test_short_chains_are_reported():
    """requirement: a sentence if there are fewer than 50 autocorrelation times."""
    space = line_fit().space
    short = Posterior(space, np.zeros((4, 2)), 0.3, np.array([30.0, 40.0]), 1000)
    assert "1000 steps are less than 50 autocorrelation times of 40 steps" in short.warning
    assert Posterior(space, np.zeros((4, 2)), 0.3, np.array([10.0, 20.0]), 1000).warning == ""


def test_without_the_package(monkeypatch):
    """requirement: one sentence that says what to install."""
    monkeypatch.setitem(sys.modules, "emcee", None)
    with pytest.raises(ComputationError, match="needs the package emcee: install"):
        sample_posterior(line_fit(), line)


def test_posterior_of_a_linear_model_is_normal():
    """requirement: mean and covariance of the closed form, repeatable by the seed."""
    pytest.importorskip("emcee")
    found = line_fit()
    posterior = sample_posterior(found, line, steps=3000, seed=3)
    assert posterior.warning == ""
    assert 0.2 < posterior.acceptance < 0.9
    deviations = found.standard_errors
    assert np.abs(posterior.values.mean(axis=0) - found.values).max() < 0.05 * deviations.max()
    assert posterior.values.std(axis=0) == pytest.approx(deviations, rel=0.05)
    correlation = np.corrcoef(posterior.values.T)[0, 1]
    assert correlation == pytest.approx(found.correlation[0, 1], abs=0.02)
    reach = np.diff(found.intervals()).ravel()
    assert np.abs(posterior.intervals() - found.intervals()).max(axis=1) == pytest.approx(
        0, abs=0.04 * reach.max()
    )
    again = sample_posterior(found, line, steps=20, seed=3).values
    assert np.array_equal(again, sample_posterior(found, line, steps=20, seed=3).values)


def test_posterior_ends_at_bounds():
    """requirement: half a normal distribution where a bound cuts it at its peak."""
    pytest.importorskip("emcee")
    space = ParameterSpace((Parameter("a", 0.5, 0.0, 10.0),))
    found = fit(space, Observations([0.0], 0.1, ("y",)), FunctionModel(lambda values: values))
    posterior = sample_posterior(found, lambda points: points, steps=4000, seed=2)
    assert posterior.values.min() >= 0
    assert posterior.values.mean() == pytest.approx(0.1 * np.sqrt(2 / np.pi), rel=0.05)


def test_walkers_spread_along_undetermined_directions():
    """requirement: uniform between the bounds where the data say nothing."""
    pytest.importorskip("emcee")
    space = ParameterSpace((
        Parameter("k", 1.0, 0.1, 10.0, log=True), Parameter("mu", 1.0, 0.1, 10.0, log=True)
    ))  # fmt: skip
    model = FunctionModel(lambda values: values[:1] * values[1])
    found = fit(space, Observations([1.0], 0.05, ("y",)), model)
    posterior = sample_posterior(found, lambda p: [v[:1] * v[1] for v in p], steps=4000, seed=2)
    low, high = posterior.intervals()[0]
    assert low < 0.15
    assert high > 6
