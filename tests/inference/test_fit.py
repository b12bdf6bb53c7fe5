"""Bounded weighted least squares."""

import numpy as np
import pytest
from scipy import stats

from tests.inference.models import FunctionModel, saturating
from thermowear.errors import ComputationError
from thermowear.inference import Normal, Observations, Parameter, ParameterSpace, fit

LINE = np.column_stack([np.ones(6), np.arange(6.0)])
DEVIATIONS = np.array([0.1, 0.2, 0.1, 0.3, 0.1, 0.2])
MEASURED = np.array([1.0, 2.9, 5.2, 6.8, 9.1, 11.3])
TIMES = np.linspace(1.0, 30.0, 12)


def line_space(**priors):
    return ParameterSpace((
        Parameter("a", 0.5, -10.0, 10.0, prior=priors.get("a")),
        Parameter("b", 1.0, -5.0, 5.0, prior=priors.get("b")),
    ))  # fmt: skip


def line_fit(space):
    model = FunctionModel(lambda values: LINE @ values)
    return fit(space, Observations(MEASURED, DEVIATIONS, ("y",) * 6), model)


def test_linear_least_squares_is_exact():
    """requirement: values and covariance of the normal equations, in values, with chi-squared."""
    found = line_fit(line_space())
    weighted = LINE / DEVIATIONS[:, None]
    covariance = np.linalg.inv(weighted.T @ weighted)
    exact = covariance @ weighted.T @ (MEASURED / DEVIATIONS)
    scale = found.space.scale
    assert found.values == pytest.approx(exact, rel=1e-9)
    assert found.covariance * np.outer(scale, scale) == pytest.approx(covariance, rel=1e-8)
    assert found.standard_errors == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-8)
    chi2 = np.sum(((LINE @ exact - MEASURED) / DEVIATIONS) ** 2)
    assert found.chi2 == pytest.approx(chi2, rel=1e-8)
    assert found.degrees_of_freedom == 4
    assert found.p_value == pytest.approx(stats.chi2.sf(chi2, 4), rel=1e-8)
    half = 1.959963984540054 * np.sqrt(np.diag(covariance))
    assert found.intervals() == pytest.approx(np.stack([exact - half, exact + half], 1), rel=1e-8)
    rho = covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])
    assert found.correlation[0, 1] == pytest.approx(rho, rel=1e-8)
    assert found.converged
    assert found.at_bounds == ()


def test_scatter_estimates_the_deviations():
    """requirement: covariance times the reduced chi-squared, and Student's t of n - p."""
    found = line_fit(line_space())
    deviations = found.standard_errors * np.sqrt(found.reduced_chi2)
    assert found.scatter == pytest.approx(np.sqrt(np.sum(found.residuals**2) / 4), rel=1e-12)
    half = stats.t.ppf(0.975, 4) * deviations
    assert found.scattered.standard_errors == pytest.approx(deviations, rel=1e-9)
    assert np.diff(found.scattered.intervals()).ravel() == pytest.approx(2 * half, rel=1e-9)
    model = FunctionModel(lambda values: LINE[:2] @ values)
    two = fit(line_space(), Observations(MEASURED[:2], 0.1, ("y",) * 2), model)
    assert np.isnan(two.p_value)
    with pytest.raises(ValueError, match="none is left"):
        _ = two.scattered


def test_relative_weights_of_any_size_give_the_same_fit():
    """requirement: a factor of all deviations has no effect, on the end of the search neither."""
    curve = saturating(TIMES)
    space = ParameterSpace((
        Parameter("a", 5.0, 0.1, 100.0, log=True), Parameter("b", 20.0, 0.1, 100.0, log=True)
    ))  # fmt: skip
    exact = curve(np.array([10.0, 8.0]))
    measured = exact + 0.05 * np.random.default_rng(4).standard_normal(len(TIMES))
    one, other = (
        fit(
            space,
            Observations(measured, deviation, ("d",) * 12),
            FunctionModel(curve),
            1e-3,
            estimated=True,
        )
        for deviation in (0.05, 500.0)
    )
    assert other.values == pytest.approx(one.values, rel=1e-6)
    assert other.scattered.standard_errors == pytest.approx(one.scattered.standard_errors, rel=1e-5)
    best = fit(space, Observations(measured, 0.05, ("d",) * 12), FunctionModel(curve), 1e-8)
    assert np.abs((other.internal - best.internal) / one.scattered.deviations).max() < 5e-3


def test_logarithms_give_factors():
    """requirement: one measured product: relative standard error, intervals by a factor."""
    space = ParameterSpace((Parameter("k", 1e-15, 1e-18, 1e-12, log=True),))
    observed = Observations([2e-9], [2e-10], ("depth",))
    found = fit(space, observed, FunctionModel(lambda values: values * 1e5))
    assert found.values == pytest.approx([2e-14], rel=1e-7, abs=0.0)
    assert found.standard_errors == pytest.approx([0.1], rel=1e-6)
    factor = np.exp(1.959963984540054 * 0.1)
    assert found.intervals()[0] == pytest.approx(
        [2e-14 / factor, 2e-14 * factor], rel=1e-6, abs=0.0
    )


def test_priors_are_observations():
    """requirement: a normal prior adds its information; posterior mean of normal errors."""
    found = line_fit(line_space(b=Normal(1.0, 0.05)))
    rows = np.concatenate([LINE / DEVIATIONS[:, None], [[0.0, 20.0]]])
    covariance = np.linalg.inv(rows.T @ rows)
    exact = covariance @ rows.T @ np.append(MEASURED / DEVIATIONS, 20.0)
    assert found.values == pytest.approx(exact, rel=1e-8)
    assert found.standard_errors == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-8)
    assert found.degrees_of_freedom == 5
    assert found.chi2 == pytest.approx(
        np.sum((rows @ exact - np.append(MEASURED / DEVIATIONS, 20)) ** 2)
    )


def test_a_prior_of_a_logarithm_determines_what_data_do_not():
    """requirement: k·mu measured, mu known to 20 %: deviations of mu 0.2, of k that and noise."""
    space = ParameterSpace((
        Parameter("k", 1.0, 1e-3, 1e3, log=True),
        Parameter("mu", 0.5, 0.01, 2.0, log=True, prior=Normal(np.log(0.3), 0.2)),
    ))  # fmt: skip
    observed = Observations([0.6], [0.006], ("rate",))
    found = fit(space, observed, FunctionModel(lambda values: values[:1] * values[1]))
    assert found.values == pytest.approx([2.0, 0.3], rel=1e-4)
    assert found.standard_errors == pytest.approx([np.hypot(0.2, 0.01), 0.2], rel=1e-4)


def test_undetermined_parameters_have_infinite_intervals():
    """requirement: no finite interval for k and mu if only their product is measured; c has one."""
    space = ParameterSpace((
        Parameter("k", 1.0, 1e-3, 1e3, log=True),
        Parameter("mu", 0.5, 0.01, 2.0, log=True),
        Parameter("c", 0.0, -3.0, 3.0),
    ))  # fmt: skip
    x = np.arange(5.0)
    model = FunctionModel(lambda values: values[0] * values[1] + values[2] * x)
    found = fit(space, Observations(0.6 + 0.2 * x, 0.01, ("rate",) * 5), model)
    assert np.isinf(found.standard_errors).tolist() == [True, True, False]
    assert found.intervals()[:2].tolist() == [[0.0, np.inf]] * 2
    assert np.isfinite(found.intervals()[2]).all()
    assert np.isnan(found.correlation[0]).all()
    assert found.determined == 2
    assert found.degrees_of_freedom == 3


@pytest.mark.parametrize(("start", "lower", "upper", "at"), [(1, -5, 1.5, 1.5), (4, 3, 5, 3)])
def test_active_bounds_are_named(start, lower, upper, at):
    """requirement: optimum beyond a bound: value at the bound, others the best there."""
    space = ParameterSpace((Parameter("a", 0.5, -10, 10), Parameter("b", start, lower, upper)))
    found = line_fit(space)
    weights = 1 / DEVIATIONS**2
    exact = np.sum(weights * (MEASURED - at * LINE[:, 1])) / weights.sum()
    assert found.at_bounds == ("b",)
    assert found.values == pytest.approx([exact, at], rel=1e-4)
    assert lower <= found.values[1] <= upper


def test_each_point_is_predicted_once_and_neighbours_refer_to_it():
    """requirement: one batch of p steps at each accepted point, and 2 p at the optimum."""
    truth = np.array([10.0, 8.0])
    curve = saturating(TIMES)
    model = FunctionModel(curve)
    space = ParameterSpace((
        Parameter("a", 5.0, 0.1, 100.0, log=True), Parameter("b", 20.0, 0.1, 100.0, log=True)
    ))  # fmt: skip
    found = fit(space, Observations(curve(truth), 0.5, ("depth",) * 12), model)
    assert found.values == pytest.approx(truth, rel=1e-6)
    predicted = [tuple(values) for values in model.predicted]
    assert len(predicted) == len(set(predicted))
    assert {tuple(values) for values, _ in model.calls} <= set(predicted)
    assert [count for _, count in model.calls] == [2] * (len(model.calls) - 1) + [4]
    assert found.evaluations == len(predicted) <= 12


def test_coverage_of_intervals():
    """requirement: of 200 synthetic sets, 92 to 98 % of the 95 % intervals contain the truth."""
    truth, rng = np.array([10.0, 8.0]), np.random.default_rng(20)
    curve = saturating(TIMES)
    space = ParameterSpace((
        Parameter("a", 5.0, 0.1, 100.0, log=True), Parameter("b", 20.0, 0.1, 100.0, log=True)
    ))  # fmt: skip
    known, scattered = [], []
    exact = curve(truth)
    for _ in range(200):
        measured = exact * (1 + 0.05 * rng.standard_normal(len(TIMES)))
        found = fit(space, Observations(measured, 0.05 * exact, ("d",) * 12), FunctionModel(curve))
        for held, intervals in (
            (known, found.intervals()),
            (scattered, found.scattered.intervals()),
        ):
            held.append((intervals[:, 0] <= truth) & (truth <= intervals[:, 1]))
    for held in (known, scattered):
        share = np.mean(held, axis=0)
        assert np.all((share >= 0.92) & (share <= 0.98)), share


def test_predictions_that_fail_shorten_the_step():
    """requirement: NaN away from the start is no obstacle; at the start it is an error."""
    curve = saturating(TIMES)

    def fails_far_away(values):
        return curve(values) if values[1] > 3 else np.full(len(TIMES), np.nan)

    space = ParameterSpace((
        Parameter("a", 40.0, 0.1, 100.0, log=True), Parameter("b", 60.0, 0.1, 100.0, log=True)
    ))  # fmt: skip
    observed = Observations(curve([10.0, 4.0]), 0.5, ("depth",) * 12)
    found = fit(space, observed, FunctionModel(fails_far_away))
    assert found.values == pytest.approx([10.0, 4.0], rel=1e-5)
    nothing = FunctionModel(lambda values: np.full(12, np.nan))
    with pytest.raises(ComputationError, match="at the start"):
        fit(space, observed, nothing)


def test_an_unfinished_fit_says_so():
    """requirement: not converged after the largest number of evaluations."""
    curve = saturating(TIMES)
    space = ParameterSpace((
        Parameter("a", 90.0, 0.1, 100.0, log=True), Parameter("b", 90.0, 0.1, 100.0, log=True)
    ))  # fmt: skip
    observed = Observations(curve([10.0, 4.0]), 0.5, ("depth",) * 12)
    found = fit(space, observed, FunctionModel(curve), max_evaluations=2)
    assert not found.converged
    assert "not converged" in found.message


def test_search_ends_near_the_optimum():
    """requirement: within the tolerance, in standard errors, of the optimum; fewer predictions."""
    space = ParameterSpace((Parameter("a", 2.0, 0.1, 20.0), Parameter("b", 20.0, 1.0, 50.0)))
    truth = saturating(TIMES)(np.array([5.0, 8.0]))
    noise = np.random.default_rng(3).normal(size=len(TIMES))
    observed = Observations(truth * (1 + 0.05 * noise), 0.05 * truth, ("y",) * len(TIMES))
    found = [
        fit(space, observed, FunctionModel(saturating(TIMES)), tolerance)
        for tolerance in (1e-9, 1e-2)
    ]
    best, near = found
    off = np.linalg.solve(np.linalg.cholesky(best.covariance), near.internal - best.internal)
    assert np.linalg.norm(off) < 2e-2
    assert near.converged
    assert "within the tolerance" in near.message
    assert near.evaluations < best.evaluations


@pytest.mark.parametrize("upper", [4.0, 6.0])
def test_search_ends_at_a_bound(upper):
    """requirement: the other parameters are the best for that bound."""
    space = ParameterSpace((Parameter("a", 2.0, 0.1, upper), Parameter("b", 20.0, 1.0, 50.0)))
    observed = Observations(saturating(TIMES)(np.array([9.0, 8.0])), 0.05, ("y",) * len(TIMES))
    near = fit(space, observed, FunctionModel(saturating(TIMES)), 1e-3)
    one = ParameterSpace((Parameter("b", 20.0, 1.0, 50.0),))
    held = FunctionModel(lambda values: saturating(TIMES)(np.array([upper, values[0]])))
    best = fit(one, observed, held, 1e-9)
    assert near.at_bounds == ("a",)
    assert abs(near.values[1] - best.values[0]) < 1e-2 * best.standard_errors[0]
    assert near.values[0] == pytest.approx(upper, rel=1e-3)


def test_kinks_are_told_by_the_distance():
    """requirement: the larger of two lines, whose crossing fits best: far by the derivatives."""
    space = ParameterSpace((Parameter("a", 0.2, -1.0, 3.0),))
    lines = FunctionModel(lambda v: np.array([max(v[0], 3 * v[0] - 2.0), 2.0 - v[0]]))
    kinked = fit(space, Observations([0.9, 0.75], 0.1, ("y",) * 2), lines, 1e-3)
    assert kinked.values == pytest.approx([1.0], abs=1e-2)
    assert kinked.distance > 0.2
    smooth = fit(
        line_space(),
        Observations(MEASURED, DEVIATIONS, ("y",) * 6),
        FunctionModel(lambda v: LINE @ v),
        1e-3,
    )
    assert smooth.distance < 1e-3
