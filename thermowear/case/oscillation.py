"""What must hold between the tables of cases that oscillate: fretting, sliding to and fro."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from .analyses import Fretting, Reciprocating
from .history import History

if TYPE_CHECKING:
    from .driving import Motion
    from .schema import Case

Fault = tuple[str, str]


def fretting(case: Case) -> Iterator[Fault]:
    """A history of loads and a fretting analysis need each other."""
    analysis, history = case.analysis, case.load.history
    if not isinstance(analysis, Fretting):
        return
    if history is None:
        yield "load.history", "missing; a fretting analysis follows a history of loads"
    elif history.tangential and case.model == "axisymmetric":
        yield "load.history", "an axisymmetric body has no tangential motion"
    elif history.tangential and case.geometry.symmetry:
        yield "geometry.half", "tangential loads are not symmetric; mesh the whole section"
    else:
        yield from _cycles(analysis, history)
    if case.contact.method != "condensed":
        yield "contact.method", f"{case.contact.method!r} does not know sticking; use condensed"
    for table in ("heat", "motion"):
        if getattr(case, table) is not None:
            yield table, "is not for a fretting analysis"


def reciprocating(case: Case) -> Iterator[Fault]:
    """Sliding to and fro is along x, in a plane and cold."""
    analysis, motion = case.analysis, case.motion
    if not isinstance(analysis, Reciprocating):
        return
    plane = case.model in ("plane-strain", "plane-stress")
    if not plane or case.geometry.rotation_center or case.geometry.slides_across:
        yield "model", "a reciprocating analysis is for bodies that slide along x in a plane"
    elif case.geometry.symmetry:
        yield "geometry.half", "sliding to and fro is not symmetric; mesh the whole section"
    if case.heat is not None:
        yield "heat", "is not for a reciprocating analysis"
    if case.contact.method != "condensed":
        yield "contact.method", f"{case.contact.method!r} is not for it; use condensed"
    if "x" in case.holder.free:
        yield "holder.free", '"x" is not free: body 1 is driven along it'
    if analysis.until == "steady" and case.holder.free != ("z",):
        yield "analysis.until", "wear rates become uniform only under a holder that does not turn"
    if motion is not None:
        yield from _to_and_fro(analysis, motion)


def _cycles(analysis: Fretting, history: History) -> Iterator[Fault]:
    """Cycles need loads that come back; output times lie in the history, or in its repetitions."""
    end = history.time[-1]
    if history.cycle is not None:
        end += (analysis.cycles - 1) * (end - history.cycle[0])
    elif analysis.cycles > 1:
        yield "analysis.cycles", "no instant of load.history has the loads of its last one"
    late = [t for t in analysis.output_times if not history.time[0] <= t <= end]
    if late:
        where = "load.history.time" if analysis.cycles == 1 else "the cycles"
        yield "analysis.output_times", f"{late[0]:g} s lies outside {where}"


def _to_and_fro(analysis: Reciprocating, motion: Motion) -> Iterator[Fault]:
    """Amplitude and frequency, and nothing else; output times before the last cycle ends."""
    for key in ("amplitude", "frequency"):
        if getattr(motion, key) is None:
            yield f"motion.{key}", "missing; a reciprocating analysis needs it"
    for key in ("velocity", "angular_velocity"):
        if getattr(motion, key) is not None:
            yield f"motion.{key}", "does not fit; a reciprocating body has amplitude and frequency"
    if analysis.cycles is not None and motion.frequency is not None:
        late = [t for t in analysis.output_times if t > analysis.cycles / motion.frequency]
        if late:
            yield "analysis.output_times", f"{late[0]:g} s lies after the last cycle"
