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


def solution(model, measured, deviations, given="known"):
    """Calibration of one parameter by a function."""
    parameter = {"key": "x", "start": 0.2, "lower": -1, "upper": 3}
    table = CalibrationTable(parameters={"a": parameter}, deviations=given)
    space = ParameterSpace((Parameter("x", 0.2, -1.0, 3.0, short="a"),))
    found = fit(
        space,
        Observations(measured, deviations, ("y",) * 2),
        FunctionModel(model),
        1e-3,
        estimated=given == "estimated",
    )
    factor = found.scatter if given == "estimated" else 1.0
    identified = identify(space, found.jacobian / factor)
    return Calibration(table, (), found, identified, (), None, 9, 0.1)


def test_kinks_and_large_residuals_are_noted():
    """requirement: a search that ended at a kink, and residuals of many deviations, are told."""
    corner = lambda v: np.array([max(v[0], 3 * v[0] - 2), 2 - v[0]])  # noqa: E731
    for size, given in ((0.1, "known"), (1e-3, "estimated"), (1e3, "estimated")):
        (kink,) = solution(corner, [0.9, 0.75], size, given).notes()
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
    """requirement: a force that changes by mu settles k·mu, also where mu is at a bound.

    The volume, which is k·mu itself, does not, and neither does a torque of rounding errors.
    """

    class WithForce(Product):
        def _run(self, run):
            found = super()._run(run)
            k, own = (float(change.partition("=")[2]) for change in run.overrides)
            found.numbers["friction_force"] = 10.0 * own
            found.numbers["friction_torque"] = 1.0 + 1e-4 * self.random.standard_normal()
            found.numbers["wear_volume_1"] = 1e-9 * k * own
            return found

    space = space_of(TABLE)
    model = CaseModel(TABLE, [experiment()], WithForce())
    found = identify(space, np.stack([LOADS, LOADS], axis=1))
    (one,) = suggestions(space, model, np.array([2.0, mu]), found)
    assert one.text == "a measurement of friction_force"
    assert one.change == pytest.approx(1.0, rel=1e-3)
