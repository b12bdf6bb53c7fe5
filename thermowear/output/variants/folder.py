"""Folder of many runs of a case: record of the command, journal, and one table of all variants.

Each run that ends is appended to the journal at once, from which a killed command goes on.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

from ...errors import CaseError
from ...results.quantity import Quantity
from ...results.summary_keys import of_key
from ..files import is_report, read_object, write_text, writing
from ..folder import Lock, finite, run_ended, run_started, write_json
from ..tables import write_csv

JOURNAL = "variants.jsonl"
LOST = "failed: its process"
"""Beginning of the status of variants whose process died; a resumed command computes them again."""
_NOT_FINAL = (
    *("interrupted", LOST, "failed: MemoryError"),
    *("failed: results cannot be written", "failed: -o ", "failed: OSError"),  # up to 0.2.0
)
"""Beginnings of the status of variants whose own computation has not failed."""
_INTERVAL, _SHARE = 1.0, 0.05
"""Least interval between two updates of the table on disk [s], and their largest share of time."""
Cell = float | str


class BatchFolder:
    """Writer of the results of many runs of a case, with their journal.

    Parameters
    ----------
    path : Path
        Folder, created if it does not exist.
    about : dict
        Entries of ``run.json``.
    checksum : str
        Checksum of all that the runs depend on.
    overwrite : bool
        Allow a folder with earlier results of this kind, which are removed; other files remain.
    resume : bool
        Continue the command that was stopped in the folder, if there is one.

    Raises
    ------
    CaseError
        If the folder cannot be used, or what the runs depend on has changed.

    Attributes
    ----------
    complete : bool
        True if nothing was left to do by the command that is resumed.
    """

    KIND: ClassVar[str]
    """Word for such a folder."""
    MARK: ClassVar[str]
    """Key that only its ``run.json`` has."""
    FILES: ClassVar[tuple[str, ...]]
    """Names of its files, beside the journal and ``run.json``."""
    JOURNAL: ClassVar[str] = JOURNAL

    def __init__(
        self,
        path: Path,
        about: dict[str, Any],
        checksum: str,
        overwrite: bool = False,
        resume: bool = False,
    ):
        self.path, self.complete = path, False
        self._run = run_started(**about, cases_sha256=checksum)
        self._made = not os.path.exists(path)  # Path.exists raises an error for invalid names
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._lock = Lock(path)
            if resume and self.is_of_kind(path):
                self._restore(checksum)
            elif any(path.iterdir()):
                self._clear(overwrite)
            self._write_run()
            self._begin()
        except OSError as error:
            raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None

    @classmethod
    def is_of_kind(cls, folder: Path) -> bool:
        """Test whether a folder contains results of this kind."""
        return cls.MARK in (read_object(folder / "run.json") or {})

    def close(self, status: str, message: str = "", **more: Any) -> None:
        """Record how the command ended: ``done``, ``failed`` or ``interrupted``.

        Raises
        ------
        UnwritableError
        """
        self._run |= run_ended(status, message) | more
        try:
            with writing():
                self._write_run()
        finally:
            self._lock.release()

    def append(self, line: dict[str, Any]) -> None:
        """Append a line to the journal: whole, or not at all.

        Raises
        ------
        UnwritableError
        """
        data = f"{json.dumps(finite(line))}\n".encode()
        with writing(), (self.path / self.JOURNAL).open("ab", buffering=0) as file:
            end = file.tell()
            try:
                while data:  # on a full disk it is written in part before there is an error
                    data = data[file.write(data) :]
            except OSError:
                file.truncate(end)
                raise

    def _begin(self) -> None:
        """Write further files that tell what will be computed."""

    def _take_over(self, line: dict[str, Any]) -> None:
        """Take over a line of the journal.

        Any error by its content tells that it is damaged.
        """
        raise NotImplementedError

    def _restore(self, checksum: str) -> None:
        """Read the runs that have ended from the journal."""
        before = read_object(self.path / "run.json") or {}
        if before.get("cases_sha256") != checksum:
            raise CaseError(
                f"--resume: the case or the values differ from those of the {self.KIND} in "
                f"{self.path}; start anew with --overwrite, or use another folder"
            )
        self.complete = before.get("status") == "done"
        journal = self.path / self.JOURNAL
        text = journal.read_bytes() if journal.is_file() else b""
        whole = text[: text.rfind(b"\n") + 1]  # the last line may not have been written to its end
        for number, line in enumerate(whole.splitlines(), 1):
            try:
                self._take_over(json.loads(line))
            except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
                raise CaseError(
                    f"--resume: {journal}, line {number}: is damaged; remove this line, and its "
                    "variant is computed again"
                ) from None
        write_text(journal, whole.decode("utf-8"))

    def _clear(self, overwrite: bool) -> None:
        """Remove earlier results of this kind."""
        if not overwrite:
            raise CaseError(
                f"-o {self.path}: exists and is not empty; use --overwrite or another folder"
            )
        found = [self.path / name for name in (self.JOURNAL, "run.json", *self.files())]
        ours = [p for p in found if p.is_file() and (p.suffix != ".html" or is_report(p))]
        if not self.is_of_kind(self.path) and ours:
            raise CaseError(
                f"-o {self.path}: contains {ours[0].name} but is not a folder of a {self.KIND}; "
                "use another folder"
            )
        for entry in ours:
            entry.unlink()

    def files(self) -> tuple[str, ...]:
        """Names of the files of earlier results, beside the journal and ``run.json``."""
        return self.FILES

    def _write_run(self) -> None:
        write_json(self.path / "run.json", self._run)


def is_final(status: str) -> bool:
    """Test whether a run need not be computed again by a resumed command."""
    return not status.startswith(_NOT_FINAL)


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


class VariantsFolder(BatchFolder):
    """Writer of the results of many variants; see `BatchFolder`.

    Parameters
    ----------
    path : Path
    headers : sequence of str
        Columns of the table that tell the variants.
    cells : sequence of sequence
        Their values, a row for each variant.
    about : dict
    checksum : str
        Checksum of the cases of all variants.
    overwrite, resume : bool
    """

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
        self._headers, self._cells = headers, cells
        self._ends: dict[int, VariantEnd] = {}
        self._next_writing = 0.0
        super().__init__(path, about | {"variants": len(cells)}, checksum, overwrite, resume)

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
        self.append({"variant": number, "status": status, "numbers": numbers, **more})
        self._ends[number] = VariantEnd(status, numbers)
        if time.monotonic() > self._next_writing:
            with writing():
                self._write_table()

    def close(self, status: str, message: str = "", seconds: float = 0.0, **more: Any) -> None:
        """Record how the command ended, see `BatchFolder`, and its wall time [s]."""
        try:
            with writing():
                self._write_table()
        finally:
            super().close(status, message, seconds=round(seconds, 4), **more)

    def restored(self, line: dict[str, Any]) -> None:
        """Take over more entries of a line of the journal."""

    def files(self) -> tuple[str, ...]:
        return f"{self.KIND}.csv", *self.FILES

    def _begin(self) -> None:
        self._write_table()

    def _take_over(self, line: dict[str, Any]) -> None:
        """Take over a line of the journal, unless its variant is to be computed again."""
        number, status = line["variant"], line["status"]
        if type(number) is not int or not 1 <= number <= self.count or type(status) is not str:
            raise ValueError("no such variant")
        numbers = numbers_in(line["numbers"])
        if is_final(status):
            self._ends[number] = VariantEnd(status, numbers)
            self.restored(line)

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


def numbers_in(line: dict[str, Any]) -> dict[str, float]:
    """Numbers of a line of the journal by name; NaN for null.

    Raises
    ------
    TypeError
        If others are among them.
    """
    if any(type(value) not in (int, float, type(None)) for value in line.values()):
        raise TypeError("not a number")
    return {name: float("nan") if value is None else value for name, value in line.items()}


MAIN = (
    *("max_temperature_K", "peak_temperature_K", "heat_carried_out_W"),
    *("shape_range_m", "rigid_wear_velocity_m_per_s", "friction_power_W"),
    *("wear_volume_1_m3", "wear_volume_2_m3", "contact_area_m2", "guide_force_N", "approach_m"),
    *("critical_speed_m_per_s", "critical_speed_with_wear_m_per_s"),
    *("critical_angular_velocity_rad_per_s", "critical_angular_velocity_with_wear_rad_per_s"),
    *("growth_rate_per_s", "dissipated_energy_J"),
)
"""Keys of the main numbers, beside the largest pressure."""
_OF_PARTS = ("contacts", "holders", "bodies", "probes")
"""Tables of a summary with numbers of parts of a model."""


def numbers_of(summary: dict[str, Any]) -> dict[str, float]:
    """Numbers of a summary, those in tables by the paths of their keys."""
    return dict(_numbers(summary))


def quantity_at(path: str) -> Quantity:
    """Quantity of a number by its path, such as ``contacts.upper.max_pressure_Pa``."""
    where, _, key = path.rpartition(".")
    quantity = of_key(key)
    part = where.partition(".")[2]
    return replace(quantity, label=f"{quantity.label}, {part}") if part else quantity


def _numbers(summary: dict[str, Any], above: str = "") -> Iterator[tuple[str, float]]:
    for name, value in summary.items():
        if name in _OF_PARTS and isinstance(value, dict):
            for part, numbers in value.items():
                yield from _numbers(numbers, f"{name}.{part}.")
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield f"{above}{name}", value
