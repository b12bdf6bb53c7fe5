"""Key figures of a report: all of ``summary.json``, grouped and labelled."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...balances import ALLOWED, BALANCES, holds
from ..quantities import PHASES
from .engineering import NOTHING, number, quantity, split_key

GROUPS = {
    "Loads and forces": {
        "normal_force_N": "normal force",
        "friction": "coefficient of friction",
        "friction_force_N": "friction force",
        "friction_torque_Nm": "friction torque",
        "guide_force_N": "guide force along x",
        "guide_force_y_N": "guide force along y",
        "guide_force_z_N": "guide force along z",
        "guide_moment_Nm": "guide moment",
        "guide_moment_x_Nm": "guide moment about x",
        "guide_moment_y_Nm": "guide moment about y",
        "tangential_force_N": "tangential force",
        "approach_m": "approach",
        "holder_rotation_rad": "rotation of the holder",
        "holder_rotation_x_rad": "rotation of the holder about x",
        "holder_rotation_y_rad": "rotation of the holder about y",
        "tangential_displacement_m": "tangential displacement",
        "equilibrium_relative_error": "equilibrium error",
    },
    "Pressure and contact": {
        "max_pressure_Pa": "largest pressure",
        "mean_pressure_Pa": "mean pressure",
        "min_pressure_Pa": "smallest pressure",
        "contact_area_m2": "contact area",
        "contact_zones_m": "contact zones",
        "stick_area_m2": "stick area",
    },
    "Wear": {
        "shape_range_m": "peak-to-valley of the worn shape",
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
        "peak_temperature_K": "peak surface temperature",
        "peak_temperature_time_s": "time of the peak temperature",
        "friction_power_W": "friction power",
        "prescribed_heat_W": "heat through surfaces of prescribed flux or power",
        "contact_heat_1_W": "heat into body 1 at the contact",
        "contact_heat_2_W": "heat into body 2 at the contact",
        "heat_advection": "heat advection",
        "max_cell_peclet_number": "largest cell Péclet number",
        "heat_in_J": "heat input",
        "heat_stored_J": "heat stored",
        "heat_lost_J": "heat lost",
        "heat_cooled_W": "heat lost by cooling",
        "heat_carried_out_W": "heat removed by advection",
        "dissipated_energy_J": "dissipated energy",
        "heat_balance_relative_error": "heat balance error",
    },
    "Discretisation": {
        "analysis": "analysis",
        "model": "model",
        "method": "contact method",
        "dofs_displacement": "unknowns, displacement",
        "dofs_temperature": "unknowns, temperature",
        "contact_points": "contact points",
        "mesh_sha256": "SHA-256 of the mesh read from a file",
        "pressure_error_estimate_relative": "estimated mean error of the pressure",
        "max_pressure_error_estimate_relative": "estimated error of the largest pressure",
        "shape_error_estimate_relative": "estimated error of the shape",
        "temperature_error_estimate_relative": "estimated error of the temperature",
        "error_estimate_missing": "reason for the missing error estimate",
        "coarser_discretisation": "coarser discretisation",
        "finer_discretisation": "finer discretisation",
    },
    "Times": {
        "time_s": "time at the end",
        "steps": "steps",
        "seconds": "time",
    },
}
"""Labels of the keys of a summary, by group."""

OTHER = "Other"
_CELSIUS = {
    "max_temperature_K",
    "peak_temperature_K",
}  # temperatures; temperature differences stay in K
_UNITS = {"seconds": "s"}  # of keys whose name contains no unit


@dataclass(frozen=True)
class Figure:
    """Line of the key figures.

    Attributes
    ----------
    label, text : str
        Description, and value with its unit.
    source : str
        Key and SI value.
    """

    label: str
    text: str
    source: str


@dataclass(frozen=True)
class BalanceFigure:
    """Result of a balance check; `good` is None if there is nothing to balance."""

    label: str
    text: str
    good: bool | None


def key_figures(summary: dict[str, Any]) -> dict[str, list[Figure]]:
    """Key figures of all keys of a summary by group; keys without a group are in `OTHER`."""
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


def balances(summary: dict[str, Any]) -> list[BalanceFigure]:
    """Balance errors of a summary compared with the allowed limit."""
    found = []
    for key, kept in BALANCES.items():
        error = summary.get(key)
        if isinstance(error, int | float):
            text = f"{error:.1e}" if math.isfinite(error) else NOTHING
            found.append(BalanceFigure(kept.name, f"{text} (allowed {ALLOWED:g})", holds(error)))
        elif key in summary:
            found.append(BalanceFigure(kept.name, NOTHING, None))
    return found


def figure_text(key: str, value: Any, entry: str = "") -> str:
    """Format a value of a summary, or of one of its tables, in the unit that suits its size."""
    if key in _CELSIUS and isinstance(value, int | float):
        return f"{number(value - 273.15)} °C"
    return quantity(value, split_key(entry)[1] or _UNITS.get(key) or split_key(key)[1])


def _figures(key: str, label: str, value: Any) -> list[Figure]:
    """One line for a value, or one line per entry of a table."""
    if not isinstance(value, dict) or not value:
        return [Figure(label, figure_text(key, value), f"{key} = {value}")]
    return [
        Figure(
            f"{label}: {PHASES.get(entry) or split_key(entry)[0]}",
            figure_text(key, inner, entry),
            f"{key}.{entry} = {inner}",
        )
        for entry, inner in value.items()
    ]
