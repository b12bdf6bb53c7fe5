"""Results folders of earlier versions, and of later ones: read as far as they can be."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from thermowear.app.cli import main

from .shown import PageText, shown

DATA = Path(__file__).parent / "data" / "0.1.0"
RUNS = ("steady", "transient", "fretting")
PICTURES = {
    "steady": {"interface"},
    "transient": {"interface", "wear", "history", "heat"},
    "fretting": {"interface", "profile", "wear", "friction", "loads", "cycles"},
    "sweep": {"shapes", "sweep"},
}


@pytest.fixture
def copy(tmp_path):
    """Modifiable copy of a results folder."""
    return lambda name: Path(shutil.copytree(DATA / name, tmp_path / name))


@pytest.mark.parametrize("name", [*RUNS, "sweep"])
def test_all_that_is_seen_of_an_earlier_folder(name, copy, monkeypatch):
    """requirement: labels, units and numbers of pictures, report and console remain."""
    lines = shown(copy(name), monkeypatch)
    assert lines == (DATA / f"{name}.txt").read_text(encoding="utf-8").splitlines()


@pytest.mark.parametrize("name", PICTURES)
def test_the_commands_read_an_earlier_folder(name, copy):
    """requirement: plot and report work on folders written by version 0.1.0."""
    folder = copy(name)
    assert main(["plot", str(folder)]) == 0
    drawn = {path.stem for path in folder.glob("*.png")} - {"bodies", "deformed"}
    assert drawn == PICTURES[name]
    assert all(np.ptp(matplotlib.image.imread(path)) > 0.5 for path in folder.glob("*.png"))
    if name != "sweep":
        assert main(["report", str(folder)]) == 0
        assert "</html>" in (folder / "report.html").read_text(encoding="utf-8")


def resumed(folder, *more):
    case = str(folder / "case.resolved.toml")
    return main(["run", case, "-o", str(folder), "--resume", "--no-pictures", *more])


@pytest.mark.parametrize("name", RUNS)
def test_a_complete_run_is_not_resumed(name, copy, capsys):
    """requirement: --resume of an earlier complete run says in one line that nothing is left."""
    folder = copy(name)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert resumed(folder) == 0
    printed = capsys.readouterr()
    assert printed.out.splitlines() == [
        f"{folder}: the run is complete, nothing is left to compute"
    ]
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_checkpoint_of_another_version(copy, capsys):
    """requirement: a later end is computed from an earlier checkpoint, or one line says why not."""
    folder = copy("transient")
    code = resumed(folder, "--set=analysis.end_time=3.01 s")
    printed = capsys.readouterr()
    if code == 0:
        assert "resumed from 3 s" in printed.out
        return
    (line,) = printed.err.splitlines()
    assert line.startswith("error: --resume: the checkpoint was written by another version")
    assert line.endswith("--overwrite starts from the beginning")
    assert (folder / "interface.csv").read_bytes() == (
        DATA / "transient" / "interface.csv"
    ).read_bytes()


def without(folder, pattern, header):
    """Remove a column of some tables, and add one of a later version in front."""
    for path in folder.rglob(pattern):
        with path.open(newline="") as file:
            head, *rows = csv.reader(file)
        k = head.index(header)
        with path.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["film_m", *head[:k], *head[k + 1 :]])
            writer.writerows([1e-6, *row[:k], *row[k + 1 :]] for row in rows)


LACKING = {
    ("transient", "history.csv", "max_pressure_Pa"): {"history", "heat"},
    ("transient", "heat.csv", "mean_temperature_1_K"): {"heat"},
    ("transient", "interface*.csv", "wear_1_m"): {"wear"},
    ("fretting", "friction.csv", "slip_m"): {"friction"},
    ("fretting", "interface.csv", "x_m"): {"interface", "wear"},
    ("sweep", "interface.csv", "shape_m"): {"shapes"},
}


@pytest.mark.usefixtures("bodies_not_drawn")
@pytest.mark.parametrize(("where", "missing"), LACKING.items(), ids=map(str, LACKING))
def test_what_needs_a_missing_column_is_left_out(where, missing, copy, capsys):
    """requirement: all other pictures are drawn, a note names the column, and report works."""
    name, pattern, header = where
    folder = copy(name)
    without(folder, pattern, header)
    assert main(["plot", str(folder)]) == 0
    assert {path.stem for path in folder.glob("*.png")} == PICTURES[name] - missing
    notes = [line for line in capsys.readouterr().err.splitlines() if header in line]
    assert len(notes) == len(missing)
    for picture in missing:
        assert any(f"no {picture}.png, as" in note for note in notes)
    if name != "sweep":
        assert main(["report", str(folder)]) == 0
        page = PageText((folder / "report.html").read_text(encoding="utf-8"))
        assert "film [µm]" in page.lines
