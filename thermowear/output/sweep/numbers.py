"""``sweep.png``: key figures over the swept key."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...results.quantity import from_key
from ...results.summary_keys import of_key
from .. import tables
from ..coordinates import in_model, model_of
from ..pictures.panels import panels
from .layout import LINES, Layout, add_legend, is_wide, legend_height
from .record import VariantRecord

_EQUAL = 1e-6
"""Relative difference below which numbers are considered equal."""
_MARKED = 25
_LISTED = 24  # entries of a legend
_PLACE = from_key("x_m", "position of the largest pressure, x", "mm")
_KEYS = (
    *("max_pressure_Pa", _PLACE.header, "max_temperature_K", "peak_temperature_K"),
    *("heat_carried_out_W", "shape_range_m", "rigid_wear_velocity_m_per_s", "friction_power_W"),
    *("wear_volume_1_m3", "wear_volume_2_m3", "contact_area_m2", "guide_force_N", "approach_m"),
    *("critical_speed_m_per_s", "critical_speed_with_wear_m_per_s"),
    *("critical_angular_velocity_rad_per_s", "critical_angular_velocity_with_wear_rad_per_s"),
    *("growth_rate_per_s", "dissipated_energy_J"),
)
_NUMBERS = {key: _PLACE if key == _PLACE.header else of_key(key) for key in _KEYS}
"""Quantities that are drawn, by their columns."""


def draw_numbers(layout: Layout, path: Path) -> None:
    """Draw the quantities that vary, and list those that do not in the title."""
    record, numbers = layout.record, _numbers(layout.record)
    model = model_of(record.folders[0])
    shown = {name: in_model(quantity, model) for name, quantity in _NUMBERS.items()}
    varying = {name: values for name, values in numbers.items() if _varies(values)}
    same = {name: values[0] for name, values in numbers.items() if name not in varying}
    if not varying:
        return
    options: dict[str, Any] = {"margin": (0.6, 0.6), "sharex": True}
    with panels(path, len(varying), 2, (4.0, 2.5), **options) as (figure, axes):
        drawn = axes.ravel()[: len(varying)]
        for axis, (name, values) in zip(drawn, varying.items(), strict=True):
            _draw(axis, layout, shown[name].drawn(values))
            axis.set_ylabel(shown[name].wrapped)
        for axis in drawn[-axes.shape[1] :]:
            axis.set_xlabel(layout.axis.label)
            axis.tick_params(labelbottom=True)
        handles = drawn[0].get_lines()[:_LISTED]
        if len(handles) > 1:
            title = ", ".join(record.axes[k].key for k in _others(layout))
            add_legend(figure, "outside lower center", title, handles)
            figure.set_figheight(figure.get_figheight() + legend_height(handles))
        if same:
            listed = (
                f"{shown[k].label} {shown[k].drawn(v):.6g} {shown[k].unit}" for k, v in same.items()
            )
            figure.suptitle(f"constant: {'; '.join(listed)}", fontsize="small")


def _draw(axis, layout: Layout, values: np.ndarray) -> None:
    """Draw a line per combination of the other keys."""
    record = layout.record
    others = _others(layout)
    across = layout.axis.numbers or tuple(range(len(layout.axis.words)))
    for number, combination in enumerate(np.unique(record.indices[:, others], axis=0)):
        chosen = np.flatnonzero((record.indices[:, others] == combination).all(axis=1))
        x = np.array([across[index] for index in record.indices[chosen, layout.colored]])
        order = np.argsort(x)
        named = [record.axes[k].words[index] for k, index in zip(others, combination, strict=True)]
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
    """Indices of the other keys with several values."""
    axes = layout.record.axes
    return [k for k in range(len(axes)) if k != layout.colored and len(axes[k].words) > 1]


def _numbers(record: VariantRecord) -> dict[str, np.ndarray]:
    """Numbers present in all variants, and the position of the largest pressure."""
    found = record.numbers | {_PLACE.header: np.array([_place(f) for f in record.folders])}
    known = {name: found[name] for name in _NUMBERS if name in found}
    return {
        name: values for name, values in known.items() if np.isfinite(values).all() and values.any()
    }


def _place(folder: Path) -> float:
    data = tables.read(folder / "interface.csv")
    return float(data["x"][np.argmax(data["pressure"])])


def _varies(values: np.ndarray) -> bool:
    return bool(np.ptp(values) > _EQUAL * np.abs(values).max())
