"""Histories from CSV files, and lists of numbers with one unit."""

from __future__ import annotations

import os

import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case import as_plain
from thermowear.errors import CaseNote
from thermowear.laws.histories import LoadHistories

from .bad import Bad, assert_refused
from .starter import FRETTING, GONE, RUNNING_IN, tables

LOAD, SPEED, FRICTION = "load.history", "motion.history", "contact.friction_history"
BLOCKS, FILE = "stacked-blocks", "course.csv"
HEAD = "time [s], force [kN]\n"


def case_with(folder, key: str, content: str | bytes, more=None, name=FILE, written=FILE):
    """A case file whose history is a file beside it."""
    folder.mkdir(exist_ok=True)
    content = content if isinstance(content, bytes) else content.encode()
    (folder / name).write_bytes(content)
    changes = {"load": {"history": written}} if key == LOAD else {key: written}
    path = folder / "case.toml"
    text = tomli_w.dumps(tables(RUNNING_IN, changes | (more or {})))
    path.write_text(text, encoding="utf-8")
    return path


READ = {
    "commas": "time [s], force [kN]\n0, 0\n1.5, 2\n",
    "semicolons": "Time [ms];Force [N]\r\n0;0\r\n1500;2e3\r\n",
    "tabs": "time [s]\tforce [kN]\n0\t0\n1.5\t2\n",
    "byte order mark": "\ufefftime [s],force [kN]\n0,0\n1.5,2\n",
    "comments and empty lines": "# measured\n\ntime [s],force [kN]\n0,0\n\n# later\n1.5,+2.\n",
    "columns changed": 'force [kN],"time [s]"\n.0,0\n2E0,1.5',
    "old line ends": "time [min],force [MN]\r0,0\r0.025,0.002\r",
}


@pytest.mark.parametrize("content", READ.values(), ids=READ)
def test_a_history_is_read_with_its_units(content, tmp_path):
    """requirement: histories from a CSV file with units in its header."""
    history = tw.load(case_with(tmp_path, LOAD, content)).load.history
    assert history.time == pytest.approx((0.0, 1.5))
    assert history.force == pytest.approx((0.0, 2000.0))


def test_every_history_may_be_a_file(tmp_path):
    """requirement: load, motion, friction and temperatures, with other keys beside the file."""
    case_with(tmp_path, SPEED, "time [s],factor\n0,1\n1,0.5\n2,1\n")
    (tmp_path / "warm.csv").write_text("time [s],temperature [degC]\n0,20\n10,120\n")
    repeated = {"file": FILE, "repeat": True}
    storing = {"density": "7800 kg/m^3", "specific_heat": "460 J/(kg K)"}
    changes = {f"bodies.{b}.{k}": v for b in ("upper", "lower") for k, v in storing.items()} | {
        SPEED: repeated,
        FRICTION: FILE,
        "heat.transient": True,
        "heat.temperature.upper_top": "warm.csv",
        "heat.cooling": {"lower_side": "10 W/(m^2 K)"},
        "heat.ambient_history": {"file": "warm.csv"},
        "analysis": {"type": "transient", "end_time": "10 s"},
    }
    path = tmp_path / "case.toml"
    path.write_text(tomli_w.dumps(tables(BLOCKS, changes)), encoding="utf-8")
    case = tw.load(path)
    assert case.motion.history.repeat
    assert case.contact.friction_history.factor == (1.0, 0.5, 1.0)
    warm = case.heat.temperature["upper_top"]
    assert [warm.function.at(t) for t in (0.0, 5.0, 99.0)] == pytest.approx(
        [293.15, 343.15, 393.15]
    )
    assert case.heat.ambient_history == warm
    assert set(case.histories) == {
        SPEED, FRICTION, "heat.temperature.upper_top", "heat.ambient_history",
    }  # fmt: skip


def test_cycles_of_loads_may_be_a_file(tmp_path):
    """requirement: a fretting history from a file, its cycle beside it; columns by their words."""
    (tmp_path / FILE).write_text("time [s];tangential force [N]\n0;0\n1;36\n3;-36\n5;36\n")
    changes = {"load.history": {"file": FILE, "cycle_start": "1 s"}, "analysis.output_times": []}
    path = tmp_path / "case.toml"
    path.write_text(tomli_w.dumps(tables(FRETTING, changes)), encoding="utf-8")
    history = tw.load(path).load.history
    assert history.tangential_force == (0.0, 36.0, -36.0, 36.0)
    assert LoadHistories((history.loads,)).cycle == (1.0, 5.0)


def test_a_list_stands_in_the_file_or_in_the_table(tmp_path):
    """requirement: what is given twice is refused, by the path of its key."""
    given = {"file": FILE, "factor": [1.0, 0.5]}
    for table, text in (
        (given, f"{SPEED}.factor: is a column of {FILE} already"),
        ({"file": 3}, f"{SPEED}.file: must be the name of a CSV file"),
    ):
        path = case_with(tmp_path, SPEED, "time [s],factor\n0,1\n", written=table)
        with pytest.raises(tw.CaseError) as caught:
            tw.load(path)
        assert caught.value.faults == [text]


def test_what_was_read_is_written_out(tmp_path):
    """requirement: a resolved case needs no file, and is the same case."""
    case = tw.load(case_with(tmp_path, LOAD, HEAD + "0,0\n1,1\n"))
    plain = as_plain(case)
    assert plain["load"]["history"]["force"] == ("0.0 N", "1000.0 N")
    (tmp_path / FILE).unlink()
    assert tw.load(plain) == case


def test_files_are_looked_for_beside_the_case(tmp_path, monkeypatch):
    """requirement: paths are meant from the case's folder, then from the current one."""
    beside, here = tmp_path / "beside", tmp_path / "here"
    path = case_with(beside, LOAD, HEAD + "0,1\n")
    here.mkdir()
    (here / FILE).write_text(HEAD + "0,2\n")
    monkeypatch.chdir(here)
    with pytest.warns(CaseNote, match="the other file .* is not read"):
        assert tw.load(path).force() == 1000.0
    (beside / FILE).unlink()
    with pytest.warns(CaseNote, match="paths are relative to the folder of the case file"):
        assert tw.load(path).force() == 2000.0
    override = (f"load.history={beside / 'other.csv'}",)
    (beside / "other.csv").write_text(HEAD + "0,3\n")
    assert tw.load(path, override).force() == 3000.0


FAULTS = {
    "no file": (None, f"{FILE} cannot be read: No such file"),
    "empty": ("", f"{FILE} is empty; needs a header with columns of: time [s], force [kN]"),
    "header alone": (HEAD, f"{FILE} has a header but no rows"),
    "binary": (b"\xff\xfe\x00\x01", f"{FILE} is not text in UTF-8"),
    "no unit": ("time [s],force\n0,1\n", f"{FILE}, line 1: force: unit missing; write force ["),
    "unknown column": ("time [s],farce [N]\n0,1\n", f"{FILE}, line 1: found the column 'farce"),
    "column twice": ("time [s],time [s]\n0,1\n", f"{FILE}, line 1: the column time is given twice"),
    "wrong unit": (HEAD.replace("kN", "mm") + "0,1\n", f"{FILE}, line 2: force: "),
    "unreadable unit": (HEAD.replace("kN", "kXN") + "0,1\n", f"{FILE}, line 2: force: "),
    "short row": (HEAD + "0,1\n1\n", f"{FILE}, line 3: has 1 cells for 2 columns"),
    "long row": (HEAD + "0,1,2\n", f"{FILE}, line 2: has 3 cells for 2 columns"),
    "empty cell": (HEAD + "0,1\n1,\n", f"{FILE}, line 3: force: found ''; must be a finite"),
    "nan": (HEAD + "0,1\n\n1,nan\n", f"{FILE}, line 4: force: found 'nan'"),
    "inf": (HEAD + "0,1\n1,inf\n", f"{FILE}, line 3: force: found 'inf'"),
    "too large": (HEAD + "0,1\n1,1e999\n", f"{FILE}, line 3: force: "),
    "word": (HEAD + "0,much\n", f"{FILE}, line 2: force: found 'much'"),
    "decimal comma": ("time [s];force [kN]\n0;1,5\n", f"{FILE}, line 2: force: found '1,5'"),
    "underscore": (HEAD + "0,1_0\n", f"{FILE}, line 2: force: found '1_0'"),
    "formula": (HEAD + '0,"=cmd()"\n', f"{FILE}, line 2: force: found '=cmd()'"),
    "long cell": (HEAD + f"0,{'9' * 200_000}x\n", f"{FILE}, line 2: "),
    "open quotation": (HEAD + '0,"1\n1,2\n', f"{FILE}: a quotation mark is not closed"),
    "back in time": (HEAD + "0,1\n2,1\n1,1\n", f"{FILE}, line 4: time: found 1; must increase"),
    "standing still": (HEAD + "0,1\n0,1\n", f"{FILE}, line 3: time: found 0; must increase"),
    "before the start": (HEAD + "-1,1\n0,1\n", f"{FILE}, line 2: time: found "),
    "tension": (HEAD + "0,1\n1,-1\n", f"{FILE}, line 3: force: found "),
    "too many rows": (
        HEAD + "".join(f"{i},1\n" for i in range(5_001)),
        f"{FILE} has 5001 rows; at most 5000",
    ),
    "too long": (HEAD + "#" * 10_000_001, f"{FILE} cannot be read: has more than 10000000 bytes"),
}


@pytest.mark.parametrize(("content", "text"), FAULTS.values(), ids=FAULTS)
def test_a_faulty_file_is_one_line_with_key_file_and_line(content, text, tmp_path, capsys):
    """requirement: bad files end with exit code 1 and one line: key, file, line, what is wrong."""
    path = case_with(tmp_path, LOAD, content or "")
    if content is None:
        (tmp_path / FILE).unlink()
    assert main(["validate", str(path)]) == 1
    printed = capsys.readouterr()
    (line,) = printed.err.splitlines()
    assert line.replace(f"{tmp_path}/", "").startswith(f"error: {LOAD}: {text}")
    assert len(line) < 400


def test_only_regular_files_are_opened(tmp_path, capsys):
    """requirement: a folder, a device or a pipe is not waited for."""
    os.mkfifo(tmp_path / "pipe.csv")
    for name in ("pipe.csv", str(tmp_path), "/dev/zero"):
        path = case_with(tmp_path, LOAD, "", written=name)
        assert main(["validate", str(path)]) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert line.startswith(f"error: {LOAD}: ")
        assert "not a file" in line or "Is a directory" in line


def test_factors_have_no_unit_and_are_not_negative(tmp_path):
    """requirement: columns without dimension; a wrong value is charged to its line."""
    for content, text in (
        ("time [s],factor [m/s]\n0,1\n", f"{FILE}, line 1: factor: found the unit 'm/s'"),
        ("time [s],factor [-]\n0,1\n1,-1\n", f"{FILE}, line 3: factor: must be greater than or"),
    ):
        with pytest.raises(tw.CaseError) as caught:
            tw.load(case_with(tmp_path, SPEED, content))
        (line,) = caught.value.faults
        assert line.startswith(f"{SPEED}: {text}")


def seconds(values, unit="s"):
    return {"values": values, "unit": unit}


def test_a_list_may_have_one_unit():
    """requirement: lists with one unit wherever a case takes a list of quantities."""
    stored = {"bodies.punch.conductivity_factor": {
        "at": seconds([20, 400.5], "degC"), "factor": [1, 0.5],
    }}  # fmt: skip
    changes = {
        "load": {"history": {"time": seconds([0, 1500], "ms"), "force": seconds([0, 2.5], "kN")}},
        "analysis.output_times": seconds([1, 2.0]),
        "analysis.end_time": "10 s",
    } | stored
    case = tw.load(tables(RUNNING_IN, changes))
    assert case.load.history.time == (0.0, 1.5)
    assert case.load.history.force == (0.0, 2500.0)
    assert case.analysis.output_times == (1.0, 2.0)
    assert case.bodies["punch"].conductivity_factor.at == pytest.approx((293.15, 673.65))
    table = {"type": "table", "pressure": seconds([0, 10], "MPa"),
             "conductance": seconds([1e3, 5e3], "W/(m^2 K)")}  # fmt: skip
    law = tw.load(tables(BLOCKS, {"heat.conductance": table})).heat.conductance
    assert law.pressure == (0.0, 1e7)
    assert law.conductance == (1e3, 5e3)
    moved = {"load.point": seconds([-5, 0], "mm")}
    assert tw.load(tables("rectangular-punch", moved)).load.point == (-0.005, 0.0)
    pivot = {"geometry.pivot": seconds([0, -75], "mm")}
    assert tw.load(tables("drum-brake", pivot)).geometry.pivot == (0.0, -0.075)


LISTS = [
    Bad("text in it", {LOAD: {"time": seconds([0, "1"])}, "load.mean_pressure": GONE},
        f"{LOAD}.time.values.1", "must be a number", RUNNING_IN),
    Bad("true in it", {f"{SPEED}": {"time": seconds([0, True]), "factor": [1, 1]}},
        f"{SPEED}.time.values.1", "must be a number", RUNNING_IN),
    Bad("no list", {f"{SPEED}": {"time": seconds(1), "factor": [1, 1]}},
        f"{SPEED}.time.values", "must be a list", RUNNING_IN),
    Bad("no unit", {f"{SPEED}": {"time": seconds([1], ""), "factor": [1]}},
        f"{SPEED}.time.unit", 'such as "s"', RUNNING_IN),
    Bad("nan in it", {f"{SPEED}": {"time": seconds([float("nan")]), "factor": [1]}},
        f"{SPEED}.time.0", "must be finite", RUNNING_IN),
    Bad("wrong unit", {f"{SPEED}": {"time": seconds([1], "kN"), "factor": [1]}},
        f"{SPEED}.time.0", "has the dimension", RUNNING_IN),
    Bad("one quantity", {"bodies.punch.young_modulus": seconds([200], "GPa")},
        "bodies.punch.young_modulus", "needs a quantity", RUNNING_IN),
]  # fmt: skip


@pytest.mark.parametrize("bad", LISTS, ids=lambda bad: bad.name)
def test_a_fault_of_a_list_is_one_line_with_the_path_of_its_key(bad, tmp_path, capsys):
    """
    requirement: bad input ends with exit code 1 and one line: exact path, what is wrong with it.
    """
    assert_refused(bad, tmp_path, capsys)
