"""Completed runs for comparison with references."""

from __future__ import annotations

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
