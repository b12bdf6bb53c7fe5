"""Results folder without a run."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path

import pytest

import thermowear as tw
from thermowear.case import as_plain
from thermowear.case.starters import starter_text
from thermowear.output.files import name_at
from thermowear.output.folder import ResultsFolder
from thermowear.output.tables import read
from thermowear.results import HistoryRow

TABLES = as_plain(tw.load(tomllib.loads(starter_text("annular-punch-running-in"))))


def opened(path: Path, overwrite: bool = False) -> ResultsFolder:
    return ResultsFolder(path, TABLES, ranks=3, overwrite=overwrite)


def run_file(path: Path) -> dict:
    return json.loads((path / "run.json").read_text(encoding="utf-8"))


def test_a_new_folder_says_what_runs(tmp_path):
    """
    requirement: the resolved case and run.json are written at the beginning.
    """
    path = tmp_path / "deep" / "er"
    opened(path)
    assert tw.load(path / "case.resolved.toml") == tw.load(TABLES)
    assert run_file(path)["status"] == "running"
    assert run_file(path)["ranks"] == 3
    assert run_file(path)["versions"]["thermowear"] == tw.__version__
    assert sorted(p.name for p in path.iterdir()) == ["case.resolved.toml", "run.json"]


def test_an_empty_folder_can_be_used(tmp_path):
    """
    requirement: an existing folder is used if it is empty.
    """
    opened(tmp_path)
    assert run_file(tmp_path)["status"] == "running"


@pytest.mark.parametrize("name", ["run.json", "notes.txt", ".hidden", "sub"])
def test_a_folder_in_use_is_refused(name, tmp_path):
    """
    requirement: a folder with any content is refused and remains unchanged.
    """
    if name == "sub":
        (tmp_path / name).mkdir()
    else:
        (tmp_path / name).write_text("mine", encoding="utf-8")
    with pytest.raises(tw.CaseError, match="not empty"):
        opened(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [name]


OURS = [
    "summary.json",
    "run.json",
    "case.resolved.toml",
    "fields.vtu",
    "history.csv",
    "heat.csv",
    "interface.csv",
    "interface_20.csv",
    "interface_0.5.csv",
    "interface_1e+06.csv",
    "interface_1e-05.csv",
    "interface.png",
    "wear.png",
    "history.png",
    "heat.png",
    "bodies.png",
    "deformed.png",
]
THEIRS = [
    "interface_old.csv",
    "interface_.csv.txt",
    "my_history.csv",
    "summary.json~",
    "wear.pdf",
    "case.toml",
    "fields.vtu.bak",
    "bodies.png.old",
    "Interface.csv",
]


def test_overwriting_takes_away_results_only(tmp_path):
    """
    requirement: earlier results are removed for any output times; other files remain.
    """
    for name in OURS + THEIRS:
        (tmp_path / name).write_text("old", encoding="utf-8")
    opened(tmp_path, overwrite=True)
    left = {path.name: path.read_text(encoding="utf-8") for path in tmp_path.iterdir()}
    assert set(left) == {*THEIRS, "run.json", "case.resolved.toml"}
    assert {name for name, text in left.items() if text == "old"} == set(THEIRS)


def test_files_that_only_look_like_ours_are_safe(tmp_path):
    """
    requirement: --overwrite does not change a folder without results of this program.
    """
    (tmp_path / "history.csv").write_text("of the town", encoding="utf-8")
    with pytest.raises(tw.CaseError, match=r"no run\.json"):
        opened(tmp_path, overwrite=True)
    assert (tmp_path / "history.csv").read_text(encoding="utf-8") == "of the town"


@pytest.mark.parametrize("time", [20.0, 0.5, 1e6, 1e-5, 123456789.0, 1e-300])
def test_an_interface_of_any_time_is_known_as_ours(time, tmp_path):
    """
    requirement: --overwrite removes the interface files of all output times.
    """
    opened(tmp_path)
    (tmp_path / name_at("interface", time)).write_text("old", encoding="utf-8")
    opened(tmp_path, overwrite=True)
    assert not (tmp_path / name_at("interface", time)).exists()


@pytest.mark.parametrize(
    ("status", "message"), [("done", ""), ("failed", "no answer"), ("interrupted", "")]
)
def test_the_end_is_recorded(status, message, tmp_path):
    """
    requirement: run.json contains the final status, and the reason if there is one.
    """
    opened(tmp_path).close(status, message)
    end = run_file(tmp_path)
    assert end["status"] == status
    assert end.get("message", "") == message
    assert end["finished"] >= end["started"]


def test_every_step_is_on_disk_at_once(tmp_path):
    """
    requirement: results can be read during the run.
    """
    folder = opened(tmp_path)
    first = HistoryRow(*(0.1 * n for n in range(1, 16)))
    second = HistoryRow(*(math.pi * n for n in range(1, 15)), friction_torque=math.nan)
    for count, row in enumerate((first, second), start=1):
        folder.add(row)
        table = read(tmp_path / "history.csv")
        assert [len(column) for column in table.values()] == [count] * 15
        for name, column in table.items():
            assert column[-1] == pytest.approx(getattr(row, name), rel=1e-14, nan_ok=True)


def test_a_case_that_turns_out_wrong_leaves_what_was_computed(tmp_path):
    """requirement: no files remain if nothing was computed; else results and status are kept."""
    opened(tmp_path / "none").abandon()
    assert not (tmp_path / "none").exists()
    folder = opened(tmp_path / "some")
    (folder.path / "history.csv").write_text("time_s\n", encoding="utf-8")
    folder.abandon()
    assert run_file(folder.path)["status"] == "failed"
    assert (folder.path / "history.csv").is_file()
