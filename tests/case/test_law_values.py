"""Laws in the case file: expressions and registered laws, and their faults."""

from __future__ import annotations

import pickle

import pytest

import thermowear as tw
from thermowear.laws.expressions import Expression
from thermowear.simulation.from_case import model_of

from .bad import Bad, assert_refused
from .starter import FRETTING, GONE, RECIPROCATING, RUNNING_IN, STEADY, tables

MU, WEAR, RATE = "contact.friction", "wear.punch", "wear.punch.rate"
HEAT = "heat.conductance"
STABLE = {"analysis": {"type": "stability"}}
ARCHARD = {"rate": "1e-7 1/MPa*p*v"}


def rate(text, **more):
    return {WEAR: {"rate": text, **more}}


BAD = [
    Bad("import", {MU: "__import__('os')"}, MU, "at character 12: \"'\" cannot stand"),
    Bad("attribute", {MU: "p.real"}, MU, "at character 2: '.' cannot stand"),
    Bad("no function", {MU: "0.1 + 0.25*foo(v)"}, MU,
        "at character 12: 'foo' is not a function; known: exp, log"),
    Bad("towers", {MU: "9^9^9^9"}, MU, "at character 5: an exponent is at most 100"),
    Bad("pressure as friction", {MU: "p"}, MU, "needs a dimensionless number"),
    Bad("no unit", {MU: "0.3*exp(-v/0.5)"}, MU, "must be dimensionless, found m/s"),
    Bad("degrees", {MU: "0.3 - 1e-4/K*(T - 20 degC)"}, MU, "'degC' is a scale with an offset"),
    Bad("degrees converted", {MU: "0.3 - 1e-4/K*(T - 40 degC)"}, MU, "in K: 313.15 K"),
    Bad("division by zero", {MU: "0.2 + 1e-3 m/s/v"}, MU, "must be finite"),
    Bad("negative", {MU: "-0.3 + 0*v/(1 m/s)"}, MU, "must be greater than 0"),
    Bad("depth of friction", {MU: "0.3*exp(-depth/(1 um))"}, MU, "'depth' is not a variable"),
    Bad("look-alike", {MU: "0.3*р/(1 MPa)"}, MU, "U+0440"),
    Bad("long", {MU: "p" * 10_000}, MU, "has 10000 characters"),
    Bad("parentheses", {MU: "((0.3"}, MU, "at character 2: '(' is not closed"),
    Bad("nan", {MU: "nan"}, MU, "'nan' is not a variable"),
    Bad("empty", {MU: ""}, MU, "is empty"),
    Bad("law of friction", {MU: {"type": "coulomb"}}, f"{MU}.type", "must be one of: 'stribeck'"),
    Bad("law without type", {MU: {"static": 0.3}}, f"{MU}.type",
        "missing; must be one of: 'stribeck'"),
    Bad("law without speed", {MU: {"type": "stribeck", "static": 0.3, "kinetic": 0.1}},
        f"{MU}.speed", "missing"),
    Bad("speed of a law", {MU: {"type": "stribeck", "static": 0.3, "kinetic": 0.1,
        "speed": "0.5 m"}}, f"{MU}.speed", "must be in m/s"),
    Bad("negative static", {MU: {"type": "stribeck", "static": -0.3, "kinetic": 0.1,
        "speed": "0.5 m/s"}}, f"{MU}.static", "must be greater than 0"),
    Bad("key of a law", {MU: {"type": "stribeck", "viscous": 0.1}}, f"{MU}.viscous",
        "unknown key; known: static, kinetic, speed"),
    Bad("wear in metres", rate("1e-7 1/MPa*p*(1 m)"), RATE, "has the unit m; needs m/s"),
    Bad("falling wear", rate("1e-7 1/MPa*p*v*exp(-p/(10 MPa))"), RATE, "decreases with increasing"),
    Bad("wear without pressure", rate("1e-9*v"), RATE, "wear without pressure"),
    Bad("negative wear", rate("1e-7 1/MPa*p*(v - 1 m/s)"), RATE, "at least 0"),
    Bad("wear by a number", rate(1e-7), RATE, "must be an expression in p, v, T, depth, mu"),
    Bad("two laws", rate("1e-7 1/MPa*p*v", coefficient="1e-7 1/MPa"), f"{WEAR}.coefficient",
        "not allowed together with rate"),
    Bad("exponent of a rate", rate("1e-7 1/MPa*p*v", pressure_exponent=2.0),
        f"{WEAR}.pressure_exponent", "not allowed together with rate"),
    Bad("no law", {WEAR: {"per": "pressure"}}, f"{WEAR}.coefficient", "missing"),
    Bad("threshold", rate({"type": "energy", "coefficient": "1e-13 m^3/J",
        "threshold": "-1 W/m^2"}), f"{RATE}.threshold", "must be at least 0"),
    Bad("conductance of a speed", {HEAT: "1e3 W/(m^2 K)*v"}, HEAT,
        "the unit kg m/(K s^4); needs W/(m^2 K)"),
    Bad("conductance below 0", {HEAT: "1e3 W/(m^2 K)*(1 - p/(1 GPa))"}, HEAT, "at least 0"),
    Bad("cold friction", {MU: "0.3 - 1e-4/K*(T - 293.15 K)"}, MU, "requires a [heat] table",
        RUNNING_IN),
    Bad("cold wear", rate("1e-7 1/MPa*p*v*T/(300 K)"), RATE, "requires a [heat] table", RUNNING_IN),
    Bad("fretting", {MU: "0.3 + p/(1 GPa)"}, MU,
        "depends on p; not supported in a fretting", FRETTING),
    Bad("to and fro", rate("1e-7 1/MPa*p*v*exp(-depth/(1 um))"), RATE,
        "depends on depth; not supported in a reciprocating", RECIPROCATING),
    Bad("stable", STABLE | {MU: "0.3 + v/(1 km/s)"}, MU,
        "depends on v; not supported in a stability"),
    Bad("steady depth", rate("1e-7 1/MPa*p*v*exp(-depth/(1 um))"), RATE, "no steady state"),
    Bad("running-in to the end", rate("1e-7 1/MPa*p*v*exp(-depth/(1 um))")
        | {"analysis": {"type": "transient", "until": "steady"}}, RATE, "no steady state",
        RUNNING_IN),
    Bad("no friction", rate("1e-7 1/MPa*mu*p*v") | {MU: 0}, MU, "wear.punch.rate depends on mu",
        RUNNING_IN),
    Bad("method", {MU: "0.3 + p/(1 GPa)", "contact.method": "penalty"}, "contact.method",
        "'penalty' does not support variable friction, wear or conductance", RUNNING_IN),
]  # fmt: skip


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: bad.name)
def test_a_fault_of_a_law_is_one_line_with_the_path_of_its_key(bad, tmp_path, capsys):
    """requirement: B9; exit code 1 and one line with the key's path and the position."""
    assert_refused(bad, tmp_path, capsys)


def test_laws_are_read():
    """requirement: expressions and registered laws, in SI; what varies is known."""
    changes = {
        MU: "0.1 + 0.25*exp(-v/(0.5 m/s))",
        WEAR: {"rate": {"type": "energy", "coefficient": "0.1 mm^3/J"}},
        HEAT: "1e3 W/(m^2 K)*p/(1 MPa)",
    }
    case = tw.load(tables(STEADY, changes))
    assert isinstance(case.contact.friction, Expression)
    assert case.wear["punch"].law.coefficient == pytest.approx(1e-10)
    assert case.wear["punch"].law.threshold == 0.0
    assert case.friction_variables == {"v"}
    assert model_of(case).interface.friction_varies
    assert case.varies


def test_cases_with_laws_are_copied_to_other_processes():
    """requirement: the first rank reads a case, and the others get it by pickle."""
    changes = {
        MU: {"type": "stribeck", "static": 0.35, "kinetic": 0.1, "speed": "0.5 m/s"},
        WEAR: {"rate": "1e-13/Pa*max(p - 1 MPa, 0 Pa)*v"},
    }
    case = tw.load(tables(STEADY, changes))
    assert pickle.loads(pickle.dumps(case)) == case
    assert pickle.loads(pickle.dumps(case)).contact.friction.law == case.contact.friction.law


def test_wear_that_depends_on_pressure_and_speed_alone_asks_for_no_iteration():
    """requirement: Newton's method knows the law's own derivative."""
    case = tw.load(tables(RUNNING_IN, {WEAR: ARCHARD}))
    assert not case.varies
    assert not tw.load(tables(STEADY, {HEAT: "1e3 W/(m^2 K)"})).varies
    assert tw.load(tables(STEADY, {HEAT: GONE})).heat.conductance is None


def test_an_expression_may_be_set_from_the_command_line():
    """requirement: ``--set`` takes an expression without quotation marks."""
    case = tw.load(tables(STEADY), ("contact.friction=0.1 + 0.2*exp(-v/(0.5 m/s))",))
    assert case.contact.friction.variables == {"v"}
