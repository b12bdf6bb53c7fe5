"""Consistency checks of fretting and reciprocating analyses."""

from __future__ import annotations

from collections.abc import Iterator

from ...laws.time_course import LoadHistory
from ..tables.analyses import Fretting, Reciprocating
from ..tables.driving import MotionTable
from ..tables.schema import Case
from .faults import Fault


def counted(case: Case) -> Iterator[Fault]:
    """Number of cycles is given once, where supported; `max_jump` limits automatic jumps only."""
    analysis, wear = case.analysis, case.wear
    for key in ("cycles", "max_jump"):
        if getattr(wear, key) is not None and not isinstance(analysis, Fretting | Reciprocating):
            yield (
                f"wear.{key}",
                f"requires a fretting or reciprocating analysis, not {analysis.type}",
            )
    if wear.cycles is not None and getattr(analysis, "cycles", None) is not None:
        yield "wear.cycles", "only one of wear.cycles and analysis.cycles can be given"
    if isinstance(analysis, Fretting) and analysis.jump != "auto" and wear.max_jump is not None:
        yield "wear.max_jump", 'requires analysis.jump = "auto"'


def fretting(case: Case) -> Iterator[Fault]:
    """Load history of a fretting analysis, and features that it does not support."""
    analysis = case.analysis
    if not isinstance(analysis, Fretting):
        return
    history = None if case.load.history is None else case.load.history.loads
    if history is None:
        yield "load.history", "missing; required in a fretting analysis"
    elif history.tangential and case.model == "axisymmetric":
        yield "load.history", "tangential loads are not supported in axisymmetric models"
    elif history.tangential and case.geometry.symmetry:
        yield "geometry.half", "tangential loads are not symmetric; mesh the whole section"
    else:
        yield from _load_cycles(case, analysis, history)
    if case.contact.method != "condensed":
        yield "contact.method", f"{case.contact.method!r} does not support sticking; use condensed"
    for table in ("heat", "motion"):
        if getattr(case, table) is not None:
            yield table, "is not supported in a fretting analysis"


def reciprocating(case: Case) -> Iterator[Fault]:
    """Reciprocating sliding is along x, in plane models, without heat."""
    analysis, motion = case.analysis, case.motion
    if not isinstance(analysis, Reciprocating):
        return
    plane = case.model in ("plane-strain", "plane-stress")
    if not plane or case.geometry.rotation_center or case.geometry.slides_across:
        yield "model", "a reciprocating analysis needs a plane model with sliding along x"
    elif case.geometry.symmetry:
        yield "geometry.half", "reciprocating sliding is not symmetric; mesh the whole section"
    if case.heat is not None:
        yield "heat", "is not supported in a reciprocating analysis"
    if case.contact.method != "condensed":
        yield (
            "contact.method",
            f"{case.contact.method!r} does not support a reciprocating analysis; use condensed",
        )
    if "x" in case.holder.free:
        yield "holder.free", '"x" is not allowed: the motion of body 1 along x is prescribed'
    if analysis.until == "steady" and case.holder.free != ("z",):
        yield (
            "analysis.until",
            'needs holder.free = ["z"]: otherwise wear rates do not become uniform',
        )
    if motion is not None:
        yield from _reciprocating_motion(case, analysis, motion)
    yield from _end_conditions(case, analysis)


def _load_cycles(case: Case, analysis: Fretting, history: LoadHistory) -> Iterator[Fault]:
    """Cycles need a closed load cycle; output times lie within the history and its repetitions."""
    end, count = history.time[-1], case.cycles or 1
    if history.cycle is not None:
        end += (count - 1) * (end - history.cycle[0])
    elif count > 1:
        yield (
            _cycles_key(case),
            "no earlier instant of load.history has the loads of its last one: no cycle to repeat",
        )
    late = [t for t in analysis.output_times if not history.time[0] <= t <= end]
    if late:
        where = "load.history.time" if count == 1 else "the cycles"
        limits = f"from {history.time[0]:g} s to {end:g} s"
        yield "analysis.output_times", f"{late[0]:g} s lies outside {where}, {limits}"


def _cycles_key(case: Case) -> str:
    """Path of the key that holds the number of cycles."""
    return "analysis.cycles" if case.wear.cycles is None else "wear.cycles"


def _end_conditions(case: Case, analysis: Reciprocating) -> Iterator[Fault]:
    """Reciprocating needs an end time, a number of cycles or ``until``."""
    if case.cycles is None and analysis.end_time is None and analysis.until is None:
        yield "analysis.end_time", 'missing; needs end_time, cycles or until = "steady"'
    if case.wear.cycles is not None and analysis.end_time is not None:
        yield "wear.cycles", "only one of analysis.end_time and wear.cycles can be given"


def _reciprocating_motion(
    case: Case, analysis: Reciprocating, motion: MotionTable
) -> Iterator[Fault]:
    """Amplitude and frequency only; output times before the end of the last cycle."""
    for key in ("amplitude", "frequency"):
        if getattr(motion, key) is None:
            yield f"motion.{key}", "missing; a reciprocating analysis needs it"
    for key in ("velocity", "angular_velocity"):
        if getattr(motion, key) is not None:
            yield (
                f"motion.{key}",
                "not supported; a reciprocating motion has amplitude and frequency",
            )
    count = case.cycles
    if count is not None and motion.frequency is not None:
        late = [t for t in analysis.output_times if t > count / motion.frequency]
        if late:
            end = count / motion.frequency
            yield "analysis.output_times", f"{late[0]:g} s lies after the last cycle, {end:g} s"
