"""Curves along the contact (pressure, temperatures, shape, wear, friction), and over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from .. import tables
from ..files import name_at, picture, read_summary, states
from .panels import (
    BODIES,
    abscissa,
    column,
    from_zero,
    plot_along,
    plot_columns,
    time_colors,
    time_legend,
    time_text,
)

_FLAT = 1e-12  # range of the shape up to which a face is flat but for rounding errors [m]
_SAME = 1e-3
"""Relative difference below which both shapes coincide, as on a level face."""
_SMALLEST_RANGE = 1e-2
"""Smallest range of wear rates along the face, relative to their size."""
_DIRECTIONS = (("shape", "height of the unloaded face"), ("wear_rate", "wear rate"))


def interface_panels(data: tables.TableColumns) -> list[list[str]]:
    """Columns of ``interface.csv`` to draw, by panel: pressures, temperatures, shape if worn."""
    shown = [[name for name in ("pressure", "fluid_pressure") if name in data]]
    if np.isfinite(data["temperature_1"]).all():
        shown.append(["temperature_1", "temperature_2"])
    if np.ptp(data["shape"]) > _FLAT:
        shown.append(["shape"])
    return shown


def worn_bodies(data: tables.TableColumns) -> list[str]:
    """Columns of wear depths of the bodies that wear."""
    return [name for name in ("wear_1", "wear_2") if data[name].max() > 0]


def final_time(folder: Path) -> float | None:
    """Time at the end of a run in time, from its history; None without one [s]."""
    for name in ("history.csv", "loads.csv"):
        if (folder / name).is_file():
            return float(tables.read(folder / name)["time"][-1])
    return None


def draw_interface(folder: Path, contact: str = "") -> None:
    """Draw ``interface.png``: pressure, temperatures and shape along the contact."""
    data = tables.read(folder / name_at("interface", None, contact))
    shown = interface_panels(data)
    with column(folder / picture("interface", contact), len(shown), 2.3) as axes:
        for axis, names in zip(axes, shown, strict=True):
            for name, color, line in zip(names, BODIES, ("-", "--"), strict=False):
                label = data.quantities[name].label.split(", ")[-1]
                plot_along(axis, data, name, line, color=color, label=label)
            both = data.quantities[names[0]].of_both
            if "fluid_pressure" in names:
                both = replace(both, label="pressure")
            axis.set_ylabel(both.wrapped)
            if len(names) > 1:
                axis.legend()
        from_zero(axes[0])


def coated_bodies(data: tables.TableColumns) -> list[str]:
    """Columns of what is left of the coatings; empty without any, and in earlier results."""
    names = ("coating_left_1", "coating_left_2")
    return [name for name in names if name in data and np.isfinite(data[name]).any()]


def draw_wear(folder: Path, contact: str = "") -> None:
    """Draw ``wear.png``: pressure and wear depth along the contact at the output times."""
    found = _at_output_times(folder, contact)
    bodies = worn_bodies(found[max(found)]) if found else []
    if bodies:
        shown = ["pressure", *bodies] if len(found) > 1 else bodies
        _draw_states(folder / picture("wear", contact), found, shown, downwards=bodies)


def draw_coating(folder: Path, contact: str = "") -> None:
    """Draw ``coating.png``: what is left of the coatings at the output times."""
    found = _at_output_times(folder, contact)
    bodies = coated_bodies(found[max(found)]) if found else []
    if bodies:
        _draw_states(folder / picture("coating", contact), found, bodies)


def _at_output_times(folder: Path, contact: str) -> dict[float, tables.TableColumns]:
    """Contact points at the output times and at the end; empty for a run without time."""
    end = final_time(folder)
    if end is None:
        return {}
    last = {end: folder / name_at("interface", None, contact)}
    files = last | states(folder, "interface", contact)
    return {time: tables.read(files[time]) for time in sorted(files)}


def _draw_states(
    path: Path,
    found: dict[float, tables.TableColumns],
    shown: list[str],
    downwards: Sequence[str] = (),
) -> None:
    """Draw columns along the contact at several times, some of them downwards."""
    final = found[max(found)]
    with column(path, len(shown), 3.0) as axes:
        for axis, name in zip(axes, shown, strict=True):
            for (time, data), color in zip(found.items(), time_colors(len(found)), strict=True):
                plot_along(axis, data, name, color=color, label=time_text(time, max(found)))
            axis.set_ylabel(final.quantities[name].axis)
            if name in downwards:
                axis.invert_yaxis()
        time_legend(axes[0])


def draw_profile(folder: Path, contact: str = "") -> None:
    """Draw ``profile.png``: worn shape and wear rates of a face that is not level."""
    data = tables.read(folder / name_at("profile", None, contact))
    shown = [(name, label) for name, label in _DIRECTIONS if _depends_on_direction(data, name)]
    if not shown or not np.any(data["wear_rate"] > 0):
        return
    with column(folder / picture("profile", contact), len(shown), 2.6) as axes:
        for axis, (name, label) in zip(axes, shown, strict=True):
            plot_along(axis, data, name, "-", label="along the normal")
            plot_along(axis, data, f"{name}_along_press", "--", label="along the load direction")
            axis.set_ylabel(f"{label}\n[{data.quantities[name].unit}]")
        axes[0].legend()


def _depends_on_direction(data: tables.TableColumns, name: str) -> bool:
    """Test whether a column differs along the normal and along the load direction."""
    along_normal, along_load = data[name], data[f"{name}_along_press"]
    size = max(float(np.ptp(along_normal)), _SMALLEST_RANGE * float(np.abs(along_normal).max()))
    return bool(np.any(np.abs(along_load - along_normal) > _SAME * size))  # NaN is not


def draw_friction(folder: Path, contact: str = "") -> None:
    """Draw ``friction.png``: shear with its Coulomb limits, and slip, at the output times."""
    files = _at_times(folder, "friction", contact)
    found = {label: tables.read(path) for label, path in files.items()}
    summary = read_summary(folder)
    of_contact = summary.get("contacts", {}).get(contact, summary)
    with column(folder / picture("friction", contact), 2, 2.8) as (upper, lower):
        for (label, data), color in zip(found.items(), time_colors(len(found), 0.85), strict=True):
            where, position = abscissa(data)
            upper.plot(position, data.drawn("shear"), color=color, label=label)
            slip = np.where(data["pressure"] > 0, data.drawn("slip"), np.nan)
            lower.plot(position, slip, color=color)
        limit = (of_contact.get("friction") or np.nan) * data.drawn("pressure")
        upper.plot(position, limit, color="0.5", linestyle=":", label="friction · pressure")
        upper.plot(position, -limit, color="0.5", linestyle=":")
        pressed = position[data["pressure"] > 0]
        margin = 0.1 * np.ptp(pressed)
        lower.set_xlim(pressed.min() - margin, pressed.max() + margin)
        lower.locator_params(axis="x", nbins=7)
        upper.set_ylabel(data.quantities["shear"].axis)
        lower.set_ylabel(data.quantities["slip"].axis)
        lower.set_xlabel(where)
        time_legend(upper)


def draw_track(folder: Path, contact: str = "") -> None:
    """Draw ``track.png``: wear depths of both bodies in the middle of the stroke."""
    files = _at_times(folder, "track", contact)
    with column(folder / picture("track", contact), 2, 2.8) as axes:
        for (label, path), color in zip(files.items(), time_colors(len(files)), strict=True):
            moving = tables.read(path.with_name(path.name.replace("track", "interface")))
            both = passing(moving, tables.read(path))
            for axis, (data, name) in zip(axes, both, strict=True):
                plot_columns(axis, data, "x", name, color=color, label=label)
                axis.set_ylabel(data.quantities[name].axis)
        for axis in axes:
            axis.invert_yaxis()
        time_legend(axes[0])


def passing(
    moving: tables.TableColumns, track: tables.TableColumns
) -> list[tuple[tables.TableColumns, str]]:
    """Tables and columns of the wear of a body that passes over another, and of that one."""
    names = ["wear_1", "wear_2"]
    return list(zip((moving, track), names[::-1] if "wear_1" in track else names, strict=True))


def _at_times(folder: Path, stem: str, contact: str) -> dict[str, Path]:
    """Files of a table at the output times and at the end, by the labels of their times."""
    found = states(folder, stem, contact)
    files = {time_text(time, max(found)): path for time, path in found.items()}
    return files | {"end": folder / name_at(stem, None, contact)}
