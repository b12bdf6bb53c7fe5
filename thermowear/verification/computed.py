"""Runs whose numbers are held against references: they have come to their end."""

from __future__ import annotations

from ..case.tables.schema import Case
from ..simulation import Result, run


def computed(case: Case) -> Result:
    """Compute a case to its end.

    Raises
    ------
    ComputationError
        If it stopped before, or its balances do not hold.
    KeyboardInterrupt
        If a request to stop was noted on the way.
    """
    result = run(case)
    if result.stopped is not None:
        raise result.stopped
    return result
