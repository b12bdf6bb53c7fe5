"""Folder of a calibration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Required, TypedDict

import numpy as np
import tomli_w
from pydantic import Strict, TypeAdapter, ValidationError

from ..files import read_object, write_text, writing
from ..folder import finite, write_json
from ..study.folder import read_cells
from ..tables import write_csv
from ..variants.folder import BatchFolder, is_final, numbers_in

RECORD, OBSERVATIONS, POSTERIOR = "calibration.json", "observations.csv", "posterior.csv"
CALIBRATED, RESOLVED = "case.calibrated.toml", "case.resolved.toml"
PICTURES = {
    "fit": "Measured values with their standard deviations, and predictions with the band of their "
    "uncertainty.",
    "residuals": "Predicted against measured values, and weighted residuals: two thirds should lie "
    "between -1 and 1.",
    "parameters": "Parameters, one by one and in pairs: 68 % and 95 % regions.",
}
"""Pictures with their captions."""
_JOURNAL = "runs.jsonl"
_WORDS = {"observation", "quantity"}
_COLUMNS = _WORDS | {"observed", "deviation", "predicted", "lower", "upper", "weighted_residual"}
_Number = Annotated[float | None, Strict()]


class _Parameter(TypedDict):
    """Parameter in the record; numbers that are not finite are null."""

    key: str | None
    unit: str
    value: Annotated[float, Strict()]
    interval: tuple[_Number, _Number]
    standard_error: _Number
    scale: Literal["linear", "log"]
    lower: Annotated[float, Strict()]
    upper: Annotated[float, Strict()]
    internal: Annotated[float, Strict()]
    internal_scale: Annotated[float, Strict()]


class _Combination(TypedDict):
    """Combination of parameters in the record."""

    text: str
    deviation: _Number


class _Record(TypedDict, total=False):
    """Record, as far as pictures and the report need it."""

    planned: bool
    confidence: Required[Annotated[float, Strict()]]
    parameters: Required[dict[str, _Parameter]]
    covariance: Required[list[list[_Number]]]
    correlation: Required[list[list[_Number]]]
    combinations: list[_Combination]
    notes: list[str]
    reduced_chi2: _Number
    p_value: _Number
    degrees_of_freedom: _Number
    runs: _Number
    seconds: _Number


_RECORD = TypeAdapter(_Record)


@dataclass(frozen=True)
class StoredRun:
    """Outcome of a run of the search: ``done``, or a description of the failure.

    Attributes
    ----------
    status : str
    numbers : dict of str to float
        Numbers of the summary.
    values, steps, distances : list of float
        Predictions [SI], ends of the time steps [s], and sliding distances [m].
    """

    status: str
    numbers: dict[str, float]
    values: list[float]
    steps: list[float]
    distances: list[float]


class CalibrationFolder(BatchFolder):
    """Writer of the results of one calibration; see `BatchFolder`.

    Parameters
    ----------
    path : Path
    tables : dict
        Case with all default values.
    checksum : str
        Checksum of the case and of the measurements.
    overwrite, resume : bool
    """

    KIND = "calibration"
    MARK = "calibration"
    FILES = (
        *(RECORD, OBSERVATIONS, POSTERIOR, CALIBRATED, RESOLVED, "report.html"),
        *(f"{name}.png" for name in PICTURES),
    )
    JOURNAL = _JOURNAL

    def __init__(
        self,
        path: Path,
        tables: dict[str, Any],
        checksum: str = "",
        overwrite: bool = False,
        resume: bool = False,
    ):
        self._tables = tables
        self._runs: dict[str, StoredRun] = {}
        super().__init__(path, {"calibration": True}, checksum, overwrite, resume)

    def known(self, key: str) -> StoredRun | None:
        """Outcome of a run by its key; None if it is to be computed."""
        return self._runs.get(key)

    def add(self, key: str, run: StoredRun) -> None:
        """Record the outcome of a run.

        Raises
        ------
        UnwritableError
        """
        self.append({"key": key, **asdict(run)})

    def _begin(self) -> None:
        write_text(self.path / RESOLVED, tomli_w.dumps(self._tables))

    def _take_over(self, line: dict[str, Any]) -> None:
        key, status = line.pop("key"), line["status"]
        if type(key) is not str or type(status) is not str:
            raise TypeError("not a run")
        columns = {
            name: [float("nan") if number is None else float(number) for number in line[name]]
            for name in ("values", "steps", "distances")
        }
        if is_final(status):
            self._runs[key] = StoredRun(status, numbers_in(line["numbers"]), **columns)

    def finish(
        self,
        record: dict[str, Any],
        rows: Sequence[dict[str, Any]],
        calibrated: dict[str, Any] | None = None,
        posterior: tuple[Sequence[str], np.ndarray] | None = None,
    ) -> None:
        """Write the results.

        Parameters
        ----------
        record : dict
            Parameters and the quality of the fit.
        rows : sequence of dict
            Observations with their predictions.
        calibrated : dict, optional
            Case with the calibrated values.
        posterior : tuple, optional
            Names and values (n, p) of a sample of the posterior distribution.
        """
        with writing():
            write_json(self.path / RECORD, finite(record))
            write_csv(self.path / OBSERVATIONS, list(rows[0]), [list(row.values()) for row in rows])
            if calibrated is not None:
                write_text(self.path / CALIBRATED, tomli_w.dumps(calibrated))
            if posterior is not None:
                write_csv(self.path / POSTERIOR, list(posterior[0]), posterior[1].tolist())

    def close(self, status: str, message: str = "", **more: Any) -> None:
        """Record how it ended, see `BatchFolder`; the journal has served once all is done."""
        super().close(status, message, **more)
        if status == "done":
            (self.path / self.JOURNAL).unlink(missing_ok=True)

    def abandon(self) -> None:
        """Remove the files of a calibration whose data prove invalid, unless it has runs."""
        if (self.path / self.JOURNAL).is_file():
            self.close("failed", "the case proved invalid during the search")
            return
        for name in (RESOLVED, "run.json"):
            (self.path / name).unlink(missing_ok=True)
        if self._made:
            self.path.rmdir()
        self._lock.release()


def is_calibration(folder: Path) -> bool:
    """Test whether a folder contains a calibration."""
    return bool((read_object(folder / "run.json") or {}).get("calibration"))


def read_calibration(folder: Path) -> tuple[dict[str, Any], list[dict[str, str]]]:
    """Record and rows of the observations of a calibration.

    Raises
    ------
    ValueError
        If the folder contains none that has been finished.
    """
    record, path = read_object(folder / RECORD), folder / OBSERVATIONS
    if record is None or not path.is_file():
        raise ValueError(f"{folder}: contains no finished calibration")
    try:
        _RECORD.validate_python(record)
    except ValidationError as error:
        fault = error.errors()[0]
        where = ".".join(map(str, fault["loc"]))
        raise ValueError(f"{folder / RECORD}: is damaged: {where}: {fault['msg']}") from None
    sizes = {len(row) for row in [*record["covariance"], *record["correlation"]]}
    sizes |= {len(record[name]) for name in ("covariance", "correlation", "parameters")}
    if len(sizes) != 1:
        raise ValueError(f"{folder / RECORD}: is damaged: needs as many rows as parameters")
    return record, _observations(path)


def _observations(path: Path) -> list[dict[str, str]]:
    """Rows of the observations, whose cells but the first two are numbers."""
    rows = read_cells(path)
    if not rows or not rows[0].keys() >= _COLUMNS:
        raise ValueError(f"{path}: has no rows with the columns {', '.join(sorted(_COLUMNS))}")
    try:
        for row in rows:
            for name in row.keys() - _WORDS:
                float(row[name])
    except ValueError:
        raise ValueError(f"{path}: {name}: found {row[name]!r}; must be a number") from None
    return rows


def read_posterior(folder: Path, count: int) -> np.ndarray | None:
    """Sample of the posterior distribution of some parameters (n, count); None without one.

    Raises
    ------
    ValueError
        If the file is no such table.
    """
    path = folder / POSTERIOR
    if not path.is_file():
        return None
    sample = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    if sample.shape[1] != count or not len(sample):
        raise ValueError(f"{path}: must have a column for each of {count} parameters")
    return sample
