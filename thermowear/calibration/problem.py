"""Problem of a calibration: case, parameters and measurements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..case import AnyCase
from ..case.studies.calibration import CalibrationTable
from ..inference import Normal, Parameter, ParameterSpace
from ..inference.fit import NOISE
from .candidate_run import Runner
from .case_model import CaseModel
from .experiments import Experiment, experiments, overrides_of
from .measurement import Measurement

_ROUGH_NOISE = 0.05
"""Noise of derivatives, relative to the largest, of runs with time steps of their own."""


@dataclass(frozen=True)
class Problem:
    """Parameters, measurements and experiments of a calibration."""

    table: CalibrationTable
    space: ParameterSpace
    measurements: list[Measurement]
    experiments: list[Experiment]

    @classmethod
    def of(cls, case: AnyCase, measurements: Sequence[Measurement]) -> Problem:
        """Problem of a case with the table ``calibrate``.

        Raises
        ------
        CaseError
            If the measurements or the first values do not fit the case.
        """
        assert case.calibrate is not None
        table, space = case.calibrate, space_of(case.calibrate)
        found = experiments(case, measurements)
        for one in found:
            one.case(overrides_of(table, space.start))
        return cls(table, space, list(measurements), found)

    def model(self, runner: Runner) -> CaseModel:
        """Forward model, whose runs a runner computes."""
        return CaseModel(self.table, self.experiments, runner)

    def noise(self, model: CaseModel) -> float:
        """Relative noise of the derivatives."""
        return NOISE if model.smooth else _ROUGH_NOISE

    @property
    def order(self) -> np.ndarray:
        """Indices of all values by what they are, whatever the order of observations and rows.

        A search in this order has the same rounding, and hence the same result, for any other.
        """
        keys: list[tuple] = []
        for one in self.measurements:
            at = sorted(one.reading.at)
            common = one.conditions, one.reading.name, one.reading.contact or "", tuple(at)
            columns = (one.reading.at[name] for name in at)
            rows = zip(*columns, one.values, one.deviations, strict=True)
            keys += [(*common, *map(float, row)) for row in rows]
        return np.array(sorted(range(len(keys)), key=keys.__getitem__), dtype=int)

    @property
    def data(self) -> list[list]:
        """All that is measured, as plain values."""
        return [
            [
                *(one.label, one.reading.name, one.reading.contact, one.changes, one.relative),
                {name: values.tolist() for name, values in one.reading.at.items()},
                *(one.values.tolist(), one.deviations.tolist()),
            ]
            for one in self.measurements
        ]

    def in_order(self, order: np.ndarray) -> Problem:
        """Problem whose predictions are in another order of the values."""
        places, end = np.argsort(order), 0
        found = []
        for one in self.experiments:
            rows = np.arange(end, end := end + one.count) if one.rows is None else one.rows
            found.append(replace(one, rows=places[rows]))
        return replace(self, experiments=found)

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


def space_of(table: CalibrationTable) -> ParameterSpace:
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
