"""Files that a case file names."""

from __future__ import annotations

import stat
from pathlib import Path

from pydantic import ValidationInfo


def folder_of(info: ValidationInfo) -> Path | None:
    """The folder of the case file that is being read; None for tables that come from no file."""
    return (info.context or {}).get("folder")


def find(name: str, folder: Path | None) -> Path:
    """A regular file, looked for in the case file's folder first, then in the current directory.

    Raises
    ------
    ValueError
        If there is none.
    """
    candidates = [Path(name)] if folder is None else [folder / name, Path(name)]
    try:
        there = [path for path in candidates if path.exists()]
    except (OSError, ValueError) as error:  # a name that no file can have
        raise ValueError(f"{name[:100]!r} is not the name of a file: {error}"[:200]) from None
    if not there:
        looked = "the current directory"
        if folder is not None and not Path(name).is_absolute():
            looked = "the folder of the case file and in the current directory"
        raise ValueError(f"no file {name[:100]!r} in {looked}")
    if not stat.S_ISREG(there[0].stat().st_mode):
        raise ValueError(f"{name[:100]!r} is not a regular file")
    return there[0]
