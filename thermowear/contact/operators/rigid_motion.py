"""Rigid motions at a contact: modes of holders, sliding, and tangential directions.

Signs are those of `contact.search.pairing`. The tangential direction ``e`` is n turned by +90
degrees: ``e = (-n_y, n_x)``, which is +x for a body 1 lying above. The shear traction t acts on
body 1: traction ``-p n + t e`` on body 1, the opposite on body 2. The slip is the tangential
displacement of body 1 relative to body 2::

    s = (u1 - u2)·e

so that friction opposes it, ``t ds <= 0``, with the heat ``-t ds``. A holder moves body 1 by
``m d``: that changes gap and slip by ``-R d`` with ``R = (m·n, -m·e)``, and the force of the holder
along m is ``F = Rᵀ w (p, t)``. Both are reversed for a holder of body 2. In space there are two
directions ``e_1`` and ``e_2 = e_1 × n``, see `faces.normals`; slip and shear have a component
along each.

Pressure and shear share the basis Ψ. Their coefficients are stacked: ``x = (λ, τ_1, τ_2 …)`` with
one block per tangential direction, one in the plane. In weak form,

    (gap, slip) = Ψᵀ w (g0, 0) + A x - R d,     F = Rᵀ x.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import TypeAlias

import numpy as np

from ...laws.histories import LoadHistory
from ...laws.motions import RigidMotion
from ..faces.normals import TangentFrame, frame_in_space
from ..search.pairing import Contacts, Pairing

_ZERO_LENGTH = 1e-9
"""Relative length, by the largest vector, below which a vector is rounding noise."""

Load: TypeAlias = "tuple[float, LoadHistory | None]"
"""Generalised force with its time history."""


@dataclass(frozen=True)
class RigidMode:
    """Rigid motion of a holder with a given load or a given amplitude.

    Attributes
    ----------
    motion : RigidMotion
    load : float or None
        Generalised force: force along a translation [N], moment of a rotation [N m].
    amplitude : float or None
        Given motion [m or rad].
    dead : float
        Constant generalised force on its bodies that does not come from the holder [N or N m].
    bodies : tuple of int
        Indices of the bodies that move.
    history : LoadHistory or None
        Time history of the load.
    reactions : tuple of (float, LoadHistory or None)
        Generalised forces of other holders that press against this one, with their histories.
    """

    motion: RigidMotion
    load: float | None = None
    amplitude: float | None = None
    dead: float = 0.0
    bodies: tuple[int, ...] = (0,)
    history: LoadHistory | None = None
    reactions: tuple[Load, ...] = ()

    def __post_init__(self):
        if (self.load is None) == (self.amplitude is None):
            raise ValueError("holder: give either the load or the motion")

    def load_by(self, factor: Callable[[LoadHistory | None], float]) -> float:
        """Sum of all loads on a free motion, by the factor of the history of each [N or N m]."""
        loads = [(self.load or 0.0, self.history), *self.reactions]
        return sum(factor(history) * load for load, history in loads)


@dataclass(frozen=True)
class RigidHolder:
    """Rigid holders of all bodies.

    Attributes
    ----------
    rigid_modes : tuple of RigidMode
        Their rigid modes: k free ones, and those with given motion.
    closure : ndarray, shape (n, n_modes)
        Matrix R: gap closure at the points per unit of each mode.
    force_response : ndarray, shape (n, n_modes)
        Matrix T: generalised force on each mode per pressure and area.
    """

    rigid_modes: tuple[RigidMode, ...]
    closure: np.ndarray
    force_response: np.ndarray

    @property
    def motions(self) -> tuple[RigidMotion, ...]:
        return tuple(mode.motion for mode in self.rigid_modes)

    @property
    def free(self) -> np.ndarray:
        """True for modes under a given load, whose motion is free, shape (n_modes,)."""
        return np.array([mode.amplitude is None for mode in self.rigid_modes], dtype=bool)

    @property
    def modes(self) -> np.ndarray:
        """Columns of R of the free motions, shape (n, k)."""
        return self.closure[:, self.free]

    @property
    def force_modes(self) -> np.ndarray:
        """Columns of T of the free motions, shape (n, k)."""
        return self.force_response[:, self.free]

    @property
    def load(self) -> np.ndarray:
        """Generalised forces of the holders on the free motions, shape (k,) [N or N m]."""
        return self.load_by(lambda history: 1.0)

    def load_by(self, factor: Callable[[LoadHistory | None], float]) -> np.ndarray:
        """These forces at a time, by the factors of their histories, shape (k,) [N or N m]."""
        given = [mode.load_by(factor) for mode in self.rigid_modes if mode.load is not None]
        return np.array(given, dtype=float)

    @property
    def dead(self) -> np.ndarray:
        """Constant forces on the free motions that the holder does not exert, (k,) [N or N m]."""
        return np.array([mode.dead for mode in self.rigid_modes if mode.load is not None], float)

    @property
    def imposed(self) -> np.ndarray:
        """Gap closure by the given motions, shape (n,) [m]."""
        return self.closure @ self.amplitudes(np.zeros(int(self.free.sum())))

    def amplitudes(self, free: np.ndarray) -> np.ndarray:
        """Amplitudes of all modes from those of the free ones, shape (n_modes,) [m or rad]."""
        result = np.array([mode.amplitude or 0.0 for mode in self.rigid_modes], dtype=float)
        result[self.free] = free
        return result


def hold(
    contacts: Contacts,
    traction_direction: np.ndarray,
    rigid_modes: list[RigidMode] | tuple[RigidMode, ...],
) -> RigidHolder:
    """Build the holders from their rigid modes.

    A motion of the second body of a contact opens where the same one of the first body closes.

    Parameters
    ----------
    contacts : Contacts
    traction_direction : ndarray, shape (n, gdim)
        ``n + mu e``, see `pairing`.
    rigid_modes : sequence of RigidMode
    """
    closure, force_response = np.zeros((2, len(contacts.weights), len(rigid_modes)))
    for k, mode in enumerate(rigid_modes):
        for body in mode.bodies:
            for side, points in contacts.of_body(body):
                at = (contacts.on_body_1, contacts.on_body_2)[side][points]
                moved = (1.0, -1.0)[side] * mode.motion.at(at)
                closure[points, k] += np.einsum("ni,ni->n", moved, contacts.normals[points])
                along = traction_direction[points]
                force_response[points, k] += np.einsum("ni,ni->n", moved, along)
    return RigidHolder(tuple(rigid_modes), closure, force_response)


@dataclass(frozen=True)
class Sliding:
    """Sliding at the contact points; sign convention of `pairing`.

    Attributes
    ----------
    speed : ndarray, shape (n,) [m/s]
    along : ndarray, shape (n, gdim)
        Unit sliding direction e of body 1, components in the section.
    across : ndarray, shape (n, gdim)
        Unit tangent e_2 across the sliding, along which the load pushes body 1 down the face; zero
        where the face is level in that direction, and where nothing slides.
    """

    speed: np.ndarray
    along: np.ndarray
    across: np.ndarray

    def traction_direction(
        self,
        normals: np.ndarray,
        friction: float | np.ndarray,
        transverse: float | np.ndarray,
    ) -> np.ndarray:
        """Direction ``n + mu e + mu_d e_2``; the traction on body 1 is minus the pressure times it.

        The transverse part comes from the small velocity of wear across the sliding (Páczelt and
        Mróz, Int. J. Solids Struct. 44 (2007) 895).

        Parameters
        ----------
        normals : ndarray, shape (n, gdim)
        friction : float or ndarray, shape (n, 1)
            Coefficient of friction mu.
        transverse : float or ndarray, shape (n, 1)
            Transverse coefficient mu_d.

        Returns
        -------
        ndarray, shape (n, gdim)
        """
        return normals + friction * self.along + transverse * self.across


def sliding(
    velocity: np.ndarray, normals: np.ndarray, load_direction: Sequence[float] | np.ndarray
) -> Sliding:
    """Split the sliding velocity into speed and directions.

    Parameters
    ----------
    velocity : ndarray, shape (n, 3)
        Velocity of body 1 relative to body 2 [m/s], see `bulk.kinematics`.
    normals : ndarray, shape (n, gdim)
        Outward unit normals of body 1.
    load_direction : array_like, shape (gdim,)
        Unit vector of the load direction of body 1.
    """
    gdim = normals.shape[1]
    n = _spatial(normals)
    speed = np.linalg.norm(velocity, axis=1)
    along = _unit(_tangential(velocity, n), float(speed.max(initial=0.0)))
    down = _tangential(np.broadcast_to(_spatial(np.array([load_direction])), n.shape), n)
    down = down - np.einsum("ni,ni->n", down, along)[:, None] * along
    down[speed == 0.0] = 0.0
    return Sliding(speed, along[:, :gdim], _unit(down, 1.0)[:, :gdim])


def joined_sliding(each: Sequence[Sliding]) -> Sliding:
    """Sliding at the points of several interfaces, one after the other."""
    if len(each) == 1:
        return each[0]
    columns = (np.concatenate([getattr(s, f.name) for s in each]) for f in fields(Sliding))
    return Sliding(*columns)


def _spatial(vectors: np.ndarray) -> np.ndarray:
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def _tangential(vectors: np.ndarray, normals: np.ndarray) -> np.ndarray:
    return vectors - np.einsum("ni,ni->n", vectors, normals)[:, None] * normals


def _unit(vectors: np.ndarray, largest: float) -> np.ndarray:
    """Unit vectors; zero for those negligible against the largest one."""
    sizes = np.linalg.norm(vectors, axis=1, keepdims=True)
    counts = sizes > _ZERO_LENGTH * largest
    return np.divide(vectors, sizes, out=np.zeros_like(vectors), where=counts)


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
