"""Files of the state of a run to restart from, each replaced atomically by the next one."""

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
from .files import atomic_write

CHECKPOINT = "checkpoint.npz"
"""Name in a results folder."""
FORMAT = 2
_ABOUT, _DIGEST = "about", "digest"
_UNREADABLE = (
    *(OSError, ValueError, KeyError, TypeError, AttributeError, EOFError),
    *(MemoryError, NotImplementedError, zipfile.BadZipFile, zlib.error),
)
"""Exceptions of numpy, zip archives and JSON on invalid content."""


def write_checkpoint(path: Path, about: dict[str, Any], arrays: Mapping[str, np.ndarray]) -> None:
    """Write the checkpoint to a draft, synchronise it to disk, and rename it.

    A valid checkpoint exists at any time, the previous or the new one.

    Parameters
    ----------
    path : Path
    about : dict
        Metadata that JSON can represent.
    arrays : mapping of str to ndarray

    Raises
    ------
    OSError
        If it cannot be written; the previous checkpoint remains.
    """
    head = np.array(json.dumps({"format": FORMAT, _DIGEST: _digest(about, arrays)} | about))
    with atomic_write(path) as draft, draft.open("wb") as file:
        np.savez(file, allow_pickle=False, **{_ABOUT: head}, **arrays)
        file.flush()
        os.fsync(file.fileno())
    _wait_for_disk(path.parent)


def read_checkpoint(path: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]] | None:
    """Read metadata and arrays of a checkpoint; None if there is none.

    Raises
    ------
    CaseError
        If the file is not a checkpoint of this program, or is damaged.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            if any(entry.compress_type != zipfile.ZIP_STORED for entry in file.zip.infolist()):
                raise ValueError("its entries are compressed and might exhaust the memory")
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
            f"{path}: is damaged, as its checksum does not match its content; "
            "--overwrite starts from the beginning"
        )
    return about, arrays


def _digest(about: dict[str, Any], arrays: Mapping[str, np.ndarray]) -> str:
    """SHA-256 checksum of the content of a checkpoint."""
    found = hashlib.sha256(json.dumps(about, sort_keys=True).encode())
    for name in sorted(arrays):
        values = np.asarray(arrays[name])
        found.update(repr((name, values.dtype.str, values.shape)).encode())
        found.update(values.tobytes())
    return found.hexdigest()


def _wait_for_disk(folder: Path) -> None:
    """Synchronise a folder, so that a renamed file in it is on disk."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
