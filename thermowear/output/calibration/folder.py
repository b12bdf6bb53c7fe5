"""Folder of a calibration."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from ...errors import CaseError
from ..files import is_report, read_object, write_text
from ..folder import Lock, finite, run_ended, run_started, write_json
from ..tables import write_csv

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
_OURS = {RECORD, OBSERVATIONS, POSTERIOR, CALIBRATED, RESOLVED, "run.json"}
_OURS |= {f"{name}.png" for name in PICTURES}


class CalibrationFolder:
    """Writer of the results of one calibration.

    Parameters
    ----------
    path : Path
        Folder, created if it does not exist.
    tables : dict
        Case with all default values.
    overwrite : bool
        Allow a folder with an earlier calibration, whose results are removed; other files remain.

    Raises
    ------
    CaseError
        If the folder cannot be used.
    """

    def __init__(self, path: Path, tables: dict[str, Any], overwrite: bool):
        self.path = path
        self._run = run_started(calibration=True)
        self._made = not path.exists()
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._lock = Lock(path)
            if any(path.iterdir()):
                self._clear(overwrite)
            write_json(path / "run.json", self._run)
            write_text(path / RESOLVED, tomli_w.dumps(tables))
        except OSError as error:
            raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None

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
        write_json(self.path / RECORD, finite(record))
        write_csv(self.path / OBSERVATIONS, list(rows[0]), [list(row.values()) for row in rows])
        if calibrated is not None:
            write_text(self.path / CALIBRATED, tomli_w.dumps(calibrated))
        if posterior is not None:
            write_csv(self.path / POSTERIOR, list(posterior[0]), posterior[1].tolist())

    def close(self, status: str, message: str = "") -> None:
        """Record how it ended: ``done``, ``failed`` or ``interrupted``."""
        self._run |= run_ended(status, message)
        write_json(self.path / "run.json", self._run)
        self._lock.release()

    def abandon(self) -> None:
        """Remove the files of a calibration whose case or data prove invalid."""
        for name in (RESOLVED, "run.json"):
            (self.path / name).unlink(missing_ok=True)
        if self._made:
            self.path.rmdir()
        self._lock.release()

    def _clear(self, overwrite: bool) -> None:
        if not overwrite:
            raise CaseError(
                f"-o {self.path}: exists and is not empty; use --overwrite or another folder"
            )
        ours = [p for p in self.path.iterdir() if p.name in _OURS or is_report(p)]
        if ours and not is_calibration(self.path):
            raise CaseError(
                f"-o {self.path}: contains {ours[0].name} but is not a folder of a calibration; "
                "use another folder"
            )
        for entry in ours:
            entry.unlink()


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
    with path.open(encoding="utf-8", newline="") as file:
        return record, list(csv.DictReader(file))


def read_posterior(folder: Path) -> np.ndarray | None:
    """Sample of the posterior distribution (n, p); None without one."""
    path = folder / POSTERIOR
    return np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2) if path.is_file() else None
