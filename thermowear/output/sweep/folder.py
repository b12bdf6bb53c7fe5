"""Folder of a sweep: one results folder per variant, and one table of all variants."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ...errors import CaseError
from ..files import is_ours, read_object
from ..folder import run_ended, run_started, write_json
from ..tables import write_csv
from .keys import Swept

_OURS = ("sweep.csv", "shapes.png", "sweep.png", "run.json")
_VARIANT = re.compile(r"\d{3,}")
_INTERVAL = 1.0  # seconds between two updates of the table on disk


_OF_PARTS = ("contacts", "holders", "bodies", "probes")
"""Tables of a summary with numbers of parts of a model."""


class SweepFolder:
    """Writer of the results of one sweep.

    Parameters
    ----------
    path : Path
        Folder, created if it does not exist.
    over : dict of str to list of str
        Values by key, as given by the user.
    keys : sequence of Swept
    overwrite : bool
        Allow a folder with an earlier sweep, whose results are removed; other files remain.

    Raises
    ------
    CaseError
        If the folder cannot be used.
    """

    def __init__(
        self, path: Path, over: dict[str, list[str]], keys: Sequence[Swept], overwrite: bool
    ):
        self.path = path
        self._keys = keys
        self._count = len(keys[0].values)
        self._rows: dict[int, tuple[str, dict[str, float]]] = {}
        self._written = 0.0
        self._run = run_started(over=over, variants=self._count)
        try:
            path.mkdir(parents=True, exist_ok=True)
            if any(path.iterdir()):
                self._clear(overwrite)
            self._write_run()
        except OSError as error:
            raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None
        self._write_table()

    def variant(self, number: int) -> Path:
        """Folder of a variant."""
        return self.path / f"{number:03d}"

    def add(self, number: int, status: str, summary: dict[str, Any] | None, seconds: float) -> None:
        """Record the end of a variant.

        Parameters
        ----------
        number : int
            Number of the variant, from 1.
        status : str
            ``done``, or a description of the failure.
        summary : dict or None
        seconds : float
            Wall time.
        """
        numbers = dict(_numbers(summary or {}))
        self._rows[number] = status, numbers | {"seconds": round(seconds, 4)}
        if time.monotonic() - self._written > _INTERVAL:
            self._write_table()

    def close(self, status: str, message: str, seconds: float) -> None:
        """Record how the sweep ended: ``done``, ``failed`` or ``interrupted``."""
        self._write_table()
        self._run |= run_ended(status, message) | {"seconds": round(seconds, 4)}
        self._write_run()

    def _clear(self, overwrite: bool) -> None:
        if not overwrite:
            raise CaseError(
                f"-o {self.path}: exists and is not empty; use --overwrite or another folder"
            )
        ours = [entry for entry in self.path.iterdir() if entry.name in _OURS]
        if not is_sweep(self.path) and ours:
            raise CaseError(
                f"-o {self.path}: contains {ours[0].name} but is not a folder of a sweep; "
                "use another folder"
            )
        for entry in ours:
            entry.unlink()
        for folder in self.path.iterdir():
            if _VARIANT.fullmatch(folder.name) and (folder / "run.json").is_file():
                for entry in filter(is_ours, list(folder.iterdir())):
                    entry.unlink()
                if not any(folder.iterdir()):
                    folder.rmdir()

    def _write_table(self) -> None:
        """Write ``sweep.csv``, one row per variant; unfinished variants have no numbers."""
        names = list(dict.fromkeys(name for _, row in self._rows.values() for name in row))
        rows: list[list[float | str]] = []
        for k in range(self._count):
            status, row = self._rows.get(k + 1, ("not computed", {}))
            values = [key.values[k] for key in self._keys]
            rows.append([k + 1, *values, status, *(row.get(name, float("nan")) for name in names)])
        headers = ["variant", *(key.header for key in self._keys), "status", *names]
        write_csv(self.path / "sweep.csv", headers, rows)
        self._written = time.monotonic()

    def _write_run(self) -> None:
        write_json(self.path / "run.json", self._run)


def _numbers(summary: dict[str, Any], above: str = "") -> Iterator[tuple[str, float]]:
    """Numbers of a summary, those in tables by the paths of their keys."""
    for name, value in summary.items():
        if name in _OF_PARTS and isinstance(value, dict):
            for part, numbers in value.items():
                yield from _numbers(numbers, f"{name}.{part}.")
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield f"{above}{name}", value


def is_sweep(folder: Path) -> bool:
    """Test whether a folder contains a sweep."""
    return "over" in (read_object(folder / "run.json") or {})
