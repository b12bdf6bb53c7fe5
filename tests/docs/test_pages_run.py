"""Documents, from their first line to the last: files, programs, commands and what they print.

Each page is followed in an empty folder with the `demos` and `meshes` of the repository beside it;
its pieces of programs without a file's name are one program together.
The pages of the gallery are made by running their commands (`make gallery`).
"""

from __future__ import annotations

import math
import os
import re
import subprocess
import sys

import pytest

from .blocks import PAGES, TOP, blocks, calls

# commands that set up another system, or that end in this test; `test_targets_of_make` reads them
ELSEWHERE = re.compile(r"^(sudo|docker|pip|make) ")
MADE_BY_RUNNING = {"demos/README.md"}
PROGRAMS = {
    "bin/thermowear": f'exec {sys.executable} -m thermowear "$@"',
    "bin/python3": f'exec {sys.executable} "$@"',
    # of a cluster: two ranks on this machine, without the options of the queue
    "bin/srun": 'while [[ $1 == --* ]]; do shift; done; exec mpirun -n 2 "$@"',
    "scripts/env": 'exec "$@"',
}
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def runs(page: str) -> bool:
    found = any(call.command for call in calls(page) if not ELSEWHERE.match(call.command))
    return page not in MADE_BY_RUNNING and (found or any(map(is_program, blocks(page))))


def is_program(block) -> bool:
    return block.language in ("python", "bash")


@pytest.fixture
def folder(tmp_path):
    for name in ("demos", "meshes"):
        (tmp_path / name).symlink_to(TOP / name)
    for name, text in PROGRAMS.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    return tmp_path


def executed(script: str, folder, *, fails: bool = False) -> str:
    """Output of a script of bash, both streams; it must succeed, or fail for a wrong case."""
    path = f"{folder / 'bin'}:{os.environ['PATH']}"
    environment = os.environ | {"PYTHONPATH": str(TOP), "PATH": path, "HOME": str(folder)}
    environment["SLURM_SUBMIT_DIR"] = str(folder)
    done = subprocess.run(
        ["bash", "-euc", script],
        cwd=folder,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert done.returncode == (1 if fails else 0), f"{script}\n{done.stdout}"
    return done.stdout


def agrees(printed: str, expected: str) -> bool:
    """Whether a line is the expected one: equal words, numbers within 1 %, … for anything."""
    words = [NUMBER.sub("#", text) for text in (printed, expected)]
    pattern = r"\s+".join(map(re.escape, words[1].split())).replace("…", ".*")
    if not re.match(rf"\s*{pattern}", words[0]):
        return False
    if "…" in expected:  # the numbers before it
        expected = expected[: expected.index("…")]
    pairs = zip(NUMBER.findall(printed), NUMBER.findall(expected), strict=False)
    return all(math.isclose(float(a), float(b), rel_tol=1e-2) for a, b in pairs)


def follow(block, folder) -> None:
    """Do what a reader does with a block."""
    if block.file is not None:
        (folder / block.file).write_text(block.text, encoding="utf-8")
    elif block.language == "bash":
        executed(block.text, folder)
    for call in block.calls():
        if ELSEWHERE.match(call.command):
            continue
        shown = [line for line in call.output if line]
        fails = any(line.startswith("error: ") for line in shown)
        lines = executed(call.command, folder, fails=fails).splitlines()
        for line in shown:
            assert any(agrees(each, line) for each in lines), "\n".join([line, "---", *lines])


@pytest.mark.slow
@pytest.mark.parametrize("page", filter(runs, PAGES))
def test_page(page, folder):
    """requirement G1: a reader who follows a page gets what it says."""
    for block in blocks(page):
        follow(block, folder)
    programs = [b.text for b in blocks(page) if b.language == "python" and b.file is None]
    if programs:
        (folder / "page.py").write_text("\n".join(programs), encoding="utf-8")
        executed("python3 page.py", folder)


def test_targets_of_make():
    """requirement: targets that the documents name exist."""
    known = set(re.findall(r"^([\w-]+):", (TOP / "Makefile").read_text(encoding="utf-8"), re.M))
    commands = [call.command.split("#")[0].split() for page in PAGES for call in calls(page)]
    named = {target for words in commands if words[0] == "make" for target in words[1:]}
    assert {"demo", "docs", "test"} <= named <= known


@pytest.mark.parametrize(
    ("printed", "expected", "equal"),
    [
        ("largest pressure  175.1 MPa", "largest pressure 175.02 MPa", True),
        ("largest pressure  178 MPa", "largest pressure 175.02 MPa", False),
        ("smallest pressure 175 MPa", "largest pressure 175 MPa", False),
        ("30 runs, 12.4 s", "30 runs, …", True),
        ("31 runs, 12.4 s", "30 runs, …", False),
    ],
)
def test_comparison_of_lines(printed, expected, equal):
    assert agrees(printed, expected) is equal
