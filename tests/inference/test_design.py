"""Accuracy to expect from planned measurements."""

import numpy as np
import pytest

from tests.inference.models import FunctionModel, saturating
from thermowear.inference import (
    Observations,
    Parameter,
    ParameterSpace,
    central_jacobian,
    expected_accuracy,
    fit,
)

TIMES = np.linspace(1.0, 30.0, 12)
SPACE = ParameterSpace((
    Parameter("a", 10.0, 0.1, 100.0, log=True), Parameter("b", 8.0, 0.1, 100.0)
))  # fmt: skip
TRUTH = np.array([10.0, 8.0])
LABELS = ("early",) * 4 + ("late",) * 7 + ("last",)


def planned():
    curve = saturating(TIMES)
    model, internal = FunctionModel(curve), SPACE.internal(TRUTH)
    jacobian = central_jacobian(SPACE, model, internal, curve(TRUTH))
    return expected_accuracy(SPACE, internal, jacobian, np.full(12, 0.5), LABELS)


def test_design_is_the_fit_before_it_is_made():
    """requirement: covariance and intervals of a fit to exact data at the same point."""
    curve, plan = saturating(TIMES), planned()
    found = fit(SPACE, Observations(curve(TRUTH), 0.5, LABELS), FunctionModel(curve))
    assert plan.complete.normal.covariance == pytest.approx(found.covariance, rel=1e-6)
    assert plan.complete.intervals() == pytest.approx(found.intervals(), rel=1e-6)
    assert plan.complete.standard_errors == pytest.approx(found.standard_errors, rel=1e-6)


def test_each_group_alone_and_left_out():
    """requirement: inverse of the information of the groups; information adds up."""
    plan = planned()
    information = {
        name: np.linalg.inv(accuracy.normal.covariance)
        for name, accuracy in plan.alone.items()
        if name != "last"
    }
    without_last = np.linalg.inv(plan.without["last"].normal.covariance)
    assert without_last == pytest.approx(sum(information.values()), rel=1e-8)
    assert plan.without["last"].labels == ("early", "late")
    growth = plan.without["early"].standard_errors / plan.complete.standard_errors
    assert plan.worth("early") == pytest.approx(growth, rel=1e-12)
    assert (plan.worth("early") > plan.worth("last")).all()
    assert (plan.worth("last") >= 1).all()


def test_criteria():
    """requirement: D: log determinant, A: trace of the covariance; infinite if singular."""
    plan = planned()
    covariance = plan.complete.normal.covariance
    assert plan.complete.d_criterion == pytest.approx(np.log(np.linalg.det(covariance)), rel=1e-9)
    assert plan.complete.a_criterion == pytest.approx(np.trace(covariance), rel=1e-12)
    assert plan.alone["last"].d_criterion == plan.alone["last"].a_criterion == np.inf
    assert np.isinf(plan.alone["last"].standard_errors).all()
