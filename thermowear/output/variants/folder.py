"""Folder of the variants of a case: record of the run, journal, and one table of all variants.

Each variant that ends is appended to the journal at once, from which a killed command goes on.
"""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from ...errors import CaseError
from ..files import is_report, read_object, write_text, writing
from ..folder import Lock, finite, run_ended, run_started, write_json
from ..tables import write_csv

JOURNAL = "variants.jsonl"
LOST = "failed: its process"
"""Beginning of the status of variants whose process died; a resumed command computes them again."""
_INTERVAL, _SHARE = 1.0, 0.05
"""Least interval between two updates of the table on disk [s], and their largest share of time."""
Cell = float | str


@dataclass(frozen=True)
class VariantEnd:
    """End of a variant.

    Attributes
    ----------
    status : str
        ``done``, or a description of the failure.
    numbers : dict of str to float
        Numbers of its summary, and its wall time.
    """

    status: str
    numbers: dict[str, float]


class VariantsFolder:
    """Writer of the results of many variants.

    Parameters
    ----------
    path : Path
        Folder, created if it does not exist.
    headers : sequence of str
        Columns of the table that tell the variants.
    cells : sequence of sequence
        Their values, a row for each variant.
    about : dict
        Entries of ``run.json``.
    checksum : str
        Checksum of the cases of all variants.
    overwrite : bool
        Allow a folder with earlier results of this kind, which are removed; other files remain.
    resume : bool
        Continue the command that was stopped in the folder, if there is one.

    Raises
    ------
    CaseError
        If the folder cannot be used, or the cases of a resumed command have changed.
    """

    KIND: ClassVar[str]
    """Word for such a folder, the name of its command and of its table."""
    MARK: ClassVar[str]
    """Key that only its ``run.json`` has."""
    FILES: ClassVar[tuple[str, ...]]
    """Patterns of the names of its files, beside the table, the journal and ``run.json``."""

    def __init__(
        self,
        path: Path,
        headers: Sequence[str],
        cells: Sequence[Sequence[Cell]],
        about: dict[str, Any],
        checksum: str,
        overwrite: bool = False,
        resume: bool = False,
    ):
        self.path = path
        self._headers, self._cells = headers, cells
        self._ends: dict[int, VariantEnd] = {}
        self._next_writing = 0.0
        self._run = run_started(**about, variants=len(cells), cases_sha256=checksum)
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._lock = Lock(path)
            if resume and self.is_of_kind(path):
                self._restore(checksum)
            elif any(path.iterdir()):
                self._clear(overwrite)
            self._write_run()
            self._write_table()
        except OSError as error:
            raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None

    @classmethod
    def is_of_kind(cls, folder: Path) -> bool:
        """Test whether a folder contains results of this kind."""
        return cls.MARK in (read_object(folder / "run.json") or {})

    @property
    def count(self) -> int:
        """Number of variants."""
        return len(self._cells)

    @property
    def ended(self) -> dict[int, str]:
        """Status of the variants that have ended, by number."""
        return {number: end.status for number, end in self._ends.items()}

    @property
    def ends(self) -> dict[int, VariantEnd]:
        """Ends of the variants, by number."""
        return self._ends

    def add_numbers(
        self,
        number: int,
        status: str,
        numbers: dict[str, float],
        seconds: float,
        **more: Any,
    ) -> None:
        """Record the end of a variant, by its number from 1, with more entries of the journal.

        Raises
        ------
        UnwritableError
        """
        numbers = numbers | {"seconds": round(seconds, 4)}
        self._ends[number] = VariantEnd(status, numbers)
        line = {"variant": number, "status": status, "numbers": numbers, **more}
        with writing():
            with (self.path / JOURNAL).open("a", encoding="utf-8") as file:
                file.write(f"{json.dumps(finite(line))}\n")
            if time.monotonic() > self._next_writing:
                self._write_table()

    def close(self, status: str, message: str, seconds: float) -> None:
        """Record how the command ended: ``done``, ``failed`` or ``interrupted``.

        Raises
        ------
        UnwritableError
        """
        self._run |= run_ended(status, message) | {"seconds": round(seconds, 4)}
        with writing():
            self._write_table()
            self._write_run()
        self._lock.release()

    def restored(self, line: dict[str, Any]) -> None:
        """Take over more entries of a line of the journal."""

    def _restore(self, checksum: str) -> None:
        """Read the variants that have ended from the journal; interrupted ones are left out."""
        before = read_object(self.path / "run.json") or {}
        if before.get("cases_sha256") != checksum:
            raise CaseError(
                f"--resume: the case or the values differ from those of the {self.KIND} in "
                f"{self.path}; start anew with --overwrite, or use another folder"
            )
        journal = self.path / JOURNAL
        text = journal.read_bytes() if journal.is_file() else b""
        whole = text[: text.rfind(b"\n") + 1]  # the last line may not have been written to its end
        for number, line in enumerate(whole.splitlines(), 1):
            try:
                self._take_over(json.loads(line))
            except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
                raise CaseError(
                    f"--resume: {journal}, line {number}: is damaged; remove this line, and its "
                    "variant is computed again"
                ) from None
        write_text(journal, whole.decode("utf-8"))

    def _take_over(self, line: dict[str, Any]) -> None:
        """Take over a line of the journal, unless its variant is to be computed again."""
        if _is_final(line["status"]):
            numbers = {k: float("nan") if v is None else v for k, v in line["numbers"].items()}
            self._ends[line["variant"]] = VariantEnd(line["status"], numbers)
            self.restored(line)

    def _clear(self, overwrite: bool) -> None:
        if not overwrite:
            raise CaseError(
                f"-o {self.path}: exists and is not empty; use --overwrite or another folder"
            )
        names = (f"{self.KIND}.csv", JOURNAL, "run.json", *self.FILES)
        found = [entry for name in names for entry in self.path.glob(name)]
        ours = [entry for entry in found if entry.suffix != ".html" or is_report(entry)]
        if not self.is_of_kind(self.path) and ours:
            raise CaseError(
                f"-o {self.path}: contains {ours[0].name} but is not a folder of a {self.KIND}; "
                "use another folder"
            )
        for entry in ours:
            entry.unlink()

    def _write_table(self) -> None:
        """Write the table, one row per variant; unfinished variants have no numbers."""
        names = list(dict.fromkeys(name for end in self._ends.values() for name in end.numbers))
        waiting = VariantEnd("not computed", {})
        rows: list[list[Cell]] = []
        for number, cells in enumerate(self._cells, 1):
            end = self._ends.get(number, waiting)
            values = (end.numbers.get(name, float("nan")) for name in names)
            rows.append([number, *cells, end.status, *values])
        began = time.monotonic()
        write_csv(
            self.path / f"{self.KIND}.csv", ["variant", *self._headers, "status", *names], rows
        )
        ended = time.monotonic()
        self._next_writing = ended + max(_INTERVAL, (ended - began) / _SHARE)

    def _write_run(self) -> None:
        write_json(self.path / "run.json", self._run)


def _is_final(status: str) -> bool:
    """Test whether a variant need not be computed again by a resumed command."""
    return status != "interrupted" and not status.startswith(LOST)
