"""Tables of a study: quantiles, Sobol indices, swings and bands; written and read back."""

from __future__ import annotations

import base64
import csv
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from ...inference import SampleQuantiles, SobolIndices, Swings
from ..files import read_object, write_text
from ..tables import write_csv
from ..variants.folder import Cell, VariantsFolder

QUANTILES, SOBOL, TORNADO, BANDS = "quantiles.csv", "sobol.csv", "tornado.csv", "bands_"
COLUMNS = {
    QUANTILES: ("output", "2.5%", "50%", "97.5%"),
    TORNADO: ("output", "input", "output_at_medians", "output_at_low", "output_at_high"),
    SOBOL: (
        *("output", "input", "first_order", "first_order_lower", "first_order_upper"),
        *("total", "total_lower", "total_upper"),
    ),
    "study.csv": ("status", "part"),
}
"""Columns that pictures and the report need, by table."""
SAMPLE = ("sample", "A", "B")
"""Parts of the design that are an independent sample of all inputs."""


def write_quantiles(folder: Path, outputs: Sequence[str], found: SampleQuantiles) -> None:
    """Write ``quantiles.csv``, one row per number of the summary that varies."""
    headers = ["output", "mean", "deviation", *(f"{100 * level:g}%" for level in found.levels)]
    rows = zip(
        *(outputs, found.mean, found.deviation, *found.values, found.counts, found.failed),
        strict=True,
    )
    write_csv(folder / QUANTILES, [*headers, "count", "failed"], rows)


def write_sobol(
    folder: Path, outputs: Sequence[str], inputs: Sequence[str], found: SobolIndices
) -> None:
    """Write ``sobol.csv``, one row per output and input."""
    headers = ["output", "input", "first_order", "first_order_lower", "first_order_upper"]
    headers += ["total", "total_lower", "total_upper", "rows", "rows_dropped"]
    rows = [
        [
            *(output, name, found.first[i, k], *found.first_interval[:, i, k]),
            *(found.total[i, k], *found.total_interval[:, i, k], found.rows[k], found.dropped[k]),
        ]
        for k, output in enumerate(outputs)
        for i, name in enumerate(inputs)
    ]
    write_csv(folder / SOBOL, headers, rows)


def write_tornado(
    folder: Path,
    outputs: Sequence[str],
    headers: Sequence[str],
    lows: Sequence[float],
    highs: Sequence[float],
    found: Swings,
) -> None:
    """Write ``tornado.csv``, one row per output and input, the inputs in SI by their headers."""
    names = ["output", "input", "input_low", "input_high"]
    rows = [
        [output, name, low, high, found.base[k], found.low[i, k], found.high[i, k]]
        for k, output in enumerate(outputs)
        for i, (name, low, high) in enumerate(zip(headers, lows, highs, strict=True))
    ]
    names += ["output_at_medians", "output_at_low", "output_at_high"]
    write_csv(folder / TORNADO, names, rows)


def write_bands(folder: Path, found: Mapping[str, Mapping[str, np.ndarray]]) -> None:
    """Write ``bands_history.csv`` and ``bands_interface.csv``, those of contacts by their names."""
    for stem, columns in found.items():
        rows = zip(*columns.values(), strict=True)
        write_csv(folder / bands_file(stem), list(columns), rows)


def bands_file(stem: str) -> str:
    """Name of a table of bands."""
    return f"{BANDS}{stem}.csv"


def read_cells(path: Path, columns: Collection[str] = ()) -> list[dict[str, str]]:
    """Rows of a table as text; empty if it was not written.

    Raises
    ------
    ValueError
        If rows are incomplete, any of some columns is missing, or the file is no text.
    """
    if not path.is_file():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    if any(None in row or None in row.values() for row in rows):
        raise ValueError(f"{path}: has rows that are not as long as its header")
    missing = [name for name in columns if rows and name not in rows[0]]
    if missing:
        raise ValueError(f"{path}: has no column {missing[0]}")
    return rows


def read_columns(path: Path) -> dict[str, np.ndarray]:
    """Columns of a table of numbers by header.

    Raises
    ------
    ValueError
        If the file is no such table.
    """
    rows = read_cells(path)
    if not rows:
        raise ValueError(f"{path}: has no rows")
    try:
        return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    except ValueError:
        raise ValueError(f"{path}: is not a table of numbers with headers") from None


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
