"""Context manager for gmsh models."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

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
