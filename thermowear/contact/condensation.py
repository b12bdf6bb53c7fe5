"""The elastic bodies condensed to the contact: everything that repeats is small and dense."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..bulk.elasticity import Elasticity
from ..parallel import sum_over_ranks
from .pairing import Pairing


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
        A = Ψᵀ w B K⁻¹ Bᵗ w Ψ [m⁵/N = weak gap per coefficient].
    modes : ndarray, shape (m, k)
        Rw = Ψᵀ w R: weak gap closed per unit of each rigid motion of the holder.
    influence : ndarray, shape (n_owned, m)
        K⁻¹ Bᵗ w Ψ: the weak gap due to any nodal load f is ``influenceᵀ f``.
    """

    basis: np.ndarray
    weighted: np.ndarray
    compliance: np.ndarray
    modes: np.ndarray
    influence: np.ndarray

    def weak(self, values: np.ndarray) -> np.ndarray:
        """Weighted means ``Ψᵀ w v`` of values at the points, shape (m,)."""
        return self.weighted.T @ values


def condense(
    elastic: Elasticity,
    pairing: Pairing,
    trace: sp.csr_matrix,
    basis: np.ndarray,
    rigid: np.ndarray,
) -> CondensedContact:
    """Condense elasticity to the pressure space. Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    pairing : Pairing
    trace : csr_matrix, shape (n_owned, n)
        Bᵀ, from `traces.gap_trace`.
    basis : ndarray, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    rigid : ndarray, shape (n, k)
        R, normal components of the holder's unit motions.
    """
    weighted = pairing.weights[:, None] * basis
    loads = trace @ weighted
    influence = elastic.solve(loads)
    compliance = sum_over_ranks(elastic.space.mesh.comm, loads.T @ influence)
    compliance = (compliance + compliance.T) / 2
    return CondensedContact(basis, weighted, compliance, weighted.T @ rigid, influence)
