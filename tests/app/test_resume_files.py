"""Files of a case that goes on with --resume: what counts is their content, not their place."""

import shutil
import tomllib

import pytest
import tomli_w

from thermowear.app.cli import main
from thermowear.case.starters import starter_files, starter_text

STOPPED = "--set=analysis.max_steps=3"


@pytest.fixture
def place(tmp_path):
    """Folder with a case of a mesh file and an initial shape, and a stopped run."""
    folder = tmp_path / "first"
    folder.mkdir()
    (folder / "own-mesh.msh").write_bytes(starter_files("own-mesh")["own-mesh.msh"])
    (folder / "shape.csv").write_text("s_m,shape_m\n0,0\n0.012,1e-7\n0.025,0\n")
    tables = tomllib.loads(starter_text("own-mesh"))
    tables["geometry"]["initial_shape"] = "shape.csv"
    tables["mesh"]["degree"] = 1
    tables["analysis"] = {"type": "transient", "end_time": "10 s", "tolerance": 1e-2}
    (folder / "case.toml").write_text(tomli_w.dumps(tables))
    assert run(folder, STOPPED) == 2
    return folder


def run(folder, *more):
    results = folder.parent / "results"
    return main(["run", str(folder / "case.toml"), "-o", str(results), "--no-pictures", *more])


def moved(file):
    """Move two nodes inside a body: neither the sum of all nodes nor a face changes."""
    lines = file.read_text().splitlines()
    last = lines.index("$EndNodes") - 1
    for line, by in ((last, 0.01), (last - 1, -0.01)):
        x, y, z = lines[line].split()
        lines[line] = f"{float(x) + by!r} {y} {z}"
    file.write_text("\n".join(lines))


def test_files_may_lie_elsewhere(place):
    """requirement: the same mesh and shape in another folder are accepted."""
    there = place.parent / "second"
    shutil.move(place, there)
    assert run(there, "--resume") == 0
    assert run(there, "--resume") == 0


def test_another_mesh_is_noticed(place, capsys):
    """requirement: one line with the key, exit code 1, and unchanged results."""
    before = (place.parent / "results" / "run.json").read_text()
    original = (place / "own-mesh.msh").read_text()
    moved(place / "own-mesh.msh")
    capsys.readouterr()
    assert run(place, "--resume") == 1
    assert "--resume: geometry.path: the mesh in" in capsys.readouterr().err
    assert (place.parent / "results" / "run.json").read_text() == before
    (place / "own-mesh.msh").write_text(original)
    assert run(place, "--resume") == 0
    moved(place / "own-mesh.msh")
    assert run(place, "--resume") == 1
    assert "--resume: geometry.path: the mesh in" in capsys.readouterr().err


def test_another_shape_is_noticed(place, capsys):
    """requirement: another gap from the initial shape is refused."""
    (place / "shape.csv").write_text("s_m,shape_m\n0,0\n0.012,1.1e-7\n0.025,0\n")
    assert run(place, "--resume") == 1
    assert "the initial shape or the version of a library" in capsys.readouterr().err
