"""Solution of a calibration by runs with closed forms: what is told of it."""

import numpy as np
import pytest

from thermowear.calibration.case_model import CaseModel
from thermowear.calibration.problem import Problem, space_of
from thermowear.calibration.settling import suggestions
from thermowear.calibration.solution import Calibration, solve
from thermowear.case.studies.calibration import CalibrationTable
from thermowear.inference import Observations, Parameter, ParameterSpace, fit, identify

from ..inference.models import FunctionModel
from .test_case_model import LOADS, TABLE, Product, experiment


def rough_problem():
    """Problem of the product of k and mu, whose runs have time steps of their own."""
    one = experiment(deviation=1e-3, smooth=False)
    return Problem(TABLE, space_of(TABLE), list(one.measurements), [one])


def test_noise_of_rough_runs_determines_nothing():
    """requirement: k·mu is the one combination that is known, with the error of the data."""
    found = solve(rough_problem(), Product(error=1e-4))
    (combination,) = found.identifiability.combinations
    assert combination.text == "k · mu^1.00"
    assert np.prod(found.fit.values) == pytest.approx(1.0, rel=1e-3)
    assert combination.deviation == pytest.approx(1e-3 / np.sqrt(3), rel=0.02)
    assert np.isinf(list(found.standard_errors.values())).all()
    assert found.intervals()["k"] == (0.0, np.inf)
    assert found.notes()[0] == "the data do not determine k, mu one by one, but k · mu^1.00 only"


def solution(model, measured, deviations):
    """Calibration of one parameter by a function."""
    table = CalibrationTable(parameters={"a": {"key": "x", "start": 0.2, "lower": -1, "upper": 3}})
    space = ParameterSpace((Parameter("x", 0.2, -1.0, 3.0, short="a"),))
    found = fit(space, Observations(measured, deviations, ("y",) * 2), FunctionModel(model), 1e-3)
    identified = identify(space, found.jacobian)
    return Calibration(table, (), found, identified, (), None, 9, 0.1)


def test_kinks_and_large_residuals_are_noted():
    """requirement: a search that ended at a kink, and residuals of many deviations, are told."""
    kinked = solution(lambda v: np.array([max(v[0], 3 * v[0] - 2), 2 - v[0]]), [0.9, 0.75], 0.1)
    (kink,) = kinked.notes()
    assert "standard errors from the optimum by the derivatives" in kink
    smooth = solution(lambda v: np.array([v[0], 2 - v[0]]), [1.0, 1.1], 0.1)
    assert smooth.notes() == []
    (large,) = solution(lambda v: np.array([v[0], 2 - v[0]]), [1.0, 1.8], 0.1).notes()
    assert "reduced chi² 32" in large  # (0.8/0.1)²/2


def test_bounds_and_data_without_effect_are_noted():
    """requirement: by the short names of the parameters."""
    beyond = solution(lambda v: np.array([v[0], v[0]]), [4.0, 4.0], 1.0)
    assert beyond.notes() == ["a ended at a bound"]
    nothing = solution(lambda v: np.array([1.0, 2.0]), [1.0, 2.0], 0.1)
    assert nothing.notes() == ["the data do not determine a"]


@pytest.mark.parametrize("mu", [0.05, 0.3, 0.9])
def test_further_measurements_are_found_at_bounds(mu):
    """requirement: a force that changes by mu settles k·mu, also where mu is at a bound."""

    class WithForce(Product):
        def _run(self, run):
            found = super()._run(run)
            own = float(run.overrides[1].partition("=")[2])
            found.numbers["friction_force"] = 10.0 * own
            return found

    space = space_of(TABLE)
    model = CaseModel(TABLE, [experiment()], WithForce())
    found = identify(space, np.stack([LOADS, LOADS], axis=1))
    (one,) = suggestions(space, model, np.array([2.0, mu]), found)
    assert one.text == "a measurement of friction_force"
    assert one.change == pytest.approx(1.0, rel=1e-3)
