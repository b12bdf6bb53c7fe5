"""Accuracy to be expected of planned measurements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..case.studies.calibration import CalibrationTable
from ..errors import CaseError, ComputationError
from ..inference import (
    Identifiability,
    MeasurementDesign,
    central_jacobian,
    expected_accuracy,
    identify,
)
from .candidate_run import Runner
from .measurement import Measurement
from .problem import Problem
from .settling import Suggestion, suggestions, undetermined


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
    noise : float
        Relative noise of the derivatives.
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
    noise: float

    def notes(self) -> list[str]:
        """Sentences on what the measurements would not determine."""
        return undetermined(self.identifiability, self.suggestions)


def expected(problem: Problem, runner: Runner) -> Planned:
    """Predict how well measurements would determine the parameters, before any is made.

    Raises
    ------
    CaseError
        If the measurements do not fit the case.
    ComputationError
        If a run fails.
    """
    model, space = problem.model(runner), problem.space
    predicted = model.predict(space.start)
    if not np.isfinite(predicted).all():
        raise ComputationError(f"calibrate: the run failed: {model.failure(space.start)}")
    deviations, labels = problem.weights
    deviations = np.where(np.isnan(deviations), problem.relative * np.abs(predicted), deviations)
    if (zero := deviations == 0.0).any():
        raise CaseError(
            f"calibrate.observations ({labels[int(np.argmax(zero))]}): the deviation is relative, "
            "but a predicted value is 0; give an absolute deviation"
        )
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
        noise,
    )
