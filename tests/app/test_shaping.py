"""Command ``shape``."""

import json
from pathlib import Path

import meshio
import numpy as np
import pytest

from thermowear.app.cli import main
from thermowear.case import starters
from thermowear.case.starters import starter_text
from thermowear.geometry.mesh.gmsh_session import gmsh_model

SMALL = ("--set", "mesh.degree=2", "--set", "mesh.elements=4")
SLOW = pytest.mark.slow


@pytest.fixture(autouse=True)
def _place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("annular-punch", "drum-brake", "rectangular-punch", "cylinder-stick-slip"):
        Path(f"{name}.toml").write_text(starter_text(name), encoding="utf-8")


def run(*words: str) -> int:
    return main(["shape", *words, *SMALL])


@pytest.mark.parametrize(
    ("name", "ending"),
    [
        pytest.param(
            name,
            ending,
            marks=SLOW if name != "annular-punch" and ending != "msh" else (),
        )
        for name in ("annular-punch", "drum-brake", "rectangular-punch")
        for ending in ("csv", "msh", "vtu", "step")
    ],
)
def test_every_format_begins_a_run(name, ending, capsys):
    """requirement: ring, section and solid in all formats; a run can start from each of them."""
    assert run(f"{name}.toml", "-o", f"d.{ending}") == 0
    assert capsys.readouterr().out.startswith(f"wrote d.{ending}: face of ")
    words = ["run", f"{name}.toml", "-o", "first", "--no-pictures", *SMALL]
    more = ["--set", "analysis={type='initial'}", "--set", f"geometry.initial_shape=d.{ending}"]
    assert main([*words, *more]) == 0
    assert main(["run", f"{name}.toml", "-o", "steady", "--no-pictures", *SMALL]) == 0
    first, steady = (
        np.genfromtxt(f"{place}/interface.csv", delimiter=",", names=True)["pressure_Pa"]
        for place in ("first", "steady")
    )
    assert np.median(np.abs(first / steady - 1)) < 0.03  # a coarse mesh


def test_step_is_in_millimetres():
    """requirement: unit millimetre; the ring minus its wear."""
    assert run("annular-punch.toml", "-o", "ring.step") == 0
    assert "SI_UNIT(.MILLI.,.METRE.)" in Path("ring.step").read_text("utf-8")
    with gmsh_model("read") as gmsh:
        ((dim, solid),) = gmsh.model.occ.importShapes("ring.step")
        gmsh.model.occ.synchronize()
        volume = gmsh.model.occ.getMass(dim, solid)
    assert run("annular-punch.toml", "-o", "ring.csv") == 0
    found = np.genfromtxt("ring.csv", delimiter=",", names=True)
    worn = 1e9 * np.trapezoid(2 * np.pi * found["x_m"] * found["depth_m"], found["x_m"])
    assert volume == pytest.approx(np.pi * (120**2 - 20**2) * 50 - worn, rel=1e-5)


def test_a_mesh_other_programs_read():
    """requirement: gmsh reads it with its names and the displacement of its nodes."""
    assert run("annular-punch.toml", "-o", "plate.msh", "--body", "plate") == 0
    assert set(meshio.read("plate.msh").field_data) == {
        "plate",
        "plate_face",
        "plate_bottom",
        "plate_side",
    }
    with gmsh_model("read") as gmsh:
        gmsh.merge("plate.msh")
        assert len(gmsh.view.getTags()) == 1


def test_files_are_not_overwritten():
    """requirement: an existing file is kept without --overwrite."""
    Path("d.csv").write_text("mine", encoding="utf-8")
    assert run("annular-punch.toml", "-o", "d.csv") == 1
    assert Path("d.csv").read_text(encoding="utf-8") == "mine"
    assert run("annular-punch.toml", "-o", "d.csv", "--overwrite") == 0
    assert Path("d.csv").read_text(encoding="utf-8").startswith("body,x_m")


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("annular-punch.toml", "-o", "d.stl"), "-o d.stl: unknown ending; one of: .csv, .msh"),
        (("annular-punch.toml", "-o", "none/d.csv"), "cannot be written"),
        (("annular-punch.toml", "-o", "none/d.msh"), "cannot be written"),
        (("annular-punch.toml", "-o", "none/d.vtu"), "cannot be written"),
        (("annular-punch.toml", "-o", "none/d.step"), "cannot be written"),
        (("annular-punch.toml", "-o", "d.csv", "--body", "disk"), "one of: punch, plate"),
        (("drum-brake.toml", "-o", "d.csv", "--body", "drum"), "slides past under shoe"),
        (("annular-punch.toml",), "-o/--output"),
        (("none.toml", "-o", "d.csv"), "none.toml"),
    ],
)
def test_bad_words(words, text, capsys):
    """requirement: exit code 1 and one line."""
    assert run(*words) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert text in line
    assert not list(Path().glob("d.*"))


def test_a_case_without_steady_state(capsys):
    """requirement: exit code 1 with the reason."""
    assert main(["shape", "cylinder-stick-slip.toml", "-o", "d.csv"]) == 1
    assert "requires a transient or fretting analysis, not steady" in capsys.readouterr().err


def test_one_process(monkeypatch, capsys):
    """requirement: several ranks are refused, as they would overwrite each other's file."""
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
    monkeypatch.setattr("time.sleep", lambda _: None)
    assert run("annular-punch.toml", "-o", "d.csv") == 1
    assert not Path("d.csv").exists()


def test_tetrahedra_of_a_mesh_file(capsys):
    """requirement: a solid of the pad, and a run that begins with its face."""
    for ending in ("toml", "msh"):
        name = f"own-mesh-3d.{ending}"
        Path(name).write_bytes((Path(starters.__file__).parent / name).read_bytes())
    assert main(["shape", "own-mesh-3d.toml", "-o", "pad.step"]) == 0
    with gmsh_model("read") as gmsh:
        ((dim, _),) = gmsh.model.occ.importShapes("pad.step")
        assert dim == 3
    words = ["run", "own-mesh-3d.toml", "-o", "worn", "--no-pictures"]
    words += ["--set", "geometry.initial_shape=pad.step", "--set", 'analysis={type="initial"}']
    assert main(words) == 0
    shaped = json.loads(Path("worn/summary.json").read_text("utf-8"))
    # even from the start: the mean pressure of the case
    assert shaped["max_pressure_Pa"] == pytest.approx(10e6, rel=0.03)
