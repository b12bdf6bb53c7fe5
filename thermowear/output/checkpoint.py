"""``checkpoint.npz``: all that a run needs to go on; the last one stands until the next does."""

from __future__ import annotations

import json
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CaseError
from .replacing import replacing

CHECKPOINT = "checkpoint.npz"
FORMAT = 1
_ABOUT = "about"


def write_checkpoint(folder: Path, about: dict[str, Any], arrays: Mapping[str, np.ndarray]) -> None:
    """Write beside, wait for the disk, and rename: whenever that ends, one of both is whole.

    Parameters
    ----------
    folder : Path
    about : dict
        Numbers and text, as JSON has them.
    arrays : mapping of str to ndarray

    Raises
    ------
    OSError
        If the disk does not take it; then the last one stands.
    """
    head = np.array(json.dumps({"format": FORMAT} | about))
    with replacing(folder / CHECKPOINT) as draft, draft.open("wb") as file:
        np.savez(file, allow_pickle=False, **{_ABOUT: head}, **arrays)
        file.flush()
        os.fsync(file.fileno())
    _wait_for_disk(folder)


def read_checkpoint(folder: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]] | None:
    """What `write_checkpoint` was given; None where there is none.

    Raises
    ------
    CaseError
        If it is not one of this program.
    """
    path = folder / CHECKPOINT
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = dict(file)
        about = json.loads(str(arrays.pop(_ABOUT)))
        known = about["format"] == FORMAT
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise CaseError(f"{path}: cannot be read: {error}") from None
    if not known:
        raise CaseError(f"{path}: has format {about['format']}; this program reads {FORMAT}")
    return about, arrays


def _wait_for_disk(folder: Path) -> None:
    """Until the new name of a file in a folder is on disk too."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
