"""Friction, wear and conductance by expressions and registered laws, in all analyses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import thermowear as tw
from thermowear.case.tables.schema import as_plain
from thermowear.contact.wear.implicit_step import newton_with_wear
from thermowear.errors import ComputationError
from thermowear.laws import parameter, registered, registered_laws
from thermowear.laws.interfaces import REGISTERED
from thermowear.simulation.interface import interface_problem

from ..case.starter import FRETTING, GONE, RECIPROCATING, RUNNING_IN, solved, tables

STRIP = "punch-on-strip"
SMALL = ("mesh.degree=3", "mesh.elements=6")
COLD = {"heat": GONE}
SHORT = {"analysis": {"type": "transient", "end_time": "20 s", "output_times": []}}
ARCHARD = {"coefficient": "1e-7 1/MPa"}


def pressures(changes, name=RUNNING_IN, *overrides):
    return solved(name, changes, *SMALL, *overrides).interface


@pytest.mark.parametrize(
    ("law", "rate"),
    [
        ({"coefficient": "2e-7 1/MPa"}, "2e-7 1/MPa*mu*p*v"),
        ({"coefficient": "2e-7 1/MPa", "per": "pressure"}, "p*v*2e-7 1/MPa"),
        ({"coefficient": "1e-8 s^0.5/m^0.5/MPa^1.5", "pressure_exponent": 1.5,
          "velocity_exponent": 1.5, "per": "pressure"},
         "(1e-8 s^0.5/m^0.5/MPa^1.5)*p^1.5*v^1.5"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("analysis", ["transient", "steady"])
def test_a_power_as_an_expression_is_the_power(law, rate, analysis):
    """requirement: the same pressures, depths and rates as by coefficient and exponents."""
    settings = SHORT if analysis == "transient" else {"analysis": {"type": "steady"}}
    one = pressures(settings | {"wear.punch": law})
    other = pressures(settings | {"wear.punch": {"rate": rate}})
    for name in ("pressure", "wear_1", "wear_rate_1"):
        due = getattr(one, name)
        np.testing.assert_allclose(getattr(other, name), due, rtol=1e-8, atol=1e-9 * due.max())


ENERGY = {"type": "energy", "coefficient": "4e-13 m^3/J", "threshold": "2 kW/m^2"}


@pytest.mark.parametrize(
    "rate",
    [ENERGY, "4e-13 m^3/J*max(mu*p*v - 2 kW/m^2, 0 W/m^2)"],
    ids=["registered", "expression"],
)
def test_energy_wear_with_a_threshold_in_a_transient_run(rate):
    """requirement: B3; ``V = α (mu F v - q A) t`` where all of the face wears, by hand."""
    changes = COLD | {
        "wear.punch": {"rate": rate},
        "analysis": {"type": "transient", "end_time": "2000 s"},
    }
    result = solved(STRIP, changes, *SMALL)
    i, area, mu, v = result.interface, 0.04 * 0.01, 0.3, 3e-3
    due = 4e-13 * np.maximum(mu * i.pressure * v - 2e3, 0.0)
    np.testing.assert_allclose(i.wear_rate_1, due, rtol=1e-10)
    assert due.min() > 0.0
    volume = 4e-13 * (mu * 4e3 * v - 2e3 * area) * 2000
    assert result.summary["wear_volume_1_m3"] == pytest.approx(volume, rel=1e-6, abs=0.0)


def test_the_steady_state_of_energy_wear_is_uniform_on_a_strip():
    """requirement: B3; the rate of the mean pressure, ``α (mu p v - q)``."""
    changes = COLD | {"wear.punch": {"rate": ENERGY}, "analysis": {"type": "steady"}}
    i = solved(STRIP, changes, *SMALL).interface
    np.testing.assert_allclose(i.wear_rate_1, 4e-13 * (0.3 * 1e7 * 3e-3 - 2e3), rtol=1e-9)


def test_energy_wear_in_a_reciprocating_run():
    """requirement: B3; with no threshold it is Archard's law with ``k = α mu``."""
    changes = {"wear.strip": GONE, "analysis.cycles": 50, "analysis.output_times": []}
    few = ("mesh.degree=2", "mesh.elements=6", "analysis.positions=4")
    energy = {"rate": {"type": "energy", "coefficient": "5e-13 m^3/J"}}
    one, other = (
        solved(RECIPROCATING, changes | {"wear.punch": law}, *few)
        for law in (energy, {"coefficient": "5e-7 1/MPa", "per": "friction-stress"})
    )
    volumes = [result.summary["wear_volume_1_m3"] for result in (one, other)]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-9, abs=0.0)
    assert volumes[0] > 0


def test_energy_wear_in_a_fretting_run():
    """requirement: B3; without threshold the volume is α times the energy dissipated."""
    changes = {
        "wear.cylinder": {"rate": {"type": "energy", "coefficient": "1e-12 m^3/J"}},
        "analysis.output_times": [],
    }
    result = solved(FRETTING, changes, "mesh.degree=2", "mesh.elements=16")
    lost = result.friction.rows[-1].dissipated
    assert lost > 0
    assert result.summary["wear_volume_1_m3"] == pytest.approx(1e-12 * lost, rel=1e-3, abs=0.0)


STRIBECK = {"type": "stribeck", "static": 0.35, "kinetic": 0.1, "speed": "0.5 m/s"}


@pytest.mark.parametrize(
    "friction", [STRIBECK, "0.1 + 0.25*exp(-v/(0.5 m/s))"], ids=["registered", "expression"]
)
def test_stribeck_friction_in_a_transient_run(friction):
    """requirement: B3; friction and wear rate at every point by hand, equilibrium kept."""
    result = solved(RUNNING_IN, SHORT | {"contact.friction": friction}, *SMALL)
    i, summary = result.interface, result.summary
    v = 10 * i.x
    mu = 0.1 + 0.25 * np.exp(-v / 0.5)
    np.testing.assert_allclose(i.wear_rate_1, 2e-13 * mu * i.pressure * v, rtol=1e-9)
    torque = i.weight @ (mu * i.pressure * i.x)
    assert summary["friction_torque_Nm"] == pytest.approx(torque, rel=1e-9)
    assert summary["friction_min"] == pytest.approx(mu.min(), rel=1e-9)
    assert summary["friction"] is None
    assert summary["equilibrium_relative_error"] < 1e-9


def test_friction_that_depends_on_pressure_and_temperature_is_that_of_tables():
    """requirement: an expression that is linear where the table is leads to the same state."""
    at = {"at": ["20 degC", "220 degC"], "factor": [1.0, 0.5]}
    law = "0.25*(1 - 0.5*(T - 293.15 K)/(200 K))"
    unworn = {"analysis": {"type": "initial"}}
    one = pressures(unworn | {"contact.friction_factor.temperature": at}, "annular-punch")
    other = pressures(unworn | {"contact.friction": law}, "annular-punch")
    assert one.temperature_1.max() < 493.15
    np.testing.assert_allclose(other.pressure, one.pressure, rtol=1e-7)
    np.testing.assert_allclose(other.temperature_1, one.temperature_1, rtol=1e-9)


def test_conductance_by_an_expression_is_that_of_hardness():
    """requirement: ``h = c k p/H`` as an expression."""
    hard = {"bodies.upper.hardness": "2 GPa", "bodies.lower.hardness": "2 GPa"}
    pressure = {"heat.conductance": {"type": "pressure", "coefficient": "2e4 1/m"}} | hard
    k = tw.load(tables("stacked-blocks")).material("lower").conductivity
    k1 = tw.load(tables("stacked-blocks")).material("upper").conductivity
    slope = 2e4 * 2 * k * k1 / (k + k1) / 2e9
    text = f"{slope} W/(m^2 K Pa) * p"
    one, other = (
        solved("stacked-blocks", changes, "mesh.degree=2").interface
        for changes in (pressure, {"heat.conductance": text})
    )
    np.testing.assert_allclose(other.temperature_1, one.temperature_1, rtol=1e-9)


def test_wear_that_fades_with_depth():
    """requirement: ``dw/dt = k p v exp(-w/c)``, uniform: ``w = c log(1 + k p v t/c)``."""
    rate = "1e-6 1/MPa*p*v*exp(-depth/(5 um))"
    changes = COLD | {
        "wear.punch": {"rate": rate},
        "contact.friction": 0.0,
        "bodies.punch.poisson_ratio": 0.0,
        "bodies.punch.young_modulus": "2e4 GPa",
        "analysis": {"type": "transient", "end_time": "400 s", "tolerance": 1e-3},
    }
    result = solved(STRIP, changes, *SMALL)
    i = result.interface
    mean = i.weight @ i.wear_1 / i.weight.sum()
    due = 5e-6 * np.log(1 + 1e-12 * 1e7 * 3e-3 * 400 / 5e-6)
    assert mean == pytest.approx(due, rel=1e-3, abs=0.0)
    assert mean < 0.8 * 1e-12 * 1e7 * 3e-3 * 400


def test_wear_that_depends_on_the_temperature():
    """requirement: the rate at the end is that of the body's own face, by hand."""
    rate = "2e-7 1/MPa*p*v*(1 + (T - 293.15 K)/(100 K))"
    changes = {"wear.punch": {"rate": rate}, "analysis": {"type": "steady"}}
    i = pressures(changes, "annular-punch")
    speed = tw.load(tables("annular-punch")).motion.angular_velocity * i.x
    due = 2e-13 * i.pressure * speed * (1 + (i.temperature_1 - 293.15) / 100)
    np.testing.assert_allclose(i.wear_rate_1, due, rtol=1e-8)
    assert np.ptp(i.temperature_1) > 1.0


@pytest.mark.parametrize("wearing", [("punch", "plate"), ("plate",)], ids=["both", "body 2"])
def test_each_body_wears_by_its_own_temperature_and_depth(wearing):
    """requirement: laws of T and depth ask the state of the body's own face, by hand."""
    rates = {
        "punch": "2e-7 1/MPa*p*v*(T/(300 K))^9*exp(-depth/(1 um))",
        "plate": "1e-7 1/MPa*p*v*(T/(300 K))^5*exp(-depth/(2 um))",
    }
    changes = {f"wear.{name}": {"rate": rates[name]} for name in wearing}
    if "punch" not in wearing:
        changes["wear.punch"] = GONE
    changes |= {
        "heat.conductance": "5e2 W/(m^2 K)",
        "analysis": {"type": "transient", "end_time": "20 s", "output_times": []},
    }
    i = pressures(changes, "annular-punch")
    pv = i.pressure * tw.load(tables("annular-punch")).motion.angular_velocity * i.x
    assert np.abs(i.temperature_1 - i.temperature_2).max() > 1.0  # the faces differ
    laws = ((1, 2e-13, 9, 1e-6), (2, 1e-13, 5, 2e-6))
    for body, scale, power, depth in laws[-len(wearing) :]:
        hotter = (getattr(i, f"temperature_{body}") / 300) ** power
        due = scale * pv * hotter * np.exp(-getattr(i, f"wear_{body}") / depth)
        found = getattr(i, f"wear_rate_{body}")
        np.testing.assert_allclose(found, due, rtol=1e-6, atol=1e-9 * due.max())


def test_negative_friction_is_refused_where_it_is_found():
    """requirement: a law that ends before the state does is answered in one line."""
    changes = {"analysis": {"type": "initial"}, "contact.friction": "0.3 - 0.3*(p/(12 MPa))^4"}
    with pytest.raises(ComputationError, match=r"contact.friction: -\S+ at p = ") as caught:
        pressures(COLD | changes, STRIP)
    assert "\n" not in str(caught.value)


ROUND_TRIP = {
    "contact.friction": "0.32 - 2e-4*(T - 293.15 K)/(1 K)",
    "heat.conductance": "2e4 W/(m^2 K)*(p/(1 MPa))^0.95",
    "wear.punch": {
        "rate": "1e-7 1/MPa*p*v",
        "factor": {"pressure": {"at": ["1 MPa"], "factor": [2]}},
    },
}


@pytest.mark.parametrize(
    "changes", [ROUND_TRIP, {"contact.friction": STRIBECK, "wear.punch": {"rate": ENERGY}}]
)
def test_laws_are_written_back_as_they_were_read(changes):
    """requirement: the resolved case leads to the same case."""
    case = tw.load(tables("annular-punch", changes))
    plain = as_plain(case)
    again = tw.load(plain)
    assert as_plain(again) == plain
    assert again == case
    assert "coefficient" not in plain["wear"]["punch"]


def test_a_law_of_ones_own_is_registered(monkeypatch):
    """requirement: one class with its keys, used by a case; other bodies keep their laws."""

    monkeypatch.setitem(REGISTERED, "wear", dict(registered_laws("wear")))

    @registered("wear", "square-root")
    @dataclass(frozen=True)
    class SquareRootWear:
        rate_at_1MPa: float = parameter("m/s", "1 nm/s", gt=0)
        variables = frozenset("p")

        def value(self, at):
            return self.rate_at_1MPa * np.sqrt(np.maximum(at.p, 0.0) / 1e6)

        def slope(self, at):
            return self.rate_at_1MPa * 0.5 / np.sqrt(np.maximum(at.p, 1.0) * 1e6)

    law = {"rate": {"type": "square-root", "rate_at_1MPa": "2 nm/s"}}
    changes = COLD | {"wear.punch": law, "analysis": {"type": "steady"}}
    i = solved(STRIP, changes, *SMALL).interface
    np.testing.assert_allclose(i.wear_rate_1, 2e-9 * np.sqrt(10.0), rtol=1e-9)
    assert as_plain(tw.load(tables(STRIP, changes)))["wear"]["punch"]["rate"] == {
        "type": "square-root",
        "rate_at_1MPa": "2e-09 m/s",
    }


def test_stribeck_friction_takes_no_more_iterations_than_constant_friction(monkeypatch):
    """requirement: B3; contact problems per step, at most two more."""
    solutions = []

    def counted(solve, *others):
        def counting(*parts):
            solutions.append(1)
            return solve(*parts)

        return newton_with_wear(counting, *others)

    monkeypatch.setattr(interface_problem, "newton_with_wear", counted)
    per_step = []
    for friction in (0.25, STRIBECK):
        solutions.clear()
        result = solved(RUNNING_IN, SHORT | {"contact.friction": friction}, *SMALL)
        per_step.append(len(solutions) / (len(result.history) - 1))
    assert per_step[1] <= per_step[0] + 2
