"""STEP files (CAD) in millimetres, written by OpenCASCADE through gmsh."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...errors import CaseError

UNIT = 1e3
"""Millimetres in a metre."""


def save(gmsh, path: Path) -> None:
    """Write a gmsh model to a file, with the output of OpenCASCADE suppressed.

    Written to a temporary file and renamed: gmsh derives the format from a fixed file ending.
    """
    draft = path.with_name(f".{path.name}.step")
    try:
        draft.open("wb").close()
        with _silence():
            gmsh.write(str(draft))
        os.replace(draft, path)
    except OSError as error:
        raise CaseError(f"-o {path}: cannot be written: {error.strerror}") from None


@contextmanager
def _silence() -> Iterator[None]:
    """Suppress the standard output of the process."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)
