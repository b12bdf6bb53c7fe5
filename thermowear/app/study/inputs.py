"""Uncertain inputs of a study: keys of the case with distributions, and calibrated parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from ...case.studies.calibration import CalibrationTable
from ...case.studies.scalars import Scalar
from ...case.studies.study import InputTable
from ...case.values.units import registry, unit_of
from ...errors import CaseError
from ...inference import (
    JointNormal,
    LogNormal,
    LogUniform,
    Normal,
    Parameter,
    ParameterSpace,
    Triangular,
    TruncatedNormal,
    UncertainInput,
    Uniform,
)
from ...output.files import read_object
from ...output.variants.units import in_header, in_si, value_at


@dataclass(frozen=True)
class InputColumn:
    """Value of an input.

    Attributes
    ----------
    name : str
        Path of the key, or name of a parameter.
    unit : str
        Unit in which values are given; empty for a plain number.
    header : str
        Column of tables, with the SI unit.
    offset, scale : float
        SI value of 0, and of a difference of 1, in the given unit.
    """

    name: str
    unit: str
    header: str
    offset: float = 0.0
    scale: float = 1.0

    def in_si(self, values):
        """SI values of values in the given unit."""
        return self.offset + self.scale * values


@dataclass(frozen=True)
class StudyInput:
    """Input, or a group of inputs that depend on each other.

    Attributes
    ----------
    label : str
    columns : tuple of InputColumn
    distribution : UncertainInput
        Distribution of values in the given units.
    overrides : callable
        Changes ``KEY=VALUE`` of the case for values of the columns.
    limits : ndarray or None, shape (2, p)
        Bounds to which values are moved that lie beyond.
    """

    label: str
    columns: tuple[InputColumn, ...]
    distribution: UncertainInput
    overrides: Callable[[Sequence[float]], tuple[str, ...]]
    limits: np.ndarray | None = None


def input_column(name: str, unit: str, resolved: Any = None) -> InputColumn:
    """Column of an input; its SI unit is that of the key in the resolved case, if it has one.

    Raises
    ------
    ValueError
        If the units differ in their dimension.
    """
    if not unit:
        return InputColumn(name, "", name)
    quantity, known = registry().Quantity, in_si(resolved)
    base = quantity(1.0, unit_of(unit)).to_base_units().units
    si = base if known is None else unit_of(known[1])
    if not quantity(1.0, unit_of(unit)).is_compatible_with(si):
        raise ValueError(f"{name}: found the unit {unit}; must be in {si:~C}")
    zero, one = (float(quantity(v, unit_of(unit)).to(si).magnitude) for v in (0.0, 1.0))
    spelled = f"{base:~C}" if known is None else known[1]
    return InputColumn(name, unit, f"{name}_{in_header(spelled)}", zero, one - zero)


def inputs_of(tables: dict[str, InputTable], case: dict[str, Any]) -> list[StudyInput]:
    """Inputs of the table ``study`` of a resolved case.

    Raises
    ------
    CaseError
        If a unit does not suit its key.
    """
    return [_input(key, table, value_at(key, case)) for key, table in tables.items()]


def _input(key: str, table: InputTable, resolved: Any) -> StudyInput:
    def overrides(values: Sequence[float]) -> tuple[str, ...]:
        return (Scalar(float(values[0]), table.unit).override(key),)

    try:
        column = input_column(key, table.unit, resolved)
    except ValueError as error:
        raise CaseError(f"study.inputs.{error}") from None
    return StudyInput(key, (column,), distribution_of(table), overrides)


def distribution_of(table: InputTable) -> UncertainInput:
    """Distribution of the values of an input, in the unit that they are written in."""
    numbers = table.numbers
    if table.distribution == "normal":
        cut = numbers.keys() & {"lower", "upper"}
        return TruncatedNormal(**numbers) if cut else Normal(**numbers)
    if table.distribution == "lognormal":
        return LogNormal.from_factor(**numbers)
    kinds = {"uniform": Uniform, "loguniform": LogUniform, "triangular": Triangular}
    return kinds[table.distribution](**numbers)


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
        return _calibrated_input(content, case)
    except (KeyError, TypeError, ValueError, ValidationError) as error:
        reason = f"missing {error}" if isinstance(error, KeyError) else str(error).split("\n")[0]
        raise CaseError(f"--calibration {folder}: {FILE}: {reason}") from None


def _calibrated_input(content: dict[str, Any], case: dict[str, Any]) -> StudyInput:
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
