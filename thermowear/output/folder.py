"""Results folder of a run: readable at any time; files of other origin are never changed."""

from __future__ import annotations

import fcntl
import json
import math
import os
import platform
import weakref
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from functools import cache, partial
from importlib import metadata
from pathlib import Path
from typing import Any

import tomli_w

from .. import __version__
from ..errors import CaseError
from ..interrupts import BEFORE_FORCED_END
from ..results.points import by_contact
from ..results.quantity import TABLES, table_of
from .checkpoint import CHECKPOINT, write_checkpoint
from .files import FRAMES, final_name, is_ours, name_at, read_object, write_text
from .frames import HOT_SPOTS, remove_frames, write_fields, write_frame, write_hot_spots
from .tables import RowWriter, write_points


class Lock:
    """Exclusive lock of a folder, released when the process ends in any way.

    Parameters
    ----------
    path : Path
        Folder to lock.

    Raises
    ------
    CaseError
        If another run has locked the folder.
    """

    def __init__(self, path: Path):
        handle = os.open(path, os.O_RDONLY)
        mark = partial(_mark_interrupted, path)
        BEFORE_FORCED_END.append(mark)
        self.release = weakref.finalize(self, _release, handle, mark)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise CaseError(f"-o {path}: in use by another run") from None
        except OSError:  # a file system without locks
            return


def _release(handle: int, mark: Callable[[], object]) -> None:
    BEFORE_FORCED_END.remove(mark)
    os.close(handle)


def _mark_interrupted(path: Path) -> None:
    """Close the record of a folder in use."""
    record = read_object(path / "run.json")
    if record is not None and record["status"] == "running":
        write_json(path / "run.json", record | run_ended("interrupted", "interrupted by force"))


class ResultsFolder:
    """Writer of the results of one run.

    Parameters
    ----------
    path : Path
        Folder, created if it does not exist.
    tables : dict
        Case with all default values.
    ranks : int
    overwrite : bool
        Allow a folder with earlier results, which are removed. Other files remain.

    Raises
    ------
    CaseError
        If the folder cannot be used.
    """

    def __init__(self, path: Path, tables: dict, ranks: int, overwrite: bool):
        self.path = path
        contacts = tables.get("contacts", {}).items()
        names = [name for name, table in contacts if not table.get("tie")]
        named = {"contacts": names, "probes": list(tables.get("probes", {}))}
        self._run = run_started(ranks=ranks, **{key: of for key, of in named.items() if of})
        self._rows: dict[str, RowWriter] = {}
        self._made = not os.path.exists(path)  # Path.exists raises an error for invalid names
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._lock = Lock(path)
            try:
                self._claim(overwrite)
                self._write_run()
                self.describe(tables)
            except BaseException:
                self._lock.release()
                raise
        except OSError as error:
            raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None

    def describe(self, tables: dict) -> None:
        """Write the case with all values that are used."""
        write_text(self.path / "case.resolved.toml", tomli_w.dumps(tables))

    def _claim(self, overwrite: bool) -> None:
        """Remove earlier results if `overwrite` allows it."""
        path = self.path
        present = [entry for entry in path.iterdir() if is_ours(entry)]
        if any(path.iterdir()) and not overwrite:
            raise CaseError(
                f"-o {path}: exists and is not empty; use --overwrite or another folder"
            )
        whole = [entry for entry in present if final_name(entry) == entry.name]
        if whole and not (path / "run.json").is_file():
            raise CaseError(
                f"-o {path}: contains {whole[0].name} but no run.json, so it is not a results "
                "folder; use another folder"
            )
        for entry in present:
            if entry.name == FRAMES:
                remove_frames(entry)
            elif entry.name != "run.json":  # replaced later; it marks the folder as ours
                entry.unlink()

    def add(self, row) -> None:
        """Append a row, such as a `thermowear.results.HistoryRow`, to its table."""
        table = table_of(row)
        if table.stem not in self._rows:
            self._rows[table.stem] = RowWriter(self.path, table)
        self._rows[table.stem].add(row)

    def restore(self, rows: Sequence) -> None:
        """Start a table anew with rows of the checkpoint, discarding its present rows."""
        if rows:
            table = table_of(rows[0])
            self._rows[table.stem] = RowWriter(self.path, table, rows)

    def checkpoint(self, about: dict, arrays: dict) -> None:
        """Write a state from which the run can be resumed."""
        write_checkpoint(self.path / CHECKPOINT, about, arrays)

    def output(
        self,
        time: float,
        interface,
        friction=None,
        track=None,
        contacts: Mapping[str, slice] | None = None,
    ) -> None:
        """Write tables of points at an output time; by contact if there are any."""
        for points in (interface, friction, track):
            if points is not None:
                each = by_contact(points, contacts) if contacts else {"": points}
                for name, part in each.items():
                    write_points(self.path / name_at(table_of(points).stem, time, name), part)

    def frame(self, frame) -> None:
        """Write a `thermowear.results.Frame` for an animation."""
        write_frame(self.path / FRAMES, frame)

    def finish(self, result, seconds: dict[str, float]) -> None:
        """Write points, fields and summary of a `thermowear.results.Result`."""
        for stem, content in result.tables().items():
            if not table_of(content).grows:
                write_points(self.path / name_at(stem, None), content)
        if result.fields is not None:
            write_fields(self.path / "fields.vtu", result.fields)
        if result.hot_spots is not None and result.hot_spots.first is not None:
            write_hot_spots(self.path / HOT_SPOTS, result.hot_spots.first)
        rounded = {name: round(value, 4) for name, value in seconds.items()}
        write_json(self.path / "summary.json", finite(result.summary) | {"seconds": rounded})

    def close(self, status: str, message: str = "") -> None:
        """Record how the run ended: ``done``, ``failed`` or ``interrupted``."""
        self._run |= run_ended(status, message)
        try:
            self._write_run()
        finally:
            self._lock.release()

    def abandon(self) -> None:
        """Remove the files of a run whose case proves invalid before anything is computed.

        Computed results are kept.
        """
        begun = (f"{table.stem}.csv" for table in TABLES.values() if table.grows)
        if any((self.path / name).is_file() for name in (CHECKPOINT, *begun)):
            self.close("failed", "the case proved invalid during the run")
            return
        for name in ("case.resolved.toml", "run.json"):
            (self.path / name).unlink(missing_ok=True)
        if self._made:
            self.path.rmdir()
        self._lock.release()

    def _write_run(self) -> None:
        write_json(self.path / "run.json", self._run)


def finite(summary: dict[str, Any]) -> dict[str, Any]:
    """Replace numbers of a summary that are not finite by null, for JSON.

    The table ``not_finite`` describes them by the paths of their keys.
    """
    others: dict[str, str] = {}

    def cleared(path: str, value: Any) -> Any:
        if isinstance(value, dict):
            return {key: cleared(f"{path}.{key}", inner) for key, inner in value.items()}
        if isinstance(value, list | tuple):
            return [cleared(f"{path}.{k}", inner) for k, inner in enumerate(value)]
        if isinstance(value, float) and not math.isfinite(value):
            size = "overflow or unbounded"
            others[path] = "not a number" if math.isnan(value) else f"{value:+f}: {size}"
            return None
        return value

    found = {key: cleared(key, value) for key, value in summary.items()}
    return found | {"not_finite": others} if others else found


def write_json(path: Path, content: dict[str, Any]) -> None:
    """Write a JSON file without numbers that are not finite."""
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    write_text(path, f"{text}\n")


def run_started(**details) -> dict[str, Any]:
    """Begin the record ``run.json`` of a run or sweep."""
    return {"status": "running", "started": now(), **details, "versions": versions()}


def run_ended(status: str, message: str) -> dict[str, Any]:
    """Entries of a record at the end of a run or sweep."""
    ended = {"status": status, "finished": now()}
    return ended | ({"message": message} if message else {})


def now() -> str:
    """Current date and time (UTC) in ISO format, for `run.json`."""
    return datetime.now(UTC).isoformat(timespec="seconds")


@cache
def versions() -> dict[str, str]:
    found = {"thermowear": __version__, "python": platform.python_version()}
    for package in ("fenics-dolfinx", "petsc4py", "numpy", "scipy", "gmsh", "meshio", "pydantic"):
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    return found
