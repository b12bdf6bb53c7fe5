"""Running a starter case with a few keys changed."""

from __future__ import annotations

import tomllib

from .. import geometry  # noqa: F401  (makes the geometries known)
from ..case import load
from ..case.starters import starter_text
from ..simulation import Result, run


def run_starter(name: str, *overrides: str, without: tuple[str, ...] = ()) -> Result:
    """Compute a starter case.

    Parameters
    ----------
    name : str
    *overrides : str
        ``KEY=VALUE`` each.
    without : tuple of str
        Tables to leave out.
    """
    tables = tomllib.loads(starter_text(name))
    for table in without:
        del tables[table]
    return run(load(tables, overrides))
