"""Coordinate names in labels of plane, axisymmetric and 3D models."""

import json

import numpy as np
import pytest

from thermowear.output import tables
from thermowear.output.files import model_of
from thermowear.output.pictures import bodies, panels
from thermowear.output.pictures.bodies import BodySection
from thermowear.output.report.contents import shown_table
from thermowear.results import TABLES

INTERFACE, PROFILE = (TABLES[name].columns for name in ("interface", "profile"))
AXES = {"axisymmetric": ("r", "z"), "plane-strain": ("x", "y"), "3d": ("x", "y")}


@pytest.mark.parametrize(("model", "names"), AXES.items())
def test_labels_name_the_coordinates_of_the_model(model, names):
    """requirement: r and z in axisymmetric models, x and y in others; headers do not change."""
    for column, name in zip("xy", names, strict=True):
        shown = INTERFACE[column].in_model(model)
        assert shown.axis == f"{name} [mm]"
        assert shown.header == f"{column}_m"
        assert PROFILE[f"normal_{column}"].in_model(model).label == f"normal, {name}"
    assert INTERFACE["s"].in_model(model) == INTERFACE["s"]
    assert INTERFACE["pressure"].in_model(model) == INTERFACE["pressure"]


@pytest.mark.parametrize(("model", "names"), AXES.items())
def test_axes_and_tables_of_a_folder(model, names, tmp_path):
    """requirement: the model is read from the summary; curves and report tables use its names."""
    assert model_of(tmp_path) == ""
    (tmp_path / "summary.json").write_text(json.dumps({"model": model}), encoding="utf-8")
    assert model_of(tmp_path) == model
    x = np.linspace(1.0, 2.0, 5)
    data = tables.TableColumns(tmp_path / "interface.csv", {"x_m": x, "y_m": 0 * x, "s_m": x})
    label, place = panels.abscissa(data)
    assert label == f"{names[0]} [mm]"
    assert place == pytest.approx(1e3 * x)
    columns = {"x_m": x, "y_m": x, "pressure_Pa": x}
    data = tables.TableColumns(tmp_path / "interface.csv", columns)
    shown = shown_table("", data, data.quantities, "interface.csv")
    assert [head.label for head in shown.heads] == [*names, "contact pressure"]


def test_pictures_of_the_bodies(tmp_path, monkeypatch):
    """requirement: the axes of the section of an axisymmetric model are r and z."""
    (tmp_path / "summary.json").write_text('{"model": "axisymmetric"}', encoding="utf-8")
    points = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    triangles, body = np.array([[0, 1, 2], [0, 2, 3]]), np.array([1, 2])
    section = BodySection(points, 0 * points, triangles, body, {"von_mises": np.arange(4.0)})
    monkeypatch.setattr(bodies, "read_section", lambda _: section)
    interface = dict.fromkeys(("x_m", "y_m", "s_m", "pressure_Pa"), np.array([1e-3, 2e-3]))
    monkeypatch.setattr(tables, "read", lambda path: tables.TableColumns(path, interface))
    drawn = []
    monkeypatch.setattr(panels, "save", lambda figure, *_: drawn.append(figure))
    bodies.draw_bodies(tmp_path)
    assert len(drawn) == 2
    for figure in drawn:
        assert (figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()) == ("r [mm]", "z [mm]")
