"""Numbers of summaries: their paths, their labels, and the main ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from ...results.quantity import Quantity
from ...results.summary_keys import of_key

MAIN = (
    *("max_temperature_K", "peak_temperature_K", "heat_carried_out_W"),
    *("shape_range_m", "rigid_wear_velocity_m_per_s", "friction_power_W"),
    *("wear_volume_1_m3", "wear_volume_2_m3", "contact_area_m2", "guide_force_N", "approach_m"),
    *("critical_speed_m_per_s", "critical_speed_with_wear_m_per_s"),
    *("critical_angular_velocity_rad_per_s", "critical_angular_velocity_with_wear_rad_per_s"),
    *("growth_rate_per_s", "dissipated_energy_J"),
)
"""Keys of the main numbers, beside the largest pressure."""
_OF_PARTS = ("contacts", "holders", "bodies", "probes")
"""Tables of a summary with numbers of parts of a model."""


def numbers_of(summary: dict[str, Any]) -> dict[str, float]:
    """Numbers of a summary, those in tables by the paths of their keys."""
    return dict(_numbers(summary))


def quantity_at(path: str) -> Quantity:
    """Quantity of a number by its path, such as ``contacts.upper.max_pressure_Pa``."""
    where, _, key = path.rpartition(".")
    quantity = of_key(key)
    part = where.partition(".")[2]
    return replace(quantity, label=f"{quantity.label}, {part}") if part else quantity


def _numbers(summary: dict[str, Any], above: str = "") -> Iterator[tuple[str, float]]:
    for name, value in summary.items():
        if name in _OF_PARTS and isinstance(value, dict):
            for part, numbers in value.items():
                yield from _numbers(numbers, f"{name}.{part}.")
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield f"{above}{name}", value
