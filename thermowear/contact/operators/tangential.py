"""Condensation of the elastic bodies to pressure and shear at the contact.

Sign convention: that of `pairing`, and for the tangential direction
---------------------------------------------------------------------
``e`` is n turned by +90 degrees: ``e = (-n_y, n_x)``, which is +x for a body 1 lying above. The
shear traction t acts on body 1: traction ``-p n + t e`` on body 1, the opposite on body 2. The slip
is the tangential displacement of body 1 relative to body 2::

    s = (u1 - u2)·e

so that friction opposes it, ``t ds <= 0``, with the heat ``-t ds``. The holder moves body 1 by
``m d``: that changes gap and slip by ``-R d`` with ``R = (m·n, -m·e)``, and the force of the holder
along m is ``F = Rᵀ w (p, t)``.

Pressure and shear share the basis Ψ. Their coefficients are stacked: ``x = (λ, τ_1, τ_2 …)`` with
one block per tangential direction, one in the plane. In weak form,

    (gap, slip) = Ψᵀ w (g0, 0) + A x - R d,     F = Rᵀ x.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...bulk.mechanics.elasticity import Elasticity
from ...parallel import sum_over_ranks
from ..search.contacts import Contacts
from ..search.pairing import Pairing
from .pressure import PressureSpace, scaled
from .traces import vector_trace


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
    influence : ndarray, shape (n_owned, M)
        Displacement per coefficient [m/Pa]; weak gap and slips due to any nodal load f are
        ``influenceᵀ f``.
    """

    gap: np.ndarray
    response: np.ndarray
    rigid: np.ndarray
    compliance: np.ndarray
    modes: np.ndarray
    influence: np.ndarray

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
    modes = np.concatenate([weighted.T @ component for component in rigid])
    compliance = (compliance + compliance.T) / 2
    return FrictionalContact(basis, weighted, gap, response, rigid, compliance, modes, influence)


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


def condense_tangential(
    elastic: Elasticity, pairing: Pairing, basis: np.ndarray, translations: np.ndarray
) -> FrictionalContact:
    """Condense elasticity to pressure and shear in one solution. Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    pairing : Pairing
    basis : ndarray, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    translations : ndarray, shape (k, 2)
        Unit translations of the holder: along the load direction, and across it if permitted.

    Raises
    ------
    ComputationError
        If the elastic problem cannot be solved.
    """
    weighted = scaled(pairing.weights, basis)
    directions = [pairing.normals, *-tangents(pairing.normals)]
    contacts = Contacts((pairing,))
    traces = [vector_trace(elastic.spaces, contacts, direction) for direction in directions]
    sparse = sp.csr_matrix(weighted)
    influence = elastic.solve(sp.hstack([trace @ sparse for trace in traces], format="csr"))
    comm = elastic.bodies.comm
    response = sum_over_ranks(comm, np.array([trace.T @ influence for trace in traces]))
    rigid = np.array([direction @ np.asarray(translations).T for direction in directions])
    return frictional_contact(basis, pairing.weights, pairing.gap, response, rigid, influence)
