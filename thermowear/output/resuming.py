"""Results folders whose run goes on."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from ..case import Case, as_plain, load
from ..case.validation.comparison import forbidden_changes, irrelevant_changes_only, other_mesh
from ..errors import CaseError
from .checkpoint import read_checkpoint
from .folder import ResultsFolder, now, versions
from .frames import FRAMES, keep_indexed

_ANEW = "--overwrite starts it from the beginning"


class ResumedFolder(ResultsFolder):
    """A folder with the results of a run that was stopped.

    Parameters
    ----------
    path : Path
    tables : dict
        The case with every default written out.
    ranks : int
    time : float
        From which the run goes on [s].

    Raises
    ------
    CaseError
        If the folder cannot be used.
    """

    def __init__(self, path: Path, tables: dict, ranks: int, time: float):
        self._before, self._time = read_run(path), time
        super().__init__(path, tables, ranks, overwrite=True)

    def _claim(self, overwrite: bool) -> None:
        """Take it as it is, and remember how often it was taken."""
        resumes = [*self._before.get("resumes", []), {"at": now(), "from_s": self._time}]
        self._run |= {"started": self._before["started"], "resumes": resumes}
        try:
            keep_indexed(self.path / FRAMES)
        except ValueError as error:
            raise CaseError(f"--resume: {error}; {_ANEW}") from None

    def abandon(self) -> None:
        """Be as if nobody had tried to go on."""
        self._run = self._before
        self._write_run()
        self._lock.release()


def read_run(path: Path) -> dict[str, Any]:
    """How far the run of a folder has come.

    Raises
    ------
    CaseError
        If there is none.
    """
    try:
        found = json.loads((path / "run.json").read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        found = None
    if not isinstance(found, dict) or not {"status", "started"} <= found.keys():
        raise CaseError(f"-o {path}: there is no run to resume")
    return found


def is_finished(path: Path, case: Case) -> bool:
    """Whether the run of a folder has come to the end of a case.

    Raises
    ------
    CaseError
        If there is no run, or it was one of another mesh.
    """
    ended = read_run(path)["status"] == "done" and (path / "summary.json").is_file()
    if not ended or not irrelevant_changes_only(load(path / "case.resolved.toml"), case):
        return False
    mesh = _mesh_of(path)
    if mesh is not None and mesh != case.tagged_mesh().checksum():
        raise CaseError(other_mesh(case))
    return True


def _mesh_of(path: Path) -> str | None:
    """Checksum of the mesh of a finished run, where it was read from a file."""
    try:
        summary = json.loads((path / "summary.json").read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return summary.get("mesh_sha256") if isinstance(summary, dict) else None


def last_checkpoint(
    path: Path, case: Case, ranks: int
) -> tuple[dict[str, Any], dict[str, np.ndarray]] | None:
    """The checkpoint from which a case can go on; None where nothing was computed yet.

    Raises
    ------
    CaseError
        If it is not one of this case on so many ranks, or none although there are results.
    """
    found = read_checkpoint(path)
    if found is None:
        if (path / "summary.json").is_file():
            raise CaseError(f"-o {path}: its run has left no checkpoint; {_ANEW}")
        return None
    about = found[0]
    changed = forbidden_changes(load(about["case"]), case, about["time"])
    if changed:
        first, *others = changed
        also = "".join(f", {change.key} differs too" for change in others)
        raise CaseError(f"--resume: not the case of the run: {first}{also}; undo that, or {_ANEW}")
    if about["ranks"] != ranks:
        raise CaseError(
            f"--resume: the checkpoint was made by {about['ranks']} processes, not by {ranks}; "
            f"use mpirun -n {about['ranks']}, or {_ANEW}"
        )
    return found


def about_checkpoint(case: Case, time: float, outlines: list[str]) -> dict[str, Any]:
    """What a checkpoint says of itself.

    Parameters
    ----------
    case : Case
    time : float
        Of the run [s].
    outlines : list of str
        What the arrays of each process mean.
    """
    return {
        "case": as_plain(case),
        "ranks": len(outlines),
        "time": time,
        "outlines": outlines,
        "versions": versions(),
    }
