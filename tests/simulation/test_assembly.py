"""Disk between two pads: symmetry, order of the names, units, ranks, restarts."""

import json
from dataclasses import replace

import numpy as np
import pytest
import tomli_w

from thermowear.app.cli import main
from thermowear.case import load
from thermowear.errors import CaseError
from thermowear.verification.cases.assembly.pad_disk_pad import (
    FORCE,
    Brake,
    at_contact,
    balances,
    halves_agree,
)
from thermowear.verification.check import computed

from ..app.test_resume import assert_the_same
from ..slow import marked_slow
from ..test_parallel import pytestmark as needs_mpirun
from ..test_parallel import same_on_two_ranks
from . import assembly_on_ranks

UNEQUAL = Brake("floating", 9.0, heated=True, elements=4)
IN_TIME = replace(UNEQUAL, transient=True)
NAMES = ("pressure", "wear_1", "wear_2", "temperature_1", "temperature_2", "heat_flux_1", "shape")
SWAPPED = {name: name[:-1] + str(3 - int(name[-1])) for name in NAMES if name[-1].isdigit()}


def assert_alike(found, expected, contacts=("left", "right"), swapped=(), tolerance=1e-9):
    """Compare the fields of both results by contact; those of swapped contacts with sides."""
    for contact in contacts:
        ours, theirs = at_contact(found, contact), at_contact(expected, contact)
        for name in NAMES:
            values = getattr(theirs, name)
            other = SWAPPED.get(name, name) if contact in swapped else name
            atol = tolerance * np.abs(values).max()
            np.testing.assert_allclose(
                getattr(ours, other), values, rtol=0.0, atol=atol, err_msg=f"{contact} {name}"
            )


@pytest.mark.parametrize(
    ("state", "heated", "transient"),
    [
        ("unworn", False, False),
        ("steady", True, False),
        ("after running-in", False, False),
        ("after running-in", True, True),
    ],
)
def test_equal_pads_are_the_half_model(state, heated, transient):
    """requirement: both halves of a symmetric brake are the model of one half, to 1e-9."""
    checks = list(halves_agree(state, heated, transient, elements=4))
    assert len(checks) >= 4
    assert not [check for check in checks if not check.passed]


@pytest.mark.parametrize("disk", ["floating", "fixed", "clamped"])
def test_unequal_pads_are_in_balance(disk):
    """requirement: forces of contacts, holders and hub, heat and power, all to 1e-9."""
    checks = list(balances(replace(IN_TIME, disk=disk), "after running-in"))
    assert len(checks) >= 7
    assert not [check for check in checks if not check.passed]


def mirrored(tables):
    """Tables of the same brake upside down."""
    text = json.dumps(tables)
    for old, new in (("_top", "_*"), ("_bottom", "_top"), ("_*", "_bottom")):
        text = text.replace(old, new)
    found = json.loads(text)
    layers = found["geometry"]["layers"]
    found["geometry"]["layers"] = dict(reversed(layers.items()))
    return found


@pytest.mark.parametrize("brake", [UNEQUAL, IN_TIME], ids=["quasi-steady", "in time"])
def test_a_brake_upside_down(brake):
    """requirement: the same fields at each contact, and the opposite motion of the hub."""
    expected = brake.run("after running-in")
    found = computed(load(mirrored(brake.tables("after running-in"))))
    assert_alike(found, expected)
    one, other = (r.summary["holders"]["hub"]["approach_m"] for r in (found, expected))
    assert one == pytest.approx(-other, rel=1e-8, abs=0.0)
    assert one != 0.0
    for contact in ("left", "right"):
        force = found.summary["contacts"][contact]["normal_force_N"]
        assert force == pytest.approx(FORCE, rel=1e-9)


def test_the_pressed_body_may_be_the_lower_one():
    """requirement: two bodies upside down, so that the second one is held: the same fields."""
    brake = Brake("half", heated=True, elements=4)
    tables = mirrored(brake.tables("after running-in"))
    found = computed(load(tables))
    assert_alike(found, brake.run("after running-in"), contacts=("left",))


def test_order_of_the_contacts_and_of_their_faces():
    """requirement: contacts in another order, one with its faces exchanged: the same fields."""
    tables = UNEQUAL.tables("after running-in")
    expected = computed(load(tables))
    left, right = tables["contacts"]["left"], tables["contacts"]["right"]
    exchanged = {"between": left["between"][::-1], "partition": 0.95}
    tables["contacts"] = {"right": right, "left": exchanged}
    found = computed(load(tables))
    assert list(found.contacts) == ["right", "left"]
    assert_alike(found, expected, swapped=("left",))
    for name in ("bodies", "holders"):
        for key, entries in expected.summary[name].items():
            errors = {quantity for quantity in entries if quantity.endswith("_relative_error")}
            for quantity in entries.keys() - errors:
                ours, value = found.summary[name][key][quantity], entries[quantity]
                assert ours == pytest.approx(value, rel=1e-8, abs=1e-20), (name, key, quantity)


def test_other_units():
    """requirement: the same numbers from a case in other units."""
    tables = UNEQUAL.tables("after running-in")
    expected = computed(load(tables))
    layers, holders = tables["geometry"]["layers"], tables["holders"]
    layers["left"] = {"x": ["0.08 m", "13 cm"], "height": "0.015 m"}
    holders["left"]["force"] = "0.5 kN"
    tables["motions"]["disk"]["angular_velocity"] = f"{0.5 * 30 / np.pi!r} rpm"
    tables["wear"]["right"] = {"coefficient": "1e-13 1/Pa", "per": "friction-stress"}
    tables["heat"]["ambient"] = "20 degC"
    assert_alike(computed(load(tables)), expected)


@needs_mpirun
@pytest.mark.parametrize(
    "kind", marked_slow(assembly_on_ranks.KINDS, "by region", "coated", "quasi-steady")
)
def test_two_ranks(tmp_path, kind):
    """requirement: two ranks give the running-in of the serial run, to 1e-8."""
    expected = assembly_on_ranks.computed(kind)
    same_on_two_ranks("tests.simulation.assembly_on_ranks", tmp_path, expected, kind)


def test_a_run_goes_on_from_its_checkpoint(tmp_path, capsys):
    """requirement: stopped and resumed with temperatures in time: every table the same to 1e-12."""
    case = tmp_path / "brake.toml"
    case.write_text(tomli_w.dumps(IN_TIME.tables("after running-in")))
    arguments = ["run", str(case), "--no-pictures", "-o"]
    assert main([*arguments, str(tmp_path / "whole")]) == 0
    stopped = [*arguments, str(tmp_path / "stopped")]
    assert main([*stopped, "--set=analysis.max_steps=12"]) == 2
    assert (tmp_path / "stopped" / "checkpoint.npz").exists()
    assert main([*stopped, "--resume"]) == 0
    assert "resumed from" in capsys.readouterr().out
    assert_the_same(tmp_path / "stopped", tmp_path / "whole")
    tables = {path.name for path in (tmp_path / "whole").glob("interface_*.csv")}
    assert tables == {"interface_left.csv", "interface_right.csv"}


def test_nothing_that_resists_is_refused():
    """requirement: holders that can move together without closing a gap are named."""
    tables = UNEQUAL.tables("unworn")
    tables["holders"]["right"] = {"surface": "right_bottom", "force": f"{FORCE} N"}
    with pytest.raises(CaseError, match=r"holders: the free motions left \(z\), right \(z\), hub"):
        computed(load(tables))
