"""The summary of a run: SI numbers, the unit in each key."""

from __future__ import annotations

import numpy as np

from ..bulk.field import total
from ..contact.zones import contact_zones
from .outcome import Outcome
from .system import System


def summarise(system: System, outcome: Outcome) -> dict:
    """All numbers of ``summary.json`` but the seconds. Quantities that do not exist are None."""
    case, w = system.case, system.weights
    p, interface = outcome.pressure, outcome.interface
    friction = system.friction * p
    rates = interface.wear_rate_1 + interface.wear_rate_2
    worn = interface.pressure > 0
    summary = {
        "title": case.title,
        "analysis": case.analysis.type,
        "model": case.model,
        "method": case.contact.method,
        "dofs_displacement": total(system.elastic.space),
        "dofs_temperature": _thermal_dofs(system),
        "contact_points": len(w),
        "friction": system.friction,
        "normal_force_N": system.holder.carried(p, w),
        "friction_force_N": float(w @ friction),
        "friction_torque_Nm": _torque(system, friction),
        "guide_force_N": _guide_force(system, p),
        "max_pressure_Pa": float(p.max()),
        "mean_pressure_Pa": float(w @ p / w[worn].sum()) if worn.any() else 0.0,
        "min_pressure_Pa": float(p.min()),
        "contact_area_m2": float(w[worn].sum()),
        "contact_zones_m": contact_zones(system.pairing, p),
        "shape_range_m": float(np.ptp(interface.shape)),
        "approach_m": float(outcome.translation @ system.holder.direction),
        "max_temperature_K": _number(outcome.state.hottest),
        "friction_power_W": float(w @ system.friction_heat(p)),
        "heat_balance_relative_error": _number(outcome.state.heat_error),
        "equilibrium_relative_error": outcome.state.force_error,
        "rigid_wear_velocity_m_per_s": None,
        "wear_dissipation_W": float(w @ (p * rates)),
        "wear_volume_1_m3": float(w @ interface.wear_1),
        "wear_volume_2_m3": float(w @ interface.wear_2),
        "wear_coefficient_per": {name: law.per for name, law in case.wear.items()},
    }
    return summary | outcome.extra


def _torque(system: System, friction: np.ndarray) -> float | None:
    """Friction moment about the axis [N m]; None for plane models."""
    if system.case.model != "axisymmetric":
        return None
    return float(system.weights @ (friction * system.pairing.points[:, 0]))


def _guide_force(system: System, pressure: np.ndarray) -> float | None:
    """Force along x with which the guide keeps body 1 sliding [N]; None for axisymmetric models.

    Of the whole: what the halves of a symmetric section push apart is in balance.
    """
    if system.case.model == "axisymmetric":
        return None
    if system.case.geometry.symmetry:
        return 0.0
    return float(system.weights @ (pressure * system.pull[:, 0]))


def _thermal_dofs(system: System) -> int:
    return 0 if system.thermal is None else total(system.thermal.conduction.space)


def _number(value: float) -> float | None:
    return None if np.isnan(value) else float(value)
