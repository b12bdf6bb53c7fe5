"""Units of the case file: whatever they are, inside there is SI."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import thermowear as tw
from thermowear.case.values.units import registry

from ..conftest import examples
from .starter import RUNNING_IN, STEADY, tables

COEFFICIENT = "wear.punch.coefficient"
MILLIMETRES = {
    "geometry.inner_radius": "20 mm",
    "geometry.outer_radius": "120 mm",
    "geometry.punch_height": "50 mm",
    "geometry.plate_radius": "140 mm",
    "geometry.plate_height": "100 mm",
    "bodies.punch.young_modulus": "2e5 N/mm^2",
    "bodies.punch.conductivity": "50 N/(s K)",
    "bodies.punch.expansion": "1.2e-5 1/K",
    "load.mean_pressure": "50 MPa",
    "motion.angular_velocity": "0.1 rad/s",
    COEFFICIENT: "2e-7 mm^2/N",
    "heat.conductance": "1e3 N/(mm s K)",
    "heat.cooling.punch_top": "2 N/(mm s K)",
    "heat.cooling.plate_bottom": "2 N/(mm s K)",
    "heat.ambient": "20 degC",
}
METRES = {
    "geometry.inner_radius": "0.02 m",
    "geometry.outer_radius": "0.12 m",
    "geometry.punch_height": "0.05 m",
    "geometry.plate_radius": "0.14 m",
    "geometry.plate_height": "0.1 m",
    "bodies.punch.young_modulus": "2e11 Pa",
    "bodies.punch.conductivity": "50 W/(m K)",
    "bodies.punch.expansion": "1.2e-5 1/K",
    "load.mean_pressure": "5e7 Pa",
    "motion.angular_velocity": "0.1 rad/s",
    COEFFICIENT: "2e-13 1/Pa",
    "heat.conductance": "1e6 W/(m^2 K)",
    "heat.cooling.punch_top": "2000 W/(m^2 K)",
    "heat.cooling.plate_bottom": "2000 W/(m^2 K)",
    "heat.ambient": "293.15 K",
}


def numbers(table, path=""):
    """All numbers of a case by their paths, the wear coefficient in SI."""
    if isinstance(table, float | int):
        return {path: float(table)}
    if isinstance(table, tuple):
        table = dict(enumerate(table))
    if hasattr(table, "coefficient_si"):
        return {path: table.coefficient_si()}
    if hasattr(table, "model_fields_set"):
        table = dict(table)
    if not isinstance(table, dict):
        return {}
    found = {}
    for key, value in table.items():
        found |= numbers(value, f"{path}.{key}")
    return found


def test_the_unit_system_does_not_matter():
    """
    requirement: a case in mm, N, MPa and the same in SI units are the same numbers inside.
    """
    ours, theirs = (numbers(tw.load(tables(STEADY, unit))) for unit in (MILLIMETRES, METRES))
    assert len(ours) > 15
    assert ours == pytest.approx(theirs, rel=1e-14, abs=0.0)


def test_times_have_units_too():
    """
    requirement: times of a running-in, in lists too, are read in any unit.
    """
    minutes = {"analysis.end_time": "2 min", "analysis.output_times": ["500 ms", "1 min"]}
    analysis = tw.load(tables(RUNNING_IN, minutes)).analysis
    assert (analysis.end_time, *analysis.output_times) == pytest.approx((120.0, 0.5, 60.0))


def test_force_is_pressure_times_area():
    """
    requirement: a mean pressure acts on the nominal contact area.
    """
    by_pressure = tw.load(tables()).force()
    assert by_pressure == pytest.approx(50e6 * math.pi * (0.12**2 - 0.02**2), rel=1e-14)
    by_force = tables(STEADY, {"load": {"force": f"{by_pressure!r} N"}})
    assert tw.load(by_force).force() == by_pressure


CONDUCTANCE = [
    "2000 W/(m^2 K)",
    "2000 W/m^2/K",
    "2000 W/m²/K",
    "2e3 W*m**-2*K**-1",
    "2 kW/(m^2 K)",
    "2000 W/(m^2 degC)",
    "2000 W/(m² °C)",
    "2000 W/m^2/delta_degC",
    "2000W/(m^2 K)",
    "+2000 W/m^2/K",
    " 2000  W/(m^2 K) ",
    "2000. W/m^2/K",
    ".2e4 W/m^2/K",
]


@pytest.mark.parametrize("text", CONDUCTANCE)
def test_ways_to_write_a_unit(text):
    """
    requirement: units as engineers write them; a degree Celsius below a bar is a difference.
    """
    case = tw.load(tables(STEADY, {"heat.conductance": text}))
    assert case.heat.conductance == pytest.approx(2000.0, rel=1e-14)


@pytest.mark.parametrize("text", ["1.2e-5 1/K", "1.2e-5 1/degC", "12e-6/°C", "12 um/(m degC)"])
def test_expansion_per_degree(text):
    """
    requirement: an expansion per degree Celsius is an expansion per kelvin.
    """
    case = tw.load(tables(STEADY, {"bodies.punch.expansion": text}))
    assert case.bodies["punch"].expansion == pytest.approx(1.2e-5, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "kelvin"),
    [
        ("20 degC", 293.15),
        ("20 °C", 293.15),
        ("293.15 K", 293.15),
        ("68 degF", 293.15),
        ("-273.15 degC", 0.0),
        ("0 K", 0.0),
    ],
)
def test_temperatures_are_absolute(text, kelvin):
    """
    requirement: a temperature in degrees Celsius is counted from its own zero.
    """
    case = tw.load(tables(STEADY, {"heat.ambient": text}))
    assert case.heat.ambient == pytest.approx(kelvin, rel=1e-14, abs=1e-10)


@pytest.mark.parametrize(
    ("text", "value"), [("10 rad/s", 10.0), ("60 rpm", 2 * math.pi), ("1 turn/s", 2 * math.pi)]
)
def test_angular_velocity(text, value):
    """
    requirement: turns are turns and radians are radians.
    """
    case = tw.load(tables(STEADY, {"motion.angular_velocity": text}))
    assert case.motion.angular_velocity == pytest.approx(value, rel=1e-14)


LAWS = [
    (1.0, 1.0, "2e-7 1/MPa", 2e-13),
    (1.0, 1.0, "2e-7 mm^3/(N mm)", 2e-13),
    (1.0, 0.5, "2e-7 1/MPa^0.5", 2e-10),
    (1.0, 2.0, "2e-7 1/MPa^2", 2e-19),
    (1.0, 1 / 3, "2e-7 1/MPa^0.3333333333333333", 2e-9),
    (0.5, 1.0, "2e-7 (m/s)^0.5/MPa", 2e-13),
    (0.5, 1.0, "2e-7 (mm/s)^0.5/MPa", 2e-13 * 1e-3**0.5),
    (0.0, 1.0, "2e-7 (m/s)/MPa", 2e-13),
    (2.0, 1.5, "2e-7 (m/s)^-1 1/MPa^1.5", 2e-16),
    (2.0, 1.5, "2e-7 s/m/MPa**1.5", 2e-16),
]


@pytest.mark.parametrize(("a", "b", "text", "si"), LAWS)
def test_coefficients_whose_unit_fits_the_exponents(a, b, text, si):
    """
    requirement: the unit of a wear coefficient follows its exponents, whole numbers or not.
    """
    exponents = {"wear.punch.velocity_exponent": a, "wear.punch.pressure_exponent": b}
    case = tw.load(tables(STEADY, {COEFFICIENT: text, **exponents}))
    assert case.wear["punch"].coefficient_si() == pytest.approx(si, rel=1e-13, abs=0.0)
    assert tw.load(tw.case.as_plain(case)).wear["punch"].coefficient_si() == pytest.approx(
        si, rel=1e-13
    )


SIZES = st.floats(1e-6, 1e6)
UNITS = {
    "bodies.punch.young_modulus": ["Pa", "GPa", "N/mm^2", "psi", "bar", "kN/cm^2", "J/m^3"],
    "bodies.punch.density": ["kg/m^3", "g/cm^3", "t/m^3", "lb/ft^3", "N s^2/mm^4"],
    "bodies.punch.conductivity": ["W/m/K", "W/(cm degC)", "mW/(mm K)", "BTU/hour/ft/delta_degF"],
    "heat.conductance": ["W/m^2/K", "kW/(m^2 degC)", "N/(mm s K)"],
    "motion.angular_velocity": ["rad/s", "deg/s", "rpm", "turn/minute", "mrad/ms"],
    "load.mean_pressure": ["Pa", "MPa", "atm", "kgf/cm^2"],
}


@given(data=st.data(), size=SIZES)
@settings(max_examples=examples(60), deadline=None, database=None)
def test_any_two_units_agree(data, size):
    """
    requirement: a quantity means the same in every unit of its dimension.
    """
    path = data.draw(st.sampled_from(sorted(UNITS)))
    one, other = (data.draw(st.sampled_from(UNITS[path])) for _ in range(2))
    ureg = registry()
    ratio = ureg.Quantity(1.0, ureg.parse_units(one)).to(ureg.parse_units(other)).magnitude
    texts = (f"{size!r} {one}", f"{size * ratio!r} {other}")
    fitting = {}  # the pressure is a small part of the modulus
    if path == "load.mean_pressure":
        fitting = {"bodies.punch.young_modulus": f"{1e3 * size!r} {one}"}
    elif path == "bodies.punch.young_modulus":
        fitting = {"load.mean_pressure": f"{1e-3 * size!r} {one}"}
    first, second = (
        numbers(tw.load(tables(STEADY, fitting | {path: text})))[f".{path}"] for text in texts
    )
    assert first == pytest.approx(second, rel=1e-12)


@given(size=st.floats(min_value=1e-100, max_value=1e100))
@example(size=1e-100)
@example(size=1e100)
@settings(max_examples=examples(60), deadline=None, database=None)
def test_si_numbers_are_taken_as_they_are(size):
    """
    requirement: a number in SI units is not changed by reading it.
    """
    large = {"geometry.outer_radius": "4 m", "geometry.plate_radius": "5 m"}
    force = {"load": {"force": f"{max(1e-3 * size, 1e-100)!r} N"}}  # a small part of the modulus
    modulus = {"bodies.punch.young_modulus": f"{size!r} Pa"}
    case = tw.load(tables(STEADY, large | force | modulus))
    assert case.bodies["punch"].young_modulus == size
