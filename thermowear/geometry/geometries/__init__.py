"""Geometries that a case file can name, in one file or with similar ones.

Importing this folder makes them known.
"""

import importlib
import pkgutil

for _module in pkgutil.walk_packages(__path__, f"{__name__}."):
    importlib.import_module(_module.name)
