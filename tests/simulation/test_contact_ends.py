"""Contact that ends only because a face does is reported."""

import copy

import pytest
import tomli_w

from thermowear.app.cli import main

from ..case.starter import STEADY, tables
from ..geometry.plain import NAMES, blocks, msh

END = "reaches the end of the contact face"


def ran(folder, capsys, spoilt, **load):
    """Output of a run of a punch (|x| < 20 mm) on a plate (|x| < 30 mm) with spoilt faces."""
    mesh = copy.deepcopy(blocks((8, 12), (4, 4)))
    mesh.lines = [
        (name, nodes)
        for name, nodes in mesh.lines
        if not spoilt(name, sum(mesh.points[node][0] for node in nodes) / 2)
    ]
    (folder / "blocks.msh").write_text(msh(mesh), encoding="utf-8")
    case = tables(STEADY)
    case["geometry"] = {"type": "file", "path": "blocks.msh"} | NAMES
    case |= {"model": "plane-strain", "motion": {"velocity": "0.1 m/s"}, "mesh": {"degree": 2}}
    case |= {"load": load or {"force": "10 kN"}, "analysis": {"type": "initial"}}
    case.pop("heat")
    (folder / "case.toml").write_text(tomli_w.dumps(case), encoding="utf-8")
    assert main(["run", str(folder / "case.toml"), "-o", str(folder / "r"), "--no-pictures"]) == 0
    return " ".join(capsys.readouterr().out.split())


def test_whole_faces(tmp_path, capsys):
    """requirement: a punch that ends at its edges on a longer plate is what it seems."""
    assert END not in ran(tmp_path, capsys, lambda name, x: False)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("body", ["PLATE", "PUNCH"])
def test_face_that_ends_under_the_other(body, side, tmp_path, capsys):
    """requirement: the face whose surface goes on is named, of either body, at either end."""
    said = ran(tmp_path, capsys, lambda name, x: name == f"{body}_FACE" and side * x > 10e-3)
    assert f"{END} {body}_FACE" in said


def test_end_that_contact_does_not_reach(tmp_path, capsys):
    """requirement: a plate whose face ends beyond the punch is not reported."""
    assert END not in ran(tmp_path, capsys, lambda name, x: name == "PLATE_FACE" and x > 22e-3)


def test_ends_of_both_faces_at_an_edge(tmp_path, capsys):
    """requirement: a face that ends where the other body ends leaves no contact out."""
    assert END not in ran(tmp_path, capsys, lambda name, x: name == "PLATE_FACE" and x > 20e-3)
