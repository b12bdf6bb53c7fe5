"""Tables of a result, and a table and a column that are new."""

from __future__ import annotations

import json

import numpy as np
import pytest

from thermowear.output.files import is_ours, name_at
from thermowear.output.report.contents import read_contents
from thermowear.output.tables import read, write_points
from thermowear.results import TABLES, HistoryRow, InterfaceFields, Profile, Result
from thermowear.results.quantity import as_in, column, table

INTERFACE = TABLES["interface"].columns


@pytest.fixture
def result():
    columns = {name: np.linspace(0.0, 1.0, 3) + k for k, name in enumerate(INTERFACE)}
    profile = Profile(*np.arange(33.0).reshape(11, 3))
    rows = [HistoryRow(*np.arange(15.0) + k) for k in range(2)]
    return Result(InterfaceFields(**columns), profile, {}, rows)


def test_columns_as_in_files(result):
    """requirement: columns by their names in files, for data frames of scripts."""
    assert list(result.tables()) == ["interface", "profile", "history"]
    columns = result.columns("interface")
    assert list(columns)[:6] == ["x_m", "y_m", "z_m", "s_m", "weight_m2", "pressure_Pa"]
    assert columns["pressure_Pa"] is result.interface.pressure
    assert result.columns("history")["max_pressure_Pa"].tolist() == [2.0, 3.0]
    with pytest.raises(KeyError):
        result.columns("heat")


def test_data_frames(result):
    """requirement: pandas takes the columns as they are."""
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(result.columns("history"))
    assert frame["time_s"].tolist() == [0.0, 1.0]


def test_a_new_table_is_written_down_once(tmp_path):
    """requirement: a class is all that files, reading, overwriting and report need."""
    try:

        @table("film", "Film at the end", "one row per point", at_times=True)
        class Film:
            x: np.ndarray = as_in(InterfaceFields)
            thickness: np.ndarray = column("film thickness", "m", "µm")

        for time in (None, 2.5):
            path = tmp_path / name_at("film", time)
            write_points(path, Film(np.array([0.5]), np.array([3e-6])))
            assert path.read_text() == "x_m,thickness_m\n0.5,3e-06\n"
            assert is_ours(path)
            assert read(path).drawn("thickness") == pytest.approx([3.0], rel=1e-12)
        versions = {"status": "done", "versions": {"thermowear": "0.1.0"}}
        (tmp_path / "run.json").write_text(json.dumps(versions))
        (shown,) = read_contents(tmp_path)["tables"]
        assert shown.caption == "Film at the end"
        assert [head.axis for head in shown.heads] == ["x [mm]", "film thickness [µm]"]
    finally:
        TABLES.pop("film")


@pytest.mark.parametrize(
    ("name", "ours"),
    [
        *(("interface.csv", True), ("interface_1e-05.csv", True), ("mode.csv", True)),
        *(("interface_nan.csv", False), ("interface_1_0.csv", False), ("history_1.csv", False)),
        *(("profile_1.csv", False), ("interface_.csv", False), ("interface_1.50.csv", False)),
        *(("heat.png", True), ("frames", True), ("film.png", False)),
    ],
)
def test_files_of_a_run(name, ours, tmp_path):
    """requirement: only names that a run writes are results that --overwrite removes."""
    assert is_ours(tmp_path / name) == ours
