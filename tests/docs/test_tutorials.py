"""Tutorials, from their first line to the last: files, programs, commands and what they print."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys

import pytest

from .blocks import PAGES, TOP, steps

TUTORIALS = [page for page in PAGES if page.startswith("docs/tutorials/") and steps(page)]
PROGRAM = [sys.executable, "-m", "thermowear"]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(TOP)}


def executed(command: str, folder) -> str:
    """Output of a command, which must succeed."""
    words = shlex.split(command)
    start = {"thermowear": PROGRAM, "python3": [sys.executable]}[words[0]]
    done = subprocess.run(
        [*start, *words[1:]], cwd=folder, env=ENVIRONMENT, text=True, capture_output=True
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
    return done.stdout


def compare(printed: str, expected: list[str]) -> None:
    """Check that lines were printed; … stands for anything."""
    for line in filter(None, expected):
        pattern = r"\s+".join(re.escape(word) for word in line.split()).replace("…", ".*")
        assert re.search(rf"^\s*{pattern}", printed, re.MULTILINE), f"{line}\n---\n{printed}"


@pytest.mark.slow
@pytest.mark.parametrize("page", TUTORIALS)
def test_tutorial(page, tmp_path):
    """requirement G1: a reader who follows a tutorial gets what it says."""
    for block in steps(page):
        name = re.match(r"# (\S+\.(?:py|toml))\n", block.text)
        if name is not None:
            (tmp_path / name[1]).write_text(block.text, encoding="utf-8")
        if block.language != "console":
            continue
        for call in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block.text, re.MULTILINE):
            compare(executed(call[0], tmp_path), call[1].splitlines())
