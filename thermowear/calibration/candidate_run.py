"""Runs of experiments with values of the parameters, and the predictions by them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Protocol

import numpy as np

from ..errors import CaseError, ComputationError, UnwritableError
from ..model.analyses import TimedAnalysis, TransientAnalysis
from .experiments import Experiment
from .readings import summary_numbers


@dataclass(frozen=True)
class CandidateRun:
    """Run of an experiment with values of the parameters.

    Attributes
    ----------
    number : int
    experiment : Experiment
    overrides : tuple of str
        Changes of the case, ``KEY=VALUE``.
    steps : tuple of float
        Ends of the time steps [s]; empty for error control.
    """

    number: int
    experiment: Experiment
    overrides: tuple[str, ...]
    steps: tuple[float, ...] = ()

    def failed(self, reason: str) -> Prediction:
        """Prediction without values, as the run failed."""
        return Prediction(self.number, np.full(self.experiment.count, np.nan), failure=reason)


@dataclass(frozen=True)
class Prediction:
    """Predictions of a run.

    Attributes
    ----------
    number : int
    values : ndarray, shape (n,)
        Predicted values of the measurements [SI]; NaN if the run failed.
    steps : tuple of float
        Ends of the time steps [s].
    distances : ndarray, shape (n_steps,)
        Sliding distances at the start and at these times [m].
    numbers : dict of str to float
        Numbers of the summary.
    failure : str
        Reason why there are none.
    """

    number: int
    values: np.ndarray
    steps: tuple[float, ...] = ()
    distances: np.ndarray = field(default_factory=lambda: np.zeros(0))
    numbers: dict[str, float] = field(default_factory=dict)
    failure: str = ""


def predict(series, run: CandidateRun) -> Prediction:
    """Compute a run in a series (`simulation.analyses.run.Series`) of runs.

    Values that the case does not allow are those of a failed run: the search goes elsewhere.
    """
    from ..simulation.from_case import analysis_of, model_of, with_accurate_mesh

    experiment = run.experiment
    try:
        case = experiment.case(run.overrides)
    except CaseError as error:
        return run.failed(error.faults[0])
    try:
        case = with_accurate_mesh(case, series.comm)
        analysis = analysis_of(case)
        if isinstance(analysis, TimedAnalysis):
            if experiment.ends_with_times():
                analysis = replace(analysis, end_time=max(experiment.times), until=None)
            analysis = replace(analysis, hits=experiment.times, steps=run.steps)
        if isinstance(analysis, TransientAnalysis):
            analysis = replace(analysis, compares=experiment.compares_with_steady())
        result = series.run(model_of(case), analysis)
        if result.stopped is not None:
            raise result.stopped
        values = [one.reading.of(result) for one in experiment.measurements]
    except ComputationError as error:
        return run.failed(str(error))
    except OSError as error:
        raise UnwritableError.during_run(error) from None
    rows = result.history if isinstance(analysis, TimedAnalysis) else []
    return Prediction(
        run.number,
        np.concatenate(values),
        tuple(row.time for row in rows[1:]),
        np.array([row.sliding_distance for row in rows]),
        summary_numbers(result.summary),
    )


class Runner(Protocol):
    """Computation of runs, in this process or distributed to others."""

    def __call__(self, groups: Sequence[Sequence[CandidateRun]], /) -> list[Prediction]:
        """Predictions in any order; runs of one group share set-up results."""
        ...


class InProcess:
    """Runner in this process.

    Parameters
    ----------
    series : simulation.analyses.run.Series
    """

    def __init__(self, series):
        self._series = series

    def __call__(self, groups: Sequence[Sequence[CandidateRun]]) -> list[Prediction]:
        """Compute runs one after the other."""
        return [predict(self._series, run) for run in chain.from_iterable(groups)]
