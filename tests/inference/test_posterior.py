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


def test_density_with_an_unknown_factor_of_the_deviations():
    """requirement: the common factor f integrated out with the prior 1/f, numerically."""
    found = line_fit()
    density = log_posterior(found.space, found.observations, line, estimated=True)
    points = found.space.internal([found.values, found.values + [0.3, -0.1], [2.0, 1.5]])
    logs = np.linspace(-12.0, 12.0, 20001)

    def integrated(values):
        squares = np.sum(((LINE @ values - found.observations.values) / 0.3) ** 2)
        of_factor = np.exp(-squares / (2 * np.exp(2 * logs)) - 6 * logs)
        prior = -(((values[0] - 1.0) / 0.2) ** 2) / 2
        return np.log(np.trapezoid(of_factor, logs)) + prior

    expected = [integrated(values) for values in found.space.values(points)]
    assert np.diff(density(points)) == pytest.approx(np.diff(expected), rel=1e-6)
    exact = Observations(LINE @ [1.0, 2.0], 0.3, ("y",) * 6)
    at = log_posterior(found.space, exact, line, True)(found.space.internal([[1.0, 2.0]]))
    assert np.isfinite(at).all()


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


def test_the_beginning_is_left_out():
    """requirement: five autocorrelation times of all walkers are no part of the sample."""
    pytest.importorskip("emcee")
    posterior = sample_posterior(line_fit(), line, steps=400, walkers=8, seed=1)
    left_out = int(5 * posterior.autocorrelation.max())
    assert 10 < left_out < 200
    assert posterior.values.shape == (8 * (400 - left_out), 2)


def test_posterior_with_estimated_deviations_is_student():
    """requirement: deviations ten times too large: quantiles of Student's t with the scatter."""
    pytest.importorskip("emcee")
    space = ParameterSpace((Parameter("a", 0.0, -50.0, 50.0), Parameter("b", 1.0, -50.0, 50.0)))
    observed = Observations([1.0, 2.9, 5.2, 6.8, 9.1, 11.3], 3.0, ("y",) * 6)
    found = fit(space, observed, FunctionModel(lambda values: LINE @ values))
    posterior = sample_posterior(found, line, steps=6000, seed=3, estimated=True)
    expected = found.scattered.intervals()
    reach = np.diff(expected)
    assert np.abs((posterior.intervals() - expected) / reach).max() < 0.05


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
