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
    "with steady temperatures, states may jump beyond the critical speed, here at {:.3g} times it: "
    "reduce the speed, or compute temperatures in time (heat.transient = true)"
)
_REGULAR = (
    "this state is not critical, at {:.3g} times its critical speed: use a finer mesh at the "
    "contact, or another analysis.tolerance"
)
_NEAR = 1.02
"""Critical speed factor of the last state up to which the next one may be beyond it."""


def cause_of(
    reason: ComputationError, heating: Sequence[HistoryRow], critical: float | None
) -> str | None:
    """Thermal cause of an error that ends a running-in; None if it is not known to have one.

    Parameters
    ----------
    reason : ComputationError
    heating : sequence of HistoryRow
        History with temperatures in time; empty without them.
    critical : float or None
        Critical speed factor of the last state in steady temperatures; None if not known.
    """
    if len(heating) > 2 and _runs_away(heating):
        return _UNSTABLE
    if critical is None or not isinstance(reason, StandstillError):
        return None
    return (_JUMPS if critical < _NEAR else _REGULAR).format(1 / critical)


def _runs_away(rows: Sequence[HistoryRow]) -> bool:
    """True if the faces heat up much faster than before."""
    first, before, last = rows[0], rows[-2], rows[-1]
    so_far = (before.max_temperature - first.max_temperature) / before.time
    now = (last.max_temperature - before.max_temperature) / last.step
    return now > _STEEPER * so_far > 0.0
