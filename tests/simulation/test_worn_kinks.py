"""Running-in of bodies with chamfers, whose worn faces bend within the elements of the other."""

import copy
from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.simulation import Observer
from thermowear.simulation.analyses import run as analyses
from thermowear.simulation.from_case import analysis_of, model_of

from ..case.starter import STEADY, tables
from ..geometry.plain import NAMES, blocks, msh

WEAR = {"coefficient": "1e-8 1/MPa", "per": "pressure"}
SOFTER = WEAR | {"coefficient": "2e-8 1/MPa"}


def chamfered(folder, depth, tilt=0.0, **analysis):
    """Case of a punch (|x| < 20 mm) with chamfers of 5 mm by a depth [m], on a plate that wears.

    Its face may be drawn tilted by a slope.
    """
    mesh = copy.deepcopy(blocks((16, 23), (4, 4)))
    for node in {node for name, nodes in mesh.lines if name == "PUNCH_FACE" for node in nodes}:
        x, y = mesh.points[node]
        rise = depth * max(abs(x) - 15e-3, 0.0) / 5e-3
        mesh.points[node] = [x, y + rise + tilt * (x + 20e-3)]
    path = folder / "blocks.msh"
    path.write_text(msh(mesh), encoding="utf-8")
    case = tables(STEADY)
    case.pop("heat")
    return case | {
        "model": "plane-strain",
        "geometry": {"type": "file", "path": str(path), "thickness": "25 mm"} | NAMES,
        "mesh": {"degree": 2},
        "load": {"force": "2 kN"},
        "motion": {"velocity": "0.5 m/s"},
        "wear": {"punch": WEAR, "plate": SOFTER},
        "analysis": analysis or {"type": "steady"},
    }


def run(case):
    """Result of a case, and its notes."""
    observer, notes = Observer(), []
    observer.note = notes.append
    return tw.run(tw.load(case), observer=observer), " ".join(notes)


def repeated(case, steps):
    """Result with given ends of the steps [s]."""
    loaded = tw.load(case)
    return analyses.run(model_of(loaded), replace(analysis_of(loaded), steps=tuple(steps)))


def test_it_ends_at_the_steady_state(tmp_path):
    """requirement: the pressure at the end is the steady one, as its distance says; also again.

    The wear of the plate bends within its elements: meshes moved to it change the pressure.
    """
    steady, _ = run(chamfered(tmp_path, 0.2e-3))
    case = chamfered(tmp_path, 0.2e-3, type="transient", until="steady")
    case["wear"]["update"] = 0.002
    end, notes = run(case)
    assert end.summary["geometry_updates"] > 0
    assert end.summary["distance_from_steady"] < 1e-3
    for limit in (np.min, np.max):
        expected = limit(steady.interface.pressure)
        assert limit(end.interface.pressure) == pytest.approx(expected, rel=0.01)
    again = repeated(case, [row.time for row in end.history[1:]]).interface.pressure
    assert again == pytest.approx(end.interface.pressure, rel=1e-6)
    assert "pressure or temperatures changed by" in notes
    worn = end.summary["wear_volume_1_m3"]
    assert 0.5 * worn < end.summary["geometry_volume_1_m3"] <= 1.001 * worn


@pytest.mark.parametrize(("depth", "deep"), [(0.2e-3, False), (2e-3, True)])
def test_deep_steady_states_are_noted(depth, deep, tmp_path):
    """requirement: where wear must be as deep as a tenth of the punch, shapes are approximate."""
    _, notes = run(chamfered(tmp_path, depth))
    assert ("the steady state touches where the unworn faces are up to" in notes) is deep
    assert ("apart: wear of this depth comes to 10" in notes) is deep


def test_a_face_that_is_drawn_tilted_is_not_deep(tmp_path):
    """requirement: what a free rotation of the holder closes is not worn off."""
    case = chamfered(tmp_path, 0.0, tilt=0.1)
    free = case | {"holder": {"free": ["z", "rotation"]}}
    assert "the steady state touches" not in run(free)[1]
    assert "are up to 4" in run(case)[1]
