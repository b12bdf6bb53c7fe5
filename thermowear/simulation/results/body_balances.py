"""Balances of each body of a model of several bodies, and of all of them, for the summary."""

from __future__ import annotations

import numpy as np

from ...balances import relative
from ...model.interface import Interface
from ...model.model import Model
from ..interface.equilibrium import body_equilibrium
from .recording import Snapshot


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
