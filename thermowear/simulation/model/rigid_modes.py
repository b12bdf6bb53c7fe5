"""Rigid modes of the holder of body 1 and their loads, from the settings of the case."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...case.tables.schema import Case
from ...contact.operators.holder import RigidMode
from ...contact.search.pairing import Pairing
from ...laws.motions import RigidMotion, rotation, translation

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0)}
_TURNS = {"rotation-x": (1.0, 0.0, 0.0), "rotation-y": (0.0, 1.0, 0.0)}


def drives(
    case: Case, pairing: Pairing, dead: Callable[[RigidMotion], float]
) -> tuple[RigidMode, ...]:
    """Rigid modes of the holder, the load direction first, with the load or motion of each.

    A force acts along the load direction at the point of the load, so that its generalised force
    on any motion m is ``F press·m(point)``; moments add their work on its rotation.

    Parameters
    ----------
    case : Case
    pairing : Pairing
    dead : callable
        Generalised force on a motion of body 1 that does not come from the holder [N or N m].
    """
    names, approach = case.holder.free, case.approach()
    return tuple(
        RigidMode(m, amount=approach, dead=float(dead(m)))
        if approach is not None and name == "z"
        else RigidMode(m, load=_load(case, m, names), dead=float(dead(m)))
        for name, m in ((name, _motion(case, name, pairing)) for name in names)
    )


def guides(case: Case) -> dict[str, RigidMotion]:
    """Rigid motions by name, conjugate to the guide forces and moments on body 1.

    Along x (and y), upwards, and about the pivot; none in an axisymmetric model.
    """
    if case.model == "axisymmetric":
        return {}
    pivot = reference_point(case)
    if case.model == "3d":
        turns = {name: rotation(axis, pivot) for name, axis in _TURNS.items()}
        shifts = {name: translation(axis) for name, axis in _AXES.items()}
        return shifts | {"z": translation((0.0, 0.0, 1.0))} | turns
    up, out = (0.0, 1.0), (0.0, 0.0, 1.0)
    return {"x": translation(_AXES["x"]), "z": translation(up), "rotation": rotation(out, pivot)}


def reference_point(case: Case) -> np.ndarray:
    """Pivot of the holder, else of the geometry, else the origin, shape (gdim,) [m]."""
    pivot = case.holder.pivot or case.geometry.pivot_point
    dim = len(case.geometry.press_direction)
    return np.zeros(dim) if pivot is None else np.array(pivot)


def applied(case: Case, motion: RigidMotion) -> float:
    """Generalised force of the loads of the case on a motion; moments by the right-hand rule."""
    press = np.array(case.geometry.press_direction)
    load, dim = case.load, len(press)
    point = reference_point(case)
    if load.lever is not None:
        point = point + load.lever * np.eye(dim)[0]
    if load.point is not None:
        point = point.copy()
        point[: len(load.point)] = load.point
    moments = np.zeros(3)
    if load.moments is not None:
        moments[: len(load.moments)] = load.moments
    if load.moment is not None:
        moments[2] = load.moment
    force = (case.force() or 0.0) * press
    force[0] += load.tangential_force or 0.0
    return float(force @ motion.at(point) + moments @ motion.rotation)


def _motion(case: Case, name: str, pairing: Pairing) -> RigidMotion:
    if name == "z":
        return translation(case.geometry.press_direction)
    if name in _AXES:
        return translation(_AXES[name])
    pivot = reference_point(case)
    if name in _TURNS:
        return rotation(_TURNS[name], pivot)
    turn = rotation((0.0, 0.0, 1.0), pivot)
    if case.holder.free == ("rotation",):
        return rotation((0.0, 0.0, _closing_sense(turn, pairing)), pivot)
    return turn


def _closing_sense(turn: RigidMotion, pairing: Pairing) -> float:
    """+1 where an anticlockwise rotation closes the gap in the mean, -1 otherwise."""
    closing = np.einsum("ni,ni->n", turn.at(pairing.on_body_1), pairing.normals)
    return 1.0 if pairing.weights @ closing >= 0.0 else -1.0


def _load(case: Case, motion: RigidMotion, names: tuple[str, ...]) -> float:
    if names == ("rotation",) and case.load.moment is not None:
        return case.load.moment  # positive where it presses, in either sense of rotation
    return applied(case, motion)
