"""Rigid modes of the holder of body 1, their loads, and the loads on surfaces of the bodies."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...bulk.mechanics.elasticity import Elasticity
from ...contact.operators.rigid_motion import RigidMode
from ...contact.search.pairing import Pairing
from ...laws.motions import RigidMotion, rotation, translation
from ...model.conditions import Holder
from ...model.model import Model
from ...parallel import sum_over_ranks

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0)}
_TURNS = {
    "rotation-x": (1.0, 0.0, 0.0),
    "rotation-y": (0.0, 1.0, 0.0),
    "rotation": (0.0, 0.0, 1.0),
}
_GUIDED = {
    "axisymmetric": (),
    "3d": ("x", "y", "z", "rotation-x", "rotation-y"),
    "plane-strain": ("x", "z", "rotation"),
    "plane-stress": ("x", "z", "rotation"),
}
"""Rigid motions with a guide force or moment on body 1, by kinematic model."""


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

    def mode(name: str) -> RigidMode:
        motion, load, approach = _motion(holder, name), holder.closing_moment, holder.approach
        if holder.free == ("rotation",) and not _closes(motion, pairing):
            motion = rotation((0.0, 0.0, -1.0), np.array(holder.pivot))
        if name == "z" and approach is not None:
            return RigidMode(motion, amplitude=approach, dead=float(dead(motion)))
        load = applied(holder, motion) if load is None else load
        return RigidMode(motion, load=load, dead=float(dead(motion)))

    return tuple(mode(name) for name in holder.free)


def guides(model: Model) -> dict[str, RigidMotion]:
    """Rigid motions by name, conjugate to the guide forces and moments on body 1.

    Along x (and y), upwards, and about the pivot; none in an axisymmetric model.
    """
    up = translation((0.0, 0.0, 1.0) if model.kinematics == "3d" else (0.0, 1.0))
    names = _GUIDED[model.kinematics]
    return {name: up if name == "z" else _motion(model.holder, name) for name in names}


def applied(holder: Holder, motion: RigidMotion) -> float:
    """Generalised force of the loads of the holder on a motion; moments by the right-hand rule."""
    force = (holder.force or 0.0) * np.array(holder.load_direction)
    force[0] += holder.tangential_force
    work = force @ motion.at(np.array(holder.point)) + np.array(holder.moments) @ motion.rotation
    return float(work)


def _motion(holder: Holder, name: str) -> RigidMotion:
    """Motion of the holder by its name, rotations about the pivot anticlockwise."""
    if name in _TURNS:
        return rotation(_TURNS[name], np.array(holder.pivot))
    return translation(holder.load_direction if name == "z" else _AXES[name])


def _closes(turn: RigidMotion, pairing: Pairing) -> bool:
    """Test whether a rotation closes the gap in the mean."""
    closing = np.einsum("ni,ni->n", turn.at(pairing.on_body_1), pairing.normals)
    return bool(pairing.weights @ closing >= 0.0)


def dead_load(holder: Holder, elastic: Elasticity) -> np.ndarray | None:
    """Nodal forces of the loads on surfaces, shape (n_owned,) [N]; None without surface loads."""
    loads = [elastic.spaces.loads(works) for works in surface_loads(holder, elastic)]
    return np.sum(loads, axis=0) if loads else None


def surface_loads(holder: Holder, elastic: Elasticity) -> list[list[Callable]]:
    """Forms by body of the work of the loads on surfaces, see `Elasticity`."""
    direction = np.array(holder.load_direction)
    forces = [
        elastic.surface_work(surface, force * direction)
        for surface, force in holder.surface_forces.items()
    ]
    pressures = holder.surface_pressures.items()
    return forces + [elastic.pressure_work(*given) for given in pressures]


def dead_resultant(
    elastic: Elasticity, upper: tuple[str, ...], forces: np.ndarray | None, motion: RigidMotion
) -> np.ndarray:
    """Generalised forces of nodal forces on a rigid motion of body 1 and of body 2, shape (2,).

    Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    upper : tuple of str
        Parts of body 1.
    forces : ndarray or None, shape (n_owned,) [N]
    motion : RigidMotion
    """
    if forces is None:
        return np.zeros(2)
    nodes = elastic.nodes()
    work = (forces.reshape(nodes.shape) * motion.at(nodes)).sum(axis=1)
    on_1 = elastic.owned_by(*upper)
    parts = np.array([work[on_1].sum(), work[~on_1].sum()])
    return sum_over_ranks(elastic.bodies.comm, parts)
