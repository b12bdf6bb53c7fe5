"""Folder of a sweep: table, pictures, and protection of other files."""

from __future__ import annotations

import csv
import json

import matplotlib.image
import numpy as np
import pytest

from thermowear.errors import CaseError
from thermowear.output.sweep import SweepFolder, draw_sweep, is_sweep, swept
from thermowear.output.sweep.layout import axis, is_wide, lay_out, read_sweep
from thermowear.output.sweep.pictures import alike
from thermowear.output.tables import write_points
from thermowear.results import TABLES, InterfaceFields


def points(height, surface=False):
    """Contact points with a shape of some height."""
    x = np.linspace(0.0, 0.02, 21)
    y = 0 * x
    if surface:
        x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 0.02, 6), x))
    values = dict.fromkeys(TABLES["interface"].columns, 0 * x)
    values |= {"x": x, "y": y, "s": np.full(len(x), np.nan) if surface else x}
    return InterfaceFields(
        **values | {"pressure": 1e6 + x * 1e7, "shape": height * (x - 0.01) ** 2}
    )


def made(path, over, surface=False, failing=()):
    """Sweep in which the largest pressure is the product of all values."""
    from itertools import product

    combinations = list(product(*over.values()))
    keys = [
        swept(key, [c[k] for c in combinations], [_nested(key, c[k]) for c in combinations])
        for k, key in enumerate(over)
    ]
    folder = SweepFolder(path, over, keys, "sum", overwrite=False)
    for number, _ in enumerate(combinations, 1):
        variant = folder.variant(number)
        variant.mkdir()
        (variant / "run.json").write_text("{}")
        if number in failing:
            folder.add(number, "failed: contact: nothing holds, really", None, 0.1)
            continue
        write_points(variant / "interface.csv", points(number, surface))
        summary = {"max_pressure_Pa": 1e6 * number, "title": "x", "steps": 3, "contact": True}
        folder.add(number, "done", summary | {"max_temperature_K": None}, 0.25)
    folder.close("done", "", 1.0)
    return folder


def _nested(key, value):
    for part in reversed(key.split(".")):
        value = {part: value}
    return value


def rows(path):
    with (path / "sweep.csv").open(newline="") as file:
        return list(csv.reader(file))


@pytest.mark.parametrize(
    ("resolved", "header", "values"),
    [
        (["1000.0 N", "2000.0 N"], "a.b_N", (1000.0, 2000.0)),
        (["0.0 m", "-0.001 m"], "a.b_m", (0.0, -0.001)),
        (["5.0 W/m^2/K"], "a.b_W_per_m2_K", (5.0,)),
        (["3.0 N m"], "a.b_Nm", (3.0,)),
        (["1.2e-05 1/K"], "a.b_1_per_K", (1.2e-5,)),
        (["7800.0 kg/m^3"], "a.b_kg_per_m3", (7800.0,)),
        (["2e-07 1/MPa"], "a.b_1_per_Pa", (2e-13,)),
        ([0.1, 3], "a.b", (0.1, 3)),
        (["steady", "initial"], "a.b", ("x0", "x1")),
        ([True, False], "a.b", ("x0", "x1")),
        ([["0.0 m"], ["1.0 m"]], "a.b", ("x0", "x1")),
        ([None, "1.0 N"], "a.b", ("x0", "x1")),
    ],
)
def test_columns_of_swept_keys(resolved, header, values):
    """requirement: SI numbers with the unit in the column name; words as given."""
    written = [f"x{k}" for k in range(len(resolved))]
    found = swept("a.b", written, [_nested("a.b", value) for value in resolved])
    assert found.header == header
    assert found.values == pytest.approx(values) if isinstance(values[0], float) else values


def test_axes_of_swept_keys():
    """requirement: pictures use the given unit if it is common, else SI."""
    assert axis("f", ["1 kN", '"2.5 kN"'], [1e3, 2.5e3], "f_N").label == "f [kN]"
    assert axis("f", ["1 kN", '"2.5 kN"'], [1e3, 2.5e3], "f_N").numbers == (1.0, 2.5)
    mixed = axis("f", ["1 kN", "500 N"], [1e3, 500.0], "f_N")
    assert (mixed.label, mixed.numbers) == ("f [N]", (1000.0, 500.0))
    assert axis("T", ["20 degC"], [293.15], "T_K").label == "T [°C]"
    assert axis("h", ["5 W/(m^2 K)"], [5.0], "h_W_per_m2_K").label == "h [W/(m² K)]"
    words = axis("w", ['{a="1 N", b=2}', "{}"], ["{a}", "{}"], "w")
    assert (words.numbers, words.words) == (None, ("a=1 N, b=2", ""))


def test_a_row_a_variant(tmp_path):
    """requirement: number, swept keys, status with reason, numbers of the summary."""
    made(tmp_path / "s", {"load.force": ["1.0 N", "2.0 N"], "mesh.degree": ["2", "3"]}, failing=[3])
    header, *variants = rows(tmp_path / "s")
    assert header[:4] == ["variant", "load.force_N", "mesh.degree", "status"]
    assert header[4:] == ["max_pressure_Pa", "steps", "seconds"]
    assert variants[1] == ["2", "1", "3", "done", "2000000", "3", "0.25"]
    assert variants[2][:4] == ["3", "2", "2", "failed: contact: nothing holds, really"]
    assert variants[2][4:6] == ["nan", "nan"]
    assert json.loads((tmp_path / "s" / "run.json").read_text())["status"] == "done"


def test_what_is_not_computed_yet_has_a_row(tmp_path):
    """requirement: the table is complete at any time."""
    keys = [swept("a", ["1", "2"], [{"a": 1}, {"a": 2}])]
    folder = SweepFolder(tmp_path / "s", {"a": ["1", "2"]}, keys, "sum", overwrite=False)
    assert rows(tmp_path / "s") == [
        ["variant", "a", "status"],
        ["1", "1", "not computed"],
        ["2", "2", "not computed"],
    ]
    folder.add(1, "done", {"x": 2.0}, 0.1)
    folder.close("interrupted", "", 1.0)
    assert rows(tmp_path / "s")[2] == ["2", "2", "not computed", "nan", "nan"]


def test_a_sweep_replaces_only_a_sweep(tmp_path):
    """requirement: results are replaced on request, and other files remain unchanged."""
    path = tmp_path / "s"
    made(path, {"a": ["1", "2", "3"]})
    (path / "notes.txt").write_text("mine")
    (path / "002" / "notes.txt").write_text("mine")
    (path / "2024").mkdir()
    (path / "2024" / "interface.csv").write_text("mine")
    keys = [swept("a", ["1"], [{"a": 1}])]
    with pytest.raises(CaseError, match="--overwrite"):
        SweepFolder(path, {"a": ["1"]}, keys, "sum", overwrite=False)
    assert len(rows(path)) == 4
    SweepFolder(path, {"a": ["1"]}, keys, "sum", overwrite=True)
    left = {str(entry.relative_to(path)) for entry in path.rglob("*") if entry.is_file()}
    assert left == {"run.json", "sweep.csv", "notes.txt", "002/notes.txt", "2024/interface.csv"}
    other = tmp_path / "run"
    other.mkdir()
    (other / "run.json").write_text('{"status": "done"}')
    with pytest.raises(CaseError, match="not a folder of a sweep"):
        SweepFolder(other, {"a": ["1"]}, keys, "sum", overwrite=True)
    assert not is_sweep(other)


def test_the_record_is_read_back(tmp_path):
    """requirement: pictures need the files only and omit failed variants."""
    over = {"load.force": ["1.0 kN", "2.0 kN"], "model": ["one", "two"]}
    made(tmp_path / "s", over, failing=[2])
    record = read_sweep(tmp_path / "s")
    assert [axis.label for axis in record.axes] == ["load.force [kN]", "model"]
    assert record.indices.tolist() == [[0, 0], [1, 0], [1, 1]]
    assert [folder.name for folder in record.folders] == ["001", "003", "004"]
    assert record.numbers["max_pressure_Pa"].tolist() == [1e6, 3e6, 4e6]


OVER = {
    "one": {"load.force": ["1 N", "2 N", "3 N"]},
    "many": {"load.force": [f"{k} N" for k in range(1, 13)]},
    "words": {"model": ["a", "b"]},
    "two": {"load.force": [f"{k} N" for k in range(1, 9)], "contact.friction": ["0.1", "0.2"]},
    "two long": {"a": [str(k) for k in range(1, 9)], "b": [str(k) for k in range(5)]},
    "three": {"a": ["1", "2", "3"], "model": ["x", "y"], "c": ["0", "1"]},
    "single": {"a": ["1"]},
}
# most numbers by colour, few values by lines, the rest side by side
PARTS = {  # number of the coloured key, of the lined key, columns
    "one": (0, None, 1),
    "many": (0, None, 1),
    "words": (0, None, 1),
    "two": (0, 1, 1),
    "two long": (0, None, 5),
    "three": (0, 2, 2),
    "single": (0, None, 1),
}


@pytest.mark.parametrize("name", OVER)
def test_pictures(name, tmp_path):
    """requirement: both pictures, for one, two and three keys of numbers and words."""
    made(tmp_path / "s", OVER[name])
    layout = lay_out(read_sweep(tmp_path / "s"))
    assert (layout.colored, layout.lined, len(layout.columns)) == PARTS[name]
    assert draw_sweep(tmp_path / "s") == []
    drawn = matplotlib.image.imread(tmp_path / "s" / "shapes.png")
    assert np.ptp(drawn) > 0.5
    assert (tmp_path / "s" / "sweep.png").is_file() == (name != "single")


def test_curves_that_are_one():
    """requirement: curves equal up to rounding coincide; a single one is not compared."""
    curve = np.array([1.0, np.nan, 2.0])
    assert alike([curve, curve * (1 + 1e-9)])
    assert not alike([curve, curve * (1 + 1e-5)])
    assert not alike([curve, curve[:2]])
    assert not alike([curve])


def test_pictures_of_faces_in_space(tmp_path):
    """requirement: shapes of 3D models are drawn as maps."""
    made(tmp_path / "s", {"a": [str(k) for k in range(1, 16)]}, surface=True)
    assert draw_sweep(tmp_path / "s") == []
    assert (tmp_path / "s" / "shapes.png").is_file()


def test_nothing_to_draw(tmp_path):
    """requirement: a sweep with failed variants only has no pictures, and a message."""
    made(tmp_path / "s", {"a": ["1", "2"]}, failing=[1, 2])
    (said,) = draw_sweep(tmp_path / "s")
    assert "no variant" in said


@pytest.mark.parametrize(
    ("numbers", "wide"),
    [((1, 10, 100), True), ((1, 2, 3), False), ((0.001, 0.1, 0.2, 0.3), False), ((0, 1, 99), False)]
    + [((1, 99), False)],
)
def test_logarithmic_axes(numbers, wide):
    """requirement: a logarithmic axis is used for evenly spaced logarithms only."""
    assert is_wide(numbers) == wide
