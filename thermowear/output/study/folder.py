"""Folder of a study: the case, one table of all variants, and curves in the journal."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from ..files import read_object, write_text
from ..variants.folder import Cell, VariantsFolder
from .tables import BANDS

CASE = "case.resolved.toml"
_FILES = (
    *("quantiles.csv", "sobol.csv", "tornado.csv", CASE, "report.html"),
    *("distributions.png", "tornado.png", "sobol.png", "bands.png"),
)
_BANDS = ("bands_history.csv", "bands_interface.csv")
"""Tables of bands of folders that do not tell theirs, as those up to 0.2.0."""
_FLOAT = np.dtype("<f4")
Curves = dict[str, dict[str, np.ndarray]]


class StudyFolder(VariantsFolder):
    """Writer of the results of one study; see `VariantsFolder`.

    Parameters
    ----------
    path : Path
    headers, cells : sequence
        Part of the design, and values of the inputs, of each variant.
    case : dict
        Case with all default values.
    about : dict
        Record of the study for ``run.json``.
    checksum : str
    overwrite, resume : bool

    Attributes
    ----------
    curves : dict of int to dict
        Curves of the variants in single precision, by number: columns by table.
    """

    KIND = "study"
    MARK = "study"
    FILES = _FILES

    def __init__(
        self,
        path: Path,
        headers: Sequence[str],
        cells: Sequence[Sequence[Cell]],
        case: dict[str, Any],
        about: dict[str, Any],
        checksum: str,
        overwrite: bool = False,
        resume: bool = False,
    ):
        self.curves: dict[int, Curves] = {}
        about = {"study": about, "bands": []}
        super().__init__(path, headers, cells, about, checksum, overwrite, resume)
        write_text(path / CASE, tomli_w.dumps(case))

    def announce_bands(self, names: Sequence[str]) -> None:
        """Record the tables of bands that will be written: others of such names are the user's."""
        self._run["bands"] = list(names)
        self._write_run()

    def files(self) -> tuple[str, ...]:
        told = (read_object(self.path / "run.json") or {}).get("bands", _BANDS)
        bands = map(str, told) if isinstance(told, list | tuple) else ()
        names = (Path(name).name for name in bands)  # none in another folder
        return *super().files(), *(name for name in names if name.startswith(BANDS))

    def _restore(self, checksum: str) -> None:
        super()._restore(checksum)
        self._run["bands"] = [name for name in self.files() if name.startswith(BANDS)]

    def add(
        self,
        number: int,
        status: str,
        numbers: dict[str, float],
        curves: Curves,
        seconds: float,
    ) -> None:
        """Record the end of a variant, by its number from 1."""
        more = {"curves": _packed(curves)} if curves else {}
        if curves:
            self.curves[number] = curves
        self.add_numbers(number, status, numbers, seconds, **more)

    def restored(self, line: dict[str, Any]) -> None:
        if "curves" in line:
            self.curves[line["variant"]] = _unpacked(line["curves"])


def is_study(folder: Path) -> bool:
    """Test whether a folder contains a study."""
    return StudyFolder.is_of_kind(folder)


def _packed(curves: Curves) -> dict[str, dict[str, str]]:
    """Curves as text of base 64, exactly."""
    return {
        stem: {name: base64.b64encode(v.astype(_FLOAT)).decode() for name, v in columns.items()}
        for stem, columns in curves.items()
    }


def _unpacked(packed: dict[str, dict[str, str]]) -> Curves:
    curves = {
        stem: {name: _array(text) for name, text in columns.items()}
        for stem, columns in packed.items()
    }
    if any(len({len(v) for v in columns.values()}) != 1 for columns in curves.values()):
        raise ValueError("columns of several lengths")
    return curves


def _array(text: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text, validate=True), _FLOAT)
