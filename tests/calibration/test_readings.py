"""Quantities of results that measurements correspond to: contacts, masses, times and places."""

import tomllib
from types import SimpleNamespace

import numpy as np
import pytest

from thermowear.app.calibration.measurements import read_measurements
from thermowear.calibration.readings import reading
from thermowear.case import load
from thermowear.errors import CaseError, ComputationError
from thermowear.results.points import InterfaceFields
from thermowear.results.quantity import TABLES

from ..conftest import DEMOS

X = np.linspace(0.0, 1.0, 5)
TIMES = np.array([0.0, 10.0, 20.0])
PARTS = {"left": slice(0, 5), "right": slice(5, 10)}


def face(**columns):
    """Points of a contact; columns that are not given are NaN."""
    count = len(columns["x"])
    names = TABLES["interface"].columns
    return InterfaceFields(**dict.fromkeys(names, np.full(count, np.nan)) | columns)


def assembly():
    """Result of two contacts that wear by 1 and 2 mm³/s, at two output times."""
    history = [SimpleNamespace(time=t, wear_volume_1=3e-9 * t) for t in TIMES]
    rows = [
        SimpleNamespace(time=t, contact=k, wear_volume_1=1e-9 * k * t)
        for t in TIMES
        for k in (1, 2)
    ]
    x, depth = np.tile(X, 2), np.repeat([1e-6, 2e-6], 5)
    shown = {t: face(x=x, s=x, wear_1=t * depth) for t in (10.0, 20.0)}
    return SimpleNamespace(
        contacts=PARTS,
        summary={
            "time_s": 20.0,
            "max_pressure_Pa": 7.0,
            "contacts": {
                name: {"max_pressure_Pa": p} for name, p in (("left", 5.0), ("right", 7.0))
            },
        },
        tables=lambda: {"history": history, "contacts": rows},
        outputs={10.0: shown[10.0]},
        interface=shown[20.0],
    )


def test_values_are_those_of_the_contact():
    """requirement: rows, numbers and points of the named contact, not of all contacts together."""
    at, places = {"time": np.array([5.0, 20.0])}, {"x": np.array([0.5])}
    for number, name in enumerate(PARTS, 1):
        found = reading("wear_volume_1", at, 2, name, {}).of(assembly())
        assert found == pytest.approx(1e-9 * number * at["time"], rel=1e-9, abs=0.0)
        assert reading("max_pressure", {}, 1, name, {}).of(assembly()) == [{1: 5.0, 2: 7.0}[number]]
        found = reading("wear_1", places, 1, name, {}).of(assembly())
        assert found == pytest.approx([20e-6 * number], rel=1e-9, abs=0.0)
    whole = reading("wear_volume_1", at, 2, None, {}).of(assembly())
    assert whole == pytest.approx(3e-9 * at["time"], rel=1e-9, abs=0.0)
    with pytest.raises(CaseError, match="needs the contact; one of: left, right"):
        reading("max_pressure", {}, 1, "middle", {}).of(assembly())


def test_masses_are_volumes_times_the_density():
    """requirement: 7800 kg/m³ times the worn volume of the contact."""
    given = reading("worn_mass_1", {"time": np.array([20.0])}, 1, "right", {1: 7800.0, 2: 1.0})
    assert given.of(assembly()) == pytest.approx([7800 * 40e-9], rel=1e-9)
    assert given.quantity.si == "kg"


def test_profiles_are_those_of_their_times():
    """requirement: points at an output time or at the end; other times are refused."""
    at = {"x": np.array([0.5, 0.5]), "time": np.array([20.0, 10.0])}
    found = reading("wear_1", at, 2, "left", {}).of(assembly())
    assert found == pytest.approx([20e-6, 10e-6], rel=1e-9, abs=0.0)
    for time in (0.0, 11.0, 30.0):
        late = {"x": np.array([0.5]), "time": np.array([time])}
        with pytest.raises(ComputationError, match=f"no contact points at {time:g} s"):
            reading("wear_1", late, 1, "left", {}).of(assembly())


def section(**columns):
    return SimpleNamespace(contacts={}, summary={}, outputs={}, interface=face(**columns))


def test_places_tell_the_points_apart():
    """requirement: a coordinate that passes a place twice, or is constant, tells no place."""
    angle = np.linspace(-0.5, 0.5, 41)
    arc = {"x": np.sin(angle), "y": 1 - np.cos(angle), "s": angle, "wear_1": np.exp(angle)}
    for name in ("x", "s"):
        at = {name: np.interp([-0.2, 0.3], angle, arc[name])}
        found = reading("wear_1", at, 2, None, {}).of(section(**arc))
        assert found == pytest.approx(np.exp([-0.2, 0.3]), rel=1e-5)
    flat = arc | {"y": np.zeros(41)}
    for own, names in ((arc, "y"), (arc, "xy"), (arc, "xs"), (flat, "y"), (flat, "xy")):
        with pytest.raises(
            CaseError, match=f"{', '.join(names)} do not tell the places .* such as s"
        ):
            reading("wear_1", {n: np.zeros(1) for n in names}, 1, None, {}).of(section(**own))


def test_places_in_space():
    """requirement: two coordinates that span the face, between the points linearly."""
    x, y = (grid.ravel() for grid in np.meshgrid(X, X))
    space = section(x=x, y=y, z=np.zeros(25), wear_1=1 + 2 * x - y)
    at = {"x": np.array([0.3, 0.9]), "y": np.array([0.6, 0.1])}
    assert reading("wear_1", at, 2, None, {}).of(space) == pytest.approx([1.0, 2.7], rel=1e-9)
    for names in ("x", "xz", "xyz"):
        with pytest.raises(CaseError, match="give two coordinates"):
            reading("wear_1", {n: np.zeros(1) for n in names}, 1, None, {}).of(space)


def test_quantities_without_values():
    """requirement: one line for a quantity that this case leaves empty, in rows and at points."""
    empty = section(x=X, s=X)
    with pytest.raises(CaseError, match="temperature_1: has no value"):
        reading("temperature_1", {"x": np.array([0.5])}, 1, None, {}).of(empty)
    rows = [SimpleNamespace(time=t, friction_torque=np.nan) for t in TIMES]
    empty.tables = lambda: {"history": rows}
    with pytest.raises(CaseError, match="friction_torque: has no value"):
        reading("friction_torque", {"time": np.array([5.0])}, 1, None, {}).of(empty)


DENSITIES = {"left_pad": 2500, "right_pad": 2500, "disk": 7200, "left_plate": 7850}


def measured(path, head, cells, densities=DENSITIES, **observation):
    """Measurements of the brake disk between two pads."""
    path.write_text(f"{head}\n{cells}\n", encoding="utf-8")
    tables = tomllib.loads((DEMOS / "disk_brake_two_pads.toml").read_text("utf-8"))
    tables["bodies"]["right_pad"] = tables["bodies"]["left_pad"]
    for body, density in densities.items():
        tables["bodies"][body] = tables["bodies"][body] | {"density": f"{density} kg/m^3"}
    friction = {"key": "contact.friction", "start": 0.4, "lower": 0.2, "upper": 0.6}
    observed = {"parameters": {"mu": friction}, "observations": {"d": observation}}
    return read_measurements(load(tables | {"calibrate": observed}), {"d": path})


def test_densities_are_those_of_the_bodies_in_contact(tmp_path):
    """requirement: mass of the pad, not of its backing plate, which is the first body."""
    path = tmp_path / "d.csv"
    head, cells = "time [s], {} [g], deviation [g]", "20, 1, 1"
    for name, density in (("worn_mass_1", 2500.0), ("worn_mass_2", 7200.0)):
        for contact in ("left", None):
            (one,) = measured(
                path, head.format(name), cells, **({"contact": contact} if contact else {})
            )
            assert one.reading.factor == density
    other = DENSITIES | {"right_pad": 2600}
    (one,) = measured(path, head.format("worn_mass_1"), cells, other, contact="right")
    assert one.reading.factor == 2600.0
    with pytest.raises(CaseError, match="needs the density of the body, and the contact"):
        measured(path, head.format("worn_mass_1"), cells, other)
    with pytest.raises(CaseError, match="contact: must be one of: left, right"):
        measured(path, head.format("worn_mass_1"), cells, contact="middle")


@pytest.mark.parametrize(
    ("head", "cells", "said"),
    [
        (
            "sliding_distance [m], x [mm], wear_1 [um], deviation [um]",
            "1, 20, 1, 1",
            "at a time or",
        ),
        ("cycle, x [mm], wear_1 [um], deviation [um]", "1, 20, 1, 1", "found cycle"),
    ],
)
def test_profiles_by_other_columns_are_refused(tmp_path, head, cells, said):
    """requirement: a profile at a distance is not taken for that at the end."""
    with pytest.raises(CaseError, match=said):
        measured(tmp_path / "d.csv", head, cells)


def test_plain_deviations_need_a_plain_quantity(tmp_path):
    """requirement: a deviation without unit is not taken for one in SI."""
    with pytest.raises(CaseError, match="found the plain number 2; must be in m"):
        measured(tmp_path / "d.csv", "time [s], max_wear_1 [um]", "20, 60", deviation=2)


def test_percentages_of_temperatures_are_refused(tmp_path):
    """requirement: a percentage of a temperature depends on its scale."""
    with pytest.raises(CaseError, match="depends on the temperature scale; give it in K"):
        measured(tmp_path / "d.csv", "time [s], max_temperature [degC]", "20, 60", deviation="1 %")


@pytest.mark.parametrize(
    ("head", "cells", "given", "value", "deviation"),
    [
        ("max_temperature [degC], deviation [degC]", "60, 2", {}, 333.15, 2.0),
        ("max_temperature [degC]", "60", {"deviation": "2 degC"}, 333.15, 2.0),
        ("approach [um]", "-5", {"deviation": "10 %"}, -5e-6, 5e-7),
        ("approach [um], approach_deviation [nm]", "-5, 20", {}, -5e-6, 2e-8),
    ],
)
def test_deviations_are_differences(tmp_path, head, cells, given, value, deviation):
    """requirement: no offset of a temperature scale, no sign of the value."""
    (one,) = measured(tmp_path / "d.csv", f"time [s], {head}", f"20, {cells}", **given)
    assert one.values == pytest.approx([value], rel=1e-12, abs=0.0)
    assert one.deviations == pytest.approx([deviation], rel=1e-9, abs=0.0)
