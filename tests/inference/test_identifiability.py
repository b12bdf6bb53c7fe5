"""Directions and combinations that data determine."""

import numpy as np
import pytest

from tests.inference.models import FunctionModel, depths
from thermowear.inference import (
    Observations,
    Parameter,
    ParameterSpace,
    central_jacobian,
    fit,
    identify,
    settling,
)

K = Parameter("wear.k", 1e-3, 1e-6, 1.0, log=True)
MU = Parameter("friction.mu", 0.3, 0.01, 1.0, log=True)
B = Parameter("wear.b", 1.0, 0.3, 3.0)


def weighted(space, function, values, deviation=0.05):
    """Jacobian with relative deviations of the predictions."""
    model = FunctionModel(function)
    values = np.asarray(values)
    predicted = function(values)
    jacobian = central_jacobian(space, model, space.internal(values), predicted)
    return jacobian / (deviation * np.abs(predicted))[:, None]


def test_coefficient_and_friction_are_one_parameter():
    """requirement: k and mu of depth ~ k mu p: a structural direction, and `k · mu^1.00`."""
    space = ParameterSpace((K, MU))
    loads = np.array([1.0, 2.0, 4.0])
    found = identify(space, weighted(space, lambda v: v[0] * v[1] * loads, [2e-3, 0.3]))
    assert found.structural.tolist() == [False, True]
    assert found.undetermined == ("wear.k", "friction.mu")
    assert np.abs(found.null[:, 0]) == pytest.approx(np.sqrt([0.5, 0.5]), rel=1e-6)
    assert found.null[0, 0] * found.null[1, 0] < 0
    (combination,) = found.combinations
    assert combination.text == "k · mu^1.00"
    assert combination.deviation == pytest.approx(0.05 / np.sqrt(3), rel=1e-6)
    assert combination.value([2e-3, 0.3]) == pytest.approx(6e-4, rel=1e-9)


def test_all_three_by_several_loads_leave_one_combination():
    """requirement: k, mu, b: b is determined by several loads, k mu^b is what remains."""
    space = ParameterSpace((K, MU, B))
    found = identify(space, weighted(space, depths([1.0, 4.0, 20.0]), [2e-3, 0.3, 1.4]))
    assert found.structural.sum() == 1
    assert found.undetermined == ("wear.k", "friction.mu")
    (combination,) = found.combinations
    assert combination.text == "k · mu^1.40"
    assert combination.coefficients == pytest.approx([1.0, 1.4, 0.0], rel=1e-6, abs=1e-9)


def test_one_load_determines_k_times_a_power_of_it():
    """requirement: k and b by one load p: `k · p^b`, whose deviation is that of the depth."""
    space = ParameterSpace((K, B))
    found = identify(space, weighted(space, lambda v: v[:1] * 20.1 ** v[1], [2e-3, 1.0]))
    assert found.structural.tolist() == [False, True]
    (combination,) = found.combinations
    assert combination.text == "k · 20.1^b"
    assert combination.deviation == pytest.approx(0.05, rel=1e-6)
    assert combination.value([2e-3, 1.0]) == pytest.approx(2e-3 * 20.1, rel=1e-6)


def test_one_load_leaves_two_directions_of_three():
    """requirement: k, mu, b by one load: one combination of all three."""
    space = ParameterSpace((K, MU, B))
    found = identify(space, weighted(space, depths([10.0]), [2e-3, 0.3, 1.4]))
    assert found.null.shape == (3, 2)
    (combination,) = found.combinations
    assert combination.text == "k · mu^1.40 · 3^b"


def test_two_loads_settle_k_and_b():
    """requirement: nothing is undetermined, and deviations are those of the line through logs."""
    space = ParameterSpace((K, B))
    loads = np.array([2.0, 20.0])
    function = depths(loads)
    rows = weighted(space, lambda v: function([v[0], 1.0, v[1]]), [2e-3, 1.4])
    found = identify(space, rows)
    assert found.identified
    assert found.combinations == ()
    deviation = 0.05 * np.sqrt(2) / np.log(10.0)
    assert found.normal.standard_errors[1] == pytest.approx(deviation, rel=1e-6)


def test_close_loads_are_practically_not_enough():
    """requirement: loads that differ by 1 % determine b less than its bounds do."""
    space = ParameterSpace((K, B))
    function = depths([20.0, 20.2])
    found = identify(space, weighted(space, lambda v: function([v[0], 1.0, v[1]]), [2e-3, 1.4]))
    assert found.practical.tolist() == [False, True]
    assert not found.structural.any()
    assert found.combinations[0].text == "k · 20.1^b"


def test_small_exponents_are_kept():
    """requirement: a factor of mu^0.20, which changes by 27 % within the bounds, is named."""
    space = ParameterSpace((K, Parameter("friction.mu", 0.5, 0.3, 1.0, log=True)))
    found = identify(space, weighted(space, lambda v: v[:1] * v[1] ** 0.2, [2e-3, 0.5]))
    assert [combination.text for combination in found.combinations] == ["k · mu^0.20"]


@pytest.mark.parametrize(("deviation", "practical"), [(3.9, False), (4.1, True)])
def test_parameters_are_determined_within_their_bounds(deviation, practical):
    """requirement: a deviation below the distance of the bounds, 4, is that of a parameter."""
    space = ParameterSpace((Parameter("x", 1.0, -1.0, 3.0),))
    found = identify(space, space.scale[None] / deviation)
    assert found.practical.tolist() == [practical]
    assert not found.structural.any()


def test_independent_pairs_have_a_combination_each():
    """requirement: two products of two parameters, not mixed with each other."""
    names = ("one.k", "one.mu", "two.k", "two.mu")
    space = ParameterSpace(tuple(Parameter(name, 1.0, 0.1, 10.0, log=True) for name in names))
    function = lambda v: np.array([v[0] * v[1], v[2] * v[3] ** 2, v[0] * v[1] * 3])  # noqa: E731
    found = identify(space, weighted(space, function, [2.0, 3.0, 4.0, 5.0]))
    texts = [combination.text for combination in found.combinations]
    assert texts == ["one.k · one.mu^1.00", "two.k · two.mu^2.00"]


def test_linear_parameters_are_summed():
    """requirement: x + 2 y measured: `x + 2.00 y` with its deviation in its own unit."""
    space = ParameterSpace((Parameter("x", 1.0, 0.0, 10.0), Parameter("y", 1.0, 0.0, 3.0)))
    rows = weighted(space, lambda v: np.array([v[0] + 2 * v[1]]), [1.0, 2.0], deviation=0.1)
    (combination,) = identify(space, rows).combinations
    assert combination.text == "x + 2.00 y"
    assert combination.deviation == pytest.approx(0.5, rel=1e-6)
    assert combination.value([1.0, 2.0]) == pytest.approx(5.0, rel=1e-9)


def test_without_any_effect_there_is_no_combination():
    """requirement: a parameter that nothing depends on is undetermined alone."""
    space = ParameterSpace((K, MU))
    found = identify(space, weighted(space, lambda v: v[:1] * np.ones(3), [2e-3, 0.3]))
    assert found.undetermined == ("friction.mu",)
    assert found.combinations == ()
    assert identify(space, np.zeros((3, 2))).undetermined == ("wear.k", "friction.mu")


def test_small_couplings_do_not_take_part():
    """requirement: c measured apart from 0.2 % of k is determined, k and b are not."""
    space = ParameterSpace((K, B, Parameter("wear.c", 1.0, 0.1, 10.0, log=True)))

    def function(values):
        k, b, c = values
        return np.array([k * 20.0**b, k + c, k + c])

    found = identify(space, weighted(space, function, [2e-3, 1.4, 1.0]))
    assert found.structural.tolist() == [False, False, True]
    assert 1e-3 < abs(found.null[2, 0]) < 3e-3
    assert found.undetermined == ("wear.k", "wear.b")
    assert [combination.text for combination in found.combinations] == ["k · 20^b"]
    assert found.normal.standard_errors[2] == pytest.approx(0.05 / np.sqrt(2), rel=1e-2)


def test_noise_of_differences_does_not_identify():
    """requirement: predictions with relative noise 1e-10, steps 1e-4: noise below the tolerance."""
    space = ParameterSpace((K, MU))
    rng = np.random.default_rng(3)
    loads = np.array([1.0, 2.0, 4.0])

    def noisy(values):
        return values[0] * values[1] * loads * (1 + 1e-10 * rng.standard_normal(3))

    found = identify(space, weighted(space, noisy, [2e-3, 0.3]))
    assert found.structural.tolist() == [False, True]
    observed = Observations(6e-4 * loads, 3e-5 * loads, ("depth",) * 3)
    fitted = fit(space, observed, FunctionModel(noisy))
    assert np.isinf(fitted.standard_errors).all()


def test_further_measurements_are_ranked():
    """requirement: along k·mu = const, the friction force changes by mu, a depth not at all."""
    space = ParameterSpace((K, MU))
    found = identify(space, weighted(space, lambda v: v[:1] * v[1], [2e-3, 0.3]))
    candidates = {
        "depth": (np.array([6e-4]), np.array([[6e-4, 6e-4]])),
        "friction force": (np.array([30.0, 60.0]), np.array([[0.0, 30.0], [0.0, 60.0]])),
        "zero": (np.zeros(1), np.zeros((1, 2))),
    }
    first, *others = settling(found.null[:, 0], candidates)
    assert first.name == "friction force"
    assert first.change == pytest.approx(1.0, rel=1e-6)
    assert max(other.change for other in others) < 1e-6


def test_equal_candidates_keep_their_order():
    """requirement: the rank of measurements does not hang on the last bit of their changes."""
    sizes = {"force": 1.0, "torque": 1.0 - 1e-6, "power": 1.0 + 1e-6, "mass": 0.5, "heat": 2.0}
    candidates = {name: (np.ones(1), np.array([[size, 0.0]])) for name, size in sizes.items()}
    ranked = [one.name for one in settling(np.array([1.0, -1.0]), candidates)]
    assert ranked == ["heat", "force", "torque", "power", "mass"]
