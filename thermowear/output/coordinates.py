"""JSON files of a results folder, and coordinates in labels: r and z in axisymmetric models."""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..results.quantity import Quantity

_AXISYMMETRIC = {"x": "r", "y": "z"}


def read_object(path: Path) -> dict[str, Any] | None:
    """Content of a JSON file; None if it is missing, unreadable, or not an object."""
    try:
        found = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def read_summary(folder: Path) -> dict[str, Any]:
    """Summary of the run in a results folder; empty if there is none."""
    path = folder / "summary.json"
    return json.loads(path.read_bytes()) if path.is_file() else {}


def model_of(folder: Path) -> str:
    """Kinematic model of the run in a results folder; empty if it is not known."""
    case = folder / "case.resolved.toml"
    if (folder / "summary.json").is_file() or not case.is_file():
        return read_summary(folder).get("model", "")
    return tomllib.loads(case.read_text("utf-8")).get("model", "")


def in_model(quantity: Quantity, model: str) -> Quantity:
    """Quantity whose label names the coordinates as the kinematic model does."""
    if model != "axisymmetric":
        return quantity
    label = re.sub(r"\b[xy]\b", lambda name: _AXISYMMETRIC[name[0]], quantity.label)
    return replace(quantity, label=label)
