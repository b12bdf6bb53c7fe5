"""Everything that can be wrong in a case: one line a fault, with the key's path."""

from __future__ import annotations

import datetime
from dataclasses import dataclass, field
from math import inf, nan
from typing import Any

import pytest
import tomli_w

import thermowear as tw
from thermowear.cli import main

from .starter import GONE, RUNNING_IN, STEADY, tables


@dataclass(frozen=True)
class Bad:
    """A change of a starter case and what must be said about it."""

    name: str
    changes: dict[str, Any]
    path: str
    text: str
    starter: str = field(default=STEADY)


YOUNG, NU, COOL = "bodies.punch.young_modulus", "bodies.punch.poisson_ratio", "heat.cooling"
COEFFICIENT, A, B = (
    f"wear.punch.{key}" for key in ("coefficient", "velocity_exponent", "pressure_exponent")
)
END, TIMES = "analysis.end_time", "analysis.output_times"

NAMES = [
    Bad("unknown key", {"mesh.elemnts": 4}, "mesh.elemnts", "did you mean elements?"),
    Bad("key of another table", {"mesh.friction": 0.2}, "mesh.friction", "known: bodies, degree"),
    Bad("key of another analysis", {TIMES: ["1 s"]}, TIMES, "unknown key here"),
    Bad("key named as an analysis", {"analysis.steady": 1}, "analysis.steady", "unknown key"),
    Bad("unknown table", {"geometri": {}}, "geometri", "did you mean geometry?"),
    Bad("unknown key of a body", {"bodies.punch.nu": 0.3}, "bodies.punch.nu", "unknown key"),
    Bad("unknown key of the geometry", {"geometry.width": "1 m"}, "geometry.width", "unknown key"),
    Bad("unknown body", {"bodies.disc": {"like": "punch"}}, "bodies.disc", "punch, plate"),
    Bad("body left out", {"bodies.plate": GONE}, "bodies.plate", "missing"),
    Bad(
        "wear of an unknown body",
        {"wear.disc": {"coefficient": "1e-7 1/MPa"}},
        "wear.disc",
        "one of: punch, plate",
    ),
    Bad(
        "mesh of an unknown body",
        {"mesh.bodies.disc": {"elements": 3}},
        "mesh.bodies.disc",
        "one of: punch, plate",
    ),
    Bad(
        "cooling of an unknown surface",
        {f"{COOL}.top": "1 W/(m^2 K)"},
        f"{COOL}.top",
        "plate_bottom",
    ),
    Bad(
        "temperature of an unknown surface",
        {"heat.temperature.top": "20 degC"},
        "heat.temperature.top",
        "plate_bottom",
    ),
    Bad("unknown geometry", {"geometry.type": "cone"}, "geometry.type", "annular-punch"),
    Bad("geometry without type", {"geometry.type": GONE}, "geometry.type", "annular-punch"),
    Bad("unknown analysis", {"analysis.type": "modal"}, "analysis.type", "found 'modal'"),
    Bad("analysis without type", {"analysis.type": GONE}, "analysis.type", "'transient'"),
    Bad("unknown method", {"contact.method": "magic"}, "contact.method", "'condensed'"),
    Bad("unknown model", {"model": "3d"}, "model", "found '3d'"),
    Bad(
        "unknown pressure or stress",
        {"wear.punch.per": "area"},
        "wear.punch.per",
        "'friction-stress' or 'pressure'",
    ),
    Bad("no model", {"model": GONE}, "model", "missing"),
    Bad("no geometry", {"geometry": GONE}, "geometry", "missing"),
    Bad("no bodies", {"bodies": GONE}, "bodies", "missing"),
    Bad("no load", {"load": GONE}, "load", "missing"),
    Bad("no analysis", {"analysis": GONE}, "analysis", "missing"),
    Bad("size left out", {"geometry.plate_height": GONE}, "geometry.plate_height", "missing"),
]

QUANTITIES = [
    Bad("no unit", {YOUNG: "200e9"}, YOUNG, "without a unit"),
    Bad("bare number", {YOUNG: 200e9}, YOUNG, "needs a quantity with its unit"),
    Bad("wrong dimension", {YOUNG: "200 mm"}, YOUNG, "dimension [length]; needs one of Pa"),
    Bad("unreadable unit", {YOUNG: "200 furlongpascal"}, YOUNG, "cannot read"),
    Bad("unreadable number", {YOUNG: "two GPa"}, YOUNG, "cannot read"),
    Bad("unit alone", {YOUNG: "GPa"}, YOUNG, "cannot read"),
    Bad("two numbers", {YOUNG: "200 300 GPa"}, YOUNG, "cannot read"),
    Bad(
        "comma in the number",
        {"geometry.inner_radius": "20,5 mm"},
        "geometry.inner_radius",
        "cannot read",
    ),
    Bad("empty text", {YOUNG: ""}, YOUNG, "cannot read"),
    Bad("quantity nan", {YOUNG: "nan GPa"}, YOUNG, "must be finite"),
    Bad("quantity inf", {YOUNG: "inf GPa"}, YOUNG, "must be finite"),
    Bad("too large for a number", {YOUNG: "1e400 Pa"}, YOUNG, "must be finite"),
    Bad("too large in SI", {YOUNG: "1e308 GPa"}, YOUNG, "must be finite in Pa"),
    Bad("too small in SI", {YOUNG: "1e-323 mPa"}, YOUNG, "greater than 0 Pa"),
    Bad(
        "negative conductivity",
        {"bodies.punch.conductivity": "-50 W/(m K)"},
        "bodies.punch.conductivity",
        'found "-50 W/(m K)"; must be greater than 0 W/m/K',
    ),
    Bad(
        "zero conductivity",
        {"bodies.punch.conductivity": "0 W/(m K)"},
        "bodies.punch.conductivity",
        "greater than 0",
    ),
    Bad(
        "negative expansion",
        {"bodies.punch.expansion": "-1e-5 1/K"},
        "bodies.punch.expansion",
        "at least 0 1/K",
    ),
    Bad("zero load", {"load.mean_pressure": "0 MPa"}, "load.mean_pressure", "greater than 0 Pa"),
    Bad(
        "colder than 0 K",
        {"heat.ambient": "-300 degC"},
        "heat.ambient",
        'found "-300 degC"; must be at least 0 K',
    ),
    Bad(
        "turns for an angle",
        {"motion.angular_velocity": "10 Hz"},
        "motion.angular_velocity",
        "turn/s, or rad/s",
    ),
    Bad("zero conductance", {"heat.conductance": "0 W/(m^2 K)"}, "heat.conductance", "greater"),
]

NUMBERS = [
    Bad("incompressible", {NU: 0.5}, NU, "found 0.5; must be less than 0.5"),
    Bad("Poisson's ratio -1", {NU: -1}, NU, "found -1; must be greater than -1"),
    Bad("Poisson's ratio nan", {NU: nan}, NU, "finite number"),
    Bad("friction inf", {"contact.friction": inf}, "contact.friction", "finite number"),
    Bad("negative friction", {"contact.friction": -0.1}, "contact.friction", "at least 0"),
    Bad("friction as text", {"contact.friction": "0.25"}, "contact.friction", "must be a number"),
    Bad("friction true", {"contact.friction": True}, "contact.friction", "must be a number"),
    Bad("partition 1.5", {"heat.partition": 1.5}, "heat.partition", "at most 1"),
    Bad("degree 11", {"mesh.degree": 11}, "mesh.degree", "at most 10"),
    Bad("degree 0", {"mesh.degree": 0}, "mesh.degree", "at least 1"),
    Bad("degree 2.5", {"mesh.degree": 2.5}, "mesh.degree", "whole number"),
    Bad("degree 2.0", {"mesh.degree": 2.0}, "mesh.degree", "whole number"),
    Bad("degree true", {"mesh.degree": True}, "mesh.degree", "whole number"),
    Bad("degree nan", {"mesh.degree": nan}, "mesh.degree", "whole number"),
    Bad("no elements", {"mesh.elements": 0}, "mesh.elements", "at least 1"),
    Bad(
        "no elements of a body",
        {"mesh.bodies.plate": {"elements": 0}},
        "mesh.bodies.plate.elements",
        "at least 1",
    ),
    Bad("too many elements", {"mesh.elements": 10**30}, "mesh.elements", "at most 2000"),
    Bad("grading 1.5", {"mesh.grading": 1.5}, "mesh.grading", "at most 1"),
    Bad("grading true", {"mesh.grading": True}, "mesh.grading", "must be a number"),
    Bad(
        "degree of pressure above that of displacement",
        {"contact.pressure_degree": 9},
        "contact.pressure_degree",
        "at most mesh.degree = 8",
    ),
    Bad("tolerance 0", {"analysis.tolerance": 0}, "analysis.tolerance", "at least", RUNNING_IN),
    Bad("tolerance nan", {"analysis.tolerance": nan}, "analysis.tolerance", "finite", RUNNING_IN),
    Bad("no steps", {"analysis.max_steps": 0}, "analysis.max_steps", "at least 1", RUNNING_IN),
    Bad("exponent 0", {B: 0}, B, "at least 0.1"),
    Bad("exponent nan", {A: nan}, A, "finite number"),
]

KINDS = [
    Bad("table for a number", {NU: {"value": 0.3}}, NU, "must be a number"),
    Bad("list for a number", {NU: [0.3]}, NU, "found [0.3]; must be a number"),
    Bad("date for a number", {NU: datetime.date(2020, 2, 2)}, NU, "must be a number"),
    Bad("number for a table", {"mesh": 8}, "mesh", "found 8; must be a table"),
    Bad("number for the geometry", {"geometry": 8}, "geometry", "needs a table"),
    Bad("number for the analysis", {"analysis": 8}, "analysis", "found 8; must be a table"),
    Bad("number for a body", {"bodies.plate": 8}, "bodies.plate", "must be a table"),
    Bad("list for bodies", {"bodies": [1]}, "bodies", "must be a table"),
    Bad("text for a wear law", {"wear.punch": "hard"}, "wear.punch", "must be a table"),
    Bad("list for text", {"title": ["a"]}, "title", "must be text"),
    Bad("number for text", {"bodies.plate.like": 3}, "bodies.plate.like", "must be text"),
    Bad("list for a quantity", {YOUNG: ["200 GPa"]}, YOUNG, "needs a quantity"),
    Bad("table for a quantity", {YOUNG: {"GPa": 200}}, YOUNG, "needs a quantity"),
    Bad("list for a type", {"analysis.type": ["steady"]}, "analysis.type", "must be one of"),
    Bad("list for a geometry", {"geometry.type": ["cone"]}, "geometry.type", "must be one of"),
    Bad("text for a list", {TIMES: "1 s"}, TIMES, "must be a list", RUNNING_IN),
]

RELATIONS = [
    Bad(
        "ring inside out",
        {"geometry.inner_radius": "130 mm"},
        "geometry.inner_radius",
        "0.13 m must be less than outer_radius 0.12 m",
    ),
    Bad(
        "plate smaller than the ring",
        {"geometry.plate_radius": "110 mm"},
        "geometry.plate_radius",
        "greater than outer_radius",
    ),
    Bad("force and pressure", {"load.force": "1 kN"}, "load", "exactly one"),
    Bad("neither force nor pressure", {"load.mean_pressure": GONE}, "load", "exactly one"),
    Bad("no modulus", {YOUNG: GONE}, YOUNG, "missing"),
    Bad("no Poisson's ratio", {NU: GONE}, NU, "missing"),
    Bad("like no body", {"bodies.plate.like": "disc"}, "bodies.plate.like", "punch, plate"),
    Bad("like itself", {"bodies.plate.like": "plate"}, "bodies.plate.like", "back to itself"),
    Bad(
        "like, and a key of its own",
        {"bodies.plate.density": "7800 kg/m^3"},
        "bodies.plate.density",
        "no keys of its own",
    ),
    Bad(
        "no friction for friction stress",
        {"contact.friction": 0, "heat": GONE},
        "contact.friction",
        'write per = "pressure"',
    ),
    Bad(
        "no friction for heat",
        {"contact.friction": 0, "wear.punch.per": "pressure"},
        "contact.friction",
        "heat needs friction",
    ),
    Bad("steady without wear", {"wear": GONE}, "wear", "steady analysis needs"),
    Bad("transient without wear", {"wear": GONE}, "wear", "transient analysis needs", RUNNING_IN),
    Bad("no motion", {"motion": GONE}, "motion", "need sliding"),
    Bad("coefficient without unit", {COEFFICIENT: "2e-7"}, COEFFICIENT, "without a unit"),
    Bad("coefficient 0", {COEFFICIENT: "0 1/MPa"}, COEFFICIENT, "greater than 0"),
    Bad("coefficient vanishes in SI", {COEFFICIENT: "1e-320 1/MPa"}, COEFFICIENT, "out of range"),
    Bad("unit does not fit b", {B: 2.0}, COEFFICIENT, "needs 1/MPa^2"),
    Bad("unit does not fit b = 1/2", {B: 0.5}, COEFFICIENT, "needs 1/MPa^0.5"),
    Bad("unit does not fit a", {A: 0.5}, COEFFICIENT, "needs (m/s)^0.5 1/MPa^1"),
    Bad("coefficient a length", {COEFFICIENT: "2 mm"}, COEFFICIENT, "does not fit"),
    Bad("heat without sink", {"heat.cooling": GONE}, "heat", "nowhere to go"),
    Bad(
        "cooled, and of given temperature",
        {"heat.temperature": {"plate_bottom": "20 degC"}},
        f"{COOL}.plate_bottom",
        "given temperature already",
    ),
    Bad(
        "cooled contact face",
        {f"{COOL}.punch_face": "9 W/(m^2 K)"},
        f"{COOL}.punch_face",
        "contact face",
    ),
    Bad(
        "contact face of given temperature",
        {"heat.temperature": {"plate_face": "20 degC"}},
        "heat.temperature.plate_face",
        "contact face",
    ),
    Bad(
        "heat without conductivity",
        {"bodies.punch.conductivity": GONE},
        "bodies.punch.conductivity",
        "[heat]",
    ),
    Bad(
        "heat without expansion",
        {"bodies.punch.expansion": GONE},
        "bodies.punch.expansion",
        "[heat]",
    ),
    Bad("transient without end", {END: GONE}, END, 'or until = "steady"', RUNNING_IN),
    Bad("output after the end", {TIMES: ["1 s", "5 min"]}, TIMES, "300 s lies after", RUNNING_IN),
    Bad("negative output time", {TIMES: ["1 s", "-1 s"]}, f"{TIMES}.1", "greater", RUNNING_IN),
    Bad("output time twice", {TIMES: ["1 s", "1000 ms"]}, TIMES, "1 s is there twice", RUNNING_IN),
    Bad("negative end", {END: "-1 s"}, END, "greater than 0 s", RUNNING_IN),
    Bad("end 0", {END: "0 s"}, END, "greater than 0 s", RUNNING_IN),
    Bad("until never", {"analysis.until": "never"}, "analysis.until", "'steady'", RUNNING_IN),
]

ALL = NAMES + QUANTITIES + NUMBERS + KINDS + RELATIONS


@pytest.mark.parametrize("bad", ALL, ids=lambda bad: bad.name)
def test_a_fault_is_one_line_with_the_path_of_its_key(bad, tmp_path, capsys):
    """
    requirement: bad input ends with exit code 1 and one line: exact path, what is wrong with it.
    """
    file = tmp_path / "case.toml"
    file.write_text(tomli_w.dumps(tables(bad.starter, bad.changes)), encoding="utf-8")
    code = main(["validate", str(file)])
    printed = capsys.readouterr()
    assert code == 1
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert line.startswith(f"error: {bad.path}: ")
    assert bad.text in line


def faults(changes: dict[str, Any], starter: str = STEADY) -> list[str]:
    with pytest.raises(tw.CaseError) as caught:
        tw.load(tables(starter, changes))
    return caught.value.faults


def test_several_faults_give_a_line_each():
    """
    requirement: one line per fault, not one run per fault.
    """
    found = faults({NU: 0.6, "mesh.degree": 11, "model": "3d", "geometry.plate_radius": "1 s"})
    assert sorted(line.split(":")[0] for line in found) == [
        NU,
        "geometry.plate_radius",
        "mesh.degree",
        "model",
    ]


def test_several_faults_between_tables_give_a_line_each():
    """
    requirement: one line per fault, for what does not fit together too.
    """
    found = faults({"load.force": "1 N", "motion": GONE, "wear": GONE, f"{COOL}.x": "1 W/m^2/K"})
    assert sorted(line.split(":")[0] for line in found) == [
        "heat.cooling.x",
        "load",
        "motion",
        "wear",
    ]


def test_every_key_beside_like_is_named():
    """
    requirement: one line per fault: each key that a body may not have beside `like`.
    """
    found = faults({"bodies.plate.density": "1 kg/m^3", "bodies.plate.poisson_ratio": 0.2})
    assert [line.split(":")[0] for line in found] == [
        "bodies.plate.density",
        "bodies.plate.poisson_ratio",
    ]


def test_bodies_like_each_other_in_a_circle():
    """
    requirement: a circle of `like` is reported at each of its bodies, and does not hang.
    """
    found = faults({"bodies.punch": {"like": "plate"}})
    assert [line.split(":")[0] for line in found] == ["bodies.punch.like", "bodies.plate.like"]
    assert all("back to itself" in line for line in found)


def test_an_unknown_body_is_not_asked_for_its_material():
    """
    requirement: one line per fault: the wrong name is the fault, not what is missing under it.
    """
    assert [line.split(":")[0] for line in faults({"bodies.disc": {}})] == ["bodies.disc"]


def test_an_empty_case_names_every_table_it_needs():
    """
    requirement: an empty file gets one line per missing table.
    """
    with pytest.raises(tw.CaseError) as caught:
        tw.load({})
    assert caught.value.faults == [
        f"{key}: missing" for key in ("model", "geometry", "bodies", "load", "analysis")
    ]


def test_what_is_wrong_with_heat_does_not_matter_without_heat():
    """
    requirement: without [heat] the run is isothermal and needs no thermal material.
    """
    gone = {f"bodies.punch.{key}": GONE for key in ("conductivity", "expansion")}
    assert tw.load(tables(STEADY, {"heat": GONE, **gone})).heat is None


def test_initial_contact_needs_neither_wear_nor_motion():
    """
    requirement: what an analysis does not use may be left out.
    """
    changes = {"wear": GONE, "motion": GONE, "heat": GONE, "analysis": {"type": "initial"}}
    assert tw.load(tables(STEADY, changes)).analysis.type == "initial"


FILES = [
    ("syntax", b'title = "a"\nmodel = \n', "line 2"),
    ("key twice", b"a = 1\na = 2\n", "line 2"),
    ("table twice", b"[mesh]\n[load]\n[mesh]\n", "line 3"),
    ("not UTF-8", b'title = "\xff"\n', "UTF-8"),
    ("binary", b"\x00\x01\x02", "line 1"),
    ("number too long", b"a = " + b"9" * 5000, "TOML"),
    ("nested too deeply", b"a = " + b"[" * 5000, "TOML"),
]


@pytest.mark.parametrize(("content", "text"), [f[1:] for f in FILES], ids=[f[0] for f in FILES])
def test_a_file_that_is_no_toml(content, text, tmp_path, capsys):
    """
    requirement: a file that cannot be read as TOML: exit code 1, one line with file and place.
    """
    file = tmp_path / "case.toml"
    file.write_bytes(content)
    assert main(["validate", str(file)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"error: {file}: ")
    assert text in line


@pytest.mark.parametrize(
    ("name", "text"),
    [("missing.toml", "No such file"), (".", "directory"), ("n" * 300, "too long")],
    ids=["missing", "directory", "name too long"],
)
def test_a_file_that_cannot_be_opened(name, text, tmp_path, capsys):
    """
    requirement: a case that is not there: exit code 1, one line that names it and says why.
    """
    assert main(["validate", str(tmp_path / name)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"error: {tmp_path / name}: cannot be read")
    assert text in line


def test_a_fault_stays_one_line_whatever_the_key(tmp_path, capsys):
    """
    requirement: one line per fault, though the key or the value has line breaks.
    """
    file = tmp_path / "case.toml"
    changes = {"mesh.a\nb": 1, YOUNG: "200\nGPb"}
    file.write_text(tomli_w.dumps(tables(STEADY, changes)), encoding="utf-8")
    assert main(["validate", str(file)]) == 1
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(": ")[1] for line in lines] == [r"mesh.a\nb", YOUNG]
