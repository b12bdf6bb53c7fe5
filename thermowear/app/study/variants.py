"""Validation and computation of the variants of a study."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from ... import load
from ...case import AnyCase
from ...errors import CaseError, CaseNote
from ...output.variants.numbers import numbers_of
from ..batch.computing import Stopped
from ..batch.reporting import status_of
from ..batch.variants import grouped
from .curves import Curves, curves_of
from .design import StudyDesign

_MOST_LINES = 10


@dataclass(frozen=True)
class StudyJob:
    """Variant of a study, to be computed by any process.

    Attributes
    ----------
    number : int
        Number of the variant, from 1.
    tables : dict
        Case as plain tables.
    overrides : tuple of str
        Its changes, ``KEY=VALUE``.
    room : int
        Largest number of values of its curves; 0 for none.
    """

    number: int
    tables: dict[str, Any]
    overrides: tuple[str, ...]
    room: int


@dataclass(frozen=True)
class StudyEnd:
    """Outcome of a variant: its status, the numbers of its summary, and its curves."""

    number: int
    status: str
    numbers: dict[str, float] = field(default_factory=dict)
    curves: Curves = field(default_factory=dict)
    seconds: float = 0.0


def compute_study_variant(series, job: StudyJob) -> StudyEnd:
    """Compute a variant; see `batch.computing.Work`."""
    from ...simulation.from_case import analysis_of, model_of

    began = time.perf_counter()
    numbers: dict[str, float] = {}
    curves: Curves = {}
    problem: BaseException | None = None
    try:
        with _without_notes():
            case = load(job.tables, job.overrides)
        result = series.run(model_of(case), analysis_of(case))
        problem = result.stopped
        if problem is None:
            numbers = numbers_of(result.summary)
            curves = curves_of(result, job.room) if job.room else {}
    except BaseException as error:
        problem = error
    seconds = time.perf_counter() - began
    ended = StudyEnd(job.number, status_of(problem), numbers, curves, seconds)
    if isinstance(problem, KeyboardInterrupt):
        raise Stopped(ended)
    return ended


def checked_groups(
    tables: dict[str, Any], design: StudyDesign, chosen: Sequence[int]
) -> list[list[int]]:
    """Groups of variants that share set-up results, after all were validated.

    Parameters
    ----------
    tables : dict
        Case as plain tables.
    design : StudyDesign
    chosen : sequence of int
        Indices of the variants.

    Raises
    ------
    CaseError
        One line per key with an invalid value in any variant.
    """
    faults: dict[str, list[tuple[int, str]]] = {}

    def cases() -> Iterator[AnyCase]:
        for k in chosen:
            try:
                with _without_notes():
                    case = load(tables, design.overrides(k))
            except CaseError as error:
                for line in error.faults:
                    faults.setdefault(line.partition(":")[0], []).append((k, line))
                continue
            if not faults:
                yield case

    groups = grouped(cases())
    if faults:
        lines = [_line(key, found, design) for key, found in faults.items()]
        raise CaseError(*lines[:_MOST_LINES], more=len(lines[_MOST_LINES:]))
    return [[chosen[k] for k in group] for group in groups]


def _line(key: str, found: list[tuple[int, str]], design: StudyDesign) -> str:
    """Message on the variants with an invalid value of a key."""
    first, line = found[0]
    count = f"{len(found)} of {len(design.values)} samples are invalid"
    for one in design.inputs:
        if key in (column.name for column in one.columns) and one.limits is None:
            return f"study.inputs.{key}: {count}; {line}; limit the distribution by lower and upper"
    return f"{count}, the first with {', '.join(design.overrides(first))}: {line}"


class _without_notes(warnings.catch_warnings):
    """Context without the notes on the case, which were given once for the case itself."""

    def __enter__(self):
        entered = super().__enter__()
        warnings.simplefilter("ignore", CaseNote)
        return entered
