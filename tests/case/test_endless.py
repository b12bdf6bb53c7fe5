"""Case files that would take for ever, or all the memory, to be read."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case.loading import (
    LARGEST_FILE,
    LONGEST_KEY,
    MOST_PARTS,
    MOST_VALUES,
    check_keys,
)
from thermowear.case.starters import starter_text
from thermowear.errors import MOST_FAULTS

from .bad import faults
from .starter import RUNNING_IN, STEADY, tables

PRESSURE, COEFFICIENT = "load.mean_pressure", "wear.punch.coefficient"

TOWERS = [
    "1 m^9^9^9",
    "1 m**9**9**9",
    "1 m⁹^9^9",
    "1 m^9⁹⁹⁹⁹⁹⁹⁹⁹",
    "1 m^(9^(9^9))",
    "1 m^(9)^9^9",
    "1 (9^9^9) Pa",
    "1 9^999999999 Pa",
    "1 m^999999999",
    "1 " + "(" * 60 + "9" + "^20)" * 60 + " Pa",
]


@pytest.mark.parametrize("key", [PRESSURE, COEFFICIENT])
@pytest.mark.parametrize("text", TOWERS)
def test_towers_of_powers(text, key):
    """
    requirement: no power of powers is worked out: it would have more digits than there is memory.
    """
    (line,) = faults({key: text})
    assert line.startswith(f"{key}: ")


@pytest.mark.parametrize(
    ("text", "pascal"),
    [
        ("2 (N)^(1/1)/m²", 2.0),
        ("2 N^1 m^-2", 2.0),
        ("2 N m⁻²", 2.0),
        ("2 (N^2/m^4)^0.5", 2.0),
        ("2 (N² / m⁴)^(1/2)", 2.0),
        ("2 kg^1.0/m^1.0/s**2.0", 2.0),
    ],
)
def test_small_powers_are_read(text, pascal):
    """
    requirement: exponents as engineers write them, fractions and brackets too, are understood.
    """
    case = tw.load(tables(STEADY, {PRESSURE: text}))
    assert case.load.mean_pressure == pytest.approx(pascal, rel=1e-14)


@pytest.mark.parametrize("key", [PRESSURE, COEFFICIENT])
def test_a_large_power_overflows_in_words(key):
    """
    requirement: a number too large once it is in SI is a fault, not an overflow.
    """
    (line,) = faults({key: "1 Ym^20 Pa/m^20"})
    assert line.startswith(f'{key}: cannot read "1 Ym^20 Pa/m^20"')


LONG = {
    "dotted key": ".".join("a" * 200_000) + " = 1",
    "quoted parts": ".".join(['"a b"'] * 200_000) + " = 1",
    "spaces between parts": " . ".join("a" * 200_000) + " = 1",
    "dotted table": "[" + ".".join("a" * 200_000) + "]",
    "lists in lists": "a = " + "[" * 400_000,
    "tables in tables": "a = " + "{a=" * 30 + "1" + "}" * 30,
    "long integer": "a = 0x" + "f" * 400_000,
    "larger than allowed": "#" * (LARGEST_FILE + 1),
    "values": "a = [" + "1," * (MOST_VALUES + 1) + "]",
    "key of many characters": "a" * (LONGEST_KEY + 1) + " = 1",
    "one word": "a" * 900_000,
    "quotes": '"' * 900_000,
    "escaped quotes": 'a = "' + '\\"' * 400_000,
}


@pytest.mark.parametrize("text", LONG.values(), ids=LONG)
def test_long_files_are_refused_at_once(text, tmp_path, capsys):
    """
    requirement: size, depth and number of keys and values are bounded; one short line.
    """
    file = tmp_path / "case.toml"
    file.write_text(text, encoding="utf-8")
    assert main(["validate", str(file)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert len(line) < 400 + len(str(file))


@pytest.mark.parametrize("parts", [MOST_PARTS, 200_000])
def test_long_keys_on_the_command_line(parts):
    """
    requirement: --set with a key of very many parts is refused, too.
    """
    with pytest.raises(tw.CaseError) as caught:
        tw.load(tables(), (".".join("a" * parts) + "=1",))
    (line,) = caught.value.faults
    assert len(line) < 300


def test_limits_are_out_of_the_way():
    """
    requirement: thousands of output times are no trouble.
    """
    times = [f"{k} ms" for k in range(1, 3001)]
    case = tw.load(tables(RUNNING_IN, {"analysis.output_times": times}))
    assert len(case.analysis.output_times) == 3000


@pytest.fixture
def pipe(tmp_path):
    """A pipe that nobody writes to."""
    path = tmp_path / "pipe"
    os.mkfifo(path)
    return path


def test_a_pipe_is_no_case_file(pipe, capsys):
    """
    requirement: what may never end is not waited for.
    """
    assert main(["validate", str(pipe)]) == 1
    assert "is a pipe, a device or a socket" in capsys.readouterr().err


@pytest.mark.parametrize("device", ["/dev/zero", "/dev/urandom"])
def test_a_device_is_no_case_file(device, capsys):
    """
    requirement: endless files are not read.
    """
    assert main(["validate", device]) == 1
    assert "is a pipe, a device or a socket" in capsys.readouterr().err


ECHOED = {
    PRESSURE: "x" * 10_000,
    COEFFICIENT: "1 " + "m " * 5_000,
    "geometry.type": "x" * 10_000,
    "analysis.type": "x" * 10_000,
    "bodies.plate.like": "x" * 10_000,
    "mesh.degree": "x" * 10_000,
    "heat.partition": "x" * 10_000,
    "title": ["x" * 10_000],
}


@pytest.mark.parametrize(("key", "value"), ECHOED.items(), ids=ECHOED)
def test_long_values_are_cut(key, value):
    """
    requirement: a message shows the beginning and the end of a long value, and what is wrong.
    """
    (line,) = faults({key: value})
    assert line.startswith(f"{key}: ")
    assert len(line) < 600
    assert "characters left out" in line


def test_many_faults_are_counted():
    """
    requirement: a file that is wrong all over gets some lines, not thousands.
    """
    lines = faults({"bodies": {f"b{k}": {"like": "punch"} for k in range(3000)}})
    assert len(lines) == MOST_FAULTS + 1
    assert lines[-1].startswith("and 29")
    assert lines[-1].endswith("further faults")


def test_a_byte_order_mark(tmp_path):
    """
    requirement: a case file written by an editor that begins files with a mark is a case file.
    """
    file = tmp_path / "case.toml"
    file.write_text(starter_text(STEADY), encoding="utf-8-sig")
    assert tw.load(file) == tw.load(tables())


def test_a_line_break_behind_set_is_not_dropped():
    """
    requirement: what stands behind a line break of --set is not left out silently.
    """
    with pytest.raises(tw.CaseError, match="a second key after a line break"):
        tw.load(tables(), ("mesh.degree=6\nmesh.elements=4",))
    times = 'analysis.output_times=["1 s",\n "2 s"]'
    assert tw.load(tables(RUNNING_IN), (times,)).analysis.output_times == (1.0, 2.0)


def test_tables_written_and_read_again_are_bounded_alike():
    """
    requirement: the bounds hold for tables handed in by a script, too.
    """
    deep: dict = {}
    for _ in range(40):
        deep = {"a": deep}
    assert tomli_w.dumps(deep)
    (line,) = faults({"mesh": deep})
    assert f"at most {MOST_PARTS}" in line


@pytest.mark.parametrize("text", ["x = " + "[" * 5000, "x = " + "{a=" * 5000, "[" * 5000])
def test_brackets_within_brackets(text, tmp_path):
    """
    requirement: the recursion limit is never approached, where finalisers would fail as well.
    """
    path = tmp_path / "case.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(tw.CaseError, match="brackets nested deeper than 100"):
        tw.load(path)


def test_brackets_in_strings_are_no_brackets():
    """
    requirement: brackets in strings and comments do not count, unterminated strings included.
    """
    for text in ('t = "' + "[" * 500 + '"', "t = '" + "{" * 500 + "'", "# " + "[" * 500):
        check_keys(text, "case")
        check_keys(text[:-1], "case")
    check_keys('t = """' + "[\n" * 500 + '"""', "case")
    check_keys('t = "' + r"\"[" * 500 + '"', "case")


def test_the_bounds_are_documented():
    """
    requirement: the README names the bounds that hold.
    """
    said = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    values = f"{MOST_VALUES:,}".replace(",", " ")
    assert f"up to {LARGEST_FILE // 10**6} MB with {values} values" in said
    assert f"deeper than {MOST_PARTS} tables" in said
