"""Summary of a run: SI numbers, the unit in each key."""

from __future__ import annotations

import numpy as np

from ...contact.operators.pressure import contact_zones
from ...laws.coefficients import Constant
from ...results import Result
from ..system.rigid_modes import applied, guides
from ..system.system import System
from .coatings import layer_volumes
from .recording import Snapshot, profile

_GUIDES = {
    "x": "guide_force_N",
    "y": "guide_force_y_N",
    "z": "guide_force_z_N",
    "rotation": "guide_moment_Nm",
    "rotation-x": "guide_moment_x_Nm",
    "rotation-y": "guide_moment_y_Nm",
}
"""Keys of the guide reactions, by the constrained motion of the holder."""

_ROTATIONS = {
    "rotation-x": "holder_rotation_x_rad",
    "rotation-y": "holder_rotation_y_rad",
    "rotation": "holder_rotation_rad",
}
"""Keys of the holder rotations, in the order of the components of a rotation vector."""


def summarise(end: Snapshot, time: float) -> dict:
    """Numbers of ``summary.json`` of any analysis. Quantities that do not exist are None.

    Parameters
    ----------
    end : Snapshot
    time : float
        Time at the end, or zero [s].
    """
    system, contact, interface = end.system, end.contact, end.interface
    model, w, heated = system.model, system.weights, end.bodies.temperatures
    p, sliding, thermal = contact.pressure, system.slides is not None, system.thermal
    friction = sliding * contact.conditions.friction * p  # at rest there is none
    system = system.with_friction(contact.conditions.friction)
    rates = interface.wear_rate_1 + interface.wear_rate_2
    worn = interface.pressure > 0
    depths = np.array([interface.wear_1, interface.wear_2])
    volumes = (system.worn_areas * (depths - system.moved)).sum(axis=1) + system.lost
    summary = {
        "model": model.kinematics,
        "method": model.interface.method.name,
        "dofs_displacement": system.elastic.spaces.total,
        "dofs_temperature": 0 if thermal is None else thermal.conduction.spaces.total,
        "contact_points": len(w),
        "friction": system.friction if isinstance(model.interface.friction, Constant) else None,
        "normal_force_N": system.normal_force(p),
        "friction_force_N": float(w @ friction),
        "friction_torque_Nm": _torque(system, friction),
        "guide_force_N": None,
        "max_pressure_Pa": float(p.max()),
        "mean_pressure_Pa": float(w @ p / w[worn].sum()) if worn.any() else 0.0,
        "min_pressure_Pa": float(p.min()),
        "contact_area_m2": float(w[worn].sum()),
        "contact_zones_m": contact_zones(system.pairing, p),
        "shape_range_m": float(np.ptp(interface.shape)),
        "approach_m": float(end.motion.at(np.array(model.holder.pivot)) @ system.load_direction),
        "max_temperature_K": None if heated is None else end.bodies.hottest,
        "friction_power_W": float(w @ (contact.conditions.heating * p)),
        **_conducted(end, time),
        "heat_balance_relative_error": None if heated is None else float(heated.error),
        "equilibrium_relative_error": end.bodies.force_error,
        "rigid_wear_velocity_m_per_s": None,
        "wear_dissipation_W": float(w @ (p * rates)),
        "wear_volume_1_m3": float(volumes[0]),
        "wear_volume_2_m3": float(volumes[1]),
        **layer_volumes(system, depths, volumes),
        "wear_coefficient_per": {
            name: per
            for index, wear in model.interface.wear.items()
            for name, per in wear.stress_by_part(model.bodies[index].name).items()
        },
    }
    about = _passing(end, time) | _guide_reactions(system, p) | _rotations(end)
    return summary | about | _friction(end)


def _friction(end: Snapshot) -> dict[str, float]:
    """Range of the coefficient of friction in contact and its force-weighted mean, if varying."""
    system, pressure = end.system, end.contact.pressure
    if not system.model.interface.friction_varies or not pressure.any():
        return {}
    friction, carries = end.contact.conditions.friction, pressure > 0
    return {
        "friction_mean": float(np.average(friction, weights=system.weights * pressure)),
        "friction_min": float(friction[carries].min()),
        "friction_max": float(friction[carries].max()),
    }


def _conducted(end: Snapshot, time: float) -> dict[str, float]:
    """Heat into both bodies: at the contact, and through surfaces with a given flux or power."""
    system, thermal, heated = end.system, end.system.thermal, end.bodies.temperatures
    if thermal is None or heated is None:
        return {}
    into = (float(system.weights @ flux) for flux in heated.faces.flux)
    found = {f"contact_heat_{body}_W": heat for body, heat in enumerate(into, 1)}
    load = thermal.loads.at(time)
    return found | ({"prescribed_heat_W": load.prescribed} if load.magnitude > 0.0 else {})


def _passing(end: Snapshot, time: float) -> dict:
    """Advection of heat by a body 2 passing under body 1, and heat losses of the bodies."""
    thermal, heated, heat = end.system.thermal, end.bodies.temperatures, end.system.model.heat
    if thermal is None or heated is None or heat is None or not end.system.model.motion.passes:
        return {}
    advection = thermal.conduction.advection
    stabilised = advection is not None and advection.stabilised
    ambient = thermal.loads.at(time).ambient
    still = np.zeros(len(heated.rise))
    cooled, _, carried = thermal.conduction.losses(heated.rise, still, ambient=ambient)
    leaves = advection is not None and end.system.model.motion.center is None
    return {
        "heat_advection": "stabilised" if stabilised else heat.advection,
        "max_cell_peclet_number": None if advection is None else advection.peclet,
        "heat_cooled_W": float(cooled),
        "heat_carried_out_W": float(carried) if leaves else None,
    }


def conclude(end: Snapshot, extra: dict, time: float = 0.0, **recorded) -> tuple[Snapshot, Result]:
    """State at the end and result of an analysis, with profile and summary. Every rank calls.

    Parameters
    ----------
    end : Snapshot
    extra : dict
        Entries that the analysis adds to the summary.
    time : float, optional
        Time at the end [s].
    **recorded
        Further attributes of the result, such as its histories.
    """
    summary = summarise(end, time) | extra
    return end, Result(end.interface, profile(end), summary, **recorded)


def _torque(system: System, friction: np.ndarray) -> float | None:
    """Friction moment about the axis of rotation of body 1 or 2 [N m]; None without one."""
    motion = system.model.motion
    if system.model.kinematics == "axisymmetric" and motion.velocity is None:
        return float(system.weights @ (friction * system.pairing.points[:, 0]))
    if motion.center is None:
        return None
    arms = system.pairing.points[:, :2] - np.array(motion.center)
    return float(system.weights @ (friction * np.linalg.norm(arms, axis=1)))


def _guide_reactions(system: System, pressure: np.ndarray) -> dict[str, float]:
    """Guide reactions on body 1 along the constrained motions of the holder [N, N m].

    For the whole body: the forces between the halves of a symmetric section cancel.
    """
    model, points = system.model, system.pairing.on_body_1
    reactions = {}
    for name, motion in guides(model).items():
        if name not in model.holder.free:
            work = np.einsum("ni,ni->n", motion.at(points), system.traction_direction)
            given = applied(model.holder, motion) + float(system.dead_resultant(motion)[0])
            reaction = float(system.weights @ (pressure * work)) - given
            reactions[_GUIDES[name]] = 0.0 if model.symmetry else reaction
    return reactions


def _rotations(end: Snapshot) -> dict[str, float]:
    """Rotation of the holder about each of its free axes [rad]."""
    turned, free = end.motion.rotation, end.system.model.holder.free
    pairs = zip(_ROTATIONS.items(), turned, strict=True)
    return {key: float(angle) for (name, key), angle in pairs if name in free}
