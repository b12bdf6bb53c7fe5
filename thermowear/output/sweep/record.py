"""Reading of a sweep from its files."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from .keys import Axis, axis


@dataclass(frozen=True)
class VariantRecord:
    """Completed variants of a sweep.

    Attributes
    ----------
    axes : tuple of Axis
        Swept keys.
    indices : ndarray of int, shape (n, n_axes)
        Index of the value of each key in each variant.
    folders : list of Path
        Results folder of each variant.
    numbers : dict of str to ndarray, shape (n,)
        Columns of ``sweep.csv`` other than the swept keys.
    """

    axes: tuple[Axis, ...]
    indices: np.ndarray
    folders: list[Path]
    numbers: dict[str, np.ndarray]


def read_sweep(folder: Path) -> VariantRecord:
    """Read the completed variants of a sweep.

    Raises
    ------
    ValueError
        If the folder contains no sweep.
    """
    over = json.loads((folder / "run.json").read_text("utf-8"))["over"]
    with (folder / "sweep.csv").open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    try:
        status = header.index("status")
        keys = header[1:status]
        indices = np.array(list(product(*(range(len(values)) for values in over.values()))))
        axes = tuple(
            axis(key, written, _different(rows, k + 1, indices[:, k]), keys[k])
            for k, (key, written) in enumerate(over.items())
        )
        done = [row for row in rows if row[status] == "done"]
        cells = zip(header, *done, strict=True)
        numbers = {name: np.array(column, dtype=float) for name, *column in [*cells][status + 1 :]}
        variants = [int(row[0]) for row in done]
        folders = [folder / f"{number:03d}" for number in variants]
        return VariantRecord(axes, indices[np.array(variants, dtype=int) - 1], folders, numbers)
    except (IndexError, KeyError, ValueError) as error:
        raise ValueError(f"{folder}: run.json and sweep.csv are not of the same sweep") from error


def _different(rows: list[list[str]], column: int, place: np.ndarray) -> Sequence[float | str]:
    """Distinct values of a key, in the order given by the user."""
    first = [int(np.argmax(place == k)) for k in range(place.max() + 1)]
    cells = [rows[k][column] for k in first]
    try:
        return [float(cell) for cell in cells]
    except ValueError:
        return cells
