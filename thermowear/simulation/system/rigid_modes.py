"""Rigid modes of the holders, their loads, and the loads on surfaces of the bodies."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy.sparse as sp

from ...bulk.elasticity.elasticity import Elasticity
from ...contact.operators.rigid_motion import Load, RigidMode, hold
from ...contact.search.pairing import Contacts, Pairing
from ...errors import CaseError
from ...laws.motions import RigidMotion, rotation, translation
from ...model.body import Body
from ...model.conditions import Holder
from ...model.interface import Interface
from ...model.model import Model
from ...parallel import sum_over_ranks

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0)}
_TURNS = {
    "rotation-x": (1.0, 0.0, 0.0),
    "rotation-y": (0.0, 1.0, 0.0),
    "rotation": (0.0, 0.0, 1.0),
}
_GUIDED = {
    "axisymmetric": ("z",),
    "3d": ("x", "y", "z", "rotation-x", "rotation-y"),
    "plane-strain": ("x", "z", "rotation"),
    "plane-stress": ("x", "z", "rotation"),
}
"""Rigid motions with a guide force or moment on body 1, by kinematic model."""
_OPPOSITE = 0.1
"""Least component of the mean normal against a load direction that has the opposite sense.

The mean normal of a face all round, or of a half beside a plane of symmetry, has no sense.
"""


def rigid_modes(
    holders: Sequence[Holder], contacts: Contacts, dead: Callable[[RigidMotion], np.ndarray]
) -> tuple[RigidMode, ...]:
    """Rigid modes of the holders, each in the order of its free motions, with loads or amplitudes.

    A force acts along the load direction at the point of the load, so that its generalised force
    on a motion m is ``F e·m(point)``, e the load direction; moments add their work on its rotation.

    Parameters
    ----------
    holders : sequence of Holder
    contacts : Contacts
    dead : callable
        Generalised forces on a motion of each body that do not come from a holder, shape
        (n_bodies,) [N or N m].
    """

    def mode(holder: Holder, name: str) -> RigidMode:
        motion, moment, approach = motion_of(holder, name), holder.closing_moment, holder.approach
        if holder.free == ("rotation",) and not _closes(motion, holder, contacts):
            motion = rotation((0.0, 0.0, -1.0), np.array(holder.pivot))
        other = float(dead(motion)[list(holder.bodies)].sum())
        if name == "z" and approach is not None:
            return RigidMode(motion, amplitude=approach, dead=other, bodies=holder.bodies)
        (load, history), *others = loads_on(holders, holder, motion)
        load = load if moment is None else moment
        return RigidMode(motion, load, None, other, holder.bodies, history, tuple(others))

    return tuple(mode(holder, name) for holder in holders for name in holder.free)


def guides(kinematics: str, holder: Holder) -> dict[str, RigidMotion]:
    """Rigid motions by name, conjugate to the guide forces and moments on a holder.

    Along x (and y), upwards, and about the pivot; upwards only in an axisymmetric model.
    """
    up = translation((0.0, 0.0, 1.0) if kinematics == "3d" else (0.0, 1.0))
    return {name: up if name == "z" else motion_of(holder, name) for name in _GUIDED[kinematics]}


def load_direction(model: Model, interface: Interface, pairing: Pairing) -> np.ndarray:
    """Unit vector along which the first body of an interface is pressed, shape (gdim,).

    Load direction of its holder, else the opposite of that of the second body, with the sense of
    the mean normal: a body that floats is pressed from both sides. Without a holder that can be
    pressed, the mean normal.
    """
    mean = pairing.weights @ pairing.normals
    for sign, body in zip((1.0, -1.0), interface.bodies, strict=True):
        for holder in model.holders:
            if body in holder.bodies and holder.free and not holder.hanging:
                direction = sign * np.array(holder.load_direction)
                opposite = direction @ mean < -_OPPOSITE * pairing.weights.sum()
                return -direction if opposite else direction
    return mean / np.linalg.norm(mean)


def load_directions(model: Model, contacts: Contacts) -> np.ndarray:
    """Load directions of the first bodies at the contact points, shape (n, gdim)."""
    each = zip(model.interfaces, contacts.each, strict=True)
    directions = [load_direction(model, interface, pairing) for interface, pairing in each]
    return np.repeat(directions, [len(pairing.weights) for pairing in contacts.each], axis=0)


def approaches(holders: Sequence[Holder], motions: Sequence[RigidMotion]) -> np.ndarray:
    """Displacement of the pivot of the first holder along its load per rigid mode, (n_modes,)."""
    if not holders:
        return np.zeros(0)
    first = holders[0]
    own, direction = len(first.free), np.array(first.load_direction)
    moved = [motion.at(np.array(first.pivot)) @ direction for motion in motions[:own]]
    return np.array([*moved, *np.zeros(len(motions) - own)], dtype=float)


def applied(holder: Holder, motion: RigidMotion) -> float:
    """Generalised force of the loads of the holder on a motion; moments by the right-hand rule."""
    force = holder.pressing_force
    force[0] += holder.tangential_force
    work = force @ motion.at(np.array(holder.point)) + np.array(holder.moments) @ motion.rotation
    return float(work)


def loads_on(holders: Sequence[Holder], holder: Holder, motion: RigidMotion) -> tuple[Load, ...]:
    """Generalised forces on a motion of a holder: its own, then of others that press against it."""
    pressing = [one for one in holders if one.reaction and one.reaction == holder.name]
    others = (
        (-float(one.pressing_force @ motion.at(np.array(one.point))), one.history)
        for one in pressing
    )
    return ((applied(holder, motion), holder.history), *others)


def motion_of(holder: Holder, name: str) -> RigidMotion:
    """Motion of the holder by its name, rotations about the pivot anticlockwise."""
    if name in _TURNS:
        return rotation(_TURNS[name], np.array(holder.pivot))
    return translation(holder.load_direction if name == "z" else _AXES[name])


def _closes(turn: RigidMotion, holder: Holder, contacts: Contacts) -> bool:
    """Test whether a rotation closes the gap in the mean."""
    turning = RigidMode(turn, load=0.0, bodies=holder.bodies)
    closing = hold(contacts, contacts.normals, [turning]).closure[:, 0]
    return bool(contacts.weights @ closing >= 0.0)


def dead_load(
    model: Model, contacts: Contacts, elastic: Elasticity, trace: sp.csr_matrix
) -> np.ndarray | None:
    """Nodal forces of loads on surfaces and of fluids, shape (n_owned,) [N]; None without them."""
    loads = [elastic.spaces.loads(works) for works in surface_loads(model, elastic)]
    fluid = fluid_pressure(model, contacts)
    if fluid is not None:
        loads.append(trace @ (contacts.weights * fluid))
    return np.sum(loads, axis=0) if loads else None


def fluid_pressure(model: Model, contacts: Contacts) -> np.ndarray | None:
    """Pressure of fluids on the contact faces, shape (n,) [Pa]; None without any.

    Raises
    ------
    CaseError
        If it is negative or not finite at a point.
    """
    if all(interface.fluid_pressure is None for interface in model.interfaces):
        return None
    axisymmetric = model.kinematics == "axisymmetric"
    found = np.zeros(len(contacts.weights))
    for interface, (pairing, own) in zip(model.interfaces, contacts, strict=True):
        if interface.fluid_pressure is not None:
            try:
                found[own] = interface.fluid_pressure.at(pairing.points, axisymmetric)
            except ValueError as error:
                raise CaseError(f"{interface.table}.fluid_pressure: {error}") from None
    return found


def surface_loads(model: Model, elastic: Elasticity) -> list[list[Callable]]:
    """Forms by body of the work of the loads on surfaces, see `Elasticity`."""
    forces = [
        elastic.surface_work(surface, force * np.array(holder.load_direction))
        for holder in model.holders
        for surface, force in holder.surface_forces.items()
    ]
    return forces + [elastic.pressure_work(*given) for given in model.surface_pressures.items()]


def dead_resultant(
    elastic: Elasticity,
    bodies: Sequence[Body],
    forces: np.ndarray | None,
    motion: RigidMotion,
) -> np.ndarray:
    """Generalised forces of nodal forces on a rigid motion of each body, shape (n_bodies,).

    Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    bodies : sequence of Body
    forces : ndarray or None, shape (n_owned,) [N]
    motion : RigidMotion
    """
    if forces is None:
        return np.zeros(len(bodies))
    nodes = elastic.nodes()
    work = (forces.reshape(nodes.shape) * motion.at(nodes)).sum(axis=1)
    parts = np.array([work[elastic.owned_by(*body.parts)].sum() for body in bodies])
    return sum_over_ranks(elastic.bodies.comm, parts)
