"""Record and tables of a calibration, as they are written."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

import numpy as np

from ...calibration.candidate_run import CandidateRun, Prediction, Runner, predict
from ...calibration.measurement import Measurement
from ...calibration.planning import Planned, expected
from ...calibration.problem import Problem
from ...calibration.solution import Calibration, solve
from ...case import AnyCase, load
from ...case.studies.calibration import CalibrationTable
from ...errors import CaseError
from ...inference import JointNormal, linear_band
from ...output.calibration import CalibrationFolder, StoredRun
from ..batch.computing import Lost, compute, new_series
from ..batch.reporting import checksum_of
from .measurements import read_measurements


def record_of(found: Calibration) -> dict[str, Any]:
    """Content of ``calibration.json``."""
    fit = found.fit
    quality = {
        "chi2": fit.chi2,
        "degrees_of_freedom": fit.degrees_of_freedom,
        "reduced_chi2": fit.reduced_chi2,
        "p_value": None if found.estimated else fit.p_value,
        "converged": fit.converged,
        "message": fit.message,
        "evaluations": fit.evaluations,
        "runs": found.runs,
        "seconds": round(found.seconds, 3),
    }
    combinations = [
        {"text": one.text, "value": float(one.value(fit.values)), "deviation": one.deviation}
        for one in found.identifiability.combinations
    ]
    posterior = {}
    if found.posterior is not None:
        intervals = found.posterior.intervals(found.table.confidence)
        posterior = {
            "posterior": {
                "steps": found.posterior.steps,
                "acceptance": found.posterior.acceptance,
                "autocorrelation_steps": found.posterior.autocorrelation.tolist(),
                "intervals": dict(zip(found.table.parameters, intervals.tolist(), strict=True)),
            }
        }
    return {
        **_parameters(found.table, found.normal, found.fit.values),
        "at_bounds": list(found.at_bounds),
        "identifiable": found.identifiability.identified,
        "singular_values": found.identifiability.singular_values.tolist(),
        "combinations": combinations,
        "suggestions": [one.text for one in found.suggestions],
        "notes": found.notes(),
        **quality,
        **posterior,
    }


def record_of_plan(found: Planned, values: np.ndarray) -> dict[str, Any]:
    """Content of ``calibration.json`` of planned measurements."""
    names, design = list(found.table.parameters), found.design
    alone, without = (
        {
            label: dict(zip(names, one.standard_errors.tolist(), strict=True))
            for label, one in each.items()
        }
        for each in (design.alone, design.without)
    )
    return {
        "planned": True,
        **_parameters(found.table, design.complete.normal, values),
        "identifiable": found.identifiability.identified,
        "combinations": [
            {"text": one.text, "deviation": one.deviation}
            for one in found.identifiability.combinations
        ],
        "suggestions": [one.text for one in found.suggestions],
        "notes": found.notes(),
        "standard_errors_alone": alone,
        "standard_errors_without": without,
    }


def _parameters(table: CalibrationTable, normal: JointNormal, values: np.ndarray) -> dict[str, Any]:
    intervals = normal.intervals(table.confidence)
    parameters = {}
    for k, (name, own) in enumerate(table.parameters.items()):
        parameters[name] = {
            "key": own.key,
            "unit": own.start.unit,
            "value": float(values[k]),
            "interval": intervals[k].tolist(),
            "standard_error": float(normal.standard_errors[k]),
            "scale": own.scale,
            "lower": float(normal.space.limits[0, k]),
            "upper": float(normal.space.limits[1, k]),
            "internal": float(normal.mean[k]),
            "internal_scale": float(normal.space.scale[k]),
        }
    return {
        "confidence": table.confidence,
        "parameters": parameters,
        "set": dict(table.set),
        "covariance": normal.covariance.tolist(),
        "correlation": normal.correlation.tolist(),
    }


def rows_of(
    measurements: tuple[Measurement, ...],
    predicted: np.ndarray,
    deviations: np.ndarray,
    jacobian: np.ndarray,
    normal: JointNormal,
    level: float,
    noise: float,
) -> list[dict[str, Any]]:
    """Rows of ``observations.csv``: measured and predicted values with their bands [SI].

    Parameters
    ----------
    jacobian : ndarray, shape (n, p)
        Derivatives of the predictions with respect to the internal coordinates.
    noise : float
        Relative noise of the derivatives.
    """
    band = linear_band(predicted, jacobian, normal, level, noise)
    along = dict.fromkeys(_header(name) for one in measurements for name in one.reading.at)
    rows, k = [], 0
    for one in measurements:
        at = {_header(name): values for name, values in one.reading.at.items()}
        for i, value in enumerate(one.values):
            rows.append(
                {
                    "observation": one.label,
                    "quantity": one.reading.quantity.header,
                    **{name: float(at[name][i]) if name in at else np.nan for name in along},
                    "observed": float(value),
                    "deviation": float(deviations[k]),
                    "predicted": float(predicted[k]),
                    "lower": float(band.lower[k]),
                    "upper": float(band.upper[k]),
                    "weighted_residual": float((value - predicted[k]) / deviations[k]),
                }
            )
            k += 1
    return rows


def _header(name: str) -> str:
    return {"time": "time_s", "cycle": "cycle"}.get(name, f"{name}_m")


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
