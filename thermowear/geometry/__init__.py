"""Geometries that can be named in a case file; importing this room makes them known."""

import importlib
import pkgutil

from .tagged import TaggedMesh

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["TaggedMesh"]
