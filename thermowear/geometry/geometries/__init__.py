"""Geometries that a case file can name, in one file or with similar ones.

Importing this folder makes them known.
"""

import importlib
import pkgutil

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")
