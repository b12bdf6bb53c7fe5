"""Curves over time: pressure, worn volumes and heat of a running-in; loads of fretting."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes

from .. import tables
from ..files import bodies_of, contacts_of
from .panels import BODIES, column, from_zero, plot_columns, times

_ROWS = 6  # of a legend of bodies or contacts
_WIDTH = 1.8  # of a column of that legend [inches]


def draw_history(folder: Path) -> None:
    """Draw ``history.png``: largest pressure and, with wear, worn volume over time."""
    data = tables.read(folder / "history.csv")
    if len(data["time"]) < 2:
        return
    contacts = _contacts(folder)
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"][-1] > 0]
    options = {"margin": (_beside(len(contacts)), 0.0), "sharex": False}
    with column(folder / "history.png", 2 if worn else 1, 2.7, **options) as (upper, *lower):
        for name, rows in (contacts or {"": data}).items():
            style = {"label": name} if contacts else {"color": "tab:red"}
            plot_columns(upper, rows.rows(np.s_[1:]), "time", "max_pressure", **style)
        if contacts:
            _legend(upper, len(contacts))
        upper.set_xscale("log")
        from_zero(upper)
        upper.set_xlabel(f"{times(data)[0]}, logarithmic")
        for axis in lower:
            if contacts:
                _plot_by_body(axis, folder, contacts, "wear_volume", np.add)
            else:
                _plot_bodies(axis, data, "time", "wear_volume", worn)
                axis.legend()


def draw_heat(folder: Path) -> None:
    """Draw ``heat.png``: surface temperatures, friction power and largest pressure over time."""
    heat = tables.read(folder / "heat.csv")
    history = tables.read(folder / "history.csv")
    if len(heat["time"]) < 2:
        return
    contacts = _contacts(folder)
    below = [(heat, "friction_power", "tab:green")] if np.any(heat["friction_power"]) else []
    below.append((history, "max_pressure", "tab:red"))
    beside = _beside(len(contacts) + 1 if contacts else 0)
    options = {"margin": (beside, 1.05), "height_ratios": (1.6, *[1] * len(below))}
    with column(folder / "heat.png", 1 + len(below), 1.85, **options) as (upper, *others):
        if contacts:
            _plot_by_body(upper, folder, contacts, "max_temperature", np.maximum)
            upper.set_xlabel("")
        else:
            _plot_temperatures(upper, heat)
        for axis, (data, name, color) in zip(others, below, strict=True):
            plot_columns(axis, data, "time", name, color=color)
            axis.set_ylabel(data.quantities[name].wrapped)
            from_zero(axis)


def draw_loads(folder: Path) -> None:
    """Draw ``loads.png``: tangential force over displacement, and dissipated energy."""
    data, contacts = tables.read(folder / "loads.csv"), _contacts(folder, "sticking")
    options = {"margin": (_beside(len(contacts)), 0.0), "sharex": False}
    with column(folder / "loads.png", 2, 2.8, **options) as (upper, lower):
        plot_columns(upper, data, "tangential_displacement", "tangential_force", color="tab:blue")
        for name, rows in (contacts or {"": data}).items():
            style = {"label": name} if contacts else {"color": "tab:red"}
            plot_columns(lower, rows, "time", "dissipated", **style)
        if contacts:
            _legend(lower, len(contacts))


def draw_cycles(folder: Path) -> None:
    """Draw ``cycles.png``: largest wear depth and worn volume of both bodies over the cycles.

    Of several bodies, the worn volume of each at the ends of the computed cycles, over time.
    """
    data, contacts = tables.read(folder / "cycles.csv"), _contacts(folder)
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"].max(initial=0.0) > 0]
    if not worn or len(data["cycle"]) < 2:
        return
    if contacts:
        with column(folder / "cycles.png", 1, 2.7, margin=(_beside(len(contacts)), 0.0)) as (axis,):
            ends = {
                name: rows.rows(np.isin(rows["time"], data["time"]))
                for name, rows in contacts.items()
            }
            _plot_by_body(axis, folder, ends, "wear_volume", np.add)
            from_zero(axis)
        return
    with column(folder / "cycles.png", 2, 2.5) as axes:
        for axis, name in zip(axes, ("max_wear", "wear_volume"), strict=True):
            _plot_bodies(axis, data, "cycle", name, worn)
            from_zero(axis)
        axes[0].legend()
        axes[1].set_xlabel("cycles")


def _contacts(folder: Path, stem: str = "contacts") -> dict[str, tables.TableColumns]:
    """Rows of each contact of several bodies by its name; empty for a pair."""
    if not (folder / f"{stem}.csv").is_file():
        return {}
    data = tables.read(folder / f"{stem}.csv")
    names = enumerate(contacts_of(folder), start=1)
    return {name: data.rows(data["contact"] == number) for number, name in names}


def _plot_temperatures(axis: Axes, heat: tables.TableColumns) -> None:
    """Plot largest and mean temperatures of both faces of a pair."""
    for body, color in enumerate(BODIES, 1):
        for kind, word, line in (("max", "largest", "-"), ("mean", "mean", "--")):
            name = f"{kind}_temperature_{body}"
            label = f"{heat.quantities[name].body}, {word}"
            plot_columns(axis, heat, "time", name, color=color, linestyle=line, label=label)
    axis.set_ylabel(f"surface\ntemperature [{heat.quantities['max_temperature_1'].unit}]")
    axis.legend(ncols=2)


def _plot_by_body(
    axis: Axes,
    folder: Path,
    contacts: dict[str, tables.TableColumns],
    name: str,
    both: Callable[[np.ndarray, np.ndarray], np.ndarray],
) -> None:
    """Plot a quantity of each of several bodies, combined over its contacts; zeros are left out."""
    found: dict[str, np.ndarray] = {}
    for contact, rows in contacts.items():
        for side, body in enumerate(bodies_of(folder, contact), start=1):
            values = rows[f"{name}_{side}"]
            found[body] = both(found[body], values) if body in found else values
    data = next(iter(contacts.values()))
    shown = {body: values for body, values in found.items() if np.any(values)}
    several = mpl.colormaps["tab20" if len(shown) > 10 else "tab10"]
    axis.set_prop_cycle(color=several(range(max(len(shown), 1))))
    quantity = data.quantities[f"{name}_1"].of_both
    label, time = times(data)
    for body, values in shown.items():
        axis.plot(time, quantity.drawn(values), label=body)
    axis.set_xlabel(label)
    axis.set_ylabel(quantity.wrapped)
    _legend(axis, len(shown))


def _legend(axis: Axes, count: int) -> None:
    """Show names of bodies or contacts beside the curves, in as many columns as they need."""
    axis.legend(
        loc="center left",
        bbox_to_anchor=(1.0, 0.5),
        fontsize="small",
        labelspacing=0.3,
        ncols=-(-count // _ROWS),
    )


def _beside(count: int) -> float:
    """Width of a legend beside the curves [inches]."""
    return -(-count // _ROWS) * _WIDTH


def _plot_bodies(
    axis: Axes, data: tables.TableColumns, x: str, name: str, bodies: list[int]
) -> None:
    """Plot a quantity of the bodies of a pair."""
    for body in bodies:
        column_name = f"{name}_{body}"
        style = {"color": BODIES[body - 1], "label": data.quantities[column_name].body}
        plot_columns(axis, data, x, column_name, **style)
