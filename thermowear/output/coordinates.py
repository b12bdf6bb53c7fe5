"""Coordinate names in labels: r and z in axisymmetric models, x and y in others."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

from .quantities import Quantity

_AXISYMMETRIC = {"x": "r", "y": "z"}


def model_of(folder: Path) -> str:
    """Kinematic model of the run in a results folder; empty without a summary."""
    path = folder / "summary.json"
    return json.loads(path.read_bytes()).get("model", "") if path.is_file() else ""


def in_model(quantity: Quantity, model: str) -> Quantity:
    """Quantity whose label names the coordinates as the kinematic model does."""
    if model != "axisymmetric":
        return quantity
    label = re.sub(r"\b[xy]\b", lambda name: _AXISYMMETRIC[name[0]], quantity.label)
    return replace(quantity, label=label)
