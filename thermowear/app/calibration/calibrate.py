"""Calibration of a case by data files, and plans of measurements."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path

from ...calibration.candidate_run import CandidateRun, InProcess, Prediction, Runner, predict
from ...calibration.planning import Planned, expected
from ...calibration.problem import Problem
from ...calibration.solution import Calibration, solve
from ...case import AnyCase, load
from ...errors import CaseError
from ..batch.computing import Lost, compute, new_series
from .measurements import read_measurements


def calibrate(
    case: AnyCase | str | Path,
    data: Mapping[str, str | Path] | str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
) -> Calibration:
    """Find the parameters of a case that fit measured data best, and their uncertainty.

    Parameters
    ----------
    case : AnyCase, str or Path
        Case with the table ``calibrate``, or its file.
    data : mapping of str to path, or path, optional
        CSV files by the name of the observation; those of the case by default.
    executor : concurrent.futures.Executor, optional
        Executor for the runs; by default they are computed in this process.
    workers : int, optional
        Number of its workers, by default the number of cores of this machine.

    Raises
    ------
    CaseError
        If the case or the data do not fit.
    ComputationError
        If a run with the first values fails.
    """
    return solve(problem_of(case, data), runner(executor, workers))


def plan(
    case: AnyCase | str | Path,
    data: Mapping[str, str | Path] | str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
) -> Planned:
    """Predict how well measurements would determine the parameters, before any is made.

    The files need the times or places and the deviations only. Parameters as of `calibrate`.
    """
    return expected(problem_of(case, data, planned=True), runner(executor, workers))


def problem_of(
    case: AnyCase | str | Path,
    data: Mapping[str, str | Path] | str | Path | None = None,
    planned: bool = False,
) -> Problem:
    """Problem of a case and its data files, as of `calibrate`.

    Raises
    ------
    CaseError
    """
    case = case if isinstance(case, AnyCase) else load(case)
    if case.calibrate is None:
        raise CaseError("calibrate: missing; the table names parameters and observations")
    return Problem.of(case, read_measurements(case, _files(case, data), planned))


def runner(executor: Executor | None = None, workers: int | None = None) -> Runner:
    """Runner in this process, or on an executor."""
    if executor is None:
        return InProcess(new_series())
    return _Distributed(executor, workers or len(os.sched_getaffinity(0)))


class _Distributed:
    """Runner on an executor; a run whose process dies has failed."""

    def __init__(self, executor: Executor, workers: int):
        self._executor, self._workers = executor, workers

    def __call__(self, groups: Sequence[Sequence[CandidateRun]]) -> list[Prediction]:
        """Compute runs on all workers."""
        found: list[Prediction] = []

        def received(outcome: Prediction | Lost) -> None:
            if isinstance(outcome, Lost):
                found.append(outcome.task.failed(outcome.reason))
            else:
                found.append(outcome)

        compute(groups, predict, received, self._executor, self._workers)
        return found


def _files(case: AnyCase, data) -> dict[str, Path]:
    """Data files by the name of the observation."""
    if data is None:
        return {}
    if isinstance(data, Mapping):
        return {name: Path(path) for name, path in data.items()}
    assert case.calibrate is not None
    open_ = [name for name, own in case.calibrate.observations.items() if own.file is None]
    path = Path(data)
    if len(open_) > 1:
        raise CaseError(f"--data {path}: several observations have no file: write NAME={path}")
    return {open_[0] if open_ else path.stem: path}
