"""Results folders of resumed runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..case import Case, as_plain, load
from ..case.validation.comparison import forbidden_changes, irrelevant_changes_only
from ..errors import CaseError, other_mesh
from .checkpoint import CHECKPOINT, read_checkpoint
from .files import FRAMES, read_object
from .folder import ResultsFolder, now, versions
from .frames import keep_indexed

_START_ANEW = "--overwrite starts the run from the beginning"


class ResumedFolder(ResultsFolder):
    """Results folder of a stopped run that is resumed.

    Parameters
    ----------
    path : Path
    tables : dict
        Case with all default values.
    ranks : int
    time : float
        Time at which the run is resumed [s].

    Raises
    ------
    CaseError
        If the folder cannot be used.
    """

    def __init__(self, path: Path, tables: dict, ranks: int, time: float):
        self._before, self._time = read_run(path), time
        super().__init__(path, tables, ranks, overwrite=True)

    def _claim(self, overwrite: bool) -> None:
        """Keep the results in the folder, and record that the run was resumed."""
        resumes = [*self._before.get("resumes", []), {"at": now(), "from_s": self._time}]
        self._run |= {"started": self._before["started"], "resumes": resumes}
        try:
            keep_indexed(self.path / FRAMES)
        except ValueError as error:
            raise CaseError(f"--resume: {error}; {_START_ANEW}") from None

    def abandon(self) -> None:
        """Restore the state of the folder before the attempt to resume."""
        self._run = self._before
        self._write_run()
        self._lock.release()


def read_run(path: Path) -> dict[str, Any]:
    """Read the record ``run.json`` of a run.

    Raises
    ------
    CaseError
        If there is no run in the folder.
    """
    found = read_object(path / "run.json")
    if found is None or not {"status", "started"} <= found.keys():
        raise CaseError(f"-o {path}: there is no run to resume")
    return found


def is_finished(path: Path, case: Case) -> bool:
    """Test whether the run of a folder has completed a case.

    Raises
    ------
    CaseError
        If there is no run, or it used another mesh.
    """
    ended = read_run(path)["status"] == "done" and (path / "summary.json").is_file()
    if not ended or not irrelevant_changes_only(load(path / "case.resolved.toml"), case):
        return False
    mesh = (read_object(path / "summary.json") or {}).get("mesh_sha256")
    if mesh is not None and mesh != case.tagged_mesh().checksum():
        raise CaseError(other_mesh(as_plain(case)["geometry"]["path"]))
    return True


def on_its_mesh(path: Path, case: Case) -> Case:
    """Case on the mesh that the run of a folder chose for the same accuracy; else unchanged.

    Raises
    ------
    CaseError
        If there is no run.
    """
    read_run(path)
    if case.mesh.accuracy is None:
        return case
    mesh = load(path / "case.resolved.toml").mesh
    given = case.mesh.model_fields_set
    same = all(getattr(mesh, key) == getattr(case.mesh, key) for key in given)
    return case.model_copy(update={"mesh": mesh}) if same else case


def last_checkpoint(
    path: Path, case: Case, ranks: int
) -> tuple[dict[str, Any], dict[str, np.ndarray]] | None:
    """Checkpoint from which a case can be resumed; None if nothing was computed yet.

    Raises
    ------
    CaseError
        If it belongs to another case or number of ranks, or is missing although results exist.
    """
    found = read_checkpoint(path / CHECKPOINT)
    if found is None:
        if (path / "summary.json").is_file():
            raise CaseError(f"-o {path}: contains results but no checkpoint; {_START_ANEW}")
        return None
    about = found[0]
    changed = forbidden_changes(load(about["case"]), case, about["time"])
    if changed:
        first, *others = changed
        also = "".join(f", {change.key} differs too" for change in others)
        raise CaseError(
            f"--resume: the case differs from that of the run: {first}{also}; "
            f"undo the change, or {_START_ANEW}"
        )
    if about["ranks"] != ranks:
        raise CaseError(
            f"--resume: the checkpoint was written by {about['ranks']} processes, not by {ranks}; "
            f"use mpirun -n {about['ranks']}, or {_START_ANEW}"
        )
    return found


def about_checkpoint(case: Case, time: float, outlines: list[str]) -> dict[str, Any]:
    """Metadata of a checkpoint.

    Parameters
    ----------
    case : Case
    time : float
        Simulated time [s].
    outlines : list of str
        Structure of each process's state, see `thermowear.serialise.Checkpoint`.
    """
    return {
        "case": as_plain(case),
        "ranks": len(outlines),
        "time": time,
        "outlines": outlines,
        "versions": versions(),
    }
