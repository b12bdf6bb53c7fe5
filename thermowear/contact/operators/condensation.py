"""Static condensation of elasticity and conduction to the contact: small dense operators."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...bulk.heat.conduction import Conduction
from ...bulk.mechanics.elasticity import Elasticity
from ...bulk.spaces import Spaces
from ...parallel import sum_over_ranks
from ..search.pairing import Pairing
from .heat import FaceHeat, InterfaceHeat, ThermalDistortion
from .pressure import Basis, PressureSpace, scaled
from .rigid_motion import RigidHolder
from .traces import distributed, transpose_product

_COLUMNS = {2: 32, 3: 128}
"""Right-hand sides per solution, by dimension; limited by the caches, or the memory."""


@dataclass(frozen=True)
class CondensedContact(PressureSpace):
    """Condensed elastic bodies: weak gap as a function of the pressure.

    The weak gap is ``Ψᵀ w (g0 + W) + A λ - Rw d`` (+ thermal distortion).

    Attributes
    ----------
    compliance : ndarray, shape (m, m)
        A = Ψᵀ w B K⁻¹ B_tᵗ w Ψ [m⁵/N = weak gap per coefficient].
    modes : ndarray, shape (m, k)
        Rw = Ψᵀ w R: weak gap closed per unit of each free rigid motion of the holder.
    force_modes : ndarray, shape (m, k)
        Ψᵀ w T: generalised force of each coefficient on each of these motions.
    """

    compliance: np.ndarray
    modes: np.ndarray
    force_modes: np.ndarray


@dataclass(frozen=True)
class Influence(PressureSpace):
    """Elastic response to each pressure function: the solutions that condensation needs.

    Independent of loads, friction and wear.

    Attributes
    ----------
    trace : csr_matrix, shape (n_owned, n)
        Transposed gap trace Bᵀ.
    touching : ndarray of int, shape (n_touching,)
        Owned degrees of freedom in cells at the contact, the only ones loaded by its tractions.
    near : ndarray, shape (n_touching, m)
        Rows of K⁻¹ Bᵗ w Ψ for these [m per coefficient].
    per_rise : tuple of ndarray, shape (n_owned of the temperature, m)
        Gᵀ K⁻¹ Bᵗ w Ψ for each thermal load matrix G: weak gap per nodal rise [m³/K].
    comm : mpi4py.MPI.Comm
    """

    trace: sp.csr_matrix
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
        modes, force_modes = self.weak(holder.modes), self.weak(holder.force_modes)
        return CondensedContact(self.basis, self.weighted, compliance, modes, force_modes)


def influence(
    elastic: Elasticity,
    pairing: Pairing,
    trace: sp.csr_matrix,
    basis: Basis,
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
    basis : ndarray or csr_array, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    thermal_loads : sequence of petsc4py.PETSc.Mat
        Matrices G of nodal forces per nodal rise, from `Elasticity.thermal_load`.
    """
    dim = elastic.bodies.dim
    weighted = scaled(pairing.weights, basis)
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
        basis,
        weighted,
        trace,
        touching,
        np.hstack(near),
        tuple(np.hstack(products) for products in per_rise),
        elastic.bodies.comm,
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
    basis: Basis,
    holder: RigidHolder,
) -> CondensedContact:
    """Condense elasticity to the pressure space; parameters as in `influence` and `Influence`.

    Every rank calls.
    """
    return influence(elastic, pairing, trace, basis).condensed(traction, holder)


def condense_heat(
    conduction: Conduction,
    weights: np.ndarray,
    basis: Basis,
    traces: tuple[sp.csr_matrix, sp.csr_matrix],
    shift: float,
    partition: float | np.ndarray,
) -> InterfaceHeat:
    """Condense conduction to the contact points; parameters as in `InterfaceHeat`.

    Every rank calls.
    """
    comm = conduction.spaces.comm
    # the bodies are uncoupled in the bulk: one solution serves a column of both faces
    heat = ((traces[0] + traces[1]) @ sp.diags(weights)).tocsc()
    found = []
    for columns in blocks(len(weights), conduction.spaces.dim):
        field = conduction.respond(heat[:, columns].tocsr())
        found.append([trace.T @ field for trace in traces])
    Θ1, Θ2 = (sum_over_ranks(comm, np.hstack(columns)) for columns in zip(*found, strict=True))
    return InterfaceHeat(weights, basis, traces, shift, partition, (Θ1, Θ2))


def condense_distortion(
    conduction: Conduction, per_rise: np.ndarray, face: FaceHeat
) -> ThermalDistortion:
    """Condense ``Ψᵀ w B K⁻¹ G K_T⁻¹ Eᵀ w``: weak gap from heat at the contact.

    With the known elastic influence this costs one (adjoint) thermal solution per pressure function
    and no elastic one. Every rank calls.

    Parameters
    ----------
    conduction : Conduction
    per_rise : ndarray, shape (n_owned, m)
        Weak gap per nodal rise, see `Influence` [m³/K].
    face : FaceHeat
    """
    spaces, found = conduction.spaces, []
    for columns in blocks(per_rise.shape[1], spaces.dim):
        adjoint = conduction.adjoint_response(per_rise[:, columns])
        found.append([(trace.T @ adjoint).T * face.weights for trace in face.traces])
    first, second = (
        sum_over_ranks(spaces.comm, np.vstack(rows)) for rows in zip(*found, strict=True)
    )
    return ThermalDistortion((first, second))


def bath_matrix(spaces: Spaces, traces, weights: np.ndarray, shift: float) -> PETSc.Mat:
    """Matrix ``Σ E_iᵀ w s E_i`` of the bath at both faces, for `bulk.conduction`; collective."""
    first, second = (transfer_matrix(spaces, trace, weights * shift) for trace in traces)
    first.axpy(1.0, second, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    return first


def transfer_matrix(spaces: Spaces, trace: sp.csr_matrix, sizes: np.ndarray) -> PETSc.Mat:
    """Matrix ``Eᵀ diag(sizes) E`` of a transposed trace Eᵀ and sizes (n,) >= 0; collective."""
    root = distributed(spaces, (trace @ sp.diags(np.sqrt(sizes))).tocsr())
    return root.matMult(root.copy().transpose())
