"""Thermal causes that end a running-in: thermal runaway, and jumps of steady temperatures."""

from __future__ import annotations

from collections.abc import Sequence

from ...errors import ComputationError, StandstillError
from ...results import HistoryRow

_STEEPER = 3.0  # heating rate over mean rate so far; linear rise of load and speed gives 2.5
_UNSTABLE = (
    "thermal runaway: friction heat distorts the bodies, which concentrates pressure and heat "
    "(thermoelastic instability); reduce the speed or the friction"
)
_JUMPS = (
    "with steady temperatures, states may jump beyond the critical speed, which a stability "
    "analysis computes: reduce the speed, or compute temperatures in time (heat.transient = true)"
)


def cause_of(
    reason: ComputationError, heating: Sequence[HistoryRow], steady_heat: bool
) -> str | None:
    """Thermal cause of an error that ends a running-in; None if it is not known to have one.

    Parameters
    ----------
    reason : ComputationError
    heating : sequence of HistoryRow
        History with temperatures in time; empty without them.
    steady_heat : bool
        True if the temperatures are the steady ones of each moment.
    """
    if len(heating) > 2 and _runs_away(heating):
        return _UNSTABLE
    return _JUMPS if steady_heat and isinstance(reason, StandstillError) else None


def _runs_away(rows: Sequence[HistoryRow]) -> bool:
    """True if the faces heat up much faster than before."""
    first, before, last = rows[0], rows[-2], rows[-1]
    so_far = (before.max_temperature - first.max_temperature) / before.time
    now = (last.max_temperature - before.max_temperature) / last.step
    return now > _STEEPER * so_far > 0.0
