"""Tangential directions at the contact, and rigid motions of holders along them.

Sign convention: that of `pairing`, and for the tangential direction
---------------------------------------------------------------------
``e`` is n turned by +90 degrees: ``e = (-n_y, n_x)``, which is +x for a body 1 lying above. The
shear traction t acts on body 1: traction ``-p n + t e`` on body 1, the opposite on body 2. The slip
is the tangential displacement of body 1 relative to body 2::

    s = (u1 - u2)·e

so that friction opposes it, ``t ds <= 0``, with the heat ``-t ds``. A holder moves body 1 by
``m d``: that changes gap and slip by ``-R d`` with ``R = (m·n, -m·e)``, and the force of the holder
along m is ``F = Rᵀ w (p, t)``. Both are reversed for a holder of body 2. In space there are two
directions ``e_1`` and ``e_2 = e_1 × n``, see `faces.tangent_frame`; slip and shear have a component
along each.

Pressure and shear share the basis Ψ. Their coefficients are stacked: ``x = (λ, τ_1, τ_2 …)`` with
one block per tangential direction, one in the plane. In weak form,

    (gap, slip) = Ψᵀ w (g0, 0) + A x - R d,     F = Rᵀ x.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...laws.motions import RigidMotion
from ..faces.tangent_frame import TangentFrame, frame_in_space
from ..search.contacts import Contacts
from ..search.pairing import Pairing
from .rigid_motion import RigidMode, hold

_NOISE = 1e-9
"""Travel per unit of a motion, relative to the motion, below which it is rounding noise."""


@dataclass(frozen=True)
class HeldMotion:
    """Motion of a holder, free or given.

    Attributes
    ----------
    motion : RigidMotion
    bodies : tuple of int
        Indices of the bodies that move.
    role : str
        ``"press"`` along the load direction, ``"slide"`` across it, ``"other"``.
    holder : str
        Subject of messages about it.
    """

    motion: RigidMotion
    bodies: tuple[int, ...] = (0,)
    role: str = "other"
    holder: str = "contact: body 1"


def tangents(normals: np.ndarray) -> np.ndarray:
    """Tangential directions e: normals turned by +90 degrees.

    Parameters
    ----------
    normals : ndarray, shape (n, 2)

    Returns
    -------
    ndarray, shape (1, n, 2)
        One direction in the plane.
    """
    return np.column_stack([-normals[:, 1], normals[:, 0]])[None]


def forwards(directions: np.ndarray) -> np.ndarray:
    """Signs that turn directions (n, 2) towards +x, or towards +y if they run along y, (n,)."""
    x, y = directions.T
    return np.where(np.where(np.abs(x) > _NOISE, x, y) < 0.0, -1.0, 1.0)


def tangential_frame(
    contacts: Contacts, poles: np.ndarray | None = None, turned: float = 0.0
) -> np.ndarray:
    """Tangential directions e at the points, shape (t, n, gdim).

    Parameters
    ----------
    contacts : Contacts
    poles : ndarray, shape (n_interfaces, 3), optional
        Directions that the frames in space start from, by default the mean normals.
    turned : float, optional
        Angle by which the frames in space are turned [rad].
    """
    if not contacts.in_space:
        return tangents(contacts.normals)
    given = [None] * len(contacts.each) if poles is None else poles
    each = zip(contacts.each, given, strict=True)
    frames = ((p, frame_in_space(p.normals, p.weights, pole, turned)) for p, pole in each)
    return np.concatenate([frame.at(pairing.normals) for pairing, frame in frames], axis=1)


def travel(contacts: Contacts, motion: HeldMotion) -> np.ndarray:
    """Travel of the first body along the face of each interface, see `FrictionalContact`.

    Shape (n_interfaces,), in space (n_interfaces, 3).
    """
    measure = _travel_in_space if contacts.in_space else _travel_in_plane
    found = np.zeros((len(contacts.each), *((3,) if contacts.in_space else ())))
    for body in motion.bodies:
        for index, pair in enumerate(contacts.bodies):
            if body in pair:
                moved = measure(contacts.each[index], motion.motion)
                found[index] += moved if pair.index(body) == 0 else -moved
    found[np.abs(found) < _NOISE * np.abs(found).max(initial=1.0)] = 0.0
    return found


def _travel_in_plane(pairing: Pairing, motion: RigidMotion) -> float:
    """Displacement along the mean tangent in the middle of the face."""
    middle, along = _middle(pairing)
    return float(motion.at(middle) @ along)


def _travel_in_space(pairing: Pairing, motion: RigidMotion) -> np.ndarray:
    """Displacement along the axes of the frame in the middle of a face, and rotation, (3,)."""
    middle, frame = middle_in_space(pairing)
    return np.append(frame.axes @ motion.at(middle), motion.rotation @ frame.pole)


def middle_in_space(pairing: Pairing) -> tuple[np.ndarray, TangentFrame]:
    """Middle of a face in space (3,), and its frame by the mean outward normal."""
    middle = pairing.weights @ pairing.points / pairing.weights.sum()
    return middle, frame_in_space(pairing.outward, pairing.weights)


def _middle(pairing: Pairing) -> tuple[np.ndarray, np.ndarray]:
    """Middle of a carrying face in the plane, and its mean tangent along increasing positions."""
    mean = pairing.weights @ pairing.normals
    along = tangents(mean[None])[0, 0] / np.linalg.norm(mean)
    position = pairing.carrying.position
    onwards = (pairing.points[position.argmax()] - pairing.points[position.argmin()]) @ along
    middle = pairing.weights @ pairing.points / pairing.weights.sum()
    return middle, along if onwards >= 0.0 else -along


def closure(contacts: Contacts, held: Sequence[HeldMotion], frame: np.ndarray) -> np.ndarray:
    """Matrix R at the points, shape (1 + t, n, k), see `FrictionalContact`."""
    modes = [RigidMode(each.motion, amplitude=0.0, bodies=each.bodies) for each in held]
    return np.array([hold(contacts, e, modes).force_response for e in measured(contacts, frame)])


def measured(contacts: Contacts, frame: np.ndarray) -> list[np.ndarray]:
    """Directions of gap and slips: the normals, and the reversed tangential directions."""
    return [contacts.normals, *-frame]


def weak(weighted, rigid: np.ndarray) -> np.ndarray:
    """Weak modes, shape (M, k), of a matrix R at the points, shape (1 + t, n, k)."""
    return np.concatenate([weighted.T @ component for component in rigid])
