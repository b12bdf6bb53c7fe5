"""Tables of results for the report: few rows, in the units of plots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...results.quantity import TABLES, Quantity, from_key
from ...results.summary_keys import of_key
from ..files import name_at, states
from ..tables import TableColumns, read
from .figures import number

_ROWS = 20


@dataclass(frozen=True)
class ShownTable:
    """Table of a report as text.

    Attributes
    ----------
    caption, note : str
    heads : list of Quantity
    rows : list of list of str
    """

    caption: str
    note: str
    heads: list[Quantity]
    rows: list[list[str]]


def shown_table(
    caption: str,
    columns: Mapping[str, np.ndarray],
    quantities: Mapping[str, Quantity],
    source: str,
) -> ShownTable:
    """Table of at most twenty rows, including first and last, of the columns with content."""
    total = len(next(iter(columns.values()), ()))
    chosen = np.unique(np.linspace(0, total - 1, min(total, _ROWS)).round().astype(int))
    full = {name: v for name, v in columns.items() if (np.isfinite(v) & (v != 0)).any()}
    heads = [quantities[name] for name in full]
    drawn = [head.drawn(values[chosen]) for head, values in zip(heads, full.values(), strict=True)]
    rows = [[number(float(value)) for value in row] for row in zip(*drawn, strict=True)]
    note = f"{len(chosen)} of {total} rows of {source}" if len(chosen) < total else f"from {source}"
    if len(full) < len(columns):
        note += "; empty columns are left out"
    return ShownTable(caption, note, heads, rows)


def output_times(folder: Path, end: float | None) -> dict[str, np.ndarray]:
    """Extremes and totals at the output times by header, one row per time; empty without them.

    Parameters
    ----------
    folder : Path
    end : float or None
        Final time, to which the tables without a time in their names belong [s].
    """
    found: dict[float, dict[str, float]] = {}
    for stem in _TOTALS:
        for time, path in states(folder, stem).items():
            found.setdefault(time, {}).update(_totals(stem, read(path)))
    if not found:
        return {}
    for stem in _TOTALS:
        path = folder / name_at(stem, None)
        if end is not None and path.is_file():
            found.setdefault(end, {}).update(_totals(stem, read(path)))
    times = sorted(found)
    headers = dict.fromkeys(header for time in times for header in found[time])
    rows = {h: np.array([found[time].get(h, np.nan) for time in times]) for h in headers}
    return {"time_s": np.array(times)} | rows


def _totals(stem: str, points: TableColumns) -> dict[str, float]:
    """Extremes over the contact points, and integrals over the contact, by header."""
    if "weight" not in points or not points["weight"].size:
        return {}
    return {
        quantity.header: float(reduce(points[name], points["weight"]))
        for quantity, name, reduce in _TOTALS[stem]
        if name in points
    }


_interface, _history, _cycles, _loads = (
    TABLES[stem].columns for stem in ("interface", "history", "cycles", "loads")
)
_TOTALS = {
    "interface": (
        (_history["max_pressure"], "pressure", lambda p, w: p.max()),
        (_history["contact_area"], "pressure", lambda p, w: w[p > 0].sum()),
        (of_key("shape_range_m"), "shape", lambda h, w: np.ptp(h)),
        (_cycles["max_wear_1"], "wear_1", lambda depth, w: depth.max()),
        (_cycles["max_wear_2"], "wear_2", lambda depth, w: depth.max()),
        (_history["wear_volume_1"], "wear_1", lambda depth, w: w @ depth),
        (_history["wear_volume_2"], "wear_2", lambda depth, w: w @ depth),
        (_interface["temperature_1"], "temperature_1", lambda T, w: T.max()),
        (_interface["temperature_2"], "temperature_2", lambda T, w: T.max()),
    ),
    "friction": (
        (_loads["stick_area"], "status", lambda status, w: w[status == 1].sum()),
        (from_key("max_shear_Pa", "largest shear", "MPa"), "shear", lambda t, w: np.abs(t).max()),
        (from_key("max_slip_m", "largest slip", "µm"), "slip", lambda s, w: np.abs(s).max()),
        (_cycles["dissipated"], "dissipated", lambda energy, w: w @ energy),
    ),
}
"""Extremes and totals of each table: quantity, column, and its reduction with the area weights."""

AT_TIMES = {
    quantity.header: quantity
    for quantity in (_history["time"], *(q for rows in _TOTALS.values() for q, _, _ in rows))
}
"""Quantities of the table of output times by header."""
