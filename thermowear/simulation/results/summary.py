"""Summary of a run: SI numbers, the unit in each key."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...balances import relative
from ...contact.operators.pressure import contact_zones
from ...contact.operators.rigid_motion import RigidMode, hold
from ...laws.interfaces import Constant
from ...model.conditions import Holder
from ...model.interface import Interface
from ...model.model import Model
from ...results import Result
from ...results.short_names import by_name
from ..heat.probes import probe_temperatures
from ..interface.body_state import body_equilibrium
from ..system.conditions import fluid_forces
from ..system.rigid_modes import guides, loads_on
from ..system.system import System
from .coatings import layer_volumes
from .friction import friction_of
from .recording import Snapshot, profile


def balances(end: Snapshot, volumes: list[float]) -> tuple[dict, list[dict]]:
    """Summary entries of the balances of all bodies together and of each. Every rank calls.

    Parameters
    ----------
    end : Snapshot
        Its system with the present friction.
    volumes : list of float
        Volume worn from each body, by the depths of its faces [m³].
    """
    found = body_equilibrium(end.system, end.contact, end.bodies.supports)
    heated, worn = end.bodies.temperatures, _volume_errors(end, volumes)
    each = {
        "force_balance_relative_error": found.forces,
        "moment_balance_relative_error": found.moments,
        "heat_balance_relative_error": None if heated is None else heated.errors,
        "wear_volume_relative_error": worn[1:],
    }
    whole = {
        "moment_balance_relative_error": found.total,
        "wear_volume_relative_error": worn[0] if worn else None,
    }
    return (
        {key: error for key, error in whole.items() if error is not None},
        [{key: errors[k] for key, errors in each.items() if errors} for k in range(len(volumes))],
    )


def friction_torques(model: Model, index: int, interfaces: list[dict]) -> dict[str, float]:
    """Friction torque of all contacts on a body, about the axis of rotation; empty without one.

    Positive anticlockwise. Its drive, its holder or its supports exert the opposite one.

    Parameters
    ----------
    model : Model
    index : int
        Index of the body.
    interfaces : list of dict
        Summary entries of the interfaces, with the magnitude of the torque of each.
    """
    pairs = zip(model.interfaces, interfaces, strict=True)
    own = [(one, found["friction_torque_Nm"]) for one, found in pairs if index in one.bodies]
    if not own or any(torque is None for _, torque in own):
        return {}
    torques = (_sense(model, one, index) * torque for one, torque in own)
    return {"friction_torque_Nm": float(sum(torques)) + 0.0}


def _sense(model: Model, interface: Interface, index: int) -> float:
    """Sense of the friction torque on a body, opposite to its rotation over the other one.

    The angular velocity of a contact is that of its first body relative to the second one in an
    axisymmetric model and about an axis in place, else that of its second body.
    """
    in_place = model.kinematics == "axisymmetric" or interface.motion.axis is not None
    turning = 0 if in_place else 1
    own = 1.0 if interface.bodies[turning] == index else -1.0
    return -own * float(np.sign(interface.motion.angular_velocity or 0.0))


def _volume_errors(end: Snapshot, volumes: list[float]) -> list[float]:
    """Differences of volumes by depths and by rates in time, relative, of all bodies and of each.

    Empty where nothing wears in time.
    """
    if end.removed is None:
        return []
    both, interfaces = np.zeros((2, len(end.system.model.interfaces))), end.system.model.interfaces
    both[list(end.system.laws)] = end.removed
    bodies = np.array([one.bodies for one in interfaces]).T
    removed = [float(both[bodies == k].sum()) for k in range(len(volumes))]
    pairs = [(sum(volumes), sum(removed)), *zip(volumes, removed, strict=True)]
    return [relative(depth - rate, max(abs(depth), abs(rate))) for depth, rate in pairs]


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

    Those of interfaces and holders with names are in tables by these.

    Parameters
    ----------
    end : Snapshot
    time : float
        Time at the end, or zero [s].
    """
    system, heated, model = end.system, end.bodies.temperatures, end.system.model
    thermal = system.thermal
    size = {
        "model": model.kinematics,
        "method": model.method,
        "dofs_displacement": system.elastic.spaces.total,
        "dofs_temperature": 0 if thermal is None else thermal.conduction.spaces.total,
        "contact_points": len(system.weights),
    }
    state = {
        "max_temperature_K": None if heated is None else end.bodies.hottest,
        "heat_balance_relative_error": None if heated is None else float(heated.error),
        "equilibrium_relative_error": end.bodies.force_error,
        **_prescribed(end, time),
        **_probes(end),
        **_passing(end, time),
    }
    turned = replace(end, system=system.with_friction(end.contact.conditions.friction))
    interfaces = [_of_interface(turned, index) for index in range(len(model.interfaces))]
    holders = [_of_holder(turned, index, time) for index in range(len(model.holders))]
    bodies = [_of_body(model, k, interfaces) for k in range(len(model.bodies))]
    whole, each = balances(turned, [body["wear_volume_m3"] for body in bodies])
    contacts, held = [one.name for one in model.interfaces], [one.name for one in model.holders]
    return size | {
        **by_name("contacts", dict(zip(contacts, interfaces, strict=True))),
        **({"holders": {}} if model.named else {}),  # also where supports hold all bodies
        **by_name("holders", dict(zip(held, holders, strict=True))),
        **state,
        **whole,
        "max_pressure_Pa": float(end.interface.pressure.max()),
        "friction_power_W": sum(found["friction_power_W"] for found in interfaces),
        "wear_dissipation_W": sum(found["wear_dissipation_W"] for found in interfaces),
        "bodies": {
            body.name: found | errors
            for body, found, errors in zip(model.bodies, bodies, each, strict=True)
        },
    }


def _of_interface(end: Snapshot, index: int) -> dict:
    """Numbers of one interface of a system with its present friction."""
    system, own = end.system, end.system.contacts.ranges[index]
    interface, pairing = system.model.interfaces[index], system.contacts.each[index]
    fields, at, p, w = (
        end.interface,
        end.contact.conditions,
        end.contact.pressure[own],
        pairing.weights,
    )
    friction = friction_of(system, index, at, end.contact.pressure)
    rates = (fields.wear_rate_1 + fields.wear_rate_2)[own]
    shown = fields.pressure[own]
    worn = shown > 0
    depths = np.array([fields.wear_1, fields.wear_2])
    in_gap = (system.worn_areas * (depths - system.moved))[:, own].sum(axis=1)
    volumes = in_gap + system.lost[index]
    shape = fields.shape[own]
    constant, fluid = isinstance(interface.friction, Constant), fluid_forces(system)
    return {
        "between": [system.model.bodies[k].name for k in interface.bodies],
        "friction": interface.nominal_friction if constant else None,
        "normal_force_N": system.normal_forces(end.contact.pressure)[index],
        "contact_force_N": float(w @ p),
        **({"fluid_force_N": fluid[index]} if index in fluid else {}),
        "friction_force_N": friction.force,
        "friction_torque_Nm": friction.torque,
        "max_pressure_Pa": float(shown.max()),
        "mean_pressure_Pa": float(w @ p / w[worn].sum()) if worn.any() else 0.0,
        "min_pressure_Pa": float(shown.min()),
        "contact_area_m2": float(w[worn].sum()),
        "contact_zones_m": contact_zones(pairing, shown),
        "shape_range_m": float(np.ptp(shape)) if np.isfinite(shape).all() else None,
        "friction_power_W": friction.power,
        **_conducted(end, own),
        "wear_dissipation_W": float(w @ (p * rates)),
        "wear_volume_1_m3": float(volumes[0]),
        "wear_volume_2_m3": float(volumes[1]),
        **layer_volumes(system, index, depths, volumes),
        "wear_coefficient_per": {
            name: per
            for side, wear in interface.wear.items()
            for name, per in wear.stress_by_part(
                system.model.bodies[interface.bodies[side]].name
            ).items()
        },
        **_friction(interface, at.friction[own], w * p),
    }


def _of_holder(end: Snapshot, index: int, time: float) -> dict:
    """Position of a holder, and the reactions of its guides, at a time [s]."""
    system, holder = end.system, end.system.model.holders[index]
    motion, direction = end.motions[index], np.array(holder.load_direction)
    turned = zip(_ROTATIONS.items(), motion.rotation, strict=True)
    return {
        "approach_m": float(motion.at(np.array(holder.pivot)) @ direction),
        "guide_force_N": None,
        "rigid_wear_velocity_m_per_s": None,
        **_guide_reactions(system, holder, end.contact.traction(system), time),
        **{key: float(angle) for (name, key), angle in turned if name in holder.free},
    }


def _of_body(model: Model, index: int, interfaces: list[dict]) -> dict:
    """Volume worn from a body, heat into it and friction torque at all of its interfaces."""
    sides = [
        (found, interface.bodies.index(index) + 1)
        for found, interface in zip(interfaces, model.interfaces, strict=True)
        if index in interface.bodies
    ]
    result = {"wear_volume_m3": sum(found[f"wear_volume_{side}_m3"] for found, side in sides)}
    if all(f"contact_heat_{side}_W" in found for found, side in sides):
        result["contact_heat_W"] = sum(found[f"contact_heat_{side}_W"] for found, side in sides)
    return result | friction_torques(model, index, interfaces)


def _friction(interface: Interface, friction: np.ndarray, force: np.ndarray) -> dict[str, float]:
    """Range of the coefficient of friction in contact and its force-weighted mean, if varying."""
    if not interface.friction_varies or not force.any():
        return {}
    carries = force > 0
    return {
        "friction_mean": float(np.average(friction, weights=force)),
        "friction_min": float(friction[carries].min()),
        "friction_max": float(friction[carries].max()),
    }


def _conducted(end: Snapshot, own: slice) -> dict[str, float]:
    """Heat into both bodies of an interface."""
    heated = end.bodies.temperatures
    if end.system.thermal is None or heated is None:
        return {}
    into = (float(end.system.weights[own] @ flux[own]) for flux in heated.faces.flux)
    return {f"contact_heat_{side}_W": heat for side, heat in enumerate(into, 1)}


def _probes(end: Snapshot) -> dict[str, dict]:
    """Temperatures at the probes by name, if there are any; every rank calls."""
    system, heated = end.system, end.bodies.temperatures
    if not system.model.probes or heated is None:
        return {}
    each = zip(system.model.probes, probe_temperatures(system, heated.rise), strict=True)
    known = ((probe.name, None if np.isnan(T) else float(T)) for probe, T in each)
    return {"probes": {name: {"temperature_K": T} for name, T in known}}


def _prescribed(end: Snapshot, time: float) -> dict[str, float]:
    """Heat through surfaces with a given flux or power, if there are any."""
    thermal = end.system.thermal
    load = None if thermal is None else thermal.loads.at(time)
    return {} if load is None or load.magnitude == 0.0 else {"prescribed_heat_W": load.prescribed}


def _passing(end: Snapshot, time: float) -> dict:
    """Advection of heat by a body 2 passing under body 1, and heat losses of the bodies."""
    thermal, heated, heat = end.system.thermal, end.bodies.temperatures, end.system.model.heat
    passing = [one.motion for one in end.system.model.interfaces if one.motion.passes]
    if thermal is None or heated is None or heat is None or not passing:
        return {}
    advection = thermal.conduction.advection
    stabilised = advection is not None and advection.stabilised
    ambient = thermal.loads.at(time).ambient
    still = np.zeros(len(heated.rise))
    cooled, _, carried = thermal.conduction.losses(heated.rise, still, ambient=ambient)
    leaves = advection is not None and passing[0].center is None
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
    summary = merged(summarise(end, time), extra)
    contacts = end.system.ranges_by_name
    return end, Result(end.interface, profile(end), summary, contacts=contacts, **recorded)


def merged(one: dict, other: dict) -> dict:
    """Union of two tables and of the tables in them; the other's values replace those of one."""
    shared = {
        key: merged(one[key], table)
        for key, table in other.items()
        if isinstance(table, dict) and isinstance(one.get(key), dict)
    }
    return one | other | shared


def _guide_reactions(
    system: System, holder: Holder, traction: np.ndarray, time: float
) -> dict[str, float]:
    """Guide reactions on the bodies of a holder along its constrained motions [N, N m].

    The traction on the second bodies has the shape (n, gdim) [Pa].

    For the whole body: the forces between the parts of a symmetric body cancel.
    """
    model, reactions = system.model, {}
    cancelling = _cancelling(model, holder)
    for name, motion in guides(model.kinematics, holder).items():
        if name not in holder.free:
            mode, load = RigidMode(motion, load=0.0, bodies=holder.bodies), 0.0
            for part, history in loads_on(model.holders, holder, motion):
                load += part if history is None else part * history.factor_at(time)
            response = hold(system.contacts, traction, [mode]).force_response
            dead = system.dead_resultant(motion)[list(holder.bodies)].sum()
            reaction = float(system.weights @ response[:, 0]) - load - float(dead)
            reactions[_GUIDES[name]] = 0.0 if name in cancelling else reaction
    return reactions


def _cancelling(model: Model, holder: Holder) -> tuple[str, ...]:
    """Guided motions whose reactions cancel in a body cut by planes of symmetry x = const."""
    if not model.symmetry:
        return ()
    quarter = any(model.bodies[index].rollers for index in holder.bodies)
    return ("x", "rotation", "rotation-y", *(("y", "rotation-x") if quarter else ()))
