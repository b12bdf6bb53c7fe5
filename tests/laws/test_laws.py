"""Laws of the interface: values, derivatives, laws from Python, and their checks."""

from __future__ import annotations

import numpy as np
import pytest

from thermowear.case.values.units import expression
from thermowear.errors import CaseError, ComputationError
from thermowear.laws import LocalState, PowerWear
from thermowear.laws.formulas import (
    FormulaLaw,
    FormulaWear,
    interface_law,
    require_interface_law,
    require_wear_rate,
    wear_rate,
)
from thermowear.laws.interfaces import (
    Constant,
    Multiplied,
    Multipliers,
    PressureConductance,
    Table1D,
    harmonic_mean,
    registered_laws,
)

P = np.array([1e5, 2e6, 7e6, 3e7])
V = np.array([0.05, 0.2, 0.5, 1.0])
T = np.array([300.0, 350.0, 400.0, 500.0])
STATE = LocalState(P, V, T)
FALLS = Table1D((293.15, 493.15), (1.0, 0.5))
HARD = Table1D((1e6, 5e6, 9e6), (1.0, 2.0, 1.5))


def written(text, unit="", variables=("p", "v", "T")):
    return expression(text, unit, variables)


def wear_text(text):
    return FormulaWear(expression(text, "m/s", ("p", "v", "T", "depth", "mu")))


def energy(p, v, mu):
    return 2e-13 * np.maximum(mu * p * v - 1e4, 0.0)


INTERFACE = {
    "constant": Constant(0.3),
    "multiplied": Multiplied(
        Constant(0.3), Multipliers({"T": FALLS, "p": HARD, "v": Table1D((0.0,), (0.9,))})
    ),
    "multiplied expression": Multiplied(
        FormulaLaw(written("0.3 + p/(1 GPa)")), Multipliers({"p": HARD})
    ),
    "by pressure": PressureConductance(2e4, np.full(4, 40.0), np.full(4, 2e9)),
    "table": Multipliers({"p": Table1D((1e6, 1e7), (1e3, 5e3))}),
    "expression": FormulaLaw(written("0.1 + 0.2*exp(-p/(5 MPa))*(T/(300 K))")),
    "function": interface_law(lambda p, T: 0.1 + 0.2 * np.exp(-p / 5e6) * T / 300),
    "stribeck": registered_laws("friction")["stribeck"](0.35, 0.1, 0.5),
}
WEAR = {
    "power": PowerWear(1e-13, 1.3, 0.7),
    "expression": wear_text("1e-13/Pa*p*v*(1 + exp(-depth/(1 um)))*(T/(300 K))^0.5"),
    "function": wear_rate(lambda p, v, T: 1e-13 * p * v * np.sqrt(T / 300)),
    "energy": registered_laws("wear")["energy"](2e-13, 1e4),
    "function of mu": wear_rate(energy),
}


@pytest.mark.parametrize("law", INTERFACE.values(), ids=INTERFACE.keys())
def test_slopes_of_coefficients_are_their_derivatives(law):
    """requirement: every law has its derivative by the pressure."""
    h = 1e-6 * P
    above, below = (law.value(STATE._replace(p=P + step)) for step in (h, -h))
    np.testing.assert_allclose(law.slope(STATE), (above - below) / (2 * h), rtol=1e-6, atol=1e-20)
    assert law.value(STATE).shape == P.shape
    assert law.variables <= {"p", "v", "T"}


@pytest.mark.parametrize("law", WEAR.values(), ids=WEAR.keys())
def test_slopes_of_wear_rates_are_their_derivatives(law):
    """requirement: every law has its derivative by the pressure, finite without pressure."""
    h, state = 1e-6 * P, STATE._replace(depth=np.full(4, 2e-6), mu=np.full(4, 0.3))
    above, below = (law.value(state._replace(p=P + step)) for step in (h, -h))
    np.testing.assert_allclose(law.slope(state), (above - below) / (2 * h), rtol=1e-6, atol=1e-30)
    assert np.all(law.value(state._replace(p=-P)) == 0.0)
    assert np.all(np.isfinite(law.slope(state._replace(p=np.zeros(4)))))


def test_laws_by_hand():
    """requirement: energy above a threshold, Stribeck, harmonic means, the factors of tables."""
    law = registered_laws("wear")["energy"](2e-13, 1e4)
    state = LocalState(np.array([1e5, 1e6]), 0.2, mu=0.25)
    assert law.value(state) == pytest.approx([0.0, 2e-13 * 4e4], rel=1e-9, abs=0.0)
    np.testing.assert_allclose(wear_rate(energy).value(state), [0.0, 2e-13 * 4e4], rtol=1e-9)
    friction = registered_laws("friction")["stribeck"](0.35, 0.1, 0.5)
    assert friction.value(state._replace(v=0.5)) == pytest.approx(0.1 + 0.25 / np.e)
    assert harmonic_mean(10.0, 40.0) == pytest.approx(16.0)
    factors = Multipliers({"T": FALLS, "p": HARD})
    assert factors.variables == {"T", "p"}
    state = LocalState(np.array([3e6]), 0.1, np.array([393.15]))
    assert factors.value(state) == pytest.approx([0.75 * 1.5])


@pytest.mark.parametrize(
    "function",
    [lambda p: 0.2 + 0.1 * abs(p) / 1e7, lambda p: 0.2 + 0.1 * np.minimum(p, 5e6) / 1e7,
     lambda p: np.where(p > 5e6, 0.3, 0.2 + p / 1e8),
     lambda p: 0.2 + 0.01 * np.interp(p, [0, 1e8], [0, 1])],
    ids=["abs", "minimum", "where", "interp"],
)  # fmt: skip
def test_functions_that_drop_the_imaginary_part_have_their_derivative_by_differences(function):
    """requirement: a complex step is taken only where it is right."""
    law, h = interface_law(function), 1e-4 * P
    due = (function(P + h) - function(P - h)) / (2 * h)
    np.testing.assert_allclose(law.slope(STATE), due, rtol=1e-6, atol=1e-20)


def test_a_smooth_function_has_its_derivative_to_rounding():
    """requirement: complex step, not differences, where the function takes it."""
    law = interface_law(lambda p: 0.2 + 0.1 * np.exp(-p / 5e6))
    np.testing.assert_allclose(law.slope(STATE), -2e-8 * np.exp(-P / 5e6), rtol=1e-13)


@pytest.mark.parametrize(
    ("function", "text"),
    [(lambda q: q, "parameter 'q'; known: p, v, T"), (lambda p: p[:2], "returned the shape (2,)"),
     (lambda p: "0.3", "must take and return arrays"), (lambda p: None, "must take and return")],
)  # fmt: skip
def test_functions_that_are_no_laws_are_refused(function, text):
    """requirement: shapes and types are checked; the message names the law."""
    with pytest.raises(CaseError, match="law") as caught:
        interface_law(function).value(STATE)
    assert text in str(caught.value)


BAD_WEAR = [
    ("1e-9 m/s*(1 - p/(1 GPa))", "must be finite and at least 0"),
    ("1e-13/Pa*v*p*exp(-p/(10 MPa))", "decreases with increasing pressure at p ="),
    ("1e-13/Pa*v*p/(1 - depth/(10 mm))", "must be finite"),
    ("1e-13/Pa*p*(v - 1 mm/s)", "must be finite and at least 0"),
    ("1e-13/Pa^2*p^2*v*log(p/(1 Pa))", "must be finite"),
    ("1e-9 m/s", "wear without pressure"),
    ("1e-13/Pa*p*v*exp(p/(1 MPa))", "must be finite"),
    ("0 m/s", "is 0 at all pressures"),
]


@pytest.mark.parametrize(("text", "what"), BAD_WEAR)
def test_wear_rates_that_no_contact_can_have_are_refused(text, what):
    """requirement: B9; negative, infinite, or falling as the pressure rises."""
    with pytest.raises(ValueError, match=r".") as caught:
        require_wear_rate(wear_text(text))
    assert what in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("law", WEAR.values(), ids=WEAR.keys())
def test_the_wear_rates_of_this_file_are_accepted(law):
    """requirement: growing rates, with thresholds and depths too."""
    require_wear_rate(law)


@pytest.mark.parametrize(
    ("text", "what"),
    [("0.1 + 0.01 m/s/v", "must be finite"), ("0.3 - p/(1 MPa)", "must be greater than 0"),
     ("log(p/(1 Pa))", "must be finite"), ("0.3/(T/(500 K) - 1)", "must be finite")],
)  # fmt: skip
def test_coefficients_that_no_contact_can_have_are_refused(text, what):
    """requirement: B9; division by zero on the plausible range, not positive."""
    with pytest.raises(ValueError, match=what):
        require_interface_law(FormulaLaw(written(text)))


def test_a_law_that_fails_at_a_point_says_where():
    """requirement: one line with the state at which the rate is not a number."""
    law = wear_rate(lambda p, v: 1e-13 * p * v)
    broken = FormulaWear(law.formula.of(lambda p, T: p * np.log(T - 400), ("p", "T")), "my law")
    with pytest.raises(ComputationError, match=r"^my law: nan at p = 1e\+05 Pa, v = 0.05 m/s"):
        broken.value(STATE)
