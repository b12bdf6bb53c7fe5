"""Runs of starter cases with a few keys changed."""

from __future__ import annotations

import tomllib

from .. import geometry  # noqa: F401  (makes the geometries known)
from ..case import load
from ..case.starters import starter_text
from ..case.tables.schema import Case
from ..results import Result
from .computed import computed


def starter(name: str, *overrides: str, without: tuple[str, ...] = ()) -> Case:
    """Starter case with changes.

    Parameters
    ----------
    name : str
    *overrides : str
        ``KEY=VALUE`` each.
    without : tuple of str
        Paths of tables and keys to leave out.
    """
    tables = tomllib.loads(starter_text(name))
    for path in without:
        *above, key = path.split(".")
        table = tables
        for part in above:
            table = table[part]
        del table[key]
    return load(tables, overrides)


def run_starter(name: str, *overrides: str, without: tuple[str, ...] = ()) -> Result:
    """Compute a starter case; parameters as in `starter`."""
    return computed(starter(name, *overrides, without=without))
