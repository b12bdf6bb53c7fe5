"""Rigid modes of the holder of body 1 and their loads."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...contact.operators.rigid_motion import RigidMode
from ...contact.search.pairing import Pairing
from ...laws.motions import RigidMotion, rotation, translation
from ...model.conditions import Holder
from ...model.model import Model

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0)}
_TURNS = {"rotation-x": (1.0, 0.0, 0.0), "rotation-y": (0.0, 1.0, 0.0)}


def rigid_modes(
    holder: Holder, pairing: Pairing, dead: Callable[[RigidMotion], float]
) -> tuple[RigidMode, ...]:
    """Rigid modes of the holder, the load direction first, with the load or motion of each.

    A force acts along the load direction at the point of the load, so that its generalised force
    on a motion m is ``F e·m(point)``, e the load direction; moments add their work on its rotation.

    Parameters
    ----------
    holder : Holder
    pairing : Pairing
    dead : callable
        Generalised force on a motion of body 1 that does not come from the holder [N or N m].
    """
    approach = holder.approach
    return tuple(
        RigidMode(m, amplitude=approach, dead=float(dead(m)))
        if approach is not None and name == "z"
        else RigidMode(m, load=_load(holder, m), dead=float(dead(m)))
        for name, m in ((name, _motion(holder, name, pairing)) for name in holder.free)
    )


def guides(model: Model) -> dict[str, RigidMotion]:
    """Rigid motions by name, conjugate to the guide forces and moments on body 1.

    Along x (and y), upwards, and about the pivot; none in an axisymmetric model.
    """
    if model.kinematics == "axisymmetric":
        return {}
    pivot = np.array(model.holder.pivot)
    if model.kinematics == "3d":
        turns = {name: rotation(axis, pivot) for name, axis in _TURNS.items()}
        shifts = {name: translation(axis) for name, axis in _AXES.items()}
        return shifts | {"z": translation((0.0, 0.0, 1.0))} | turns
    up, out = (0.0, 1.0), (0.0, 0.0, 1.0)
    return {"x": translation(_AXES["x"]), "z": translation(up), "rotation": rotation(out, pivot)}


def applied(holder: Holder, motion: RigidMotion) -> float:
    """Generalised force of the loads of the holder on a motion; moments by the right-hand rule."""
    force = (holder.force or 0.0) * np.array(holder.load_direction)
    force[0] += holder.tangential_force
    work = force @ motion.at(np.array(holder.point)) + np.array(holder.moments) @ motion.rotation
    return float(work)


def _motion(holder: Holder, name: str, pairing: Pairing) -> RigidMotion:
    if name == "z":
        return translation(holder.load_direction)
    if name in _AXES:
        return translation(_AXES[name])
    pivot = np.array(holder.pivot)
    if name in _TURNS:
        return rotation(_TURNS[name], pivot)
    turn = rotation((0.0, 0.0, 1.0), pivot)
    if holder.free == ("rotation",):
        return rotation((0.0, 0.0, _closing_sense(turn, pairing)), pivot)
    return turn


def _closing_sense(turn: RigidMotion, pairing: Pairing) -> float:
    """+1 where an anticlockwise rotation closes the gap in the mean, -1 otherwise."""
    closing = np.einsum("ni,ni->n", turn.at(pairing.on_body_1), pairing.normals)
    return 1.0 if pairing.weights @ closing >= 0.0 else -1.0


def _load(holder: Holder, motion: RigidMotion) -> float:
    closing = holder.closing_moment
    return applied(holder, motion) if closing is None else closing
