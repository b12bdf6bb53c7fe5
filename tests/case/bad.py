"""Faults of cases, and how they are reported."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main

from .starter import STEADY, tables


@dataclass(frozen=True)
class Bad:
    """A change of a starter case and what must be said about it."""

    name: str
    changes: dict[str, Any]
    path: str
    text: str
    starter: str = field(default=STEADY)


def assert_refused(bad: Bad, tmp_path, capsys) -> None:
    """The command line ends with exit code 1 and one line: the key at fault and what is wrong."""
    file = tmp_path / "case.toml"
    file.write_text(tomli_w.dumps(tables(bad.starter, bad.changes)), encoding="utf-8")
    code = main(["validate", str(file)])
    printed = capsys.readouterr()
    assert code == 1
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert line.startswith(f"error: {bad.path}: ")
    assert bad.text in line


def faults(changes: dict[str, Any], starter: str = STEADY) -> list[str]:
    """Every line about a starter case with changes."""
    with pytest.raises(tw.CaseError) as caught:
        tw.load(tables(starter, changes))
    return caught.value.faults
