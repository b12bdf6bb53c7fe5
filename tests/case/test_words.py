"""Hints in starters and messages on keys that are often set wrongly."""

from __future__ import annotations

import re
import warnings

import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case.starters import starter_text, starters
from thermowear.errors import CaseNote

from .bad import faults
from .starter import GONE, STEADY, tables

PER = "wear.punch.per"


def notes(given: dict) -> list[str]:
    """Notes issued for a case."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", CaseNote)
        tw.load(given)
    return [str(one.message) for one in found]


@pytest.mark.parametrize("name", starters())
def test_every_starter_says_what_its_coefficients_multiply(name):
    """
    requirement: `per` stands below every wear coefficient; nothing is to be noted.
    """
    laws = {k: v for k, v in tables(name).get("wear", {}).items() if isinstance(v, dict)}
    assert all("per" in law for law in laws.values())
    assert notes(tables(name)) == []


@pytest.mark.parametrize("exponent", [1.0, 2.0])
def test_per_left_out_is_noted(exponent):
    """
    requirement: Archard's k read as beta is off by mu^b; that is said, with the ratio.
    """
    law = {
        "wear.punch.coefficient": f"2e-7 1/MPa^{exponent}",
        "wear.punch.pressure_exponent": exponent,
    }
    (note,) = notes(tables(STEADY, law | {PER: GONE}))
    assert note.startswith("wear.punch.per is left out")
    assert f"{0.25**-exponent:g} times as fast" in note
    assert notes(tables(STEADY, law | {PER: "pressure"})) == []


@pytest.mark.parametrize("command", ["validate", "mesh"])
def test_commands_print_notes(command, tmp_path, capsys):
    """
    requirement: a note is no fault: exit code 0, once on the error stream.
    """
    file = tmp_path / "case.toml"
    file.write_text(re.sub(r"(?m)^per = .*$", "", starter_text(STEADY)), encoding="utf-8")
    words = ["-o", str(tmp_path / "mesh.vtu")] if command == "mesh" else []
    assert main([command, str(file), *words]) == 0
    printed = capsys.readouterr()
    assert printed.err.startswith("note: wear.punch.per is left out")
    assert printed.err.count("\n") == 1
    assert ("ok" if command == "validate" else "wrote") in printed.out


@pytest.mark.parametrize("name", [n for n in starters() if "arc_start" in starter_text(n)])
def test_angles_say_where_they_begin(name):
    """
    requirement: from which direction angles are measured, and which way.
    """
    assert "from 12 o'clock (+y), clockwise" in starter_text(name)


@pytest.mark.parametrize("name", [n for n in starters() if "disk_thickness" in starter_text(n)])
def test_a_thickness_says_of_what(name):
    """
    requirement: whether the thickness of a disk is that of the whole one.
    """
    assert re.search(r"(?m)^disk_thickness = .*# of the whole disk", starter_text(name))


LIMITS = [
    ("drum-brake", {"geometry.pivot": ["0 mm", "300 mm"]}, "must be less than drum_radius 0.1"),
    ("drum-brake", {"geometry.pivot": ["50 mm", "0 mm"]}, "90 deg clockwise from 12 o'clock"),
    ("drum-brake", {"geometry.arc_end": "300 deg"}, "at most 170 deg"),
    ("block-on-disk", {"geometry.arc_start": "-170 deg"}, "of 12 o'clock (+y), on either side"),
    ("cylinder-stick-slip", {"analysis.output_times": ["9 s"]}, "from 0 s to 3 s"),
]


@pytest.mark.parametrize(("name", "changes", "text"), LIMITS)
def test_limits_are_named(name, changes, text):
    """
    requirement: a message about a limit says which one it is.
    """
    (line,) = faults(changes, name)
    assert text in line
