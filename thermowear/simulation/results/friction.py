"""Friction force, torque and power of the interfaces, and the rows of each contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...contact.search.pairing import Pairing
from ...model.interface import Interface
from ...model.model import Model
from ...results import ContactRow
from ..interface.sdirk import InterfaceState
from ..system.conditions import InterfaceConditions
from ..system.system import System


@dataclass(frozen=True)
class Friction:
    """Friction of an interface.

    Attributes
    ----------
    force : float
        Area integral of the magnitude of the friction stress [N].
    torque : float or None
        Moment about the axis of rotation [N m]; None without one.
    power : float
        [W]
    """

    force: float
    torque: float | None
    power: float


def friction_of(
    system: System, index: int, conditions: InterfaceConditions, pressure: np.ndarray
) -> Friction:
    """Friction of one interface.

    Parameters
    ----------
    system : System
    index : int
        Index of the interface.
    conditions : InterfaceConditions
    pressure : ndarray, shape (n,)
        Pressure at the points of all interfaces [Pa].
    """
    own = system.contacts.ranges[index]
    force, torque, power = map(float, friction_rows(system, index, conditions) @ pressure[own])
    return Friction(force, None if np.isnan(torque) else torque, power)


def friction_rows(system: System, index: int, conditions: InterfaceConditions) -> np.ndarray:
    """Friction force, torque and power of one interface per pressure at its points, (3, n).

    The torque is NaN without an axis of rotation.
    """
    own, pairing = system.contacts.ranges[index], system.contacts.each[index]
    interface = system.model.interfaces[index]
    sliding = not interface.motion.at_rest  # at rest there is no friction
    force = pairing.weights * (sliding * conditions.friction[own])
    arms = _arms(system.model, interface, pairing)
    return np.stack([force, force * arms, pairing.weights * conditions.heating[own]])


def _arms(model: Model, interface: Interface, pairing: Pairing) -> np.ndarray:
    """Distances from the axis of rotation of body 1 or 2 [m]; NaN without one."""
    motion = interface.motion
    if model.kinematics == "axisymmetric" and motion.velocity is None:
        return pairing.points[:, 0]
    if motion.axis is not None:
        arms = motion.axis.velocity(pairing.points, 1.0)
    elif motion.center is not None:
        arms = pairing.points[:, :2] - np.array(motion.center)
    else:
        return np.full(len(pairing.points), np.nan)
    return np.linalg.norm(arms, axis=1)


def contact_rows(
    system: System,
    conditions: InterfaceConditions,
    state: InterfaceState,
    time: float,
    ambient: float,
) -> list[ContactRow]:
    """Rows of the contacts of several bodies in a state.

    Parameters
    ----------
    system : System
    conditions : InterfaceConditions
        Conditions at that time.
    state : InterfaceState
    time : float
        [s]
    ambient : float
        Temperature that rises refer to [K].
    """
    p, nothing = state.pressure, np.full((2, len(state.pressure)), np.nan)
    powers = system.weights * conditions.heating * p
    areas = system.weights * (p > 0)
    kept = system.worn_areas * (state.by_body(system.laws) - system.moved)
    faces = nothing if state.faces is None else np.array(state.faces.rise) + ambient
    each = zip(system.contacts.ranges, system.lost, system.normal_forces(p), strict=True)
    return [
        ContactRow(
            time=time,
            contact=number,
            normal_force=force,
            friction_power=float(powers[own].sum()),
            max_pressure=float(p[own].max()),
            contact_area=float(areas[own].sum()),
            wear_volume_1=float(kept[0, own].sum() + lost[0]),
            wear_volume_2=float(kept[1, own].sum() + lost[1]),
            max_temperature_1=float(faces[0, own].max()),
            max_temperature_2=float(faces[1, own].max()),
        )
        for number, (own, lost, force) in enumerate(each, start=1)
    ]
