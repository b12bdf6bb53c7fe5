"""Measured data from CSV files, with their deviations."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...calibration.measurement import Measurement
from ...calibration.readings import PLACES, known_quantities, reading
from ...case import AnyCase
from ...case.assembly.schema import AssemblyCase
from ...case.studies.calibration import ROUNDING, ObservationTable
from ...case.values.csv_columns import Columns, column_names, read_columns
from ...case.values.units import parse, registry, unit_of
from ...errors import CaseError
from ..batch.variants import written

_AT = {**dict.fromkeys(PLACES, "mm"), "time": "s", "sliding_distance": "m", "cycle": ""}
"""Columns of times and places, with a suitable unit."""
_SI = {key: {"mm": "m"}.get(unit, unit) for key, unit in _AT.items()}
_DEVIATION = "deviation"
_SMALLEST = 1e-60
"""Smallest standard deviation [SI]: squares of weighted residuals remain finite."""
_MASS = {f"worn_mass_{k}": "g" for k in (1, 2)}


def read_measurements(
    case: AnyCase, files: dict[str, Path], planned: bool = False
) -> list[Measurement]:
    """Read all measurements of a calibration.

    Parameters
    ----------
    case : AnyCase
        Case with the table ``calibrate``.
    files : dict of str to Path
        Files by the name of the observation; those not named in the case are observations, too.
    planned : bool
        Without values: only what would be measured, and how precisely.

    Raises
    ------
    CaseError
        One line for the first fault.
    """
    table = case.calibrate
    assert table is not None
    tables = table.observations | {
        name: ObservationTable() for name in files if name not in table.observations
    }
    if not tables:
        raise CaseError("calibrate.observations: missing; give a file by --data FILE")
    found: list[Measurement] = []
    for name, own in tables.items():
        path = files.get(name) or (None if own.file is None else Path(own.file))
        if path is None:
            raise CaseError(f"calibrate.observations.{name}.file: missing; or --data {name}=FILE")
        found += _of_file(case, name, own, path, planned)
    return found


def _of_file(
    case: AnyCase, name: str, own: ObservationTable, path: Path, planned: bool
) -> list[Measurement]:
    try:
        heads = column_names(path)
        names = [n for n in heads if n not in _AT and n != _DEVIATION]
        quantities = list(dict.fromkeys(n.removesuffix(f"_{_DEVIATION}") for n in names))
        if planned and own.quantity is not None and not quantities:
            quantities = ["value"]
        if not quantities:
            raise ValueError(f"{path.name} has no column of a measured quantity")
        at_places = not set(heads).isdisjoint(PLACES)
        units = _known_units(case, own, quantities, at_places)
        columns = read_columns(path, units, ordered=False)
        if not planned and (missing := [q for q in quantities if q not in columns.values]):
            raise ValueError(f"{columns.name} has no column {missing[0]}")
        return [_measurement(case, name, own, columns, q, len(quantities)) for q in quantities]
    except ValueError as error:
        raise CaseError(f"calibrate.observations.{name}: {error}") from None


def _known_units(
    case: AnyCase, own: ObservationTable, columns: list[str], at_places: bool
) -> dict[str, str]:
    """Columns that a file may have, with a suitable unit each."""
    quantities = known_quantities(at_places).items()
    known = {name: one.si for name, one in quantities if name not in _AT}
    known |= {} if at_places else _MASS | dict.fromkeys(probes_of(case), "degC")
    if own.quantity is not None:
        if own.quantity not in known:
            raise ValueError(f"quantity: {own.quantity} is unknown; see docs/reference/results.md")
        known["value"] = known[own.quantity]
    known |= {f"{name}_{_DEVIATION}": unit for name, unit in known.items()}
    if len(columns) == 1 and columns[0] in known:
        known[_DEVIATION] = known[columns[0]]
    return _AT | known


def probes_of(case: AnyCase) -> list[str]:
    """Names of the points of the bodies at which temperatures are recorded."""
    return list(getattr(case, "probes", {}))


def _measurement(
    case: AnyCase, name: str, own: ObservationTable, columns: Columns, column: str, several: int
) -> Measurement:
    quantity = own.quantity or column if column == "value" else column
    at = {key: _in_si(columns, key, unit) for key, unit in _SI.items() if key in columns.values}
    if not at.keys().isdisjoint(PLACES) and "time" not in at and (found := at.keys() - set(PLACES)):
        raise ValueError(
            f"{columns.name}: places are measured at a time or at the end; found {min(found)}"
        )
    if isinstance(case, AssemblyCase) and own.contact not in (None, *case.sliding):
        raise ValueError(f"contact: must be one of: {', '.join(case.sliding)}")
    count = len(columns.lines)
    given = reading(quantity, at, count, own.contact, _densities(case, own.contact))
    values = np.full(count, np.nan)
    if column in columns.values:
        values = _in_si(columns, column, given.quantity.si)
    label = f"{name}: {quantity}" if several > 1 else name
    deviations = _deviations(columns, column, values, own, given.quantity.si)
    changes = tuple(f"{key}={written(value)}" for key, value in own.set.items())
    relative = (own.deviation.relative if own.deviation else None) or 0.0
    return Measurement(label, given, values, deviations, changes, columns.name, relative)


def _deviations(
    columns: Columns, column: str, values: np.ndarray, own: ObservationTable, unit: str
) -> np.ndarray:
    """Standard deviations: those of a column, or the common one of the case [SI]."""
    for key in (f"{column}_{_DEVIATION}", _DEVIATION):
        if key in columns.values:
            found = _in_si(columns, key, unit, difference=True)
            break
    else:
        if own.deviation is None:
            raise ValueError(
                f"{columns.name} has no column {_DEVIATION}; give one, or the key deviation"
            )
        if own.deviation.absolute is not None:
            given = _number(own.deviation.written(), unit, difference=True)
            found = np.full(len(values), given)
        else:
            assert own.deviation.relative is not None
            if unit == "K":
                raise ValueError(
                    f"deviation: a percentage of {column} depends on the temperature scale; "
                    "give it in K"
                )
            found = own.deviation.relative * np.abs(values)
    if (found <= 0.0).any():
        raise ValueError(f"{columns.name}: the {_DEVIATION} of {column} must be greater than 0")
    low = found < np.maximum(ROUNDING * np.nan_to_num(np.abs(values)), _SMALLEST)
    relative = (own.deviation.relative if own.deviation else None) or 1.0
    if low.any() or relative < ROUNDING:
        k = int(np.argmax(low))
        raise ValueError(
            f"{columns.name}, line {columns.lines[k]}: the {_DEVIATION} of {column}, "
            f"{relative if relative < ROUNDING else found[k]:g}, is below the rounding of numbers"
        )
    return found


def _in_si(columns: Columns, key: str, unit: str, difference: bool = False) -> np.ndarray:
    """Numbers of a column in a unit; of differences without the offset of a temperature scale."""
    try:
        return np.array([_number(value, unit, difference) for value in columns.values[key]])
    except ValueError as error:
        raise ValueError(f"{columns.name}: {key}: {error}") from None


def _number(value: str | float, unit: str, difference: bool) -> float:
    if not isinstance(value, str):
        if not registry().Quantity(1.0, unit_of(unit)).dimensionless:
            raise ValueError(f"found the plain number {value:g}; must be in {unit}")
        return value
    given = parse(value, f"1 {unit}")
    if not given.is_compatible_with(unit_of(unit)):
        product = "; a product has a space, as in kN m" if value.endswith("Nm") else ""
        raise ValueError(f"found the unit {given.units:~P}; must be in {unit}{product}")
    found = given.to(unit_of(unit)).magnitude
    if difference:
        zero = registry().Quantity(0.0, given.units)
        found -= zero.to(unit_of(unit)).magnitude
    return float(found)


def _densities(case: AnyCase, contact: str | None) -> dict[int, float]:
    """Densities of both bodies of a contact, where they have one [kg/m³].

    Without the name of a contact they are those of all contacts, as far as these agree.
    """
    found: dict[int, float] = {}
    for number, bodies in enumerate(zip(*_pairs(case, contact), strict=True), 1):
        densities = {case.located_material(body)[1].density for body in bodies}
        density = densities.pop()
        if density is not None and not densities:
            found[number] = density
    return found


def _pairs(case: AnyCase, contact: str | None) -> list[tuple[str, ...]]:
    """Bodies of each contact, or of one of them."""
    if not isinstance(case, AssemblyCase):
        return [tuple(case.geometry.bodies[:2])]
    return [
        tuple(map(case.geometry.body_of, table.between or ()))
        for name, table in case.sliding.items()
        if contact in (None, name)
    ]
