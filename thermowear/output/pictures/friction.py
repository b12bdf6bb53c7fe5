"""Stick, slip and fretting wear along the contact, over the load history, and over cycles."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np

from .. import tables
from ..coordinates import read_summary
from ..names import states
from .curves import BODIES, abscissa, from_zero, panels


def draw_friction(folder: Path) -> None:
    """Draw ``friction.png``: shear with its Coulomb limits, and slip, at the output times."""
    files = {f"{time:.4g} s": path for time, path in states(folder, "friction").items()}
    data = {k: tables.read(f) for k, f in (files | {"end": folder / "friction.csv"}).items()}
    colors = mpl.colormaps["viridis"](np.linspace(0.85, 0.0, len(data)))
    with panels(folder / "friction.png", 2, (6.4, 5.6), sharex=True) as (upper, lower):
        for (name, table), color in zip(data.items(), colors, strict=True):
            label, place = abscissa(table)
            upper.plot(place, table.drawn("shear"), color=color, label=name)
            slipping = np.where(table["pressure"] > 0, table.drawn("slip"), np.nan)
            lower.plot(place, slipping, color=color)
        limit = (read_summary(folder).get("friction") or np.nan) * table.drawn("pressure")
        upper.plot(place, limit, color="0.5", linestyle=":", label="friction · pressure")
        upper.plot(place, -limit, color="0.5", linestyle=":")
        pressed = place[table["pressure"] > 0]
        margin = 0.1 * np.ptp(pressed)
        lower.set_xlim(pressed.min() - margin, pressed.max() + margin)
        lower.locator_params(axis="x", nbins=7)
        upper.set_ylabel(table.quantities["shear"].axis)
        lower.set_ylabel(table.quantities["slip"].axis)
        lower.set_xlabel(label)
        upper.legend(title="time", loc="center left", bbox_to_anchor=(1.0, 0.5))


def draw_loads(folder: Path) -> None:
    """Draw ``loads.png``: tangential force over displacement, and dissipated energy."""
    data = tables.read(folder / "loads.csv")
    curves = (
        ("tangential_displacement", "tangential_force", "tab:blue"),
        ("time", "dissipated", "tab:red"),
    )
    with panels(folder / "loads.png", 2, (6.4, 5.6)) as axes:
        for axis, (x, y, color) in zip(axes, curves, strict=True):
            axis.plot(data.drawn(x), data.drawn(y), color=color)
            axis.set_xlabel(data.quantities[x].axis)
            axis.set_ylabel(data.quantities[y].axis)


def draw_cycles(folder: Path) -> None:
    """Draw ``cycles.png``: largest wear depth and worn volume of both bodies over the cycles."""
    data = tables.read(folder / "cycles.csv")
    worn = [body for body in (1, 2) if data[f"wear_volume_{body}"].max(initial=0.0) > 0]
    if not worn or len(data["cycle"]) < 2:
        return
    with panels(folder / "cycles.png", 2, (6.4, 5.0), sharex=True) as axes:
        for axis, name in zip(axes, ("max_wear", "wear_volume"), strict=True):
            for body in worn:
                drawn = data.drawn(f"{name}_{body}")
                axis.plot(data["cycle"], drawn, color=BODIES[body - 1], label=f"body {body}")
            from_zero(axis)
            axis.set_ylabel(data.quantities[f"{name}_1"].of_both.axis)
        axes[0].legend()
        axes[1].set_xlabel("cycles")
