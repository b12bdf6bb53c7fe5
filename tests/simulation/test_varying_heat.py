"""Conductivity and expansion that change with temperature, in every analysis."""

import numpy as np
import pytest

from ..case.starter import solved

RING = "annular-punch"
SLOW = {"motion.angular_velocity": "0.02 rad/s", "mesh.degree": 4, "mesh.elements": 6}
STORING = {"bodies.punch.density": "7800 kg/m^3", "bodies.punch.specific_heat": "460 J/(kg K)"}
TABLES = {
    "bodies.punch.conductivity_factor": {"at": ["20 degC", "60 degC"], "factor": [1.0, 0.7]},
    "bodies.punch.expansion_factor": {"at": ["20 degC", "60 degC"], "factor": [1.0, 1.4]},
}
ONES = {path: {"at": table["at"], "factor": [1.0, 1.0]} for path, table in TABLES.items()}
IN_TIME = {"heat.transient": True, "analysis": {"type": "transient", "end_time": "100 s"}}
ANALYSES = {
    "steady": {},
    "initial": {"analysis": {"type": "initial"}},
    "transient": {"analysis": {"type": "transient", "end_time": "5 s"}},
    "in time": STORING | IN_TIME,
}


@pytest.mark.parametrize("name", ANALYSES)
def test_a_table_of_ones_is_none(name):
    """requirement: the same numbers by Newton's method as by the condensed, linear bodies."""
    changes = SLOW | ANALYSES[name]
    with_table, without = solved(RING, changes | ONES), solved(RING, changes)
    for key in ("pressure", "temperature_1", "temperature_2", "shape"):
        found, known = (getattr(result.interface, key) for result in (with_table, without))
        assert np.abs(found - known).max() <= 1e-7 * np.abs(known).max()


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow if n == "in time" else ()) for n in ANALYSES]
)
def test_balances(name):
    """requirement: heat and forces balance to 1e-9; closed points touch, the tables matter."""
    changes = SLOW | ANALYSES[name]
    result, constant = solved(RING, changes | TABLES), solved(RING, changes)
    assert result.summary["heat_balance_relative_error"] < 1e-9
    assert result.summary["equilibrium_relative_error"] < 1e-9
    i, j = result.interface, constant.interface
    assert np.abs(i.temperature_1 - j.temperature_1).max() > 1e-3
    if name != "steady":
        closed = np.average(i.gap, weights=i.weight * (i.pressure > 0))
        assert abs(closed) <= 1e-12


def test_tables_of_a_constant_are_that_constant():
    """requirement: 0.7 of the conductivity and 1.4 of the expansion are those of another steel."""
    factors = {
        path: {"at": ["20 degC"], "factor": [0.7 if "cond" in path else 1.4]} for path in TABLES
    }
    other = {"bodies.punch.conductivity": "35 W/(m K)", "bodies.punch.expansion": "1.68e-5 1/K"}
    unworn = SLOW | ANALYSES["initial"]
    found, known = solved(RING, unworn | factors), solved(RING, unworn | other)
    np.testing.assert_allclose(found.interface.pressure, known.interface.pressure, rtol=1e-7)
    np.testing.assert_allclose(
        found.interface.temperature_2, known.interface.temperature_2, rtol=1e-9
    )
    np.testing.assert_allclose(
        found.fields.von_mises,
        known.fields.von_mises,
        rtol=1e-6,
        atol=1e-3 * known.fields.von_mises.max(),
    )


@pytest.mark.slow
def test_running_in_ends_in_the_steady_state():
    """requirement: the end of a running-in is the state that the principle gives."""
    finer = SLOW | TABLES | {"mesh.degree": 6, "mesh.elements": 8}
    until = {"type": "transient", "until": "steady", "steady_tolerance": 3e-4}
    steady = solved(RING, finer).interface
    ended = solved(RING, finer | {"analysis": until}).interface
    assert np.abs(steady.pressure - ended.pressure).max() <= 1e-3 * steady.pressure.max()
    found, known = (i.shape - np.average(i.shape, weights=i.weight) for i in (steady, ended))
    assert np.abs(found - known)[1:-1].max() <= 2e-3 * np.ptp(known)
