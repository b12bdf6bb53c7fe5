"""Consistency checks of time histories."""

from __future__ import annotations

from collections.abc import Iterator

from ..tables.analyses import Fretting, Transient
from ..tables.history import History
from ..tables.schema import Case
from .faults import Fault

_CONSTANT = ("moment", "moments", "tangential_force", "surfaces")
"""Loads that no history changes."""


def courses(case: Case) -> Iterator[Fault]:
    """Load histories need a transient or fretting analysis, all others a transient one."""
    analysis, load, histories = case.analysis, case.load.history, case.histories
    if load is not None:
        if isinstance(analysis, Transient):
            yield from _force_history(case, load)
        elif isinstance(analysis, Fretting):
            yield from _fretting_history(load)
        else:
            yield (
                "load.history",
                f"requires a transient or fretting analysis, not {analysis.type}",
            )
    if not isinstance(analysis, Transient):
        refused = histories.keys() - {"load.history"}
        if isinstance(analysis, Fretting):  # its tables motion and heat are reported elsewhere
            refused &= {"contact.friction_history"}
        for key in sorted(refused):
            yield key, f"requires a transient analysis, not {analysis.type}"
    elif analysis.until is not None and histories:
        which = next(iter(histories))
        yield "analysis.until", f"there is no steady state under {which}; give end_time only"
    if case.contact.friction_history is not None:
        if case.contact.nominal_friction == 0.0:
            yield "contact.friction_history", "has no effect: contact.friction is 0"
        elif case.motion is None and isinstance(analysis, Transient):
            yield (
                "contact.friction_history",
                "has no effect: without [motion] the bodies do not slide",
            )


def _force_history(case: Case, history: History) -> Iterator[Fault]:
    """Only the force may vary in a transient analysis, without other normal loads."""
    others = ("approach", "tangential_force", "tangential_displacement")
    refused = [key for key in others if getattr(history, key) is not None]
    for key in refused:
        yield (
            f"load.history.{key}",
            "requires a fretting analysis; a transient one supports force only",
        )
    if history.force is None and not refused:
        yield "load.history.force", "missing; required in a transient analysis"
    if history.cycle_start is not None:
        yield (
            "load.history.cycle_start",
            "requires a fretting analysis; use repeat = true in a transient one",
        )
    constant = [key for key in _CONSTANT if getattr(case.load, key)]
    for key in constant:
        yield f"load.{key}", "cannot be combined with load.history, which varies the force only"
    if not case.holder.free and not constant:
        yield "load.history", "has no effect: the holder is fixed (holder.free = [])"


def _fretting_history(history: History) -> Iterator[Fault]:
    """Cycles belong to the analysis table; the normal force must remain positive."""
    if history.repeat:
        yield (
            "load.history.repeat",
            "requires a transient analysis; use analysis.cycles in a fretting analysis",
        )
    for i, force in enumerate(history.force or ()):
        if force == 0.0:
            yield f"load.history.force.{i}", "must be greater than 0 N in a fretting analysis"
