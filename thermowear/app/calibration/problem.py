"""Problem of a calibration: case, parameters and measurements."""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...case import AnyCase, load
from ...case.studies.calibration import CalibrationTable
from ...errors import CaseError
from ...inference import Normal, Parameter, ParameterSpace
from ...inference.jacobian import NOISE
from .experiments import experiments
from .forward import CaseModel
from .measurements import Measurement, read_measurements

_ROUGH_NOISE = 0.05
"""Noise of derivatives, relative to the largest, of runs with time steps of their own."""


@dataclass(frozen=True)
class Problem:
    """Case, parameters and measurements of a calibration."""

    case: AnyCase
    table: CalibrationTable
    space: ParameterSpace
    measurements: list[Measurement]

    @classmethod
    def of(cls, case, data, planned: bool = False) -> Problem:
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
