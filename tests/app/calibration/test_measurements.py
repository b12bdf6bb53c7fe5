"""Files of observations: notations, mutations, and what is refused before anything is computed."""

from __future__ import annotations

import csv
import io
import os
import re
from pathlib import Path

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.calibration.measurements import read_measurements
from thermowear.app.cli import main
from thermowear.case.values.units import registry, unit_of

from .rings import WEAR, tables

pytestmark = pytest.mark.usefixtures("in_folder")
TEXT = """# volume and torque of a ring
time [s], wear_volume_1 [mm^3], wear_volume_1_deviation [mm^3], friction_torque [kN m], friction_torque_deviation [kN m]
5, 1.5, 0.1, 31.6, 0.4
12, 3.25, 0.1, 30.8, 0.4
20, 5.0, 0.1, 31.3, 0.4
50, 12.125, 0.1, 30.9, 0.4
"""  # noqa: E501
SEED = int(os.environ.get("THERMOWEAR_SEED", "0"))
COUNT = int(os.environ.get("THERMOWEAR_MUTATIONS", "100"))


def case(file="d.csv", **more):
    return tables(parameters={"k": WEAR}, observations={"d": {"file": file} | more})


def read(content: str | bytes, planned=False):
    """Measurements of a file."""
    data = content.encode() if isinstance(content, str) else content
    Path("d.csv").write_bytes(data)
    return read_measurements(tw.load(case()), {}, planned)


def bare(text=TEXT):
    """The table alone, without spaces that mean nothing."""
    return text.partition("\n")[2].replace(", ", ",")


NOTATIONS = {
    "as written": TEXT,
    "semicolons": bare().replace(",", ";"),
    "tabs": bare().replace(",", "\t"),
    "byte order mark": "\ufeff" + bare().replace("\n", "\r\n"),
    "separator told": "sep=;\r\n" + bare().replace(",", ";"),
    "other separator": "sep=|\n" + bare().replace(",", "|"),
    "parentheses": bare().replace("[", "(").replace("]", ")"),
    "empty column at the end": bare().replace("\n", ",\n"),
    "quotation marks": "\n".join(
        ",".join(f'"{cell}"' for cell in line.split(",")) for line in bare().splitlines()
    ),
    "other units": bare().replace("mm^3", "mm**3").replace("kN m", "kN·m"),
}


@pytest.mark.parametrize("content", NOTATIONS.values(), ids=NOTATIONS)
def test_notations_of_the_same_data(content):
    """requirement: the same numbers, whatever a spreadsheet makes of their notation."""
    volume, torque = read(content)
    assert volume.reading.at["time"].tolist() == [5.0, 12.0, 20.0, 50.0]
    assert volume.values == pytest.approx([1.5e-9, 3.25e-9, 5e-9, 12.125e-9], rel=1e-12, abs=0.0)
    assert torque.values == pytest.approx([31600.0, 30800.0, 31300.0, 30900.0], rel=1e-12)
    assert volume.deviations == pytest.approx(np.full(4, 1e-10), rel=1e-12, abs=0.0)


REFUSED = {
    "decimal comma": (
        bare().replace(",", ";").replace(".", ","),
        "d.csv, line 2: wear_volume_1: found '1,5'; must be a finite number with a decimal point",
    ),
    "decimal comma among commas": (bare().replace(".", ","), "d.csv, line 2: has 9 cells for 5"),
    "thousands": (bare().replace("1.5", '"1,500"'), "wear_volume_1: found '1,500'; must be"),
    "gap": (bare().replace("30.8", ""), "line 3: friction_torque: found ''; must be a finite"),
    "overflow": (bare().replace("30.8", "1e999"), "line 3: friction_torque: found '1e999'"),
    "joined cell": (bare().replace("30.8", '"30".8'), "d.csv, line 3: "),
    "unknown column": (bare().replace("\n", ",ok\n").replace("ok", "Note", 1), "column 'Note'; kn"),
    "preamble": ("Tribometer 3.1\n" + bare(), "column 'Tribometer 3.1'; known: x [mm]"),
    "numbered rows": (f",{bare()}".replace("\n", "\n0,", 4), "found the column ''"),
    "units in a row": ("time,friction_torque\ns,kN m\n5,3\n", "time: unit missing; write time [s]"),
    "a product": (bare().replace("kN m", "kNm"), "must be in N m; a product has a space, as in kN"),
    "another encoding": (bare().replace("kN m", "°").encode("latin1"), "is not text in UTF-8; sav"),
    "a workbook": (b"PK\x03\x04\x14\x00\xff", "is not text in UTF-8; save it as CSV in UTF-8"),
    "tiny deviation": (bare().replace("0.1,", "1e-300,", 1), "line 2: the deviation of wear_volu"),
    "beyond the end": (bare().replace("50,", "51,"), "goes to 51 s; the analysis ends before"),
}


@pytest.mark.parametrize(("content", "said"), REFUSED.values(), ids=REFUSED)
def test_validate_reads_the_data(content, said, capsys):
    """requirement: what `calibrate` would refuse, in one line, not too long to be read."""
    Path("d.csv").write_bytes(content if isinstance(content, bytes) else content.encode())
    Path("case.toml").write_text(tomli_w.dumps(case()), encoding="utf-8")
    assert main(["validate", "case.toml"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: calibrate.observations")
    assert said in line
    assert len(line) < 500


def test_validate_of_data_that_are_named_or_planned(capsys):
    """requirement: files of the command line are not missed; a plan needs no values."""
    Path("case.toml").write_text(tomli_w.dumps(case()), encoding="utf-8")
    assert main(["validate", "case.toml"]) == 1
    assert "d.csv cannot be read: No such file" in capsys.readouterr().err
    Path("d.csv").write_text("time [s], wear_volume_1_deviation [mm^3]\n20, 1\n50, 1\n")
    assert main(["validate", "case.toml"]) == 0
    assert "2 planned observations" in capsys.readouterr().out
    open_ = tables(parameters={"k": WEAR}, observations={"d": {}})
    Path("case.toml").write_text(tomli_w.dumps(open_), encoding="utf-8")
    assert main(["validate", "case.toml"]) == 0


@pytest.mark.parametrize("deviation", ["1e-300 mm^3", "0.00000000000001 %"])
def test_tiny_deviations_of_the_case(deviation):
    """requirement: deviations below rounding, of all values or of a prior, are one line."""
    Path("d.csv").write_text("time [s], wear_volume_1 [mm^3]\n20, 1\n50, 2\n")
    given = tw.load(case(deviation=deviation))
    for planned in (False, True):
        with pytest.raises(tw.CaseError, match="below the rounding of numbers"):
            read_measurements(given, {}, planned)
    held = WEAR | {"prior": {"value": "1e-7 1/MPa", "deviation": "1e-300 1/MPa"}}
    with pytest.raises(tw.CaseError, match=r"prior\.deviation: is below the rounding"):
        tw.load(tables(parameters={"k": held}))


def mutated(draw: np.random.Generator) -> bytes:
    """Content with one to three changes of bytes, cells, rows or columns."""
    data = (TEXT if draw.random() < 0.5 else bare()).encode()
    for _ in range(draw.integers(1, 4)):
        at, marks = int(draw.integers(len(data) + 1)), b",;\t\n\r\"#.eE-+ 0[]()\x00\xff%'"
        mark = bytes([marks[draw.integers(len(marks))]])
        lines = data.split(b"\n")
        row, other = (int(k) for k in draw.integers(len(lines), size=2))
        data = [
            data[:at] + mark + data[at:],
            data[:at] + data[at + 1 :],
            data[:at] + mark + data[at + 1 :],
            data[:at],
            data.replace(b",", mark),
            data.replace(b".", mark),
            b"\n".join([*lines[:row], lines[other], *lines[row + 1 :]]),
            b"\n".join([*lines[:row], *lines[row + 1 :]]),
            data.decode("latin1").encode("utf-16"),
            data.replace(b"[", b"(").replace(b"kN", b"MN"),
        ][draw.integers(10)]
    return data


def cells_of(data: bytes) -> list[list[str]]:
    """Rows of a file by the definition of CSV, without those that are comments or empty."""
    lines = [line for line in data.decode("utf-8-sig").splitlines() if line.strip()]
    lines = [line for line in lines if not line.lstrip().startswith("#")]
    mark = next((mark for mark in ";\t" if mark in lines[0]), ",")
    found = list(csv.reader(io.StringIO("\n".join(lines)), delimiter=mark, skipinitialspace=True))
    return [[cell.strip() for cell in row] for row in found]


def test_mutated_files_lose_nothing():
    """requirement: refused in one line, or each number of each row of the file is a measurement."""
    accepted = 0
    for k in range(COUNT):
        data = mutated(np.random.default_rng([SEED, k]))
        try:
            found = read(data)
        except tw.CaseError as error:
            (line,) = error.faults
            assert line.startswith("calibrate.observations.d: "), (k, line)
            continue
        accepted += 1
        head, *rows = cells_of(data)
        parts = [re.split(r"[\[(]", cell, maxsplit=1) for cell in head if cell]
        columns = {"_".join(part[0].lower().split()): k for k, part in enumerate(parts)}
        assert len(columns) == 2 * len(found) + len(found[0].reading.at), (k, data)
        for one in found:
            name = one.reading.name
            given = {name: one.values, f"{name}_deviation": one.deviations} | one.reading.at
            for key, values in given.items():
                unit = parts[columns[key]][1].strip(" )]")
                size = registry().Quantity(1.0, unit_of(unit)).to_base_units().magnitude
                expected = [size * float(row[columns[key]]) for row in rows]
                assert values == pytest.approx(expected, rel=1e-9, abs=0.0), (k, key, data)
    assert 0.02 * COUNT < accepted < 0.9 * COUNT
