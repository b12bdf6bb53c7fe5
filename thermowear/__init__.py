"""Thermo-mechanical sliding wear: pressure, temperature and worn shape of two bodies.

>>> import thermowear as tw
>>> case = tw.load("annular_punch.toml")            # doctest: +SKIP
>>> result = tw.run(case)                           # doctest: +SKIP
>>> result.interface.pressure.max()                 # doctest: +SKIP
"""

from __future__ import annotations

import importlib
from typing import Any

__version__ = "0.2.0"

_SCRIPTING = (
    *("Body", "Heat", "Holder", "Interface", "LayeredWear", "LoadHistory", "Material", "Model"),
    *("PowerWear", "PressureConductance", "Rotation", "Tie", "TimeHistory", "Translation"),
)
_LAZY = {
    **{"run": "simulation", "Result": "results", "Case": "case", "sweep": "app.sweeping"},
    **dict.fromkeys(("calibrate", "plan"), "app.calibration.calibrate"),
    "study": "app.study.study",
    **dict.fromkeys(_SCRIPTING, "scripting"),
}
_ROOMS = (
    "bulk",
    "calibration",
    "case",
    "contact",
    "geometry",
    "inference",
    "laws",
    "model",
    "output",
    "reference",
    "results",
    "scripting",
    "simulation",
    "verification",
)

__all__ = ["CaseError", "ComputationError", "load", *_LAZY, *_ROOMS]  # noqa: PLE0604

from .errors import CaseError, ComputationError  # noqa: E402


def load(source, overrides: tuple[str, ...] = ()):
    """Read and check a case file (or its tables); see `thermowear.case.load`."""
    from . import case

    return case.load(source, overrides)


def __getattr__(name: str) -> Any:
    """Import packages and entry points on first use, as the import of dolfinx is slow."""
    if name in _LAZY:
        return getattr(importlib.import_module(f".{_LAZY[name]}", __name__), name)
    if name in _ROOMS:
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
