"""What must hold between the tables of cases in which something changes in time."""

from __future__ import annotations

from collections.abc import Iterator

from ..tables.analyses import Fretting, Transient
from ..tables.history import History
from ..tables.schema import Case

Fault = tuple[str, str]

_CONSTANT = ("moment", "moments", "tangential_force", "surfaces")
"""Loads that no history changes."""


def courses(case: Case) -> Iterator[Fault]:
    """Loads change in a transient and in a fretting analysis, all else in a transient one."""
    analysis, load, histories = case.analysis, case.load.history, case.histories
    if load is not None:
        if isinstance(analysis, Transient):
            yield from _of_the_force(case, load)
        elif isinstance(analysis, Fretting):
            yield from _of_fretting(load)
        else:
            yield (
                "load.history",
                f"is for a transient or fretting analysis, not for {analysis.type}",
            )
    if not isinstance(analysis, Transient):
        refused = histories.keys() - {"load.history"}
        if isinstance(analysis, Fretting):  # which has neither motion nor heat at all
            refused &= {"contact.friction_history"}
        for key in sorted(refused):
            yield key, f"is for a transient analysis, not for {analysis.type}"
    elif analysis.until is not None and histories:
        which = next(iter(histories))
        yield "analysis.until", f"nothing is steady under {which}; give end_time alone"
    if case.contact.friction_history is not None:
        if case.contact.friction == 0.0:
            yield "contact.friction_history", "changes nothing: contact.friction is 0"
        elif case.motion is None and isinstance(analysis, Transient):
            yield "contact.friction_history", "changes nothing: without [motion] nothing slides"


def _of_the_force(case: Case, history: History) -> Iterator[Fault]:
    """In a transient analysis the force changes, and nothing else presses."""
    others = ("approach", "tangential_force", "tangential_displacement")
    refused = [key for key in others if getattr(history, key) is not None]
    for key in refused:
        yield f"load.history.{key}", "is for a fretting analysis; a transient one has force alone"
    if history.force is None and not refused:
        yield "load.history.force", "missing; a transient analysis follows the force"
    if history.cycle_start is not None:
        yield (
            "load.history.cycle_start",
            "is for a fretting analysis; a transient one has repeat = true",
        )
    constant = [key for key in _CONSTANT if getattr(case.load, key)]
    for key in constant:
        yield f"load.{key}", "does not change with load.history, which is of the force alone"
    if not case.holder.free and not constant:
        yield "load.history", "presses nothing: the holder is fixed (holder.free = [])"


def _of_fretting(history: History) -> Iterator[Fault]:
    """Cycles are counted by the analysis; what sticks must be pressed."""
    if history.repeat:
        yield "load.history.repeat", "is for a transient analysis; fretting has analysis.cycles"
    for i, force in enumerate(history.force or ()):
        if force == 0.0:
            yield f"load.history.force.{i}", "must be greater than 0 N in a fretting analysis"
