"""Sizes that are slips of a unit: refused in words, before anything is meshed."""

from __future__ import annotations

import pytest

import thermowear as tw
from thermowear.errors import CaseError
from thermowear.geometry.meshing import cells
from thermowear.geometry.meshing.divisions import MOST_CELLS, check_count, growing

from ..case.bad import faults
from ..case.starter import HERTZ, PUNCH, SPHERE, STEADY, TUBE, tables

SLIPS = [
    ("drum-brake", {"geometry.lining_thickness": "1e-12 mm"}, "geometry.lining_thickness"),
    ("drum-brake", {"geometry.lining_thickness": "5e-9 mm"}, "geometry.lining_thickness"),
    (STEADY, {"geometry.punch_height": "50e6 km"}, "geometry.punch_height"),
    (STEADY, {"geometry.punch_height": "5e-9 mm"}, "geometry.punch_height"),
    (HERTZ, {"geometry.block_width": "1e200 mm"}, "geometry.block_width"),
    (HERTZ, {"geometry.block_height": "1e-320 mm"}, "geometry.block_height"),
    (HERTZ, {"geometry.thickness": "1e-320 mm"}, "geometry.thickness"),
    (PUNCH, {"geometry.edge_radius": "1e300 m"}, "geometry.edge_radius"),
    ("disk-sector", {"geometry.disk_thickness": "1e-10 mm"}, "geometry.disk_thickness"),
    ("disk-brake-3d", {"geometry.chamfer_depth": "1e-10 mm"}, "geometry.chamfer_depth"),
]


@pytest.mark.parametrize(("starter", "changes", "key"), SLIPS)
def test_sizes_that_cannot_be_meant(starter, changes, key):
    """
    requirement: one line at the key, from `validate` on; no crash of a mesh generator.
    """
    (line,) = faults(changes, starter)
    assert line.startswith(f"{key}: found ")


def test_sizes_far_apart_are_named():
    """
    requirement: both sizes, and the ratio that is allowed.
    """
    (line,) = faults({"geometry.lining_thickness": "1e-9 mm"}, "drum-brake")
    assert "beside drum_radius = 0.1" in line
    assert "within a factor 1e+07 of each other" in line


def test_sizes_of_one_order_may_be_small_or_large():
    """
    requirement: what is all small, or all large, is no slip.
    """
    lengths = ("inner_radius", "outer_radius", "punch_height", "plate_radius", "plate_height")
    mm = {f"geometry.{key}": tables()["geometry"][key] for key in lengths}
    for unit in ("nm", "km"):
        changes = {key: text.replace("mm", unit) for key, text in mm.items()}
        cells = tw.load(tables(STEADY, changes)).tagged_mesh().cells
        assert len(cells) == len(tw.load(tables()).tagged_mesh().cells)


LARGE = [
    (STEADY, {"geometry.plate_radius": "14 km"}, "cells in one body"),
    (STEADY, {"geometry.plate_radius": "140 m"}, "million nodes"),
    (STEADY, {"mesh.elements": 400, "mesh.degree": 10}, "million nodes"),
    (HERTZ, {"geometry.block_height": "30 km"}, "cells in one body"),
    ("disk-sector", {"mesh.elements": 300}, "cells in one body"),
    ("disk-brake-3d", {"mesh.elements": 400}, "cells in one body"),
    ("rectangular-punch", {"geometry.block_x": "10 km"}, "cells in one body"),
]


@pytest.mark.parametrize(("starter", "changes", "text"), LARGE)
def test_meshes_too_large(starter, changes, text):
    """
    requirement: what would fill the memory is counted before it is made.
    """
    case = tw.load(tables(starter, changes))
    with pytest.raises(CaseError, match=text) as caught:
        case.tagged_mesh()
    assert len(caught.value.faults) == 1
    assert "check the units" in str(caught.value)


def test_counting_comes_first(monkeypatch):
    """
    requirement: nothing is made of a grid that is too large.
    """
    monkeypatch.setattr(cells.np, "meshgrid", None)
    with pytest.raises(CaseError):
        cells.grid(range(2000), range(2000))
    with pytest.raises(CaseError):
        growing(0.0, 1.0, 1e-9, 1.0, 1e-9)
    check_count(MOST_CELLS)
    for wrong in (MOST_CELLS + 1, float("inf"), float("nan")):
        with pytest.raises(CaseError):
            check_count(wrong)
    assert growing(0.0, 1.0, 0.5, 1.0, 0.5).tolist() == [0.0, 0.5, 1.0]


ZONES = [
    (HERTZ, {"load": {"force": "1e-30 N"}}, "the least width that can be meshed is"),
    (SPHERE, {"load": {"force": "1e-40 N"}}, "the least width that can be meshed is"),
    (HERTZ, {"load": {"force": "1e9 N"}}, "geometry.radius: too small for the contact"),
    (TUBE, {"geometry.zone": "1 m"}, "geometry.zone: too large"),
]


@pytest.mark.parametrize(("starter", "changes", "text"), ZONES)
def test_contacts_that_do_not_fit_the_bodies(starter, changes, text):
    """
    requirement: a load that leads to no contact that can be meshed is refused by `validate`.
    """
    (line,) = faults(changes, starter)
    assert text in line
