"""Properties that change with temperature, pressure or speed."""

from __future__ import annotations

import numpy as np
import pytest

import thermowear as tw
from thermowear.laws import LocalState

from .bad import Bad, assert_refused
from .starter import FRETTING, GONE, RECIPROCATING, RUNNING_IN, STEADY, tables

FRICTION, WEAR = "contact.friction_factor", "wear.punch.factor"
CONDUCTS, EXPANDS = "bodies.punch.conductivity_factor", "bodies.punch.expansion_factor"
WARM = {"at": ["20 degC", "220 degC"], "factor": [1.0, 0.5]}
HARD = {"at": ["10 MPa", "30 MPa"], "factor": [1.0, 2.0]}
FAST = {"at": ["0 mm/s", "1 m/s"], "factor": [1, 0.8]}
STABLE = {"analysis": {"type": "stability"}}


def table(path: str, at: list, factor: list) -> dict:
    return {path: {"at": at, "factor": factor}}


TEMPERATURE = f"{FRICTION}.temperature"

BAD = [
    Bad("falls", table(TEMPERATURE, ["20 degC", "290 K"], [1, 2]), f"{TEMPERATURE}.at", "increase"),
    Bad("lists that differ", table(TEMPERATURE, ["20 degC"], [1, 2]), f"{TEMPERATURE}.factor",
        "has 2 values for 1 places"),
    Bad("empty", table(TEMPERATURE, [], []), f"{TEMPERATURE}.at", "is empty"),
    Bad("no places", {TEMPERATURE: {"factor": [1]}}, f"{TEMPERATURE}.at", "missing"),
    Bad("no friction", table(TEMPERATURE, ["20 degC"], [0]), f"{TEMPERATURE}.factor.0",
        "greater than 0"),
    Bad("factor as text", table(TEMPERATURE, ["20 degC"], ["1"]), f"{TEMPERATURE}.factor.0",
        "must be a number"),
    Bad("temperature without unit", table(TEMPERATURE, [20], [1]), f"{TEMPERATURE}.at.0", "unit"),
    Bad("pressure in degrees", table(f"{FRICTION}.pressure", ["20 degC"], [1]),
        f"{FRICTION}.pressure.at.0", "must be in Pa"),
    Bad("backwards", table(f"{WEAR}.speed", ["-1 m/s"], [1]), f"{WEAR}.speed.at.0", "at least 0"),
    Bad("of what", {f"{WEAR}.temprature": WARM}, f"{WEAR}.temprature", "did you mean temperature?"),
    Bad("conductor of nothing", table(CONDUCTS, ["20 degC"], [0]), f"{CONDUCTS}.factor.0",
        "greater than 0"),
    Bad("shrinks", table(EXPANDS, ["20 degC"], [-1]), f"{EXPANDS}.factor.0", "at least 0"),
    Bad("temperature of the cold", {TEMPERATURE: WARM}, TEMPERATURE, "needs a [heat]", RUNNING_IN),
    Bad("wear by the cold", {f"{WEAR}.temperature": WARM}, f"{WEAR}.temperature",
        "needs a [heat] table", RUNNING_IN),
    Bad("fretting", {f"{FRICTION}.pressure": HARD}, FRICTION,
        "not supported in a fretting", FRETTING),
    Bad("to and fro", {f"{WEAR}.pressure": HARD}, WEAR, "not supported in a reciprocating",
        RECIPROCATING),
    Bad("unstable", STABLE | {f"{FRICTION}.speed": FAST}, FRICTION, "not supported in a stability"),
    Bad("unstable conductor", STABLE | {CONDUCTS: WARM}, CONDUCTS, "not supported in a stability"),
    Bad("running-in by penalty", {f"{WEAR}.pressure": HARD, "contact.method": "penalty"},
        "contact.method", "'penalty' does not support variable friction, wear or conductance",
        RUNNING_IN),
    Bad("expansion by Nitsche", {EXPANDS: WARM, "contact.method": "nitsche"},
        "contact.method", "'nitsche' does not support variable conductivity or expansion"),
    Bad("factor beside like", {"bodies.plate.conductivity_factor": WARM},
        "bodies.plate.conductivity_factor", "not allowed together with like"),
]  # fmt: skip


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: bad.name)
def test_a_fault_of_factors_is_one_line_with_the_path_of_its_key(bad, tmp_path, capsys):
    """
    requirement: bad input ends with exit code 1 and one line: exact path, what is wrong with it.
    """
    assert_refused(bad, tmp_path, capsys)


def test_factors_multiply_by_straight_lines_constant_beyond_their_ends():
    """
    requirement: friction of temperature, pressure and speed.

    By hand: halfway between 20 and 220 degC 0.75, at 20 MPa 1.5, at 0.5 m/s 0.9.
    """
    given = {"temperature": WARM, "pressure": HARD, "speed": FAST}
    factors = tw.load(tables(STEADY, {FRICTION: given})).contact.friction_factor
    T = np.array([393.15, 0.0, 900.0])
    p, v = np.array([20e6, 0.0, 1e9]), np.array([0.5, 0.0, 3.0])
    assert factors.multipliers.value(LocalState(p, v, T)) == pytest.approx(
        [0.75 * 1.5 * 0.9, 1.0, 0.5 * 2.0 * 0.8]
    )
    assert factors.depends_on == ("temperature", "pressure", "speed")


def test_without_tables_the_factor_is_one():
    """
    requirement: nothing changes unless the case says so, hot or cold.
    """
    case = tw.load(tables(STEADY, {"heat": GONE}))
    state = LocalState(np.zeros(3), np.ones(3), 0.0)
    assert case.wear["punch"].factor.multipliers.value(state).tolist() == [1, 1, 1]
    assert case.contact.friction_factor.depends_on == ()
    assert not case.varies


@pytest.mark.parametrize("path", [f"{FRICTION}.pressure", f"{WEAR}.pressure"])
def test_a_case_whose_friction_or_wear_has_a_table_varies(path):
    """
    requirement: one word for whether properties have to be followed.
    """
    assert tw.load(tables(RUNNING_IN, {path: HARD})).varies


def test_tables_of_both_are_in_kelvin():
    """
    requirement: conductivity and expansion as tables of temperature.
    """
    none = {"at": ["20 degC", "1220 degC"], "factor": [1.0, 0.0]}
    body = tw.load(tables(STEADY, {CONDUCTS: WARM, EXPANDS: none})).material("plate")
    assert body.conductivity_factor.table.value(np.array([343.15])) == pytest.approx([0.875])
    assert body.expansion_factor.table.value(np.array([1493.15])) == pytest.approx([0.0])
