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
    own, pairing = system.contacts.ranges[index], system.contacts.each[index]
    interface, p, w = system.model.interfaces[index], pressure[own], pairing.weights
    sliding = not interface.motion.at_rest  # at rest there is no friction
    stress = sliding * conditions.friction[own] * p
    return Friction(
        float(w @ stress),
        _torque(system.model, interface, pairing, stress),
        float(w @ (conditions.heating[own] * p)),
    )


def _torque(
    model: Model, interface: Interface, pairing: Pairing, friction: np.ndarray
) -> float | None:
    """Friction moment about the axis of rotation of body 1 or 2 [N m]; None without one."""
    motion = interface.motion
    if model.kinematics == "axisymmetric" and motion.velocity is None:
        return float(pairing.weights @ (friction * pairing.points[:, 0]))
    if motion.axis is not None:
        arms = motion.axis.velocity(pairing.points, 1.0)
    elif motion.center is not None:
        arms = pairing.points[:, :2] - np.array(motion.center)
    else:
        return None
    return float(pairing.weights @ (friction * np.linalg.norm(arms, axis=1)))
