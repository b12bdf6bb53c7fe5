"""Static condensation of elasticity to the contact interface: small dense operators."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...bulk.mechanics.elasticity import Elasticity
from ...parallel import sum_over_ranks
from ..search.pairing import Pairing
from .holder import RigidHolder
from .traces import transpose_product

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
    """

    basis: np.ndarray
    weighted: np.ndarray
    compliance: np.ndarray
    modes: np.ndarray
    force_modes: np.ndarray

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
    per_rise : tuple of ndarray, shape (n_owned of the temperature, m)
        Gᵀ K⁻¹ Bᵗ w Ψ for each thermal load matrix G: weak gap per nodal rise [m³/K].
    comm : mpi4py.MPI.Comm
    """

    trace: sp.csr_matrix
    basis: np.ndarray
    weighted: np.ndarray
    touching: np.ndarray
    near: np.ndarray
    per_rise: tuple[np.ndarray, ...]
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
        return CondensedContact(self.basis, self.weighted, compliance, modes, force_modes)


def influence(
    elastic: Elasticity,
    pairing: Pairing,
    trace: sp.csr_matrix,
    basis: np.ndarray,
    thermal_loads: Sequence[PETSc.Mat] = (),
) -> Influence:
    """Compute the elastic response to every pressure function. Every rank calls.

    Solutions are reduced block by block: only rows at the contact and products with the thermal
    loads are stored.

    Parameters
    ----------
    elastic : Elasticity
    pairing : Pairing
    trace : csr_matrix, shape (n_owned, n)
        Transposed gap trace Bᵀ.
    basis : ndarray, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    thermal_loads : sequence of petsc4py.PETSc.Mat
        Matrices G of nodal forces per nodal rise, from `Elasticity.thermal_load`.
    """
    dim = elastic.bodies.mesh.geometry.dim
    weighted = pairing.weights[:, None] * basis
    # only nodes of cells at the contact are loaded: 2 % of the rows
    loads = (trace @ sp.csr_matrix(weighted)).tocsc()
    nodes = np.unique(np.flatnonzero(np.diff(trace.indptr)) // dim)
    touching = (nodes[:, None] * dim + np.arange(dim)).ravel()
    near: list[np.ndarray] = []
    per_rise: list[list[np.ndarray]] = [[] for _ in thermal_loads]
    for columns in blocks(weighted.shape[1], dim):
        displacements = elastic.solve(loads[:, columns].tocsr())
        near.append(displacements[touching])
        for matrix, products in zip(thermal_loads, per_rise, strict=True):
            products.append(transpose_product(matrix, displacements))
    return Influence(
        trace,
        basis,
        weighted,
        touching,
        np.hstack(near),
        tuple(np.hstack(products) for products in per_rise),
        elastic.space.mesh.comm,
    )


def blocks(count: int, dim: int) -> Iterator[slice]:
    """Ranges of columns that are solved for together, in a mesh of dimension `dim`."""
    size = _COLUMNS[dim]
    return (slice(start, start + size) for start in range(0, count, size))


def condense(
    elastic: Elasticity,
    pairing: Pairing,
    trace: sp.csr_matrix,
    traction: sp.csr_matrix,
    basis: np.ndarray,
    holder: RigidHolder,
) -> CondensedContact:
    """Condense elasticity to the pressure space; parameters as in `influence` and `Influence`.

    Every rank calls.
    """
    return influence(elastic, pairing, trace, basis).condensed(traction, holder)
