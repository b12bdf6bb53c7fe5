"""Completed runs for comparison with references, and starter cases with a few keys changed."""

from __future__ import annotations

import tomllib

from .. import geometry  # noqa: F401  (makes the geometries known)
from ..case import load
from ..case.starters import starter_text
from ..case.tables.schema import Case
from ..results import Result
from ..simulation import run


def computed(case: Case) -> Result:
    """Compute a case to its end.

    Raises
    ------
    ComputationError
        If it stopped early, or its balances do not hold.
    KeyboardInterrupt
        If a stop was requested during the run.
    """
    result = run(case)
    if result.stopped is not None:
        raise result.stopped
    return result


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
