"""Results folders of earlier versions, and of later ones: read as far as they can be."""

from __future__ import annotations

import shutil
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from thermowear.app.cli import main

from .shown import shown

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
