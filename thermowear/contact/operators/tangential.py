"""Condensation of the elastic bodies to pressure and shear at the contact.

Sign convention: that of `pairing`, and for the tangential direction
---------------------------------------------------------------------
``e`` is n turned by +90 degrees: ``e = (-n_y, n_x)``, which is +x for a body 1 lying above. The
shear traction t acts on body 1: traction ``-p n + t e`` on body 1, the opposite on body 2. The slip
is the tangential displacement of body 1 relative to body 2::

    s = (u1 - u2)·e

so that friction opposes it, ``t ds <= 0``, with the heat ``-t ds``. A holder moves body 1 by
``m d``: that changes gap and slip by ``-R d`` with ``R = (m·n, -m·e)``, and the force of the holder
along m is ``F = Rᵀ w (p, t)``. Both are reversed for a holder of body 2.

Pressure and shear share the basis Ψ. Their coefficients are stacked: ``x = (λ, τ_1, τ_2 …)`` with
one block per tangential direction, one in the plane. In weak form,

    (gap, slip) = Ψᵀ w (g0, 0) + A x - R d,     F = Rᵀ x.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...bulk.mechanics.elasticity import Elasticity
from ...laws.motions import RigidMotion
from ...parallel import sum_over_ranks
from ..search.contacts import Contacts
from ..search.pairing import Pairing
from .pressure import Basis, PressureSpace, dense, scaled
from .rigid_motion import RigidMode, hold
from .traces import vector_trace

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


@dataclass(frozen=True)
class FrictionalContact(PressureSpace):
    """Gap and slip of the elastic bodies as functions of pressure and shear.

    Below, t tangential directions give ``M = m (1 + t)`` coefficients.

    Attributes
    ----------
    gap : ndarray, shape (n,)
        Gap of the unloaded, unworn bodies [m].
    response : ndarray, shape (1 + t, n, M)
        Gap and slips at the points per coefficient [m/Pa].
    rigid : ndarray, shape (1 + t, n, k)
        R at the points: decrease of gap and slips per unit of each motion of the holder.
    compliance : ndarray, shape (M, M)
        A, symmetric [m⁵/N].
    modes : ndarray, shape (M, k)
        Weak R [m²].
    travel : ndarray, shape (n_interfaces, k)
        Displacement of the first body over the second one, along increasing positions on the face,
        per unit of each motion.
    held : tuple of HeldMotion
        The k motions.
    influence : ndarray, shape (n_owned, M)
        Displacement per coefficient [m/Pa]; weak gap and slips due to any nodal load f are
        ``influenceᵀ f``.
    """

    gap: np.ndarray
    response: np.ndarray
    rigid: np.ndarray
    compliance: np.ndarray
    modes: np.ndarray
    travel: np.ndarray
    held: tuple[HeldMotion, ...]
    influence: np.ndarray

    def with_role(self, role: str) -> np.ndarray:
        """True for the motions with a role, shape (k,)."""
        return np.array([motion.role == role for motion in self.held], dtype=bool)

    def stack(self, pressure: np.ndarray, shear: np.ndarray) -> np.ndarray:
        """Coefficients λ, shape (m,), and τ, shape (m, t), as one vector x."""
        return np.concatenate([pressure, shear.T.ravel()])

    def split(self, stacked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Split x into λ and τ, the inverse of `stack`."""
        blocks = stacked.reshape(-1, self.basis.shape[1])
        return blocks[0], blocks[1:].T

    def point_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Slip at the points under coefficients x and motion d of the holder, shape (n, t) [m]."""
        return (self.response[1:] @ stacked - self.rigid[1:] @ motion).T


def frictional_contact(
    basis: np.ndarray,
    weights: np.ndarray,
    gap: np.ndarray,
    response: np.ndarray,
    rigid: np.ndarray,
    travel: np.ndarray,
    held: Sequence[HeldMotion],
    influence: np.ndarray,
) -> FrictionalContact:
    """Assemble weak operators from responses at the points; arguments as in `FrictionalContact`.

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Area of each point [m²].
    """
    weighted = scaled(weights, basis)
    compliance = np.concatenate([weighted.T @ component for component in response])
    modes = weak(weighted, rigid)
    compliance = (compliance + compliance.T) / 2
    return FrictionalContact(
        basis, weighted, gap, response, rigid, compliance, modes, travel, tuple(held), influence
    )


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


def travel(contacts: Contacts, motion: HeldMotion) -> np.ndarray:
    """Travel of the first body along the face of each interface, shape (n_interfaces,).

    Along the mean tangent in the middle of the face, see `FrictionalContact`.
    """
    found = np.zeros(len(contacts.each))
    for body in motion.bodies:
        for index, pair in enumerate(contacts.bodies):
            if body in pair:
                middle, along = _middle(contacts.each[index])
                moved = float(motion.motion.at(middle) @ along)
                found[index] += moved if pair.index(body) == 0 else -moved
    found[np.abs(found) < _NOISE * np.abs(found).max(initial=1.0)] = 0.0
    return found


def _middle(pairing: Pairing) -> tuple[np.ndarray, np.ndarray]:
    """Middle of a face in the plane, and its mean tangent along increasing positions."""
    mean = pairing.weights @ pairing.normals
    along = tangents(mean[None])[0, 0] / np.linalg.norm(mean)
    first, last = np.argmin(pairing.position), np.argmax(pairing.position)
    onwards = (pairing.points[last] - pairing.points[first]) @ along
    middle = pairing.weights @ pairing.points / pairing.weights.sum()
    return middle, along if onwards >= 0.0 else -along


def condense_tangential(
    elastic: Elasticity, contacts: Contacts, basis: Basis, held: Sequence[HeldMotion]
) -> FrictionalContact:
    """Condense elasticity to pressure and shear in one solution. Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    contacts : Contacts
        Contact points of a plane or axisymmetric model.
    basis : ndarray or csr_array, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    held : sequence of HeldMotion
        Motions of the holders.

    Raises
    ------
    ComputationError
        If the elastic problem cannot be solved.
    """
    basis = dense(basis)
    weighted = scaled(contacts.weights, basis)
    directions = [contacts.normals, *-tangents(contacts.normals)]
    traces = [vector_trace(elastic.spaces, contacts, direction) for direction in directions]
    sparse = sp.csr_matrix(weighted)
    influence = elastic.solve(sp.hstack([trace @ sparse for trace in traces], format="csr"))
    comm = elastic.bodies.comm
    response = sum_over_ranks(comm, np.array([trace.T @ influence for trace in traces]))
    along = np.reshape([travel(contacts, each) for each in held], (len(held), -1)).T
    rigid = closure(contacts, held)
    return frictional_contact(
        basis, contacts.weights, contacts.gap, response, rigid, along, held, influence
    )


def closure(contacts: Contacts, held: Sequence[HeldMotion]) -> np.ndarray:
    """Matrix R at the points, shape (1 + t, n, k), see `FrictionalContact`."""
    modes = [RigidMode(each.motion, amplitude=0.0, bodies=each.bodies) for each in held]
    directions = [contacts.normals, *-tangents(contacts.normals)]
    return np.array([hold(contacts, each, modes).force_response for each in directions])


def weak(weighted: np.ndarray, rigid: np.ndarray) -> np.ndarray:
    """Weak modes, shape (M, k), of a matrix R at the points, shape (1 + t, n, k)."""
    return np.concatenate([weighted.T @ component for component in rigid])
