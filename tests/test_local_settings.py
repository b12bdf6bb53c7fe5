"""Runs in a folder with files that libraries could read as settings or modules."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import thermowear as tw
from thermowear.case.starters import starter_text

SMALL = ("--set=mesh.degree=2", "--set=mesh.elements=2")


@pytest.fixture
def hostile(tmp_path, monkeypatch):
    """Folder of files that would each leave a trace if they were read."""
    mark, command = tmp_path / "mark", tmp_path / "folder" / "command"
    folder = command.parent
    folder.mkdir()
    command.write_text(f'#!/bin/sh\ntouch {mark}\nexec "$@"\n')
    command.chmod(0o755)
    options = {"cffi_extra_compile_args": ["-wrapper", str(command)], "cffi_verbose": True}
    (folder / "dolfinx_jit_options.json").write_text(json.dumps(options))
    (folder / "ffcx_options.json").write_text('{"epsilon": 0.5}')
    for name in (".petscrc", "petscrc"):
        (folder / name).write_text(f"-log_view :{mark}\n")
    for name in (".gmshrc", ".gmsh-options"):
        (folder / name).write_text(f'SystemCall "touch {mark}";\n')
    for name in ("gmsh", "h5py", "matplotlib", "meshio", "numpy", "petsc4py", "pydantic", "scipy"):
        (folder / f"{name}.py").write_text(f"open({str(mark)!r}, 'w')\n")
    (folder / "ring.toml").write_text(starter_text("annular-punch"))
    monkeypatch.chdir(folder)
    return mark


def test_nothing_in_the_current_folder_is_carried_out(hostile):
    """requirement: commands, modules and options in the current folder have no effect."""
    done = subprocess.run(
        [sys.executable, "-m", "thermowear", "run", "ring.toml", "--no-pictures", *SMALL],
        env=os.environ | {"PYTHONPATH": str(Path(tw.__file__).parents[1])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert not hostile.exists()
