"""Pictures of many contacts, half of them drawn by another process."""

import json
import shutil
from pathlib import Path

import pytest

from thermowear.output.pictures import make_pictures

RUN = Path(__file__).parent / "data" / "0.1.0" / "transient"
NAMES = ["a", "b", "c", "d", "e"]


@pytest.fixture
def folder(tmp_path):
    """Results of a model of five contacts, each with the tables of a running-in."""
    for name in NAMES:
        for table in RUN.glob("interface*.csv"):
            stem, _, time = table.stem.partition("_")
            shutil.copy(table, tmp_path / f"{stem}_{name}{'_at_' * bool(time)}{time}.csv")
    shutil.copy(RUN / "history.csv", tmp_path)
    summary = {
        "model": "axisymmetric",
        "time_s": 2.0,
        "contacts": {n: {"between": [n, "disk"]} for n in NAMES},
    }
    (tmp_path / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    (tmp_path / "run.json").write_text(json.dumps({"contacts": NAMES}), encoding="utf-8")
    return tmp_path


def test_all_contacts_are_drawn(folder):
    """requirement: each contact has its pictures, whichever process draws them."""
    notes = make_pictures(folder)
    assert notes == [f"{folder}: no fields.vtu, so no pictures of the bodies"]
    for picture in ("interface", "wear"):
        assert all((folder / f"{picture}_{name}.png").is_file() for name in NAMES)


def test_a_missing_column_is_told(folder):
    """requirement: a picture that the other process cannot draw is named with the reason."""
    path = folder / "interface_e.csv"
    path.write_text(path.read_text(encoding="utf-8").replace("shape_m", "form_m"), encoding="utf-8")
    told = " ".join(make_pictures(folder))
    assert "interface_e.png" in told
    assert "shape_m" in told
    assert (folder / "interface_d.png").is_file()
