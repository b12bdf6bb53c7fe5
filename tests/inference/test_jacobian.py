"""Finite differences in internal coordinates."""

import numpy as np
import pytest
from scipy import optimize

from tests.inference.models import FunctionModel, depths
from thermowear.errors import ComputationError
from thermowear.inference import Parameter, ParameterSpace, central_jacobian, forward_jacobian
from thermowear.inference.fit import distance_to_optimum, principal_directions

SPACE = ParameterSpace((
    Parameter("k", 1e-3, 1e-6, 1.0, log=True),
    Parameter("mu", 0.3, 0.01, 1.0, log=True),
    Parameter("b", 1.0, 0.3, 3.0),
))  # fmt: skip
LOADS = np.array([1.5, 5.0])


def exact(values):
    """Derivatives with respect to ln k, ln mu and b/scale."""
    h = depths(LOADS)(values)
    factors = np.stack(
        [np.ones(2), np.full(2, values[2]), SPACE.scale[2] * np.log(values[1] * LOADS)]
    )
    return (h * factors).T


@pytest.mark.parametrize(
    "values",
    [(2e-3, 0.3, 1.4), (1e-6, 1.0, 3.0), (1.0, 0.01, 0.3)],
    ids=["inside", "ends", "others"],
)
def test_differences_of_first_and_second_order(values):
    """requirement: errors of first and second order in the step, also at bounds."""
    values = np.array(values)
    errors = {}
    for way in (forward_jacobian, central_jacobian):
        for step in (1e-3, 2e-3):
            model = FunctionModel(depths(LOADS), step)
            found = way(SPACE, model, SPACE.internal(values), model.function(values))
            errors[way, step] = np.abs(found / exact(values) - 1).max()
    assert errors[forward_jacobian, 1e-3] < 1e-2
    assert errors[central_jacobian, 1e-3] < 1e-4
    ratios = [errors[way, 2e-3] / errors[way, 1e-3] for way in (forward_jacobian, central_jacobian)]
    assert ratios == pytest.approx([2, 4], rel=0.1)


@pytest.mark.parametrize("end", [0, 1])
def test_steps_stay_inside(end):
    """requirement: no point beyond the bounds, and all belong to the point itself."""
    lower, upper = SPACE.limits
    seen = []

    def function(values):
        seen.append(values)
        return depths(LOADS)(values)

    model = FunctionModel(function, step=0.9)
    at = SPACE.bounds[end]
    central_jacobian(SPACE, model, at, depths(LOADS)(SPACE.admissible(at)))
    assert np.all((np.array(seen) >= lower) & (np.array(seen) <= upper))
    assert len(model.calls) == 1
    assert model.calls[0][1] == 6


def test_failed_neighbours_are_named():
    """requirement: an error with the parameter whose step could not be computed."""
    start = np.array([2e-3, 0.3, 1.4])

    def fails(values):
        return np.full(2, np.nan if values[2] > 1.4 + 1e-9 else 1.0)

    with pytest.raises(ComputationError, match="respect to b: predictions"):
        forward_jacobian(SPACE, FunctionModel(fails), SPACE.internal(start), np.ones(2))


def test_directions_of_few_observations_are_complete():
    """requirement: p orthonormal directions for fewer rows than parameters."""
    singular_values, directions = principal_directions(np.array([[3.0, 0.0, 4.0]]))
    assert singular_values == pytest.approx([5.0, 0.0, 0.0], abs=1e-15)
    assert directions.T @ directions == pytest.approx(np.eye(3), abs=1e-14)
    assert np.abs(directions[:, 0]) == pytest.approx([0.6, 0.0, 0.8], abs=1e-14)


def distance(jacobian, bounds, at, optimum):
    """Distance of a point from the unbounded optimum of a linear model, and the exact one.

    The exact one is that of the optimum within the bounds, in standard errors.
    """
    space = ParameterSpace(tuple(
        Parameter(f"p{k}", 0.5 * (low + high), low, high, log=False)
        for k, (low, high) in enumerate(bounds)
    ))  # fmt: skip
    rows = jacobian * space.scale
    internal, best = space.internal(at), space.internal(optimum)
    inside = optimize.lsq_linear(rows, rows @ best, space.bounds, tol=1e-14).x
    residuals = rows @ (internal - best)
    found = distance_to_optimum(space, internal, rows, residuals, 1e-9)
    return found, np.linalg.norm(rows @ (internal - inside))


def test_distance_of_a_linear_model_is_exact():
    """requirement: the length of the step to the optimum, by its change of the predictions."""
    jacobian = np.array([[3.0, 1.0], [1.0, -2.0], [0.5, 4.0]])
    found, exact = distance(jacobian, [(-2.0, 4.0), (-3.0, 5.0)], [0.5, 1.0], [1.2, 0.3])
    assert found == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize(
    ("at", "optimum"), [(0.0004, -3.0), (0.0, -3.0), (0.0, 0.2), (0.9996, 3.0)]
)
def test_distance_near_bounds(at, optimum):
    """requirement: to the bound where it holds a parameter, beside the step of the others."""
    jacobian = np.array([[300.0, 1.0], [-100.0, 3.0], [0.0, 4.0]])  # orthogonal columns
    found, exact = distance(jacobian, [(0.0, 1.0), (-9.0, 9.0)], [at, 1.0], [optimum, 1.01])
    assert found == pytest.approx(exact, rel=1e-6)
