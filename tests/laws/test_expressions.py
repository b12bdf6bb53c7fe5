"""Expressions with units."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermowear.case.values.units import expression

from ..conftest import examples

FRICTION = ("", ("p", "v", "T"))
WEAR = ("m/s", ("p", "v", "T", "depth", "mu"))
STRIBECK = "0.1 + 0.25*exp(-v/(0.5 m/s))"


def friction(text):
    return expression(text, *FRICTION)


def at(p=2e6, v=0.3, T=350.0):
    return {"p": np.array([p]), "v": np.array([v]), "T": np.array([T])}


GOOD = [
    (STRIBECK, 0.1 + 0.25 * math.exp(-0.6)),
    ("0.32 - 2e-4*(T - 293.15 K)/(1 K)", 0.32 - 2e-4 * 56.85),
    ("0.32 - 2e-4/K*(T - 293.15 K)", 0.32 - 2e-4 * 56.85),
    ("0.32 - 2e-4 1/K * (T - 293.15 K)", 0.32 - 2e-4 * 56.85),
    ("p / 1 MPa", 2.0),
    ("(p/(1 MPa))^-0.5", 2**-0.5),
    ("-2^2 + 5", 1.0),
    ("2^3^2 / 512", 1.0),
    ("2**-1", 0.5),
    ("1 - -1", 2.0),
    ("min(0.3, p/(4 MPa), 7)", 0.3),
    ("max(0.3, p/(4 MPa))", 0.5),
    ("sqrt(p*(8 MPa))/(1 MPa)", 4.0),
    ("abs(-0.4)", 0.4),
    ("log(v/(0.3 m/s)) + log10(100) + sin(0) + cos(0) + tanh(0)", 3.0),
    ("p^2/(1 MPa^2)", 4.0),
    ("p^0.5/(1 MPa^(1/2))", 2**0.5),
    ("5 min/(300 s)", 1.0),
    ("v*(1000 W/(m^2 K))*(2 m^2 K/W)/(600 m/s)", 1.0),
    ("30 deg", math.pi / 6),
    ("p*v/(6e5 W/m^2)", 1.0),
    ("((((0.2))))", 0.2),
    ("(v/(1 m/s))^(p/(2 MPa))", 0.3),
]


@pytest.mark.parametrize(("text", "value"), GOOD)
def test_expressions_have_the_value_that_is_written(text, value):
    """requirement: units as in the case file, precedence as in Python, by hand."""
    assert friction(text).value(at())[0] == pytest.approx(value, rel=1e-12)


BAD = [
    ("__import__('os')", "character 12", '"\'" cannot stand'),
    ("p.real", "character 2", "'.' cannot stand"),
    ("p.__class__", "character 2", "'.' cannot stand"),
    ("__import__(2)", "character 1", "'__import__' is not a function; known: exp, log"),
    ("eval(0.3)", "character 1", "'eval' is not a function"),
    ("open", "character 1", "'open' is not a variable; known: p, v, T"),
    ("0.1 + 0.25*foo(v)", "character 12", "'foo' is not a function"),
    ("lambda: 1", "character 7", "':' cannot stand"),
    ("[1, 2]", "character 1", "'[' cannot stand"),
    ("p if v else T", "character 3", "needs an operator"),
    ("9^9^9^9", "character 5", "exponent is at most 100"),
    ("9**9**9", "character 4", "exponent is at most 100"),
    ("(9^99)^99", "character 1", "not a finite number"),
    ("1e999", "character 1", "must be finite"),
    ("1e300 Pm", "character 1", "finite in SI"),
    ("p", "character 1", "the value has the unit kg/(m s^2); needs a dimensionless number"),
    ("0.3 + p", "character 5", "'+' between the units 1 and kg/(m s^2)"),
    ("0.3 - 0.2 m", "character 5", "'-' between the units 1 and m"),
    ("exp(-v/0.5)", "character 5", "argument of exp must be dimensionless, found m/s"),
    ("exp(-v/0.5 m/s)", "character 8", "needs parentheses"),
    ("0.32 - 2e-4*(T - 20 degC)/(1 K)", "character 21", "'degC' is a scale with an offset"),
    ("T/(3 dB)", "character 6", "scale with an offset"),
    ("T/(68 degF)", "character 7", "write temperatures in K: 293.15 K"),
    ("p/(1 foo)", "character 6", "'foo' is not a unit"),
    ("p/(1 Mpa)", "character 6", "'Mpa' is not a unit, perhaps MPa"),
    ("p/(1 MPa^9^9)", "character 11", "needs parentheses"),
    ("p/(1 MPa^v)", "character 9", "exponent of a unit must be a number"),
    ("MPa", "character 1", "a unit needs a number before it"),
    ("depth", "character 1", "'depth' is not a variable"),
    ("1/0", "character 1", "not a finite number"),
    ("log(0)", "character 1", "not a finite number"),
    ("sqrt(-1)", "character 1", "not a finite number"),
    ("nan", "character 1", "'nan' is not a variable"),
    ("inf", "character 1", "'inf' is not a variable"),
    ("3 inf", "character 3", "'inf' is not a unit"),
    ("(0.3", "character 1", "'(' is not closed"),
    ("0.3)", "character 4", "')' closes no parenthesis"),
    ("exp(v/(1 m/s)", "character 4", "'(' is not closed"),
    ("0.3 +", "character 6", "ends too early"),
    ("* 0.3", "character 1", "found '*'"),
    ("()", "character 2", "ends too early"),
    ("0.3 0.2", "character 5", "needs an operator"),
    ("1.2.3", "character 4", "needs an operator"),
    ("1_000", "character 2", "'_000' is not a unit"),
    ("0,3", "character 2", "found ','"),
    ("p(2)", "character 1", "is a variable, not a function"),
    ("exp", "character 1", "is a function; its argument is missing"),
    ("exp()", "character 5", "ends too early"),
    ("exp(1, 2)", "character 1", "exp has one argument"),
    ("max(1)", "character 1", "at least two arguments"),
    ("max(p, 0)", "character 8", "max of the units kg/(m s^2) and 1"),
    ("p^v", "character 3", "exponent must be dimensionless"),
    ("p^(v/(1 m/s))", "character 1", "must be of something dimensionless"),
    ("р/(1 MPa)", "character 1", "U+0440"),
    ("0.3 × 2", "character 5", "U+00D7"),
    ("", "is empty", ""),
    ("   ", "is empty", ""),
    ("0.3\x00", "character 4", "cannot stand"),
    ("1" * 10_000, "has 10000 characters", "at most 1000"),
    ("(" * 200 + "1" + ")" * 200, "character 32", "at most 30"),
    ("-" * 500 + "1", "character 32", "at most 30"),
    ("2" + "^1" * 400, "at most 30", ""),
    ("abs(" * 240 + "1", "at most 30", ""),
]  # fmt: skip


@pytest.mark.parametrize(("text", "where", "what"), BAD, ids=[bad[0][:20] for bad in BAD])
def test_a_malformed_or_hostile_expression_is_answered_by_one_line(text, where, what):
    """requirement: B9; never evaluated by Python, no depth or power that takes long."""
    with pytest.raises(ValueError, match=re.escape(where)) as caught:
        friction(text)
    message = str(caught.value)
    assert what in message
    assert "\n" not in message
    assert len(message) < 300


def test_a_long_expression_is_evaluated():
    """requirement: what is accepted is evaluated, however it is made up."""
    text = "+".join(["1"] * 498) + "+v/v"
    assert friction(text).value(at())[0] == 499.0


def test_a_wear_rate_in_all_of_its_variables():
    """requirement: energy law with a threshold that falls as depth grows, by hand."""
    text = "2e-12 m^3/J * max(mu*p*v - 1e4 W/m^2 * exp(-depth/(1 um)), 0 W/m^2)"
    law = expression(text, *WEAR)
    values = {name: np.array([x]) for name, x in
              [("p", 3e6), ("v", 0.1), ("T", 300.0), ("depth", 2e-6), ("mu", 0.25)]}  # fmt: skip
    assert law.variables == {"p", "v", "depth", "mu"}
    due = 2e-12 * (7.5e4 - 1e4 * math.exp(-2))
    assert law.value(values)[0] == pytest.approx(due, rel=1e-12, abs=0.0)
    assert law.slope(values, "p")[0] == pytest.approx(2e-12 * 0.25 * 0.1, rel=1e-12, abs=0.0)
    assert law.slope(values, "depth")[0] == pytest.approx(2e-2 * math.exp(-2), rel=1e-12, abs=0.0)
    assert law.slope(values, "T")[0] == 0.0


@pytest.mark.parametrize("text", ["p^0.5*v^0.5/(1 W^0.5/m)", "abs(v/(1 m/s))", "sqrt(v/(1 m/s))"])
def test_an_infinite_slope_in_another_variable_is_not_seen(text):
    """requirement: derivative by p where v is 0 and the slope by v infinite."""
    assert friction(text).slope(at(v=0.0), "p")[0] == 0.0


def variables(x):
    return st.sampled_from([("(p/(1 Pa))", "p"), ("(v/(1 m/s))", "v"), ("(T/(1 K))", "T")]) | x


def combined(inner):
    pair = st.tuples(inner, inner)
    binary = st.tuples(pair, st.sampled_from("+-*")).map(
        lambda x: tuple(f"({a} {x[1]} {b})" for a, b in zip(*x[0], strict=True))
    )
    over = pair.map(lambda x: tuple(f"({a} / (2 + {b}^2))" for a, b in zip(*x, strict=True)))
    call = st.tuples(inner, st.sampled_from(["tanh", "sin", "cos", "exp(-0.1*{})"])).map(
        lambda x: tuple(x[1].format(a) if "{" in x[1] else f"{x[1]}({a})" for a in x[0])
    )
    root = inner.map(lambda x: tuple(f"sqrt(1 + ({a})^2)" for a in x))
    power = inner.map(lambda x: tuple(f"(1.5 + sin({a}))^cos({a})" for a in x))
    logarithm = inner.map(lambda x: tuple(f"log(1 + ({a})^2)" for a in x))
    return binary | over | call | root | power | logarithm


NUMBERS = st.floats(0.1, 3.0).map(lambda x: (f"{x:.3f}",) * 2)
TEXTS = st.recursive(variables(NUMBERS), combined, max_leaves=8)
NAMES = {"tanh": np.tanh, "sin": np.sin, "cos": np.cos, "exp": np.exp, "sqrt": np.sqrt}
POSITIVE = st.floats(0.2, 2.0)


@settings(max_examples=examples(200), deadline=None)
@given(TEXTS, POSITIVE, POSITIVE, POSITIVE)
def test_values_and_derivatives_are_those_of_python(texts, p, v, T):
    """requirement: value as Python computes it, derivative as by a complex step."""
    own, reference = texts
    law, where = friction(own), {"p": p, "v": v, "T": T}
    code = compile(reference.replace("^", "**"), "reference", "eval")

    def python(values):
        return eval(code, NAMES | {"log": np.log}, values)

    with np.errstate(all="ignore"):
        due = float(python(where))
        if not np.isfinite(due) or abs(due) > 1e6:
            return
        arrays = {name: np.array([x]) for name, x in where.items()}
        assert law.value(arrays)[0] == pytest.approx(due, rel=1e-12, abs=1e-12)
        for name in where:
            stepped = python(where | {name: where[name] + 1e-30j})
            assert law.slope(arrays, name)[0] == pytest.approx(
                np.imag(stepped) / 1e-30, rel=1e-9, abs=1e-9
            )


PIECES = ["p", "v", "T", "1", "0", "2.5", "1e3", "MPa", "m/s", "K", "1/K", "(", ")", "+", "-", "*",
          "/", "^", "**", ",", "exp(", "log(", "max(", "sqrt(", "abs(", " ", "degC", "foo", ".",
          "m^2", "nan", "1 MPa", "(0.5 m/s)"]  # fmt: skip


@settings(max_examples=examples(400), deadline=None)
@given(st.lists(st.sampled_from(PIECES), max_size=14).map("".join) | st.text(max_size=30))
def test_any_text_is_read_or_refused_in_one_line(text):
    """requirement: B9; nothing but a number or a ValueError of one line comes of a text."""
    try:
        law = friction(text)
    except ValueError as error:
        assert "\n" not in str(error)
        return
    assert law.value(at()).shape == (1,)
    assert law.slope(at(), "p").shape == (1,)
