"""Tables of results for the report: few rows, in the units of plots."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..coordinates import in_model
from ..quantities import (
    CYCLES,
    FRICTION,
    HEAT,
    HISTORY,
    INTERFACE,
    LOADS,
    PROFILE,
    TRACK,
    Quantity,
)
from .engineering import multiple, number, split_key

_ROWS = 20
_EXTREMES = {
    "shape": Quantity("shape_range_m", "peak-to-valley of the worn shape", "µm", 1e6),
    "wear_1": Quantity("max_wear_1_m", "deepest wear, body 1", "µm", 1e6),
    "wear_2": Quantity("max_wear_2_m", "deepest wear, body 2", "µm", 1e6),
    "shear": Quantity("max_shear_Pa", "largest shear", "MPa", 1e-6),
    "slip": Quantity("max_slip_m", "largest slip", "µm", 1e6),
}
_TABLES = (INTERFACE, PROFILE, HISTORY, HEAT, FRICTION, LOADS, CYCLES, TRACK, _EXTREMES)
_KNOWN = {quantity.header: quantity for table in _TABLES for quantity in table.values()}
_AT_A_TIME = re.compile(r"(interface|friction)_([-+.0-9e]+)\.csv")

Columns = dict[str, np.ndarray]  # by header, in SI


@dataclass(frozen=True)
class Table:
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


def read_columns(path: Path) -> Columns:
    """Read all columns of a CSV file; an incomplete last line is ignored.

    Raises
    ------
    ValueError
        If the file is not a table of numbers.
    """
    try:
        text = path.read_text(encoding="utf-8")
        head, *rows = csv.reader(text[: text.rfind("\n") + 1].splitlines())
        values = np.array([[float(cell) for cell in row] for row in rows])
        return dict(zip(head, values.reshape(len(rows), len(head)).T, strict=True))
    except ValueError:
        raise ValueError(f"{path}: is not a table of numbers with headers") from None


def shown_table(caption: str, columns: Columns, source: str, model: str) -> Table:
    """Table of at most twenty rows, including first and last, of the columns with content.

    Labels name the coordinates as the kinematic model does.
    """
    total = len(next(iter(columns.values()), ()))
    chosen = np.unique(np.linspace(0, total - 1, min(total, _ROWS)).round().astype(int))
    full = {h: v for h, v in columns.items() if (np.isfinite(v) & (v != 0)).any()}
    heads = [in_model(_quantity(header, values), model) for header, values in full.items()]
    drawn = [head.drawn(values[chosen]) for head, values in zip(heads, full.values(), strict=True)]
    rows = [[number(float(value)) for value in row] for row in zip(*drawn, strict=True)]
    note = f"{len(chosen)} of {total} rows of {source}" if len(chosen) < total else f"from {source}"
    if len(full) < len(columns):
        note += "; empty columns are left out"
    return Table(caption, note, heads, rows)


def output_times(folder: Path, end: float | None) -> Columns:
    """Extremes and totals at the output times, one row per time; empty without output times.

    Parameters
    ----------
    folder : Path
    end : float or None
        Final time, to which the tables without a time in their names belong [s].
    """
    states: dict[float, dict[str, float]] = {}
    for path in sorted(folder.iterdir(), reverse=True):  # interface before friction
        at_a_time = _AT_A_TIME.fullmatch(path.name)
        if at_a_time:
            time = float(at_a_time[2])
            states.setdefault(time, {}).update(_totals(at_a_time[1], read_columns(path)))
    if not states:
        return {}
    for stem in ("interface", "friction"):
        if end is not None and (folder / f"{stem}.csv").is_file():
            totals = _totals(stem, read_columns(folder / f"{stem}.csv"))
            states.setdefault(end, {}).update(totals)
    times = sorted(states)
    headers = dict.fromkeys(header for time in times for header in states[time])
    rows = {h: np.array([states[time].get(h, np.nan) for time in times]) for h in headers}
    return {"time_s": np.array(times)} | rows


def _totals(stem: str, points: Columns) -> dict[str, float]:
    """Extremes over the contact points, and integrals over the contact."""
    if not points.get("weight_m2", np.empty(0)).size:
        return {}
    w = points["weight_m2"]
    wanted = _OF_INTERFACE if stem == "interface" else _OF_FRICTION
    return {
        header: float(reduce(points[column], w))
        for header, (column, reduce) in wanted.items()
        if column in points
    }


_OF_INTERFACE = {
    "max_pressure_Pa": ("pressure_Pa", lambda p, w: p.max()),
    "contact_area_m2": ("pressure_Pa", lambda p, w: w[p > 0].sum()),
    "shape_range_m": ("shape_m", lambda h, w: np.ptp(h)),
    "max_wear_1_m": ("wear_1_m", lambda depth, w: depth.max()),
    "max_wear_2_m": ("wear_2_m", lambda depth, w: depth.max()),
    "wear_volume_1_m3": ("wear_1_m", lambda depth, w: w @ depth),
    "wear_volume_2_m3": ("wear_2_m", lambda depth, w: w @ depth),
    "temperature_1_K": ("temperature_1_K", lambda T, w: T.max()),
    "temperature_2_K": ("temperature_2_K", lambda T, w: T.max()),
}
_OF_FRICTION = {
    "stick_area_m2": ("status", lambda status, w: w[status == 1].sum()),
    "max_shear_Pa": ("shear_Pa", lambda shear, w: np.abs(shear).max()),
    "max_slip_m": ("slip_m", lambda slip, w: np.abs(slip).max()),
    "dissipated_J": ("dissipated_J_per_m2", lambda energy, w: w @ energy),
}


def _quantity(header: str, values: np.ndarray) -> Quantity:
    """Label and unit of a column; an unknown column gets a unit that suits its size."""
    if header in _KNOWN:
        return _KNOWN[header]
    name, si = split_key(header)
    unit, scale = multiple(si, float(np.abs(values[np.isfinite(values)]).max(initial=0.0)))
    return Quantity(header, name, unit, scale)
