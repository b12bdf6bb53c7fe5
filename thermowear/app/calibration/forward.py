"""Predictions of the measurements by runs of a case."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace

import numpy as np

from ...case.studies.calibration import CalibrationTable
from ...errors import CaseError, ComputationError
from ...model.analyses import TransientAnalysis
from ..batch.computing import Lost, compute, new_series
from .experiments import Experiment, other_conditions, overrides_of
from .readings import summary_numbers

_SMOOTH, _ROUGH = 1e-4, 2e-2
"""Steps of finite differences with the same time steps, and of runs with steps of their own."""


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


@dataclass(frozen=True)
class Prediction:
    """Predictions of a trial.

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


def predict(series, trial: CandidateRun) -> Prediction:
    """Run a trial; see `batch.computing.Work`."""
    from ...simulation.from_case import analysis_of, model_of, with_accurate_mesh

    experiment = trial.experiment
    try:
        case = with_accurate_mesh(experiment.case(trial.overrides), series.comm)
        analysis = analysis_of(case)
        if isinstance(analysis, TransientAnalysis):
            if experiment.ends_with_times():
                analysis = replace(analysis, end_time=max(experiment.times), until=None)
            analysis = replace(analysis, hits=experiment.times, steps=trial.steps)
        result = series.run(model_of(case), analysis)
        if isinstance(result.stopped, KeyboardInterrupt):
            raise result.stopped
        if result.stopped is not None:
            raise result.stopped
        values = [one.reading.of(result) for one in experiment.measurements]
    except ComputationError as error:
        return Prediction(trial.number, np.full(experiment.count, np.nan), failure=str(error))
    rows = result.history if isinstance(analysis, TransientAnalysis) else []
    return Prediction(
        trial.number,
        np.concatenate(values),
        tuple(row.time for row in rows[1:]),
        np.array([row.sliding_distance for row in rows]),
        summary_numbers(result.summary),
    )


class CaseModel:
    """Predictions of all measurements of a case, see `inference.forward.ForwardModel`.

    Predictions at neighbouring parameters take the time steps of the one that they are compared
    with, so that finite differences are smooth, and are computed side by side by an executor.

    Parameters
    ----------
    table : CalibrationTable
    experiments : sequence of Experiment
    executor : Executor, optional
        By default runs are computed in this process.
    workers : int
        Number of workers of the executor.

    Attributes
    ----------
    step : float
        Step of finite differences in internal coordinates.
    runs : int
        Number of runs so far.
    """

    def __init__(
        self,
        table: CalibrationTable,
        experiments: Sequence[Experiment],
        executor: Executor | None = None,
        workers: int = 1,
    ):
        self._table, self._experiments = table, list(experiments)
        self._executor, self._workers = executor, workers
        self._series = None if executor is not None else new_series()
        self._known: dict[bytes, list[Prediction]] = {}
        self._follows = True
        self.runs = 0
        if not all(one.located for one in experiments):
            self._find_times()

    @property
    def smooth(self) -> bool:
        """True if neighbouring runs take the same time steps."""
        return self._follows

    @property
    def step(self) -> float:
        """Step of finite differences in internal coordinates."""
        return _SMOOTH if self._follows else _ROUGH

    def predict(self, values: np.ndarray) -> np.ndarray:
        """Predictions [SI] with values of the parameters, with steps by error control.

        NaN where a run fails; see `failure`.
        """
        return np.concatenate([one.values for one in self._at(values)])

    def neighbours(self, values: np.ndarray, others: Sequence[np.ndarray]) -> list[np.ndarray]:
        """Predictions at other values, with the time steps of those at the given ones."""
        return [np.concatenate([p.values for p in one]) for one in self._beside(values, others)]

    def numbers(self, values: np.ndarray, others: Sequence[np.ndarray]) -> list[dict[str, float]]:
        """Numbers of the summaries of all experiments at other values, as by `neighbours`."""
        named = []
        for found in self._beside(values, others):
            several = len(found) > 1
            named.append(
                {
                    f"{name} (experiment {k})" if several else name: number
                    for k, one in enumerate(found, 1)
                    for name, number in one.numbers.items()
                }
            )
        return named

    def with_other_conditions(self) -> dict[str, CaseModel]:
        """Models of the first experiment at other loads and speeds, by the path of the key."""
        return {
            key: CaseModel(self._table, [one], self._executor, self._workers)
            for key, one in other_conditions(self._experiments[0]).items()
        }

    def failure(self, values: np.ndarray) -> str:
        """Reason of the first failed run with values of the parameters; empty for none."""
        return next((one.failure for one in self._at(values) if one.failure), "")

    def _at(self, values: np.ndarray) -> list[Prediction]:
        key = np.asarray(values, dtype=float).tobytes()
        if key not in self._known:
            self._known[key] = self._computed([(values, [()] * len(self._experiments))])[0]
        return self._known[key]

    def _beside(self, values: np.ndarray, others: Sequence[np.ndarray]) -> list[list[Prediction]]:
        steps = [one.steps if self._follows else () for one in self._at(values)]
        start = np.asarray(values, dtype=float).tobytes()
        keys = [start + np.asarray(other, dtype=float).tobytes() for other in others]
        new = [k for k, key in enumerate(keys) if key not in self._known]
        computed = self._computed([(others[k], steps) for k in new])
        self._known |= {keys[k]: found for k, found in zip(new, computed, strict=True)}
        return [self._known[key] for key in keys]

    def _computed(
        self, wanted: Sequence[tuple[np.ndarray, Sequence[tuple[float, ...]]]]
    ) -> list[list[Prediction]]:
        """Predictions of all experiments by values; runs of one experiment share factors."""
        m = len(self._experiments)
        groups = [
            [
                CandidateRun(j * m + k, experiment, overrides_of(self._table, values), steps[k])
                for j, (values, steps) in enumerate(wanted)
            ]
            for k, experiment in enumerate(self._experiments)
        ]
        found: dict[int, Prediction] = {}

        def received(outcome: Prediction | Lost) -> None:
            if isinstance(outcome, Lost):
                trial = outcome.task
                nothing = np.full(trial.experiment.count, np.nan)
                outcome = Prediction(trial.number, nothing, failure=outcome.reason)
            found[outcome.number] = outcome

        compute(groups, predict, received, self._executor, self._workers, self._series)
        self.runs += len(found)
        return [[found[j * m + k] for k in range(m)] for j in range(len(wanted))]

    def _find_times(self) -> None:
        """Times of the measurements at sliding distances, from a run with the first values."""
        first = np.array([p.start.number for p in self._table.parameters.values()])
        for k, one in enumerate(self._at(first)):
            if not self._experiments[k].located:
                if one.failure:
                    raise ComputationError(one.failure)
                if not len(one.distances):
                    raise CaseError("calibrate: sliding distances need a transient analysis")
                time = np.array([0.0, *one.steps])
                self._experiments[k] = self._experiments[k].at_distances(time, one.distances)
        self._known.clear()
