"""Command line: commands, exit codes, and protection of files."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

import meshio
import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case.starters import starter_text, starters

from ..conftest import DEMOS

SMALL = ("--set", "mesh.degree=2", "--set", "mesh.elements=2")
NAMES = ("punch", "plate")
TOO_LONG = "n" * 300
SURFACES = (
    "punch_face",
    "punch_top",
    "punch_inside",
    "punch_outside",
    "plate_face",
    "plate_bottom",
    "plate_side",
)


pytestmark = pytest.mark.usefixtures("in_folder")


@pytest.fixture
def case() -> str:
    Path("ring.toml").write_text(starter_text("annular-punch"), encoding="utf-8")
    return "ring.toml"


def contents(folder: Path = Path()) -> dict[str, bytes]:
    return {str(p): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


# ---- words ----

WRONG_WORDS = [
    ((), "COMMAND"),
    (("dance",), "'dance'"),
    (("run",), "CASE"),
    (("validate",), "CASE"),
    (("init",), "NAME"),
    (("plot",), "DIR"),
    (("mesh", "ring.toml"), "--output"),
    (("run", "ring.toml", "-o"), "-o/--output"),
    (("validate", "ring.toml", "--set"), "--set"),
    (("validate", "ring.toml", "--fast"), "--fast"),
    (("run", "ring.toml", "more.toml"), "more.toml"),
    (("--fast",), "COMMAND"),
    (("run", "ring.toml", "--overwrite=yes"), "--overwrite"),
]


@pytest.mark.parametrize(
    ("words", "text"), WRONG_WORDS, ids=[" ".join(wrong[0]) or "nothing" for wrong in WRONG_WORDS]
)
def test_wrong_words(words, text, case, refused):
    """
    requirement: an invalid command line ends with exit code 1 and one line that points to --help.
    """
    line = refused(*words)
    assert text in line
    assert "--help" in line


@pytest.mark.parametrize("words", [["--help"], ["run", "--help"], ["--version"]])
def test_help_is_no_error(words, capsys):
    """
    requirement: asking for help or the version is no error.
    """
    with pytest.raises(SystemExit) as left:
        main(words)
    assert left.value.code == 0
    assert "thermowear" in capsys.readouterr().out


def test_the_process_ends_with_the_exit_code():
    """
    requirement: exit code 1 and no traceback, seen from outside.
    """
    done = subprocess.run(
        [sys.executable, "-m", "thermowear", "validate", "none.toml"],
        capture_output=True,
        text=True,
        check=False,
        env=_environment(),
    )
    assert done.returncode == 1
    assert done.stderr == "error: none.toml: cannot be read: No such file or directory\n"


def _environment() -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(Path(tw.__file__).parents[1])}


# ---- cases, init, validate ----


def test_cases_lists_every_starter(capsys):
    """
    requirement: `cases` names every starter case with its title.
    """
    assert main(["cases"]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert len(rows) == len(starters()) >= 2
    for row, (name, title) in zip(rows, starters().items(), strict=True):
        assert row.split()[0] == name
        assert row.endswith(title)


@pytest.mark.parametrize("name", starters())
def test_a_starter_is_written_and_valid(name, capsys):
    """
    requirement: `init` writes a starter case that `validate` accepts.
    """
    assert main(["init", name]) == 0
    assert main(["validate", f"{name}.toml"]) == 0
    assert f"{name}.toml: ok" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["annular-punch", "own-mesh"])
def test_a_case_is_checked_without_the_solvers(name):
    """
    requirement: `validate` loads no dolfinx, PETSc, gmsh, VTK or plotting.
    """
    assert main(["init", name, "-o", "case.toml"]) == 0
    command = [sys.executable, "-X", "importtime", "-m", "thermowear", "validate", "case.toml"]
    done = subprocess.run(command, capture_output=True, check=True, env=_environment(), text=True)
    assert done.stdout.startswith("case.toml: ok (")
    loaded = {line.split("|")[-1].strip().split(".")[0] for line in done.stderr.splitlines()}
    assert "pydantic" in loaded
    assert not loaded & {"dolfinx", "petsc4py", "mpi4py", "gmsh", "matplotlib", "vtk", "pyvista"}


def test_init_writes_the_files_of_a_case_beside_it(refused, capsys):
    """
    requirement: a starter that reads a mesh file comes with it, and overwrites none.
    """
    Path("there").mkdir()
    assert main(["init", "own-mesh", "-o", "there/mine.toml"]) == 0
    assert sorted(contents()) == ["there/mine.toml", "there/own-mesh.msh"]
    Path("there/mine.toml").unlink()
    capsys.readouterr()
    assert "there/own-mesh.msh: exists" in refused("init", "own-mesh", "-o", "there/mine.toml")
    assert sorted(contents()) == ["there/own-mesh.msh"]


def test_init_does_not_overwrite(refused):
    """
    requirement: `init` refuses to overwrite a file unless told to.
    """
    Path("mine.toml").write_text("mine", encoding="utf-8")
    assert "mine.toml: exists" in refused("init", "annular-punch", "-o", "mine.toml")
    assert contents() == {"mine.toml": b"mine"}
    assert main(["init", "annular-punch", "-o", "mine.toml", "--overwrite"]) == 0
    assert tw.load("mine.toml")


def test_init_names_the_starters(refused):
    """
    requirement: the error of an unknown name lists the known ones.
    """
    line = refused("init", "brake")
    assert all(name in line for name in starters())
    assert contents() == {}


@pytest.mark.parametrize(
    "target",
    ["none/a.toml", "ring.toml/a.toml", "/proc/a.toml", TOO_LONG],
    ids=lambda name: name[:20],
)
def test_init_where_nothing_can_be_written(target, case, refused):
    """
    requirement: a place that cannot be written to: one line, exit code 1.
    """
    assert "cannot be written" in refused("init", "annular-punch", "-o", target)


def test_init_into_a_folder(refused):
    """
    requirement: a folder instead of a file: one line, exit code 1.
    """
    assert "cannot be written" in refused("init", "annular-punch", "-o", ".", "--overwrite")


def test_validate_takes_overrides(case, capsys):
    """
    requirement: `validate` checks what `run` would compute, --set included.
    """
    assert main(["validate", case, "--set", "mesh.degree=10"]) == 0
    assert main(["validate", case, "--set", "mesh.degree=11"]) == 1
    assert capsys.readouterr().err.startswith("error: mesh.degree: found 11")


def test_validate_loads_nothing_heavy(case):
    """
    requirement: a case is checked without dolfinx, gmsh and MPI.
    """
    script = (
        "import sys; from thermowear.app.cli import main; code = main(['validate', 'ring.toml']);"
        "heavy = {'dolfinx', 'gmsh', 'mpi4py', 'petsc4py', 'pyvista', 'matplotlib'};"
        "print(code, sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        check=True,
        env=_environment(),
    )
    assert done.stdout.splitlines()[-1] == "0 []"


# ---- mesh ----


def written_mesh(case: str, name: str) -> meshio.Mesh:
    assert main(["mesh", case, *SMALL, "-o", name]) == 0
    assert sorted(contents()) == sorted([case, name])
    return meshio.read(name)


def parts(mesh: meshio.Mesh) -> dict[str, tuple[str, np.ndarray]]:
    """Type and elements of every named part, by whichever means the format names parts."""
    blocks = {block.type: block.data for block in mesh.cells}
    if mesh.cell_sets:
        return {
            name: (block.type, block.data[chosen])
            for name, chosen_by_block in mesh.cell_sets.items()
            for block, chosen in zip(mesh.cells, chosen_by_block, strict=True)
            if chosen is not None and len(chosen)
        }
    field = "gmsh:physical" if mesh.field_data else "tag"
    tags = {name: int(tag) for name, (tag, _) in mesh.field_data.items()}
    tags = tags or {name: tag for tag, name in enumerate((*NAMES, *SURFACES), start=1)}
    return {
        name: (kind, blocks[kind][values == tag])
        for name, tag in tags.items()
        for kind, values in mesh.cell_data_dict[field].items()
        if (values == tag).any()
    }


@pytest.mark.parametrize("ending", [".msh", ".vtu", ".xdmf", ".inp"])
def test_a_mesh_is_read_back(ending, case):
    """
    requirement: `mesh` writes bodies and surfaces readable by another program.
    """
    mesh = written_mesh(case, f"ring{ending}")
    found = parts(mesh)
    assert set(found) == {*NAMES, *SURFACES}
    assert {kind for name, (kind, _) in found.items() if name in NAMES} == {"quad"}
    assert {kind for name, (kind, _) in found.items() if name in SURFACES} == {"line"}
    box = {
        name: np.array([mesh.points[cells].min((0, 1)), mesh.points[cells].max((0, 1))])[:, :2]
        for name, (_, cells) in found.items()
    }
    assert box["punch"] == pytest.approx(np.array([[0.02, 0.0], [0.12, 0.05]]))
    assert box["plate"] == pytest.approx(np.array([[0.0, -0.1], [0.14, 0.0]]))
    assert box["punch_face"] == pytest.approx(np.array([[0.02, 0.0], [0.12, 0.0]]))
    assert box["plate_face"] == pytest.approx(np.array([[0.02, 0.0], [0.12, 0.0]]))
    assert box["punch_top"] == pytest.approx(np.array([[0.02, 0.05], [0.12, 0.05]]))
    assert box["punch_inside"] == pytest.approx(np.array([[0.02, 0.0], [0.02, 0.05]]))
    assert box["plate_side"] == pytest.approx(np.array([[0.14, -0.1], [0.14, 0.0]]))


def test_a_mesh_carries_the_names_in_msh(case):
    """
    requirement: bodies and surfaces are physical groups, with their names and dimensions.
    """
    groups = written_mesh(case, "ring.msh").field_data
    assert {name for name, (_, dim) in groups.items() if dim == 2} == set(NAMES)
    assert {name for name, (_, dim) in groups.items() if dim == 1} == set(SURFACES)


@pytest.mark.parametrize("name", ["ring.stp", "ring", "ring.MSH", ".msh"])
def test_a_mesh_of_unknown_ending(name, case, refused):
    """
    requirement: an unknown ending is refused with the known ones.
    """
    assert ".msh, .vtu, .xdmf, .inp" in refused("mesh", case, *SMALL, "-o", name)
    assert list(contents()) == [case]


@pytest.mark.parametrize("ending", [".msh", ".vtu", ".xdmf", ".inp"])
@pytest.mark.parametrize("folder", ["none", "ring.toml", "/proc"])
def test_a_mesh_where_nothing_can_be_written(folder, ending, case, refused):
    """
    requirement: a place that cannot be written to: one line, exit code 1.
    """
    target = f"{folder}/mesh{ending}"
    assert f"-o {target}: cannot be written" in refused("mesh", case, *SMALL, "-o", target)


def test_a_mesh_does_not_overwrite(case, refused):
    """
    requirement: `mesh` refuses to overwrite a file unless told to.
    """
    Path("ring.msh").write_text("mine", encoding="utf-8")
    assert "exists" in refused("mesh", case, *SMALL, "-o", "ring.msh")
    assert Path("ring.msh").read_text(encoding="utf-8") == "mine"
    assert main(["mesh", case, *SMALL, "-o", "ring.msh", "--overwrite"]) == 0
    assert meshio.read("ring.msh").cells


def test_a_mesh_touches_no_file_beside_it(case):
    """
    requirement: nothing is overwritten that the user did not name.
    """
    Path("ring.h5").write_text("mine", encoding="utf-8")
    assert main(["mesh", case, *SMALL, "-o", "ring.xdmf"]) == 0
    assert Path("ring.h5").read_text(encoding="utf-8") == "mine"


# ---- plot ----


@pytest.mark.parametrize("folder", ["none", ".", "ring.toml"])
def test_plot_without_results(folder, case, refused):
    """
    requirement: `plot` without a results folder: one line, exit code 1.
    """
    assert folder in refused("plot", folder)
    assert list(contents()) == [case]


@pytest.mark.parametrize("content", [b"", b"a,b\n1,2\n", b"\xff\xfe\x00"])
def test_plot_of_a_broken_table(content, refused):
    """
    requirement: `plot` with a file of other origin: one line, exit code 1.
    """
    Path("interface.csv").write_bytes(content)
    refused("plot", ".")


# ---- run ----


@pytest.fixture(scope="module")
def results(tmp_path_factory) -> Path:
    """Results folder of a complete run of the program."""
    place = tmp_path_factory.mktemp("run")
    file = place / "ring.toml"
    file.write_text(starter_text("annular-punch"), encoding="utf-8")
    handler = signal.getsignal(signal.SIGTERM)
    assert main(["run", str(file), *SMALL, "-o", str(place / "results"), "--no-pictures"]) == 0
    signal.signal(signal.SIGTERM, handler)
    return place / "results"


def test_a_run_leaves_its_files(results):
    """
    requirement: a run writes summary, interface, fields, the resolved case and run.json.
    """
    assert {path.name for path in results.iterdir()} == {
        "summary.json",
        "run.json",
        "interface.csv",
        "profile.csv",
        "fields.vtu",
        "case.resolved.toml",
    }
    assert json.loads((results / "run.json").read_text(encoding="utf-8"))["status"] == "done"
    summary = json.loads((results / "summary.json").read_text(encoding="utf-8"))
    assert summary["analysis"] == "steady"
    assert summary["mean_pressure_Pa"] == pytest.approx(50e6, rel=1e-9)


def test_the_resolved_case_is_the_case_that_was_run(results):
    """
    requirement: case.resolved.toml contains all defaults and all --set.
    """
    resolved = tw.load(results / "case.resolved.toml")
    source = tomllib.loads(starter_text("annular-punch"))
    assert resolved == tw.load(source, ("mesh.degree=2", "mesh.elements=2"))


def test_a_second_run_touches_nothing(results, case, refused):
    """
    requirement: existing results remain unchanged without --overwrite.
    """
    before = contents(results)
    line = refused("run", case, *SMALL, "-o", str(results), "--no-pictures")
    assert "not empty" in line
    assert "--overwrite" in line
    assert contents(results) == before


def test_a_run_refuses_a_folder_of_something_else(case, refused):
    """
    requirement: a folder with other files is not used without --overwrite.
    """
    Path("notes").mkdir()
    Path("notes/todo.txt").write_text("mine", encoding="utf-8")
    assert "not empty" in refused("run", case, "-o", "notes")
    assert contents(Path("notes")) == {"notes/todo.txt": b"mine"}


def test_overwriting_spares_the_files_of_others(case, capsys):
    """
    requirement: --overwrite replaces earlier results and keeps other files.
    """
    folder = Path("results/ring")
    (folder / "more").mkdir(parents=True)
    mine = {
        "notes.txt": b"a",
        "interface.csv.bak": b"b",
        "my_fields.vtu": b"c",
        "more/run.json": b"d",
    }
    for name, content in mine.items():
        (folder / name).write_bytes(content)
    for name in ("history.csv", "interface_5.csv", "wear.png", "summary.json", "run.json"):
        (folder / name).write_text("of an earlier run", encoding="utf-8")
    assert main(["run", case, *SMALL, "--no-pictures", "--overwrite"]) == 0
    assert "results in results/ring" in capsys.readouterr().out
    for name, content in mine.items():
        assert (folder / name).read_bytes() == content
    left = {path.name for path in folder.iterdir()}
    assert not left & {"history.csv", "interface_5.csv", "wear.png"}
    assert json.loads((folder / "summary.json").read_text(encoding="utf-8"))["model"]


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ("contact.friction=-1", "contact.friction"),
        ("mesh.degree=two", "mesh.degree"),
        ("model=3d", "model"),
        ("load.force=1 N", "load"),
    ],
)
def test_a_wrong_case_leaves_no_folder(changes, path, case, refused):
    """
    requirement: no results folder remains if the case is invalid.
    """
    assert refused("run", case, "--set", changes).startswith(f"error: {path}: ")
    assert refused("run", case, "--set", changes, "-o", "a/b").startswith(f"error: {path}: ")
    assert [path.name for path in Path().iterdir()] == [case]


def test_a_wrong_case_keeps_earlier_results(results, case, refused):
    """
    requirement: nothing is overwritten if the case is invalid, even with --overwrite.
    """
    before = contents(results)
    refused("run", case, "--set", "mesh.degree=0", "-o", str(results), "--overwrite")
    assert contents(results) == before


@pytest.mark.parametrize(
    "target",
    ["ring.toml", "ring.toml/a", "/proc/a", "/proc/a/b", TOO_LONG],
    ids=lambda name: name[:20],
)
@pytest.mark.parametrize("more", [(), ("--overwrite",)], ids=["plain", "overwrite"])
def test_a_run_where_nothing_can_be_written(target, more, case, refused):
    """
    requirement: an output folder that cannot be created: one line, before computing.
    """
    before = contents()
    assert f"error: -o {target}: cannot be written" in refused("run", case, "-o", target, *more)
    assert contents() == before


@pytest.mark.parametrize("name", ["own_mesh", "two_pads_3d"])
def test_checks_are_all_that_validate_shows(name):
    """requirement: one line, and nothing of a library beside it, at the end of the process too."""
    words = [sys.executable, "-m", "thermowear", "validate", str(DEMOS / f"{name}.toml")]
    paths = {"PYTHONPATH": str(DEMOS.parent)}
    done = subprocess.run(words, capture_output=True, text=True, check=True, env=os.environ | paths)
    assert done.stderr == ""
    assert len(done.stdout.splitlines()) == 1


@pytest.mark.slow
def test_a_run_prints_the_notes_on_its_mesh():
    """requirement: also after the import of ffcx, which takes warnings away from the terminal."""
    assert main(["init", "own-mesh"]) == 0
    far = ("--set", 'geometry.length_unit="1 m"', "--set", "mesh.degree=1")
    words = ("run", "own-mesh.toml", "-o", "far", "--no-pictures", *far)
    done = subprocess.run(
        [sys.executable, "-m", "thermowear", *words], capture_output=True, text=True, check=True
    )
    assert "note: geometry.length_unit: " in done.stderr
