"""Analysis of a case: its settings, and its run."""

from __future__ import annotations

import math
from typing import Any

from ...case.tables import analyses as tables
from ...case.tables.schema import Case
from ...errors import CaseError
from ...model.analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from ...results import Result
from ...timer import Phases
from ..analyses import run as analyses
from ..runtime.observer import Observer, Saved
from .model import model_of


def run(
    case: Case,
    comm=None,
    observer: Observer | None = None,
    phases: Phases | None = None,
    saved: Saved | None = None,
) -> Result:
    """Compute a case; see `simulation.analyses.run`. Every rank calls."""
    return analyses.run(model_of(case), analysis_of(case), comm, observer, phases, saved)


def analysis_of(case: Case) -> Analysis:
    """Settings of the analysis of a case."""
    given = case.analysis
    if isinstance(given, tables.Fretting):
        return _fretting(case, given)
    if isinstance(given, tables.Reciprocating):
        return _reciprocating(case, given)
    if isinstance(given, tables.Transient):
        adapts = case.wear.update == "auto"
        return TransientAnalysis(**_in_time(case, given), adapts=adapts)
    return StaticAnalysis(given.type)


def _stepped(case: Case, given: tables.Timed | tables.Fretting) -> dict[str, Any]:
    """Settings of all analyses that follow the wear."""
    return {
        "output_times": given.output_times,
        "tolerance": given.tolerance,
        "frames": given.frames,
        "checkpoint_every": given.checkpoint_every,
        "largest_kept": case.wear.largest_kept,
    }


def _in_time(case: Case, given: tables.Timed) -> dict[str, Any]:
    """Settings of analyses with adaptive time steps."""
    return _stepped(case, given) | {
        "end_time": math.inf if given.end_time is None else given.end_time,
        "until": given.until,
        "steady_tolerance": given.steady_tolerance,
        "max_steps": given.max_steps,
    }


def _reciprocating(case: Case, given: tables.Reciprocating) -> ReciprocatingAnalysis:
    motion, settings = case.motion, _in_time(case, given)
    if motion is None or motion.amplitude is None or motion.frequency is None:
        raise CaseError("motion: missing; a reciprocating analysis needs amplitude and frequency")
    if case.cycles is not None:
        settings["end_time"] = case.cycles / motion.frequency
    return ReciprocatingAnalysis(
        **settings,
        amplitude=motion.amplitude,
        frequency=motion.frequency,
        positions=given.positions,
        max_jump=case.wear.max_jump or math.inf,
    )


def _fretting(case: Case, given: tables.Fretting) -> FrettingAnalysis:
    return FrettingAnalysis(
        **_stepped(case, given),
        increments=given.increments,
        cycles=int(case.cycles or 1),
        jump=given.jump,
        max_jump=case.wear.max_jump or math.inf,
    )
