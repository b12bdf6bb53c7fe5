"""Friction force, torque and power of an interface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...contact.search.pairing import Pairing
from ...model.interface import Interface
from ...model.model import Model
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
