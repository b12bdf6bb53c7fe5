"""Calibration of the parameters of a case by measured data."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...case import AnyCase, load
from ...case.studies.calibration import CalibrationTable
from ...errors import CaseError, ComputationError
from ...inference import (
    Fit,
    Identifiability,
    JointNormal,
    MeasurementDesign,
    Normal,
    Observations,
    Parameter,
    ParameterSpace,
    Posterior,
    central_jacobian,
    expected_accuracy,
    fit,
    identify,
    sample_posterior,
)
from ...inference.jacobian import NOISE
from .experiments import experiments
from .forward import CaseModel
from .measurements import Measurement, read_measurements
from .settling import Suggestion, suggestions

_UNLIKELY = 1e-3
"""Probability of residuals from which on they are reported as too large."""
_ROUGH_NOISE = 0.05
"""Noise of derivatives, relative to the largest, of runs with time steps of their own."""


@dataclass(frozen=True)
class Calibration:
    """Parameters of a case as data determine them.

    Attributes
    ----------
    table : CalibrationTable
    measurements : tuple of Measurement
    fit : Fit
    identifiability : Identifiability
    suggestions : tuple of Suggestion
        Measurements that would determine what these do not.
    posterior : Posterior or None
    runs : int
        Number of runs of the case.
    seconds : float
        Wall time.
    """

    table: CalibrationTable
    measurements: tuple[Measurement, ...]
    fit: Fit
    identifiability: Identifiability
    suggestions: tuple[Suggestion, ...]
    posterior: Posterior | None
    runs: int
    seconds: float

    @property
    def normal(self) -> JointNormal:
        """Distribution of the parameters, by the given deviations or by the scatter."""
        estimated = self.table.deviations == "estimated"
        return self.fit.scattered if estimated else self.fit.uncertainty

    @property
    def values(self) -> dict[str, float]:
        """Values of the parameters by name, in the units of their start."""
        return dict(zip(self.table.parameters, map(float, self.fit.values), strict=True))

    def intervals(self, level: float | None = None) -> dict[str, tuple[float, float]]:
        """Confidence intervals by name; infinite for parameters that are not determined."""
        found = self.normal.intervals(level or self.table.confidence)
        pairs = ((float(low), float(high)) for low, high in found)
        return dict(zip(self.table.parameters, pairs, strict=True))

    @property
    def standard_errors(self) -> dict[str, float]:
        """Standard errors by name, relative ones of logarithmic parameters."""
        errors = map(float, self.normal.standard_errors)
        return dict(zip(self.table.parameters, errors, strict=True))

    @property
    def overrides(self) -> tuple[str, ...]:
        """Changes ``KEY=VALUE`` that give the case the calibrated values."""
        return self.table.overrides(self.values)

    def notes(self) -> list[str]:
        """Sentences on what the data do not determine, and on a fit that is not good."""
        found = [] if self.fit.converged else [f"the fit has {self.fit.message}"]
        found += [f"{name} ended at a bound" for name in self.fit.at_bounds]
        found += _undetermined(self.identifiability, self.suggestions)
        p_value = self.fit.p_value
        if self.table.deviations == "known" and p_value < _UNLIKELY:
            found.append(
                f"the residuals are larger than the deviations explain (reduced chi² "
                f"{self.fit.reduced_chi2:.3g}, p = {p_value:.1g}): the model or the deviations "
                'are not right; deviations = "estimated" takes them from the scatter'
            )
        if self.posterior is not None and self.posterior.warning:
            found.append(self.posterior.warning)
        return found


@dataclass(frozen=True)
class Planned:
    """Accuracy of the parameters to be expected of planned measurements.

    Attributes
    ----------
    table : CalibrationTable
    measurements : tuple of Measurement
    values : ndarray, shape (p,)
        Values of the parameters that are assumed, the first ones.
    predicted, deviations : ndarray, shape (n,)
        Predictions and standard deviations of the measurements [SI].
    jacobian : ndarray, shape (n, p)
        Derivatives of the predictions in internal coordinates.
    design : MeasurementDesign
    identifiability : Identifiability
    suggestions : tuple of Suggestion
    """

    table: CalibrationTable
    measurements: tuple[Measurement, ...]
    values: np.ndarray
    predicted: np.ndarray
    deviations: np.ndarray
    jacobian: np.ndarray
    design: MeasurementDesign
    identifiability: Identifiability
    suggestions: tuple[Suggestion, ...]

    def notes(self) -> list[str]:
        """Sentences on what the measurements would not determine."""
        return _undetermined(self.identifiability, self.suggestions)


def _undetermined(found: Identifiability, further: tuple[Suggestion, ...]) -> list[str]:
    """Sentences on parameters that are not determined, and on what would determine them."""
    if found.identified:
        return []
    names = ", ".join(found.undetermined)
    known = "; ".join(one.text for one in found.combinations)
    only = f"but {known} only" if known else "nor any combination of them"
    text = f"the data do not determine {names} one by one, {only}"
    return [text, *(f"this would settle it: {one.text}" for one in further)]


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
    began, problem = time.perf_counter(), _Problem.of(case, data)
    model = problem.model(executor, workers)
    observations = Observations(
        np.concatenate([one.values for one in problem.measurements]), *problem.weights
    )
    start = problem.space.start
    if reason := (model.failure(start) if not np.isfinite(model.predict(start)).all() else ""):
        raise ComputationError(f"calibrate: the run with the first values failed: {reason}")
    table = problem.table
    search = table.tolerance, table.max_evaluations, problem.noise(model)
    found = fit(problem.space, observations, model, *search)
    identified = identify(problem.space, found.jacobian, found.noise)
    further = suggestions(problem.space, model, found.values, identified)
    posterior = None
    if table.posterior is not None:
        chosen, best = table.posterior, found.values
        posterior = sample_posterior(
            found,
            lambda points: model.neighbours(best, points),
            chosen.steps,
            chosen.walkers or 0,
            chosen.seed,
        )
    seconds = time.perf_counter() - began
    return Calibration(
        table,
        tuple(problem.measurements),
        found,
        identified,
        further,
        posterior,
        model.runs,
        seconds,
    )


def plan(
    case: AnyCase | str | Path,
    data: Mapping[str, str | Path] | str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
) -> Planned:
    """Predict how well measurements would determine the parameters, before any is made.

    The files need the times or places and the deviations only. Parameters as of `calibrate`.
    """
    problem = _Problem.of(case, data, planned=True)
    model, space = problem.model(executor, workers), problem.space
    predicted = model.predict(space.start)
    if not np.isfinite(predicted).all():
        raise ComputationError(f"calibrate: the run failed: {model.failure(space.start)}")
    deviations, labels = problem.weights
    deviations = np.where(np.isnan(deviations), problem.relative * np.abs(predicted), deviations)
    internal = space.internal(space.start)
    jacobian = central_jacobian(space, model, internal, predicted)
    noise = problem.noise(model)
    identified = identify(space, jacobian / deviations[:, None], noise)
    return Planned(
        problem.table,
        tuple(problem.measurements),
        space.start,
        predicted,
        deviations,
        jacobian,
        expected_accuracy(space, internal, jacobian, deviations, labels, noise),
        identified,
        suggestions(space, model, space.start, identified),
    )


@dataclass(frozen=True)
class _Problem:
    """Case, parameters and measurements of a calibration."""

    case: AnyCase
    table: CalibrationTable
    space: ParameterSpace
    measurements: list[Measurement]

    @classmethod
    def of(cls, case, data, planned: bool = False) -> _Problem:
        """Read the case and the data."""
        case = case if isinstance(case, AnyCase) else load(case)
        if case.calibrate is None:
            raise CaseError("calibrate: missing; the table names parameters and observations")
        measurements = read_measurements(case, _files(case, data), planned)
        return cls(case, case.calibrate, _space(case.calibrate), measurements)

    def model(self, executor: Executor | None, workers: int | None) -> CaseModel:
        """Forward model."""
        count = workers or len(os.sched_getaffinity(0))
        made = experiments(self.case, self.measurements)
        return CaseModel(self.table, made, executor, count)

    def noise(self, model: CaseModel) -> float:
        """Relative noise of the derivatives."""
        return NOISE if model.smooth else _ROUGH_NOISE

    @property
    def weights(self) -> tuple[np.ndarray, tuple[str, ...]]:
        """Deviations and labels of all values."""
        labels = tuple(one.label for one in self.measurements for _ in one.values)
        return np.concatenate([one.deviations for one in self.measurements]), labels

    @property
    def relative(self) -> np.ndarray:
        """Relative deviations of all planned values."""
        each = [np.full(len(one.values), one.relative) for one in self.measurements]
        return np.concatenate(each)


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


def _space(table: CalibrationTable) -> ParameterSpace:
    """Parameters in the units of their first values."""
    found = []
    for name, own in table.parameters.items():
        prior = None
        if own.prior is not None:
            mean = own.prior.value.in_unit_of(own.start)
            deviation = own.prior.deviation.of(replace(own.start, number=mean))
            prior = Normal(mean, deviation)
            if own.scale == "log":
                prior = Normal(float(np.log(mean)), deviation / mean)
        low, high = (bound.in_unit_of(own.start) for bound in (own.lower, own.upper))
        log = own.scale == "log"
        found.append(Parameter(own.key or name, own.start.number, low, high, log, prior, name))
    return ParameterSpace(tuple(found))
