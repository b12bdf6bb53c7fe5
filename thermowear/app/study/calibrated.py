"""Calibrated parameters as one input of a study: their joint distribution from a calibration."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from ...case.studies.calibration import CalibrationTable
from ...errors import CaseError
from ...inference import JointNormal, Parameter, ParameterSpace
from ...output.files import read_object
from ...output.variants.units import value_at
from .inputs import StudyInput, input_column

FILE = "calibration.json"
_LABEL = "calibrated parameters"


def calibrated_input(folder: Path, case: dict[str, Any]) -> StudyInput:
    """Parameters of a calibration as one input.

    Parameters
    ----------
    folder : Path
        Folder with the results of a calibration.
    case : dict
        Resolved case that the parameters are used in.

    Raises
    ------
    CaseError
        If there is no calibration, or it leaves parameters undetermined.
    """
    path = folder / FILE
    content = read_object(path)
    if content is None:
        raise CaseError(f"--calibration {folder}: contains no readable {FILE}")
    try:
        return _input(content, case)
    except (KeyError, TypeError, ValueError, ValidationError) as error:
        reason = f"missing {error}" if isinstance(error, KeyError) else str(error).split("\n")[0]
        raise CaseError(f"--calibration {folder}: {FILE}: {reason}") from None


def _input(content: dict[str, Any], case: dict[str, Any]) -> StudyInput:
    if content.get("planned"):
        raise ValueError("is that of a plan, not of a calibration")
    known: dict[str, dict[str, Any]] = content["parameters"]
    table = CalibrationTable(
        parameters={name: _table(one) for name, one in known.items()}, set=content.get("set", {})
    )
    space = ParameterSpace(tuple(_parameter(name, one) for name, one in known.items()))
    rows: list[list[float | None]] | None = content["covariance"]
    mean = [one["internal"] for one in known.values()]
    unknown = _undetermined(list(known), rows, mean)
    if rows is None or unknown:
        names = f" {', '.join(unknown)}" if unknown else ""
        raise ValueError(
            f"the measurements do not determine{names or ' all parameters'}, which then have no "
            "distribution; add measurements or priors, and calibrate again"
        )
    covariance = np.array(rows, dtype=float)
    if covariance.shape != (len(known), len(known)):
        raise ValueError(f"covariance: must have {len(known)} rows and columns")
    scales = np.array([_scale(one) for one in known.values()]) / space.scale
    normal = JointNormal.from_covariance(
        space, np.array(mean) * scales, covariance * np.outer(scales, scales)
    )
    columns = tuple(
        input_column(one.get("key") or name, one["unit"], value_at(one.get("key") or "", case))
        for name, one in known.items()
    )

    def overrides(values: Sequence[float]) -> tuple[str, ...]:
        return table.overrides(dict(zip(known, map(float, values), strict=True)))

    return StudyInput(_LABEL, columns, normal, overrides, space.limits)


def _undetermined(
    names: list[str], rows: list[list[float | None]] | None, mean: list[float | None]
) -> list[str]:
    """Names of the parameters that have no value or no variance."""
    diagonal = [row[k] for k, row in enumerate(rows or [])]
    return [n for n, *numbers in zip(names, mean, diagonal, strict=False) if None in numbers]


def _table(one: dict[str, Any]) -> dict[str, Any]:
    """Table of a parameter as in a case."""
    written = {"start": one["value"], "lower": one["lower"], "upper": one["upper"]}
    if one["unit"]:
        written = {name: f"{float(number)!r} {one['unit']}" for name, number in written.items()}
    return written | {"key": one.get("key"), "scale": one.get("scale", "linear")}


def _parameter(name: str, one: dict[str, Any]) -> Parameter:
    log = one.get("scale") == "log"
    return Parameter(name, one["value"], one["lower"], one["upper"], log)


def _scale(one: dict[str, Any]) -> float:
    """Change of the value, or of its logarithm, per unit of the coordinate in the file."""
    return 1.0 if one.get("scale") == "log" else float(one.get("internal_scale", 1.0))
