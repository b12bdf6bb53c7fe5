"""``checkpoint.npz``: all that a run needs to go on; the last one stands until the next does."""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CaseError, quoted
from .atomic_write import replacing

CHECKPOINT = "checkpoint.npz"
FORMAT = 2
_ABOUT, _DIGEST = "about", "digest"
_UNREADABLE = (
    *(OSError, ValueError, KeyError, TypeError, AttributeError, EOFError),
    *(MemoryError, NotImplementedError, zipfile.BadZipFile, zlib.error),
)
"""What numpy, zip archives and JSON raise at content that is not theirs."""


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
    head = np.array(json.dumps({"format": FORMAT, _DIGEST: _digest(about, arrays)} | about))
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
        If it is not one of this program, or not as it was written.
    """
    path = folder / CHECKPOINT
    try:
        with np.load(path, allow_pickle=False) as file:
            if any(entry.compress_type != zipfile.ZIP_STORED for entry in file.zip.infolist()):
                raise ValueError("its entries are compressed, and may fill the memory")
            arrays = dict(file)
        about = json.loads(str(arrays.pop(_ABOUT)))
        known, digest = about.pop("format"), about.pop(_DIGEST, None)
    except FileNotFoundError:
        return None
    except _UNREADABLE as error:
        raise CaseError(f"{path}: cannot be read: {error}") from None
    if known != FORMAT:
        raise CaseError(f"{path}: has format {quoted(known)}; this program reads {FORMAT}")
    if digest != _digest(about, arrays):
        raise CaseError(
            f"{path}: is damaged, its content is not what was written; "
            "--overwrite starts from the beginning"
        )
    return about, arrays


def _digest(about: dict[str, Any], arrays: Mapping[str, np.ndarray]) -> str:
    """SHA-256 of all that a checkpoint holds."""
    found = hashlib.sha256(json.dumps(about, sort_keys=True).encode())
    for name in sorted(arrays):
        values = np.asarray(arrays[name])
        found.update(repr((name, values.dtype.str, values.shape)).encode())
        found.update(values.tobytes())
    return found.hexdigest()


def _wait_for_disk(folder: Path) -> None:
    """Until the new name of a file in a folder is on disk too."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
