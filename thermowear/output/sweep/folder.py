"""Folder of a sweep: one results folder per variant, and one table of all variants."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..files import is_ours
from ..variants.folder import VariantsFolder, numbers_of
from .layout import Swept

_VARIANT = re.compile(r"\d{3,}")


class SweepFolder(VariantsFolder):
    """Writer of the results of one sweep; see `VariantsFolder`.

    Parameters
    ----------
    path : Path
    over : dict of str to list of str
        Values by key, as given by the user.
    keys : sequence of Swept
    checksum : str
    overwrite, resume : bool
    """

    KIND = "sweep"
    MARK = "over"
    FILES = ("shapes.png", "sweep.png")

    def __init__(
        self,
        path: Path,
        over: dict[str, list[str]],
        keys: Sequence[Swept],
        checksum: str,
        overwrite: bool = False,
        resume: bool = False,
    ):
        cells = list(zip(*(key.values for key in keys), strict=True))
        headers = [key.header for key in keys]
        super().__init__(path, headers, cells, {"over": over}, checksum, overwrite, resume)

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
        self.add_numbers(number, status, numbers_of(summary or {}), seconds)

    def _clear(self, overwrite: bool) -> None:
        super()._clear(overwrite)
        for folder in self.path.iterdir():
            if _VARIANT.fullmatch(folder.name) and (folder / "run.json").is_file():
                for entry in filter(is_ours, list(folder.iterdir())):
                    entry.unlink()
                if not any(folder.iterdir()):
                    folder.rmdir()


def is_sweep(folder: Path) -> bool:
    """Test whether a folder contains a sweep."""
    return SweepFolder.is_of_kind(folder)
