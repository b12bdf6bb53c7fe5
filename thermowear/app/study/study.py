"""Propagation of uncertain inputs of a case, and the sensitivity of its results."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ... import load
from ...case import AnyCase, as_plain
from ...case.studies.study import StudyTable
from ...errors import CaseError
from ...inference import (
    SampleQuantiles,
    SobolIndices,
    Swings,
    sample_quantiles,
    sobol_indices,
    swings,
)
from ...results.summary_keys import group_of
from ..batch.computing import Lost, compute
from .bands import Bands, Curves, bands
from .design import (
    StudyDesign,
    StudyEnd,
    StudyJob,
    checked_groups,
    compute_study_variant,
    study_design,
)
from .inputs import calibrated_input, inputs_of

_ROOM = 12_000_000
"""Largest number of values of all curves."""
_CONSTANT = 1e-9
"""Range of a number, relative to its size, up to which it does not vary."""
_TECHNICAL = ("seconds", "steps", "dofs_displacement", "dofs_temperature")


@dataclass(frozen=True)
class Study:
    """Results of a study.

    Attributes
    ----------
    design : StudyDesign
        Inputs and their values in all variants.
    status : dict of int to str
        ``done``, or a description of the failure, by the number of the variant.
    numbers : dict of str to ndarray, shape (n,)
        Numbers of the summary that vary, in all variants; NaN where a variant failed.
    quantiles : SampleQuantiles
        Mean, deviation and quantiles over the sample, a column for each of the numbers.
    indices : SobolIndices or None
        Shares of the inputs in the variance, a column for each of the numbers.
    swings : Swings
        Numbers with one input at a time at its 5 % and 95 % quantile.
    bands : Bands
        Quantiles of curves.
    """

    design: StudyDesign
    status: dict[int, str]
    numbers: dict[str, np.ndarray]
    quantiles: SampleQuantiles
    indices: SobolIndices | None
    swings: Swings
    bands: Bands

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the inputs; calibrated parameters are one input."""
        return tuple(one.label for one in self.design.inputs)

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the numbers that vary."""
        return tuple(self.numbers)

    @property
    def samples(self) -> dict[str, np.ndarray]:
        """Values of the inputs in the sample, in SI, by header."""
        chosen = self.design.si[self.design.sample]
        return {c.header: v for c, v in zip(self.design.columns, chosen.T, strict=True)}

    def sampled(self, output: str) -> np.ndarray:
        """Values of a number in the sample."""
        return self.numbers[output][self.design.sample]


def study(
    case: AnyCase | str | Path,
    executor: Executor | None = None,
    workers: int | None = None,
    calibration: str | Path | None = None,
) -> Study:
    """Compute the study of a case: quantiles of its results, and their sensitivity to the inputs.

    Parameters
    ----------
    case : AnyCase, str or Path
        Case with a table ``study``, or path of a case file.
    executor : concurrent.futures.Executor, optional
        As for `sweep`; by default the variants are computed in this process.
    workers : int, optional
        Number of workers of the executor; by default the number of cores of this machine.
    calibration : str or Path, optional
        Folder with a calibration, whose parameters are one further input.

    Raises
    ------
    CaseError
        If the case has no uncertain inputs, or any variant is invalid.
    KeyboardInterrupt
        If a stop was requested; no further variant is computed.
    """
    plan = StudyPlan.of(case if isinstance(case, AnyCase) else load(case), calibration)
    ends: dict[int, StudyEnd] = {}

    def received(end: StudyEnd) -> None:
        ends[end.number] = end

    every = range(len(plan.design.values))
    count = workers or len(os.sched_getaffinity(0))
    plan.compute(checked_groups(plan.tables, plan.design, every), received, executor, count)
    numbers = {k: end.numbers for k, end in ends.items()}
    status = {k: end.status for k, end in ends.items()}
    return evaluated(plan.design, status, numbers, {k: end.curves for k, end in ends.items()})


@dataclass(frozen=True)
class StudyPlan:
    """Case and design of a study.

    Attributes
    ----------
    tables : dict
        Case as plain tables, without those of studies.
    table : StudyTable
    design : StudyDesign
    """

    tables: dict[str, Any]
    table: StudyTable
    design: StudyDesign

    @classmethod
    def of(
        cls, case: AnyCase, calibration: str | Path | None = None, indices: bool = False
    ) -> StudyPlan:
        """Plan of the study of a case.

        Raises
        ------
        CaseError
        """
        table = case.study or StudyTable()
        plain = as_plain(_meshed(case))
        inputs = inputs_of(table.inputs, plain)
        if calibration is not None:
            inputs.append(calibrated_input(Path(calibration), plain))
        if not inputs:
            raise CaseError(
                "study.inputs: missing; needs a distribution of an input, such as study.inputs."
                '"contact.friction" = { distribution = "normal", mean = 0.25, deviation = 0.02 }, '
                "or --calibration DIR"
            )
        if indices and not table.indices:
            table = table.model_copy(update={"indices": True})
        if table.indices and len(inputs) < 2:
            raise CaseError("study.indices: Sobol indices need two inputs at least")
        design = study_design(inputs, table)
        keys = [change.partition("=")[0] for change in design.overrides(0)]
        twice = [key for key in keys if keys.count(key) > 1]
        if twice:
            raise CaseError(f"study.inputs.{twice[0]}: is a calibrated parameter or depends on one")
        kept = {key: own for key, own in plain.items() if key not in ("study", "calibrate")}
        return cls(kept, table, design)

    def job(self, k: int) -> StudyJob:
        """Variant by its index; curves are kept of those of the sample."""
        sample = self.design.sample
        room = _ROOM // len(sample) if k in set(sample.tolist()) else 0
        return StudyJob(k + 1, self.tables, self.design.overrides(k), room)

    def compute(
        self,
        groups: list[list[int]],
        received: Callable[[StudyEnd], None],
        executor: Executor | None,
        workers: int,
    ) -> None:
        """Compute groups of variants, and report them as they end."""

        def reported(outcome: StudyEnd | Lost) -> None:
            if isinstance(outcome, Lost):
                outcome = StudyEnd(outcome.task.number, f"failed: {outcome.reason}")
            received(outcome)

        jobs = [[self.job(k) for k in group] for group in groups]
        compute(jobs, compute_study_variant, reported, executor, workers)


def _meshed(case: AnyCase) -> AnyCase:
    """Case with the mesh of its accuracy, which all variants have in common."""
    if case.mesh.accuracy is None:
        return case
    from ..batch.computing import new_series

    comm = new_series(alone=True).comm
    from ...simulation.from_case import with_accurate_mesh

    return with_accurate_mesh(case, comm)


def evaluated(
    design: StudyDesign,
    status: Mapping[int, str],
    numbers: Mapping[int, Mapping[str, float]],
    curves: Mapping[int, Curves],
) -> Study:
    """Results of a study from its variants, those that are missing have failed."""
    every = _table(len(design.values), numbers)
    sample = design.sample
    varying = {name: v for name, v in every.items() if _varies(name, v[sample])}
    outputs = np.stack(list(varying.values()), axis=1) if varying else np.zeros((len(sample), 0))
    if not varying:
        outputs = np.zeros((len(design.values), 0))
    drawn = [curves[k] for k in sorted(curves) if curves[k]]
    indices = sobol_indices(*design.split(outputs)) if design.base and varying else None
    return Study(
        design,
        dict(sorted(status.items())),
        varying,
        sample_quantiles(outputs[sample], stratified=True),
        indices,
        swings(outputs[design.swings]),
        bands(drawn, stratified=len(drawn) == len(sample)),
    )


def _table(count: int, numbers: Mapping[int, Mapping[str, float]]) -> dict[str, np.ndarray]:
    """Numbers of all variants by name; NaN where there is none."""
    names = dict.fromkeys(name for own in numbers.values() for name in own)
    found = {name: np.full(count, np.nan) for name in names}
    for number, own in numbers.items():
        for name, value in own.items():
            found[name][number - 1] = value
    return found


def _varies(name: str, values: np.ndarray) -> bool:
    """Test whether a number of the results varies over the sample by more than rounding."""
    key = name.rpartition(".")[2]
    if key in _TECHNICAL or key.endswith("relative_error") or group_of(key) == "Discretisation":
        return False
    values = values[np.isfinite(values)]
    return len(values) > 1 and bool(np.ptp(values) > _CONSTANT * np.abs(values).max())
