"""The key figures: all of ``summary.json``, grouped and labelled."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...balances import ALLOWED, BALANCES, holds
from .engineering import NOTHING, number, quantity, split_key

GROUPS = {
    "Loads and forces": {
        "normal_force_N": "normal force",
        "friction": "coefficient of friction",
        "friction_force_N": "friction force",
        "friction_torque_Nm": "friction torque",
        "guide_force_N": "force of the guide along x",
        "guide_force_y_N": "force of the guide along y",
        "guide_force_z_N": "force of the guide along z",
        "guide_moment_Nm": "moment of the guide",
        "guide_moment_x_Nm": "moment of the guide about x",
        "guide_moment_y_Nm": "moment of the guide about y",
        "tangential_force_N": "tangential force",
        "approach_m": "approach",
        "holder_rotation_rad": "rotation of the holder",
        "holder_rotation_x_rad": "rotation of the holder about x",
        "holder_rotation_y_rad": "rotation of the holder about y",
        "tangential_displacement_m": "tangential displacement",
        "equilibrium_relative_error": "error of the equilibrium",
    },
    "Pressure and contact": {
        "max_pressure_Pa": "largest pressure",
        "mean_pressure_Pa": "mean pressure",
        "min_pressure_Pa": "least pressure",
        "contact_area_m2": "contact area",
        "contact_zones_m": "contact zones",
        "stick_area_m2": "area that sticks",
    },
    "Wear": {
        "shape_range_m": "shape, highest to lowest",
        "rigid_wear_velocity_m_per_s": "steady wear rate",
        "rigid_wear_velocity_x_m_per_s": "steady wear rate along x",
        "rigid_wear_velocity_y_m_per_s": "steady wear rate along y",
        "rigid_wear_rotation_rad_per_s": "steady wear rotation",
        "rigid_wear_rotation_x_rad_per_s": "steady wear rotation about x",
        "rigid_wear_rotation_y_rad_per_s": "steady wear rotation about y",
        "wear_dissipation_W": "wear dissipation power",
        "wear_volume_1_m3": "worn volume, body 1",
        "wear_volume_2_m3": "worn volume, body 2",
        "wear_coefficient_per": "wear coefficient per",
        "distance_from_steady": "distance from the steady pressure",
    },
    "Heat and energy": {
        "max_temperature_K": "highest temperature",
        "peak_temperature_K": "highest temperature of the faces on the way",
        "peak_temperature_time_s": "time of the highest temperature",
        "friction_power_W": "friction power",
        "prescribed_heat_W": "heat through surfaces with a given flux or power",
        "contact_heat_1_W": "heat into body 1 at the contact",
        "contact_heat_2_W": "heat into body 2 at the contact",
        "heat_advection": "heat carried along",
        "max_cell_peclet_number": "largest cell Péclet number",
        "heat_in_J": "heat put in",
        "heat_stored_J": "heat stored",
        "heat_lost_J": "heat lost",
        "heat_cooled_W": "heat lost by cooling",
        "heat_carried_out_W": "heat carried out",
        "dissipated_energy_J": "energy dissipated",
        "heat_balance_relative_error": "error of the heat balance",
    },
    "Discretisation": {
        "analysis": "analysis",
        "model": "model",
        "method": "contact method",
        "dofs_displacement": "unknowns, displacement",
        "dofs_temperature": "unknowns, temperature",
        "contact_points": "contact points",
        "mesh_sha256": "SHA-256 of the mesh read from a file",
        "pressure_error_estimate_relative": "estimated error of the pressure, in the mean",
        "max_pressure_error_estimate_relative": "estimated error of the largest pressure",
        "shape_error_estimate_relative": "estimated error of the shape",
        "temperature_error_estimate_relative": "estimated error of the temperature",
        "error_estimate_missing": "no error estimate",
        "coarser_discretisation": "coarser",
        "finer_discretisation": "finer",
    },
    "Times": {
        "time_s": "time at the end",
        "steps": "steps",
        "seconds": "computing",
    },
}
"""Which key stands where, and what it is called."""

OTHER = "Other"
_CELSIUS = {
    "max_temperature_K",
    "peak_temperature_K",
}  # a difference in K must not be turned to °C: only what is known
_UNITS = {"seconds": "s"}  # of keys that do not end in theirs


@dataclass(frozen=True)
class Figure:
    """A line of the key figures.

    Attributes
    ----------
    label, text : str
        What it is, and the value with its unit.
    source : str
        Key and SI value.
    """

    label: str
    text: str
    source: str


@dataclass(frozen=True)
class Balance:
    """How well something balances; `good` is None where there is nothing to balance."""

    label: str
    text: str
    good: bool | None


def key_figures(summary: dict[str, Any]) -> dict[str, list[Figure]]:
    """All keys of a summary by groups; those that no group knows are in `OTHER`."""
    known = {key for labels in GROUPS.values() for key in labels}
    unknown = {key: split_key(key)[0] for key in summary if key not in known | {"title"}}
    groups = {}
    for group, labels in (GROUPS | {OTHER: unknown}).items():
        found = [
            figure
            for key, label in labels.items()
            if key in summary
            for figure in _figures(key, label, summary[key])
        ]
        if found:
            groups[group] = found
    return groups


def balances(summary: dict[str, Any]) -> list[Balance]:
    """The balances of a summary against what is allowed."""
    found = []
    for key, kept in BALANCES.items():
        error = summary.get(key)
        if isinstance(error, int | float):
            text = f"{error:.1e}" if math.isfinite(error) else NOTHING
            found.append(Balance(kept.name, f"{text} (allowed {ALLOWED:g})", holds(error)))
        elif key in summary:
            found.append(Balance(kept.name, NOTHING, None))
    return found


def figure_text(key: str, value: Any, entry: str = "") -> str:
    """A value of a summary, or of an entry of one, with the unit that fits it."""
    if key in _CELSIUS and isinstance(value, int | float):
        return f"{number(value - 273.15)} °C"
    return quantity(value, split_key(entry)[1] or _UNITS.get(key) or split_key(key)[1])


def _figures(key: str, label: str, value: Any) -> list[Figure]:
    """One line, or a line an entry of a table."""
    if not isinstance(value, dict) or not value:
        return [Figure(label, figure_text(key, value), f"{key} = {value}")]
    return [
        Figure(
            f"{label}, {split_key(entry)[0]}",
            figure_text(key, inner, entry),
            f"{key}.{entry} = {inner}",
        )
        for entry, inner in value.items()
    ]
