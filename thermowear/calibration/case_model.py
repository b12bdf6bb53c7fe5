"""Predictions of the measurements by runs of a case."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..case.studies.calibration import CalibrationTable
from ..errors import CaseError, ComputationError
from .candidate_run import CandidateRun, Prediction, Runner
from .experiments import Experiment, other_conditions, overrides_of

_SMOOTH, _ROUGH = 1e-4, 2e-2
"""Steps of finite differences with the same time steps, and of runs with steps of their own."""


class CaseModel:
    """Predictions of all measurements of a case, see `inference.parameters.ForwardModel`.

    Predictions at neighbouring parameters take the time steps of the one that they are compared
    with, so that finite differences are smooth, and may be computed side by side. They are in the
    order of the values of all measurements, whatever experiments these belong to.

    Parameters
    ----------
    table : CalibrationTable
    experiments : sequence of Experiment
    runner : Runner
        Computation of the runs.

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
        runner: Runner,
    ):
        self._table, self._experiments, self._runner = table, list(experiments), runner
        self._known: dict[str, list[Prediction]] = {}
        self._order = _order_of(experiments)
        self._follows = all(one.smooth for one in experiments)
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
        return self._joined(self._at(values))

    def neighbours(self, values: np.ndarray, others: Sequence[np.ndarray]) -> list[np.ndarray]:
        """Predictions at other values, with the time steps of those at the given ones."""
        return [self._joined(found) for found in self._beside(values, others)]

    def numbers(self, values: np.ndarray, others: Sequence[np.ndarray]) -> list[dict[str, float]]:
        """Numbers of the summaries of all experiments at other values, as by `neighbours`."""
        named = []
        for found in self._beside(values, others):
            several, runs = len(found) > 1, zip(self._experiments, found, strict=True)
            named.append(
                {
                    f"{name}{experiment.described if several else ''}": number
                    for experiment, one in runs
                    for name, number in one.numbers.items()
                }
            )
        return named

    def with_other_conditions(self) -> dict[str, CaseModel]:
        """Models of the first experiment at other loads and speeds, by the path of the key."""
        return {
            key: CaseModel(self._table, [one], self._runner)
            for key, one in other_conditions(self._experiments[0]).items()
        }

    def failure(self, values: np.ndarray) -> str:
        """Reason of the first failed run with values of the parameters; empty for none."""
        return next((one.failure for one in self._at(values) if one.failure), "")

    def _joined(self, found: Sequence[Prediction]) -> np.ndarray:
        """Predictions of all experiments in the order of the measured values."""
        return np.concatenate([one.values for one in found])[self._order]

    def _at(self, values: np.ndarray) -> list[Prediction]:
        key = _key(values)
        if key not in self._known:
            self._known[key] = self._computed([(values, [()] * len(self._experiments))])[0]
        return self._known[key]

    def _beside(self, values: np.ndarray, others: Sequence[np.ndarray]) -> list[list[Prediction]]:
        steps = [one.steps if self._follows else () for one in self._at(values)]
        keys = [_key(values, other) for other in others]
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
        found = {one.number: one for one in self._runner(groups)}
        self.runs += len(found)
        return [[found[j * m + k] for k in range(m)] for j in range(len(wanted))]

    def _find_times(self) -> None:
        """Times of the measurements at sliding distances, from a run with the first values."""
        first = np.array([p.start.number for p in self._table.parameters.values()])
        found = self._at(first)
        for k, one in enumerate(found):
            if not self._experiments[k].located:
                if one.failure:
                    raise ComputationError(one.failure)
                if not len(one.distances):
                    raise CaseError("calibrate: sliding distances need a transient analysis")
                time = np.array([0.0, *one.steps])
                self._experiments[k] = self._experiments[k].at_distances(time, one.distances)
        runs = zip(self._experiments, found, strict=True)
        if not all(set(one.times) <= set(run.steps[-1:]) for one, run in runs):
            self._known.clear()  # the steps of those runs ended elsewhere


def _order_of(experiments: Sequence[Experiment]) -> np.ndarray:
    """Indices that bring the values of the experiments into the order of the measured values."""
    if any(one.rows is None for one in experiments):
        return np.arange(sum(one.count for one in experiments))
    return np.argsort(np.concatenate([one.rows for one in experiments]))


def _key(*points: np.ndarray) -> str:
    """Key of runs at values of the parameters, common to values that agree to rounding."""
    return " ".join(f"{value:.13e}" for values in points for value in values)
