"""What must hold between the tables of cases that oscillate: fretting, sliding to and fro."""

from __future__ import annotations

from collections.abc import Iterator

from ..tables.analyses import Fretting, Reciprocating
from ..tables.driving import Motion
from ..tables.history import History
from ..tables.schema import Case

Fault = tuple[str, str]


def counted(case: Case) -> Iterator[Fault]:
    """Cycles are given once, and to analyses that have them; given jumps have no limit."""
    analysis, wear = case.analysis, case.wear
    for key in ("cycles", "max_jump"):
        if getattr(wear, key) is not None and not isinstance(analysis, Fretting | Reciprocating):
            yield f"wear.{key}", f"is for fretting and reciprocating analyses, not {analysis.type}"
    if wear.cycles is not None and getattr(analysis, "cycles", None) is not None:
        yield "wear.cycles", "only one of wear.cycles and analysis.cycles can be given"
    if isinstance(analysis, Fretting) and analysis.jump != "auto" and wear.max_jump is not None:
        yield "wear.max_jump", 'is for analysis.jump = "auto"'


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
        yield from _repeated(case, analysis, history)
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
        yield from _to_and_fro(case, analysis, motion)
    yield from _ends(case, analysis)


def _repeated(case: Case, analysis: Fretting, history: History) -> Iterator[Fault]:
    """Cycles need loads that come back; output times lie in the history, or in its repetitions."""
    end, count = history.time[-1], case.cycles or 1
    if history.cycle is not None:
        end += (count - 1) * (end - history.cycle[0])
    elif count > 1:
        yield _key(case), "no instant of load.history has the loads of its last one"
    late = [t for t in analysis.output_times if not history.time[0] <= t <= end]
    if late:
        where = "load.history.time" if count == 1 else "the cycles"
        limits = f"from {history.time[0]:g} s to {end:g} s"
        yield "analysis.output_times", f"{late[0]:g} s lies outside {where}, {limits}"


def _key(case: Case) -> str:
    """Where the number of cycles stands."""
    return "analysis.cycles" if case.wear.cycles is None else "wear.cycles"


def _ends(case: Case, analysis: Reciprocating) -> Iterator[Fault]:
    """A time, a number of cycles or the steady state ends it."""
    if case.cycles is None and analysis.end_time is None and analysis.until is None:
        yield "analysis.end_time", 'missing; needs end_time, cycles or until = "steady"'
    if case.wear.cycles is not None and analysis.end_time is not None:
        yield "wear.cycles", "only one of analysis.end_time and wear.cycles can be given"


def _to_and_fro(case: Case, analysis: Reciprocating, motion: Motion) -> Iterator[Fault]:
    """Amplitude and frequency, and nothing else; output times before the last cycle ends."""
    for key in ("amplitude", "frequency"):
        if getattr(motion, key) is None:
            yield f"motion.{key}", "missing; a reciprocating analysis needs it"
    for key in ("velocity", "angular_velocity"):
        if getattr(motion, key) is not None:
            yield f"motion.{key}", "does not fit; a reciprocating body has amplitude and frequency"
    count = case.cycles
    if count is not None and motion.frequency is not None:
        late = [t for t in analysis.output_times if t > count / motion.frequency]
        if late:
            end = count / motion.frequency
            yield "analysis.output_times", f"{late[0]:g} s lies after the last cycle, {end:g} s"
