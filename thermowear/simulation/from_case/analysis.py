"""Analysis of a case: its settings, and its run."""

from __future__ import annotations

import math

from ...case import AnyCase
from ...case.assembly.schema import AssemblyCase
from ...case.tables import analyses as tables
from ...errors import CaseError
from ...model.analyses import (
    Analysis,
    FrettingAnalysis,
    ReciprocatingAnalysis,
    StabilityAnalysis,
    StaticAnalysis,
    TransientAnalysis,
)
from ...model.model import Model
from .assembly import assembly_of
from .model import attributes, pair_of


def model_of(case: AnyCase) -> Model:
    """Model of a validated case."""
    return assembly_of(case) if isinstance(case, AssemblyCase) else pair_of(case)


def analysis_of(case: AnyCase) -> Analysis:
    """Settings of the analysis of a case."""
    given, kept = case.analysis, {"largest_kept": case.wear.largest_kept}
    longest = case.wear.max_jump or math.inf
    if isinstance(given, tables.Transient):
        found = attributes(TransientAnalysis, given) | kept
        return TransientAnalysis(**found, adapts=case.wear.update == "auto")
    if isinstance(given, tables.Fretting):
        found = attributes(FrettingAnalysis, given) | kept | {"cycles": int(case.cycles or 1)}
        return FrettingAnalysis(**found, max_jump=longest)
    if isinstance(given, tables.Stability):
        mirror = case.geometry.mirror if given.mirrors is None else given.mirrors
        return StabilityAnalysis(
            hot_spots=given.hot_spots, wave_lengths=given.wave_lengths, mirror=mirror
        )
    if not isinstance(given, tables.Reciprocating):
        return StaticAnalysis(given.type)
    motion = case.reciprocation
    if motion is None:
        raise CaseError("motion: missing; a reciprocating analysis needs amplitude and frequency")
    amplitude, frequency = motion
    found = attributes(ReciprocatingAnalysis, given) | kept
    found |= {"amplitude": amplitude, "frequency": frequency}
    if case.cycles is not None:
        found["end_time"] = case.cycles / frequency
    return ReciprocatingAnalysis(**found, max_jump=longest)
