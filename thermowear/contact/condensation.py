"""The elastic bodies condensed to the contact: everything that repeats is small and dense."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..bulk.elasticity import Elasticity
from ..parallel import sum_over_ranks
from .holder import Holder
from .pairing import Pairing

_COLUMNS = {2: 32, 3: 128}
"""Solved together, by dimension: more at once would not fit the caches, or the memory."""


@dataclass(frozen=True)
class CondensedContact:
    """Weak gap of the elastic bodies as a function of the pressure.

    With ``p = Ψ λ``, the weak gap is ``Ψᵀ w (g0 + W) + A λ - Rw d`` (+ thermal distortion).

    Attributes
    ----------
    basis : ndarray, shape (n, m)
        Ψ.
    weighted : ndarray, shape (n, m)
        ``diag(w) Ψ``.
    compliance : ndarray, shape (m, m)
        A = Ψᵀ w B K⁻¹ B_tᵗ w Ψ [m⁵/N = weak gap per coefficient].
    modes : ndarray, shape (m, k)
        Rw = Ψᵀ w R: weak gap closed per unit of each free rigid motion of the holder.
    force_modes : ndarray, shape (m, k)
        Ψᵀ w T: generalised force of each coefficient on each of these motions.
    influence : ndarray or None, shape (n_owned, m)
        K⁻¹ Bᵗ w Ψ: the weak gap due to any nodal load f is ``influenceᵀ f``. Large, and kept where
        it is asked for.
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


def condense(
    elastic: Elasticity,
    pairing: Pairing,
    trace: sp.csr_matrix,
    traction: sp.csr_matrix,
    basis: np.ndarray,
    holder: Holder,
    keep_influence: bool = False,
) -> CondensedContact:
    """Condense elasticity to the pressure space. Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    pairing : Pairing
    trace, traction : csr_matrix, shape (n_owned, n)
        Bᵀ and B_tᵀ: of the gap and of what the pressure does work on; the same matrix where there
        is no friction in the section.
    basis : ndarray, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    holder : Holder
    keep_influence : bool
        For thermal distortion.
    """
    weighted = pairing.weights[:, None] * basis
    # only nodes of cells at the contact carry loads: 2 % of the rows
    loads = trace @ sp.csr_matrix(weighted)
    pulls = loads if traction is trace else traction @ sp.csr_matrix(weighted)
    rows, kept, loads = [], [], loads.tocsc()
    width = _COLUMNS[elastic.bodies.mesh.geometry.dim]
    for start in range(0, weighted.shape[1], width):
        displacements = elastic.solve(loads[:, start : start + width].tocsr())
        rows.append((pulls.T @ displacements).T)
        if keep_influence:
            kept.append(displacements)
    compliance = sum_over_ranks(elastic.space.mesh.comm, np.vstack(rows))
    if traction is trace:
        compliance = (compliance + compliance.T) / 2
    modes, force_modes = weighted.T @ holder.modes, weighted.T @ holder.force_modes
    influence = np.hstack(kept) if keep_influence else None
    return CondensedContact(basis, weighted, compliance, modes, force_modes, influence)
