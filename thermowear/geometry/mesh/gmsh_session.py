"""Context manager for gmsh models, and their export to STEP."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...errors import CaseError
from ...interrupts import DeferredSignals


@contextmanager
def gmsh_model(name: str) -> Iterator:
    """Open a silent gmsh session with one empty model and close it afterwards.

    Ctrl-C and SIGTERM are delivered at its end, as gmsh is called by ctypes.
    """
    import gmsh

    with DeferredSignals():
        gmsh.initialize(["-noenv"], interruptible=False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.model.add(name)
            yield gmsh
        finally:
            gmsh.finalize()


def write_step(gmsh, path: Path) -> None:
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
