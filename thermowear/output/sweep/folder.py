"""Folder of a sweep: one results folder per variant, and one table of all variants.

Each variant that ends is appended to a journal at once, from which a killed sweep goes on.
"""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ...errors import CaseError
from ..files import is_ours, read_object, write_text
from ..folder import Lock, finite, run_ended, run_started, write_json
from ..tables import write_csv
from .keys import Swept

JOURNAL = "variants.jsonl"
LOST = "failed: its process"
"""Beginning of the status of variants whose process died; a resumed sweep computes them again."""
_OURS = ("sweep.csv", "shapes.png", "sweep.png", JOURNAL, "run.json")
_VARIANT = re.compile(r"\d{3,}")
_INTERVAL, _SHARE = 1.0, 0.05
"""Least interval between two updates of the table on disk [s], and their largest share of time."""


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
    checksum : str
        Checksum of the cases of all variants.
    overwrite : bool
        Allow a folder with an earlier sweep, whose results are removed; other files remain.
    resume : bool
        Continue the sweep in the folder, if there is one.

    Raises
    ------
    CaseError
        If the folder cannot be used, or the cases of a resumed sweep have changed.
    """

    def __init__(
        self,
        path: Path,
        over: dict[str, list[str]],
        keys: Sequence[Swept],
        checksum: str,
        overwrite: bool = False,
        resume: bool = False,
    ):
        self.path = path
        self._keys = keys
        self._count = len(keys[0].values)
        self._rows: dict[int, tuple[str, dict[str, float]]] = {}
        self._next_writing = 0.0
        self._run = run_started(over=over, variants=self._count, cases_sha256=checksum)
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._lock = Lock(path)
            if resume and is_sweep(path):
                self._restore(checksum)
            elif any(path.iterdir()):
                self._clear(overwrite)
            self._write_run()
        except OSError as error:
            raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None
        self._write_table()

    @property
    def ended(self) -> dict[int, str]:
        """Status of the variants that have ended, by number."""
        return {number: status for number, (status, _) in self._rows.items()}

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
        numbers = dict(_numbers(summary or {})) | {"seconds": round(seconds, 4)}
        self._rows[number] = status, numbers
        line = json.dumps(finite({"variant": number, "status": status, "numbers": numbers}))
        with (self.path / JOURNAL).open("a", encoding="utf-8") as file:
            file.write(f"{line}\n")
        if time.monotonic() > self._next_writing:
            self._write_table()

    def close(self, status: str, message: str, seconds: float) -> None:
        """Record how the sweep ended: ``done``, ``failed`` or ``interrupted``."""
        self._write_table()
        self._run |= run_ended(status, message) | {"seconds": round(seconds, 4)}
        self._write_run()
        self._lock.release()

    def _restore(self, checksum: str) -> None:
        """Read the variants that have ended from the journal; interrupted ones are left out."""
        before = read_object(self.path / "run.json") or {}
        if before.get("cases_sha256") != checksum:
            raise CaseError(
                f"--resume: the case or the values differ from those of the sweep in {self.path}; "
                "start anew with --overwrite, or use another folder"
            )
        journal = self.path / JOURNAL
        text = journal.read_text(encoding="utf-8") if journal.is_file() else ""
        whole = text[: text.rfind("\n") + 1]
        for line in whole.splitlines():
            row = json.loads(line)
            numbers = {k: float("nan") if v is None else v for k, v in row["numbers"].items()}
            self._rows[row["variant"]] = row["status"], numbers
        self._rows = {k: row for k, row in self._rows.items() if _is_final(row[0])}
        write_text(journal, whole)

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
        began = time.monotonic()
        write_csv(self.path / "sweep.csv", headers, rows)
        ended = time.monotonic()
        self._next_writing = ended + max(_INTERVAL, (ended - began) / _SHARE)

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


def _is_final(status: str) -> bool:
    """Test whether a variant need not be computed again by a resumed sweep."""
    return status != "interrupted" and not status.startswith(LOST)


def is_sweep(folder: Path) -> bool:
    """Test whether a folder contains a sweep."""
    return "over" in (read_object(folder / "run.json") or {})
