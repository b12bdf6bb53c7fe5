"""Curves of a variant for bands: its history, and the points of the contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...inference import quantiles
from ...results import Result
from ...results.points import InterfaceFields, by_contact
from ...results.quantity import table_of
from ...results.rows import HistoryRow

HISTORY = (
    *("max_pressure", "wear_volume_1", "wear_volume_2"),
    *("max_temperature", "max_wear_1", "max_wear_2"),
)
"""Columns of the history with bands."""
POINTS = ("pressure", "shape", "wear_1", "wear_2", "temperature_1", "temperature_2")
"""Columns of the contact points with bands."""
PLACES = ("x", "y", "z", "s")
_MOST_ROWS = 200
Curves = dict[str, dict[str, np.ndarray]]
"""Columns by table."""


def curves_of(result: Result, room: int) -> Curves:
    """Curves of a result.

    Parameters
    ----------
    result : Result
    room : int
        Largest number of values; points of a contact that need more are left out.

    Returns
    -------
    dict of str to dict of str to ndarray
        Columns of ``history`` and of ``interface`` (``interface_CONTACT`` of several bodies) by
        the names of the fields.
    """
    found: Curves = {}
    if result.history:
        rows = result.history
        count = max(2, min(_MOST_ROWS, room // (len(HISTORY) + 1)))
        kept = np.unique(np.linspace(0, len(rows) - 1, count).round().astype(int))
        found["history"] = _columns([rows[k] for k in kept], ("time", *HISTORY))
    points = by_contact(result.interface, result.contacts) or {"": result.interface}
    for name, own in points.items():
        columns = _columns(own, (*PLACES, *POINTS))
        if len(own.x) * len(columns) * len(points) <= room:
            found[f"{table_of(own).stem}_{name}" if name else table_of(own).stem] = columns
    return found


def _columns(source: Any, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Columns of rows or points that have values, and are not zero everywhere."""
    rows = source if isinstance(source, list) else None
    every = {
        name: np.array([getattr(row, name) for row in rows] if rows else getattr(source, name))
        for name in names
    }
    return {
        name: np.asarray(values, dtype=np.float32)
        for name, values in every.items()
        if np.isfinite(values).all() and (name in ("time", *PLACES) or np.any(values != 0.0))
    }


LEVELS = {"2.5": 0.025, "50": 0.5, "97.5": 0.975}
"""Quantiles of bands by their names in columns."""
_TIMES = 200
_SAME = 1e-5
"""Distance of points that are the same, relative to the size of the contact."""
Columns = dict[str, np.ndarray]


@dataclass(frozen=True)
class Bands:
    """Bands of curves.

    Attributes
    ----------
    tables : dict of str to dict of str to ndarray
        Columns by header (``max_pressure_Pa_97.5``), by the stem of the table.
    notes : tuple of str
        Reasons for what is missing, or deviates.
    """

    tables: dict[str, Columns] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def bands(curves: Sequence[Curves], stratified: bool = False) -> Bands:
    """Bands of the curves of all variants that have them, of all of a stratified sample or not."""
    tables: dict[str, Columns] = {}
    notes: list[str] = []
    for stem in dict.fromkeys(stem for own in curves for stem in own):
        found = [own[stem] for own in curves if stem in own]
        if len(found) < 2:
            continue
        of_all = stratified and len(found) == len(curves)
        columns, note = (_over_time if stem == "history" else _at_points)(found, of_all)
        if columns:
            tables[stem] = columns
        notes += [f"bands_{stem}.csv: {note}"] if note else []
    return Bands(tables, tuple(notes))


def _over_time(found: Sequence[Columns], stratified: bool) -> tuple[Columns, str]:
    """Bands of histories up to the earliest end, at times where the steps are dense."""
    ends = np.array([own["time"][-1] for own in found], dtype=float)
    end = ends.min()
    steps = np.concatenate([own["time"] for own in found]).astype(float)
    steps = np.sort(steps[steps <= end])
    if all(np.array_equal(own["time"], found[0]["time"]) for own in found):
        times = found[0]["time"].astype(float)
    else:
        times = np.unique(np.quantile(steps, np.linspace(0, 1, _TIMES)))
    curves = {
        name: np.array([np.interp(times, own["time"], own[name]) for own in found], np.float32)
        for name in HISTORY
        if all(name in own for own in found)
    }
    note = f"up to {end:.6g} s, the end of the shortest run" if np.ptp(ends) > 1e-6 * end else ""
    named = table_of(HistoryRow).columns
    columns = {named["time"].header: times}
    own = {named[name].header: curve for name, curve in curves.items()}
    return columns | _quantiles(own, stratified), note


def _at_points(found: Sequence[Columns], stratified: bool) -> tuple[Columns, str]:
    """Bands at the contact points of all variants, or at those of the first one."""
    first, note = found[0], ""
    places = [name for name in PLACES if name in first]
    size = max(float(np.ptp(first[name])) for name in places)
    names = [name for name in POINTS if all(name in own for own in found)]
    if all(_coincide(own, first, places, _SAME * size) for own in found):
        curves = {name: np.array([own[name] for own in found]) for name in names}
    else:
        if not all(np.all(np.diff(own["x"]) > 0) for own in found):
            return {}, "left out, as the contact points differ between the variants"
        curves = {
            name: np.array([_interpolated(first["x"], own, name) for own in found], np.float32)
            for name in names
        }
        note = "interpolated on x, as the contact points differ between the variants"
    named = table_of(InterfaceFields).columns
    columns = {named[name].header: first[name].astype(float) for name in places}
    own = {named[name].header: curve for name, curve in curves.items()}
    return columns | _quantiles(own, stratified), note


def _coincide(own: Columns, first: Columns, places: Sequence[str], near: float) -> bool:
    return all(
        name in own
        and len(own[name]) == len(first[name])
        and np.abs(own[name] - first[name]).max() <= near
        for name in places
    )


def _interpolated(x: np.ndarray, own: Columns, name: str) -> np.ndarray:
    """Column at other places; NaN beyond the contact points."""
    return np.interp(x, own["x"], own[name], np.nan, np.nan)


def _quantiles(curves: dict[str, np.ndarray], stratified: bool) -> Columns:
    """Quantiles of curves (n, m) by header and level."""
    columns: Columns = {}
    for header, values in curves.items():
        found = quantiles(values, list(LEVELS.values()), stratified)
        columns |= {f"{header}_{word}": row for word, row in zip(LEVELS, found, strict=True)}
    return columns
