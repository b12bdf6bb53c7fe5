"""Tables of the starter cases, to be changed by tests."""

from __future__ import annotations

import copy
import tomllib
from functools import lru_cache
from pathlib import Path
from typing import Any

import thermowear as tw
from thermowear.case import starters
from thermowear.case.starters import starter_text

STEADY, RUNNING_IN = "annular-punch", "annular-punch-running-in"
HERTZ, FRETTING, PUNCH = "cylinder-on-block", "cylinder-stick-slip", "punch-on-block"
SPHERE, RECIPROCATING = "sphere-on-block", "punch-on-strip-reciprocating"
TUBE = "tube-in-support"

FILE = {
    "type": "file",
    "path": "mesh.msh",
    "bodies": {"cylinder": "upper", "block": "lower"},
    "contact": ["cylinder_face", "block_face"],
    "held": "cylinder_top",
    "fixed": "block_bottom",
}
"""Keys of a geometry that was meshed elsewhere, with the bodies of the cylinder."""


GONE = None
"""Stands for a key that is taken out."""


@lru_cache
def _parsed(name: str) -> dict[str, Any]:
    parsed = tomllib.loads(starter_text(name))
    if "path" in parsed["geometry"]:  # of a file that `init` writes beside the case
        parsed["geometry"]["path"] = str(
            Path(starters.__file__).parent / parsed["geometry"]["path"]
        )
    return parsed


def tables(name: str = STEADY, changes: dict[str, Any] | None = None) -> dict[str, Any]:
    """A starter case with changes."""
    return changed(_parsed(name), changes or {})


def changed(case: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """A copy of a case with keys, named by their paths, set or taken out."""
    result = copy.deepcopy(case)
    for path, value in changes.items():
        *tables_above, key = path.split(".")
        table = result
        for part in tables_above:
            table = table.setdefault(part, {})
        if value is GONE:
            del table[key]
        else:
            table[key] = copy.deepcopy(value)
    return result


def paths(table: dict[str, Any], above: str = "") -> list[str]:
    """The paths of all tables and keys."""
    found = []
    for key, value in table.items():
        found.append(f"{above}{key}")
        if isinstance(value, dict):
            found += paths(value, f"{above}{key}.")
    return found


def solved(name: str, changes: dict[str, Any] | None = None, *overrides: str, **more: Any):
    """Result of a starter case with changes; `more` is for `thermowear.run`."""
    return tw.run(tw.load(tables(name, changes), overrides), **more)
