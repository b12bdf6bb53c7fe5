"""``sweep.png``: the numbers that matter against the swept key."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from .. import tables
from ..pictures.curves import STYLE
from ..quantities import INTERFACE, Quantity
from .layout import LINES, Layout, is_wide
from .legend import add_legend, tallest
from .record import Record

_SAME = 1e-6
"""Numbers that differ by less, relative to their size, are one."""
_MARKED = 25
_LISTED = 24  # entries of a legend
_NUMBERS = {
    "max_pressure_Pa": Quantity("", "largest pressure", "MPa", 1e-6),
    "place": Quantity("", "place of the largest pressure, x", "mm", 1e3),
    "max_temperature_K": Quantity("", "highest temperature", "°C", 1.0, -273.15),
    "peak_temperature_K": Quantity(
        "", "highest temperature of the faces on the way", "°C", 1.0, -273.15
    ),
    "heat_carried_out_W": Quantity("", "heat carried out", "W"),
    "shape_range_m": Quantity("", "range of the worn shape", "µm", 1e6),
    "rigid_wear_velocity_m_per_s": Quantity("", "wear rate along the press", "nm/s", 1e9),
    "friction_power_W": Quantity("", "friction power", "W"),
    "wear_volume_1_m3": Quantity("", "worn volume, body 1", "mm³", 1e9),
    "wear_volume_2_m3": Quantity("", "worn volume, body 2", "mm³", 1e9),
    "contact_area_m2": Quantity("", "contact area", "mm²", 1e6),
    "guide_force_N": Quantity("", "force on the guide", "N"),
    "approach_m": Quantity("", "approach", "µm", 1e6),
    "critical_speed_m_per_s": Quantity("", "critical speed", "m/s"),
    "critical_speed_with_wear_m_per_s": Quantity("", "critical speed with wear", "m/s"),
    "critical_angular_velocity_rad_per_s": Quantity("", "critical speed", "rad/s"),
    "critical_angular_velocity_with_wear_rad_per_s": Quantity(
        "", "critical speed with wear", "rad/s"
    ),
    "growth_rate_per_s": Quantity("", "growth rate", "1/s"),
    "dissipated_energy_J": Quantity("", "energy dissipated", "mJ", 1e3),
}


def draw_numbers(layout: Layout, path: Path) -> None:
    """Draw what varies, and say what does not."""
    record, numbers = layout.record, _numbers(layout.record)
    varying = {name: values for name, values in numbers.items() if _varies(values)}
    same = {name: values[0] for name, values in numbers.items() if name not in varying}
    if not varying:
        return
    across = min(2, len(varying))
    down = -(-len(varying) // across)
    with mpl.rc_context(STYLE):
        size = (4.0 * across + 0.6, 2.5 * down + 0.6)
        figure = Figure(figsize=size, layout="constrained", dpi=150)
        axes = figure.subplots(down, across, sharex=True, squeeze=False)
        for axis, (name, values) in zip(axes.ravel(), varying.items(), strict=False):
            _draw(axis, layout, _NUMBERS[name].drawn(values))
            axis.set_ylabel(f"{_NUMBERS[name].label}\n[{_NUMBERS[name].unit}]")
        for axis in axes.ravel()[len(varying) :]:
            axis.set_visible(False)
        for axis in axes.ravel()[: len(varying)][-across:]:
            axis.set_xlabel(layout.axis.label)
            axis.tick_params(labelbottom=True)
        handles = axes[0, 0].get_lines()[:_LISTED]
        if len(handles) > 1:
            title = ", ".join(record.axes[k].key for k in _others(layout))
            add_legend(figure, "outside lower center", title, handles)
            figure.set_figheight(size[1] + tallest([handles]))
        if same:
            figure.suptitle(f"the same in all: {_listed(same)}", fontsize="small")
        figure.savefig(path)


def _draw(axis, layout: Layout, values: np.ndarray) -> None:
    """A line for each combination of the other keys."""
    record = layout.record
    others = _others(layout)
    across = layout.axis.numbers or tuple(range(len(layout.axis.words)))
    for number, combination in enumerate(np.unique(record.places[:, others], axis=0)):
        chosen = np.flatnonzero((record.places[:, others] == combination).all(axis=1))
        x = np.array([across[place] for place in record.places[chosen, layout.colored]])
        order = np.argsort(x)
        named = [record.axes[k].words[place] for k, place in zip(others, combination, strict=True)]
        axis.plot(
            x[order],
            values[chosen][order],
            LINES[number // 10 % len(LINES)],
            color=f"C{number % 10}",
            marker="o" if len(across) <= _MARKED else None,
            markersize=3.5,
            label=", ".join(named),
        )
    if layout.axis.numbers is None:
        axis.set_xticks(across, layout.axis.words)
        axis.margins(x=0.1)
    elif is_wide(across):
        axis.set_xscale("log")


def _others(layout: Layout) -> list[int]:
    """Keys with several values beside the one along the axis."""
    axes = layout.record.axes
    return [k for k in range(len(axes)) if k != layout.colored and len(axes[k].words) > 1]


def _numbers(record: Record) -> dict[str, np.ndarray]:
    """Numbers of the summaries that exist in all variants, and where the pressure is largest."""
    found = record.numbers | {"place": np.array([_place(f) for f in record.folders])}
    known = {name: found[name] for name in _NUMBERS if name in found}
    return {
        name: values for name, values in known.items() if np.isfinite(values).all() and values.any()
    }


def _place(folder: Path) -> float:
    data = tables.read(folder / "interface.csv", INTERFACE)
    return float(data["x"][np.argmax(data["pressure"])])


def _varies(values: np.ndarray) -> bool:
    return bool(np.ptp(values) > _SAME * np.abs(values).max())


def _listed(same: dict[str, float]) -> str:
    return "; ".join(
        f"{_NUMBERS[name].label} {_NUMBERS[name].drawn(value):.6g} {_NUMBERS[name].unit}"
        for name, value in same.items()
    )
