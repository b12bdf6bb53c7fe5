"""Coordinate names in labels: r and z in axisymmetric models, x and y in others."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from pathlib import Path

from ..results import Quantity
from .summary import read_summary

_AXISYMMETRIC = {"x": "r", "y": "z"}


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
