"""Calibration of a case by data files, and plans of measurements."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path

import numpy as np

from ...calibration.candidate_run import CandidateRun, Prediction, Runner, predict
from ...calibration.planning import Planned, expected
from ...calibration.problem import Problem
from ...calibration.solution import Calibration, solve
from ...case import AnyCase, load
from ...errors import CaseError
from ...output.calibration import CalibrationFolder, StoredRun
from ..batch.computing import Lost, compute, new_series
from ..batch.reporting import checksum_of
from .measurements import read_measurements

_FAILED = "failed: "


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


def described_data(case: AnyCase) -> list[str]:
    """Content of the data files of a case, once they and its first values were checked.

    Observations whose files are named by the command are left out.

    Raises
    ------
    CaseError
    """
    table = case.calibrate
    assert table is not None
    named = {name: own for name, own in table.observations.items() if own.file is not None}
    if not named:
        return []
    known = case.model_copy(update={"calibrate": table.model_copy(update={"observations": named})})
    try:
        problem, planned = problem_of(known), ""
    except CaseError as error:
        try:
            problem, planned = problem_of(known, planned=True), " planned"
        except CaseError:
            raise error from None
    return [f"{sum(len(one.values) for one in problem.measurements)}{planned} observations"]


def runner(
    executor: Executor | None = None,
    workers: int | None = None,
    folder: CalibrationFolder | None = None,
) -> Runner:
    """Runner in this process, or on an executor, which keeps what it computes in a folder."""
    return _Runner(executor, workers or len(os.sched_getaffinity(0)), folder)


class _Runner:
    """Runner of batches; a run whose process dies has failed, one in the folder is not repeated."""

    def __init__(self, executor: Executor | None, workers: int, folder: CalibrationFolder | None):
        self._executor, self._workers, self._folder = executor, workers, folder
        self._series = new_series() if executor is None else None

    def __call__(self, groups: Sequence[Sequence[CandidateRun]]) -> list[Prediction]:
        """Compute runs on all workers, but for those that the folder has."""
        found: list[Prediction] = []
        left: list[list[CandidateRun]] = [[] for _ in groups]
        runs = {run.number: run for group in groups for run in group}
        for own, group in zip(left, groups, strict=True):
            for run in group:
                if (known := self._known(run)) is not None:
                    found.append(known)
                else:
                    own.append(run)

        def received(outcome: Prediction | Lost) -> None:
            if isinstance(outcome, Lost):
                prediction: Prediction = outcome.task.failed(outcome.reason)
            else:
                prediction = outcome
            if self._folder is not None:
                self._folder.add(_key(runs[prediction.number]), _stored(prediction))
            found.append(prediction)

        left = [group for group in left if group]
        compute(left, predict, received, self._executor, self._workers, self._series)
        return found

    def _known(self, run: CandidateRun) -> Prediction | None:
        """Prediction that the folder has."""
        stored = None if self._folder is None else self._folder.known(_key(run))
        if stored is None:
            return None
        if stored.status != "done":
            return run.failed(stored.status.removeprefix(_FAILED))
        if len(stored.values) != run.experiment.count:
            return None
        values, distances = np.array(stored.values), np.array(stored.distances)
        return Prediction(run.number, values, tuple(stored.steps), distances, stored.numbers)


def _key(run: CandidateRun) -> str:
    """Key of a run by all that it depends on."""
    experiment = run.experiment
    return checksum_of([experiment.tables, experiment.times, run.overrides, run.steps])


def _stored(found: Prediction) -> StoredRun:
    status = f"{_FAILED}{found.failure}" if found.failure else "done"
    values = [] if found.failure else list(map(float, found.values))
    distances = list(map(float, found.distances))
    return StoredRun(status, found.numbers, values, list(found.steps), distances)


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
