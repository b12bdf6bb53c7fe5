"""Consistency checks of the histories of a case of several bodies."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from ...laws.histories import TANGENTIAL
from ..assembly.schema import AssemblyCase
from ..assembly.tables import AssemblyHolderTable
from ..values.section import Fault
from .analyses import NOT_UNDER

_NOT_FORCE = ("approach", *chain.from_iterable(TANGENTIAL), "moment", "cycle_start")
_UNVARIED = ("moments", "tangential_force", "closing_moment")


def histories(case: AssemblyCase) -> Iterator[Fault]:
    """Histories are for transient analyses, beside cyclic ones, and have no steady state."""
    analysis = case.analysis
    if analysis.cyclic:
        return
    for path in case.histories if analysis.type != "transient" else ():
        yield path, f"requires a transient analysis, not {analysis.type}"
    if getattr(analysis, "until", None) is not None and case.histories:
        which = next(iter(case.histories))
        yield "analysis.until", NOT_UNDER.format(which)
    for name, holder in case.holders.items():
        yield from _of_holder(f"holders.{name}", holder)
    for path, contact in case.contact_tables.items():
        if contact.friction_history is not None and contact.nominal_friction == 0.0:
            yield f"{path}.friction_history", f"has no effect: {path}.friction is 0"


def _of_holder(path: str, holder: AssemblyHolderTable) -> Iterator[Fault]:
    """Only the force may vary in a transient analysis, without other loads of the holder."""
    history = holder.history
    if history is None:
        return
    refused = [key for key in _NOT_FORCE if getattr(history, key) is not None]
    for key in refused:
        text = "requires a fretting analysis; a transient one supports force only"
        yield f"{path}.history.{key}", text
    if history.force is None and not refused:
        yield f"{path}.history.force", "missing; required in a transient analysis"
    for key in ("force", "approach"):
        if getattr(holder, key) is not None:
            text = f"cannot be given together with {path}.history, which gives the force"
            yield f"{path}.{key}", text
    for key in _UNVARIED:
        if getattr(holder, key):
            text = f"cannot be combined with {path}.history, which varies the force only"
            yield f"{path}.{key}", text
