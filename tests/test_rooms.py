"""Architecture: allowed imports between packages and folders."""

import ast
import os
import re
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import thermowear

ROOT = Path(thermowear.__file__).parent
PACKAGE = "thermowear"
ORDER = [
    "laws",
    "case",
    "reference",
    "inference",
    "geometry",
    "bulk",
    "contact",
    "model",
    "results",
    "simulation",
    "calibration",
    "verification",
    "output",
    "scripting",
    "app",
]
"""Packages in the order of data flow: each imports only from packages above it."""
NOT_ALLOWED = {
    "case": {"dolfinx", "gmsh", "meshio", "petsc4py", "mpi4py", "ufl", "basix"},
    "laws": {"dolfinx", "gmsh", "meshio", "petsc4py", "mpi4py", "ufl", "basix", "pydantic", "pint"},
    "model": {"dolfinx", "gmsh", "meshio", "petsc4py", "mpi4py", "ufl", "pydantic", "pint"},
    "reference": {"dolfinx", "gmsh", "petsc4py", "mpi4py", "ufl", "pydantic", "pint"},
    "inference": {
        *("dolfinx", "gmsh", "meshio", "petsc4py", "mpi4py", "ufl", "basix"),
        *("pydantic", "pint", "matplotlib"),
    },
    "geometry": {"dolfinx", "petsc4py", "mpi4py", "ufl"},
    "results": {"dolfinx", "gmsh", "meshio", "petsc4py", "mpi4py", "ufl", "basix", "matplotlib"},
    "calibration": {"dolfinx", "gmsh", "petsc4py", "mpi4py", "ufl", "basix", "matplotlib"},
    "output": {"dolfinx", "petsc4py", "ufl", "basix", "gmsh"},
    "app": {"dolfinx", "ufl", "basix", "gmsh"},
}
BARE = {
    "output": {"simulation", "calibration", "verification", "contact", "bulk", "laws", "model"},
    "reference": {"case"},
    "inference": {"laws", "case", "reference"},
    "results": {"laws", "case", "reference", "geometry", "bulk", "contact", "model"},
    "bulk": {"case", "geometry"},
    "contact": {"case", "geometry"},
    "model": {"case", "reference", "bulk", "contact"},
}
"""Packages that must not be imported although the order would allow it."""


def module_of(path):
    """Dotted name of a source file."""
    parts = [PACKAGE, *path.relative_to(ROOT).with_suffix("").parts]
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


SOURCES = {module_of(path): path for path in sorted(ROOT.rglob("*.py"))}


def imports(path):
    """Absolute dotted names that a module imports, for type hints and in functions, too."""
    package = [PACKAGE, *path.relative_to(ROOT).parts[:-1]]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            module = [*base, *(node.module.split(".") if node.module else [])]
            for alias in node.names:
                yield ".".join([*module, alias.name])


def own_imports(path):
    """Modules of the package that a module imports."""
    for name in imports(path):
        while name and name not in SOURCES:
            name = name.rpartition(".")[0]
        if name and name != PACKAGE:
            yield name


@pytest.mark.parametrize("room", ORDER)
def test_rooms_import_only_from_above(room):
    """requirement: imports follow the order; only bulk, contact and simulation use dolfinx."""
    below = set(ORDER[ORDER.index(room) + 1 :]) | BARE.get(room, set())
    for path in (ROOT / room).rglob("*.py"):
        for name in imports(path):
            parts = name.split(".")
            if parts[0] == PACKAGE and len(parts) > 1:
                assert parts[1] not in below, f"{path} imports {name}"
            assert parts[0] not in NOT_ALLOWED.get(room, set()), f"{path} imports {name}"


def test_the_simulation_reads_no_case_file():
    """requirement: the case file is one client of the model, translated in one folder."""
    for path in (ROOT / "simulation").rglob("*.py"):
        if path.parent.name != "from_case":
            for name in imports(path):
                assert not name.startswith(f"{PACKAGE}.case"), f"{path} imports {name}"


def test_no_circle_of_imports():
    """requirement: modules import one way, also for type hints and inside functions."""
    graph = {name: set(own_imports(path)) - {name} for name, path in SOURCES.items()}
    assert tuple(TopologicalSorter(graph).static_order())


def test_folders_inside_a_room_import_one_way():
    """requirement: imports between sibling folders and modules go one way."""
    graph = {}
    for name, path in SOURCES.items():
        if path.name == "__init__.py":
            continue  # says what a folder offers
        for other in own_imports(path):
            one, two = name.split("."), other.split(".")
            at = next((i for i, (a, b) in enumerate(zip(one, two, strict=False)) if a != b), None)
            if at is not None:
                node, needed = ".".join(one[: at + 1]), ".".join(two[: at + 1])
                graph.setdefault(node, set()).add(needed)
    assert tuple(TopologicalSorter(graph).static_order())


def test_docstrings_begin_with_a_noun_phrase_or_an_imperative():
    """requirement: plain technical English that a search finds."""
    riddles = ("What", "How", "Where", "Which", "Of", "Those", "Its", "The same")
    for path in SOURCES.values():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            text = node.value if isinstance(node, ast.Expr) else None
            if isinstance(text, ast.Constant) and isinstance(text.value, str):
                words = text.value.strip() + " "
                assert not words.startswith(tuple(f"{word} " for word in riddles)), (
                    f"{path}:{text.lineno}: {words[:60]}"
                )


def test_only_compat_knows_versions():
    """requirement: differences of dolfinx releases are handled in one module."""
    own = {"__init__.py", "app/arguments.py", "output/folder.py"}  # the program's own version
    for path in SOURCES.values():
        if path.name != "compat.py":
            assert "dolfinx.cpp" not in set(imports(path)), path
            known = path.relative_to(ROOT).as_posix() in own
            assert known or "__version__" not in path.read_text(encoding="utf-8"), path


def run_python(code):
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=False
    )


def test_import_is_light_and_clean():
    """requirement: ``import thermowear`` warns of nothing and loads no heavy library."""
    heavy = {"dolfinx", "gmsh", "matplotlib", "pyvista", "mpi4py", "pint", "meshio"}
    done = run_python(f"import sys, thermowear; print({heavy} & set(sys.modules))")
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "set()"


def test_public_names_are_there():
    """requirement: the Python interface that is promised."""
    for name in thermowear.__all__:
        assert getattr(thermowear, name) is not None
    assert callable(thermowear.contact.pair)
    assert callable(thermowear.contact.condense)
    assert callable(thermowear.laws.steady_pressure)
    with pytest.raises(AttributeError):
        _ = thermowear.nothing_of_the_kind


def test_a_case_is_loaded_without_the_package_being_asked_first(tmp_path):
    """requirement: `thermowear.case.load` knows every geometry without other imports."""
    from thermowear.case.starters import starter_text

    (tmp_path / "ring.toml").write_text(starter_text("annular-punch"), encoding="utf-8")
    words = "import thermowear as tw; print(tw.case.load('ring.toml').geometry.type)"
    done = subprocess.run(
        [sys.executable, "-c", words],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(ROOT.parent)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == "annular-punch\n", done.stderr


def test_files_named_in_the_documents_exist():
    """requirement: a path in CONTRIBUTING, README and docs is the end of one of a source file."""
    top = ROOT.parent
    sources = [f"/{path.relative_to(top).as_posix()}" for path in top.rglob("*.py")]
    for document in (top / "CONTRIBUTING.md", top / "README.md", *top.rglob("docs/**/*.md")):
        named = re.findall(r"`([\w/]+\.py)`", document.read_text(encoding="utf-8"))
        missing = [n for n in named if not any(s.endswith(f"/{n}") for s in sources)]
        assert not missing, document.name
