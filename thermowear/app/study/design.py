"""Variants of a study: swings of one input at a time, and a sample or Saltelli's design."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ... import load
from ...case import AnyCase
from ...case.studies.study import StudyTable
from ...errors import CaseError, CaseNote
from ...inference import latin_hypercube, saltelli, sobol_sequence, swing_points
from ...inference.sensitivity import columns_of
from ...output.variants.folder import numbers_of
from ..batch.computing import Stopped
from ..batch.reporting import status_of
from ..batch.variants import grouped
from .bands import Curves, curves_of
from .inputs import InputColumn, StudyInput

SWING = 0.9
"""Probability between the low and the high value of a swing."""
CURVES = "sample"


@dataclass(frozen=True)
class StudyDesign:
    """Values of the inputs in all variants.

    Attributes
    ----------
    inputs : tuple of StudyInput
    values : ndarray, shape (n, p)
        Values in the given units.
    parts : tuple of str
        Part of the design that each variant belongs to, shape (n,).
    base : int
        Number of rows of Saltelli's design; 0 without Sobol indices.
    notes : tuple of str
    """

    inputs: tuple[StudyInput, ...]
    values: np.ndarray
    parts: tuple[str, ...]
    base: int = 0
    notes: tuple[str, ...] = ()

    @property
    def columns(self) -> tuple[InputColumn, ...]:
        """Columns of all inputs."""
        return tuple(column for one in self.inputs for column in one.columns)

    @property
    def swings(self) -> slice:
        """Variants with one input at a time at its low or high value, after that of all medians."""
        return slice(0, 1 + 2 * len(self.columns))

    @property
    def swing_values(self) -> tuple[list[float], list[float]]:
        """Low and high values of the columns in the swings, in SI."""
        width = len(self.columns)
        low, high = np.split(self.si[1 : self.swings.stop], [width])
        return [float(v) for v in low.diagonal()], [float(v) for v in high.diagonal()]

    @property
    def sample(self) -> np.ndarray:
        """Indices of the variants that are an independent sample of all inputs."""
        return np.flatnonzero([part in (CURVES, "A", "B") for part in self.parts])

    @property
    def si(self) -> np.ndarray:
        """Values in SI, shape (n, p)."""
        found = [c.in_si(v) for c, v in zip(self.columns, self.values.T, strict=True)]
        return np.stack(found, axis=1)

    def overrides(self, k: int) -> tuple[str, ...]:
        """Changes ``KEY=VALUE`` of the case in a variant, by its index."""
        own = columns_of([one.distribution for one in self.inputs])
        changes = (
            one.overrides([float(v) for v in self.values[k, columns]])
            for one, columns in zip(self.inputs, own, strict=True)
        )
        return tuple(change for each in changes for change in each)

    def split(self, outputs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Outputs (n, k) of all variants as those of A, B and AB of Saltelli's design."""
        parts = outputs[self.swings.stop :].reshape(len(self.inputs) + 2, self.base, -1)
        return parts[0], parts[1], parts[2:]


def study_design(inputs: Sequence[StudyInput], table: StudyTable) -> StudyDesign:
    """Design of a study with the settings of its table."""
    distributions = [one.distribution for one in inputs]
    swings = swing_points(distributions, SWING)
    width = swings.shape[1]
    names = [column.name for one in inputs for column in one.columns]
    parts = ["medians", *(f"low {name}" for name in names), *(f"high {name}" for name in names)]
    notes: list[str] = []
    base = 0
    if table.indices:
        design = saltelli(distributions, table.samples, table.seed)
        points, base = design.points, len(design.a)
        if base != table.samples:
            notes.append(f"{table.samples} base samples rounded up to {base}, a power of two")
        words = ["A", "B", *(f"AB {one.label}" for one in inputs)]
        parts += [word for word in words for _ in range(base)]
    else:
        make = sobol_sequence if table.method == "sobol" else latin_hypercube
        sample = make(distributions, table.samples, table.seed)
        points = sample.values
        notes += [sample.note] if sample.note else []
        parts += [CURVES] * len(points)
    values, moved = _within_limits(inputs, np.concatenate([swings, points]))
    if moved:
        notes.append(
            f"{moved} of {len(values)} samples were beyond the bounds of a calibrated "
            "parameter, and were moved to them"
        )
    assert values.shape == (len(parts), width)
    return StudyDesign(tuple(inputs), values, tuple(parts), base, tuple(notes))


def _within_limits(inputs: Sequence[StudyInput], values: np.ndarray) -> tuple[np.ndarray, int]:
    """Values moved to the limits of their inputs, and the number of rows that were moved."""
    limits = [
        np.tile([[-np.inf], [np.inf]], len(one.columns)) if one.limits is None else one.limits
        for one in inputs
    ]
    moved = np.clip(values, *np.concatenate(limits, axis=1))
    return moved, int(np.any(moved != values, axis=1).sum())


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
