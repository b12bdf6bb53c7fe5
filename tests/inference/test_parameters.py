"""Parameters and their internal coordinates."""

import numpy as np
import pytest

from thermowear.inference import Normal, Parameter, ParameterSpace

SPACE = ParameterSpace((
    Parameter("wear.pad.coefficient", 1e-15, 1e-18, 1e-12, log=True, prior=Normal(-34.0, 0.5)),
    Parameter("wear.pad.exponent", 1.0, 0.5, 3.0, prior=Normal(1.2, 0.1)),
    Parameter("wear.disk.coefficient", 1e-16, 1e-18, 1e-12, log=True, short="k_d"),
))  # fmt: skip


def test_coordinates_and_values_are_inverse():
    """requirement: ln of logarithmic parameters, value over scale of others, for many points."""
    rng = np.random.default_rng(1)
    internal = SPACE.bounds[0] + rng.random((5, 4, 3)) * SPACE.widths
    values = SPACE.values(internal)
    assert SPACE.internal(values) == pytest.approx(internal, rel=1e-12)
    assert np.log(values[..., 0]) == pytest.approx(internal[..., 0], rel=1e-12)
    assert SPACE.scale.tolist() == [1.0, 1.25, 1.0]
    assert values[..., 1] == pytest.approx(1.25 * internal[..., 1], rel=1e-12)
    assert SPACE.contains(internal).all()
    assert not SPACE.contains(SPACE.bounds[1] + [0.0, 0.1, 0.0])


def test_admissible_values_do_not_pass_the_bounds():
    """requirement: exp(ln(bound)) is not above the bound by rounding."""
    rng = np.random.default_rng(2)
    for lower in 10 ** rng.uniform(-18, 3, 50):
        space = ParameterSpace((Parameter("k", 1.5 * lower, lower, 3 * lower, log=True),))
        ends = space.admissible(space.bounds)
        assert lower <= ends[0, 0] < ends[1, 0] <= 3 * lower
        assert ends[:, 0] == pytest.approx([lower, 3 * lower], rel=1e-13, abs=0.0)


def test_priors_are_residuals():
    """requirement: deviations of ln(value) or of the value, and their derivatives."""
    internal = SPACE.internal([np.exp(-33.0), 1.5, 1e-15])
    assert SPACE.prior_residuals(internal) == pytest.approx([2.0, 3.0], rel=1e-12)
    step = 1e-3
    moved = SPACE.prior_residuals(internal + step * np.eye(3)) - SPACE.prior_residuals(internal)
    assert SPACE.prior_jacobian == pytest.approx(moved.T / step, rel=1e-9, abs=1e-9)


def test_short_names_differ():
    """requirement: given names, or the last parts of the names that distinguish them."""
    assert SPACE.short_names == ("pad.coefficient", "exponent", "k_d")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("k", 1.0, 2.0, 3.0), "k: the start 1 is outside the bounds 2 … 3"),
        (("k", 1.0, 0.0, 3.0, True), "k: the lower bound is 0; must be positive"),
        (("k", 1.0, 3.0, 0.0), "k: the lower bound 3 is not below 0"),
        (("k", 1.0, 0.0, np.inf), "k: upper is inf; must be finite"),
    ],
)
def test_invalid_parameters_are_refused(arguments, message):
    """requirement: one sentence with the name and the fault."""
    with pytest.raises(ValueError, match=message):
        Parameter(*arguments)


def test_names_are_used_once():
    """requirement: neither names nor short names stand for two parameters."""
    k = Parameter("k", 1.0, 0.0, 3.0)
    with pytest.raises(ValueError, match="k: name of several"):
        ParameterSpace((k, k))
    with pytest.raises(ValueError, match="k: short name of several"):
        ParameterSpace((k, Parameter("a.b", 1.0, 0.0, 3.0, short="k")))
    with pytest.raises(ValueError, match="at least one"):
        ParameterSpace(())
