"""Static condensation of elasticity to the contact interface: small dense operators."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...bulk.mechanics.elasticity import Elasticity
from ...parallel import sum_over_ranks
from ..search.pairing import Pairing
from .holder import RigidHolder

_COLUMNS = {2: 32, 3: 128}
"""Right-hand sides per solution, by dimension; limited by the caches, or the memory."""


@dataclass(frozen=True)
class CondensedContact:
    """Condensed elastic bodies: weak gap as a function of the pressure.

    With ``p = Ψ λ``, the weak gap is ``Ψᵀ w (g0 + W) + A λ - Rw d`` (+ thermal distortion).

    Attributes
    ----------
    basis : ndarray, shape (n, m)
        Basis Ψ of the pressure.
    weighted : ndarray, shape (n, m)
        ``diag(w) Ψ``.
    compliance : ndarray, shape (m, m)
        A = Ψᵀ w B K⁻¹ B_tᵗ w Ψ [m⁵/N = weak gap per coefficient].
    modes : ndarray, shape (m, k)
        Rw = Ψᵀ w R: weak gap closed per unit of each free rigid motion of the holder.
    force_modes : ndarray, shape (m, k)
        Ψᵀ w T: generalised force of each coefficient on each of these motions.
    influence : ndarray or None, shape (n_owned, m)
        K⁻¹ Bᵗ w Ψ: the weak gap due to any nodal load f is ``influenceᵀ f``. Large: stored on
        request.
    """

    basis: np.ndarray
    weighted: np.ndarray
    compliance: np.ndarray
    modes: np.ndarray
    force_modes: np.ndarray
    influence: np.ndarray | None

    def weak(self, values: np.ndarray) -> np.ndarray:
        """Weighted means ``Ψᵀ w v`` of values at the points, shape (m,)."""
        return self.weighted.T @ values


@dataclass(frozen=True)
class Influence:
    """Elastic response to each pressure function: the solutions that condensation needs.

    Independent of loads, friction and wear.

    Attributes
    ----------
    trace : csr_matrix, shape (n_owned, n)
        Transposed gap trace Bᵀ.
    basis : ndarray, shape (n, m)
        Basis Ψ of the pressure.
    weighted : ndarray, shape (n, m)
        ``diag(w) Ψ``.
    touching : ndarray of int, shape (n_touching,)
        Owned degrees of freedom in cells at the contact, the only ones loaded by its tractions.
    near : ndarray, shape (n_touching, m)
        Rows of K⁻¹ Bᵗ w Ψ for these [m per coefficient].
    whole : ndarray or None, shape (n_owned, m)
        All rows: large, stored on request.
    comm : mpi4py.MPI.Comm
    """

    trace: sp.csr_matrix
    basis: np.ndarray
    weighted: np.ndarray
    touching: np.ndarray
    near: np.ndarray
    whole: np.ndarray | None
    comm: object

    def condensed(self, traction: sp.csr_matrix, holder: RigidHolder) -> CondensedContact:
        """Condensed contact for a friction and a holder, without elastic solution; collective.

        Parameters
        ----------
        traction : csr_matrix, shape (n_owned, n)
            B_tᵀ; the gap trace itself if there is no friction in the section.
        holder : RigidHolder
        """
        pulls = traction[self.touching] @ sp.csr_matrix(self.weighted)
        compliance = sum_over_ranks(self.comm, (pulls.T @ self.near).T)
        if traction is self.trace:
            compliance = (compliance + compliance.T) / 2
        modes, force_modes = (self.weighted.T @ m for m in (holder.modes, holder.force_modes))
        return CondensedContact(
            self.basis, self.weighted, compliance, modes, force_modes, self.whole
        )


def influence(
    elastic: Elasticity,
    pairing: Pairing,
    trace: sp.csr_matrix,
    basis: np.ndarray,
    keep_whole: bool = False,
) -> Influence:
    """Compute the elastic response to every pressure function. Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    pairing : Pairing
    trace : csr_matrix, shape (n_owned, n)
        Transposed gap trace Bᵀ.
    basis : ndarray, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    keep_whole : bool
        Whether to store all rows, for thermal distortion.
    """
    dim = elastic.bodies.mesh.geometry.dim
    weighted = pairing.weights[:, None] * basis
    # only nodes of cells at the contact are loaded: 2 % of the rows
    loads = (trace @ sp.csr_matrix(weighted)).tocsc()
    nodes = np.unique(np.flatnonzero(np.diff(trace.indptr)) // dim)
    touching = (nodes[:, None] * dim + np.arange(dim)).ravel()
    near, whole = [], []
    for start in range(0, weighted.shape[1], _COLUMNS[dim]):
        displacements = elastic.solve(loads[:, start : start + _COLUMNS[dim]].tocsr())
        near.append(displacements[touching])
        if keep_whole:
            whole.append(displacements)
    return Influence(
        trace,
        basis,
        weighted,
        touching,
        np.hstack(near),
        np.hstack(whole) if keep_whole else None,
        elastic.space.mesh.comm,
    )


def condense(
    elastic: Elasticity,
    pairing: Pairing,
    trace: sp.csr_matrix,
    traction: sp.csr_matrix,
    basis: np.ndarray,
    holder: RigidHolder,
    keep_influence: bool = False,
) -> CondensedContact:
    """Condense elasticity to the pressure space; parameters as in `influence` and `Influence`.

    Every rank calls.
    """
    return influence(elastic, pairing, trace, basis, keep_influence).condensed(traction, holder)
