"""Critical speeds by the number of hot spots, and growth of the first ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from .. import tables
from .panels import column

_SYMMETRIES = {
    0: ("any symmetry", "tab:blue"),
    -1: ("antisymmetric", "tab:red"),
    1: ("symmetric", "tab:blue"),
}
_SHOWN = 12.0
"""Critical speeds up to this multiple of the lowest one are shown."""


def draw_hot_spots(folder: Path) -> None:
    """Draw ``hot_spots.png``."""
    modes = tables.read(folder / "hot_spots.csv")
    path = folder / "growth.csv"
    growth = tables.read(path) if path.is_file() else None
    with column(folder / "hot_spots.png", 1 if growth is None else 2, 3.2, sharex=False) as (
        upper,
        *lower,
    ):
        _draw_critical(upper, modes)
        for axis in lower:
            assert growth is not None
            _draw_growth(axis, growth)


def _draw_critical(axis: Axes, modes: tables.TableColumns) -> None:
    """Critical speeds by number, relative to the speed of the case."""
    along = "number" if len(np.unique(modes["number"])) > 1 else "wave_number"
    worn = np.isfinite(modes["speed_factor_with_wear"]).any()
    for symmetry in sorted(set(modes["symmetry"].astype(int))):
        label, color = _SYMMETRIES[symmetry]
        own = modes.rows(modes["symmetry"] == symmetry)
        own = own.rows(np.argsort(own[along]))
        x = own.drawn(along)
        axis.plot(x, own["speed_factor"], "o-", color=color, markersize=4, label=label)
        if worn:
            axis.plot(
                *(x, own["speed_factor_with_wear"], "x--"),
                color=color,
                markersize=5,
                label=f"{label}, with wear",
            )
    lowest = np.nanmin(modes["speed_factor"], initial=np.inf)
    highest = np.nanmax(modes["speed_factor"], initial=0.0)
    if np.isfinite(lowest):
        axis.set_ylim(0.0, 1.08 * max(min(highest, _SHOWN * lowest), 1.0))
    axis.margins(x=0.03)
    axis.axhline(1.0, color="0.5", linewidth=0.8)
    axis.text(
        *(0.995, 1.0, "speed of the case"),
        transform=axis.get_yaxis_transform(),
        ha="right",
        va="bottom",
        color="0.4",
        fontsize=9,
    )
    if along == "number":
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axis.set_xlabel(modes.quantities[along].axis.replace(" [1]", ""))
    axis.set_ylabel("critical speed\nrelative to the case")
    axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize=9)


def _draw_growth(axis: Axes, growth: tables.TableColumns) -> None:
    """Growth rate of the first hot spots over the speed."""
    x = growth["speed_factor"]
    axis.plot(x, growth["growth_rate"], ".-", color="tab:red", label="without wear")
    if np.isfinite(growth["growth_rate_with_wear"]).any():
        axis.plot(x, growth["growth_rate_with_wear"], "x--", color="tab:green", label="with wear")
        axis.legend(fontsize=9)
    axis.axhline(0.0, color="0.5", linewidth=0.8)
    axis.set_xlabel("speed relative to the case")
    axis.set_ylabel("growth rate\nof the first hot spots [1/s]")
