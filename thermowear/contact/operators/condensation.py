"""Static condensation of elasticity and conduction to the contact: small dense operators."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...bulk.heat.conduction import Conduction
from ...bulk.mechanics.elasticity import Elasticity
from ...bulk.mechanics.thermal_forces import ThermalForces
from ...bulk.spaces import Spaces, distributed
from ...parallel import sum_over_ranks
from .face_nodes import nodes_by_group
from .heat_exchange import FaceHeat, InterfaceHeat
from .nodal_responses import NodalResponses
from .pressure import Basis, PressureSpace, scaled
from .rigid_motion import RigidHolder
from .thermal_opening import DistortionRows, elastic_columns


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
        Owned degrees of freedom of the faces, the only ones loaded by contact tractions.
    near : ndarray, shape (n_touching, m)
        Rows of K⁻¹ Bᵗ w Ψ for these [m per coefficient].
    per_rise : tuple of ndarray, shape (n_owned of the temperature, m)
        Gᵀ K⁻¹ Bᵗ w Ψ for each thermal load matrix G: weak gap per nodal rise [m³/K]; empty if they
        are not stored, see `thermal_opening`.
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
    weights: np.ndarray,
    trace: sp.csr_matrix,
    basis: Basis,
    thermal_loads: Sequence[ThermalForces] = (),
    distortion: DistortionRows | None = None,
) -> Influence:
    """Compute the elastic response to every pressure function. Every rank calls.

    Solutions are reduced block by block: only rows at the contact are stored, and products with
    the thermal loads, or with `distortion` only what remains of them there.

    Parameters
    ----------
    elastic : Elasticity
    weights : ndarray, shape (n,)
        Areas of the contact points [m²].
    trace : csr_matrix, shape (n_owned, n)
        Transposed gap trace Bᵀ.
    basis : ndarray or csr_array, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    thermal_loads : sequence of ThermalForces
        Matrices G of nodal forces per nodal rise, from `Elasticity.thermal_load`.
    distortion : DistortionRows, optional
        Receives the weak gap per nodal rise of the first of them, which is not stored.
    """
    dim = elastic.bodies.dim
    weighted = scaled(weights, basis)
    loads = pressure_loads(trace, weighted)
    nodes = np.unique(np.flatnonzero(np.diff(trace.indptr)) // dim)
    touching = (nodes[:, None] * dim + np.arange(dim)).ravel()
    near = np.zeros((len(touching), loads.shape[1]))
    kept, used = (thermal_loads,) * 2 if distortion is None else ((), thermal_loads[:1])
    per_rise = [np.zeros((G.columns.owned, loads.shape[1]), order="F") for G in kept]
    spaces = elastic.spaces
    body = np.searchsorted(spaces.starts, touching, side="right") - 1
    for found in elastic_columns(elastic, loads, used):
        bodies = spaces.groups[found.group]
        inside = np.flatnonzero(np.isin(body, bodies))
        rows = spaces.within(found.group, touching[inside])
        columns = np.r_[found.columns]
        near[np.ix_(inside, columns)] = found.displacements[rows]
        for matrix, products, product in zip(kept, per_rise, found.per_rise, strict=False):
            products[np.ix_(np.r_[matrix.columns.rows(*bodies)], columns)] = product
        if distortion is not None:
            distortion.add(found.group, found.columns, found.per_rise[0])
    comm = elastic.bodies.comm
    return Influence(basis, weighted, trace, touching, near, tuple(per_rise), comm)


def pressure_loads(trace: sp.csr_matrix, weighted: Basis) -> sp.csc_matrix:
    """Nodal loads Bᵗ w Ψ of the pressure functions, shape (n_owned, m)."""
    return (trace @ sp.csr_matrix(weighted)).tocsc()


def condense(
    elastic: Elasticity,
    weights: np.ndarray,
    trace: sp.csr_matrix,
    traction: sp.csr_matrix,
    basis: Basis,
    holder: RigidHolder,
) -> CondensedContact:
    """Condense elasticity to the pressure space; parameters as in `influence` and `Influence`.

    Every rank calls.
    """
    return influence(elastic, weights, trace, basis).condensed(traction, holder)


def condense_heat(conduction: Conduction, face: FaceHeat) -> InterfaceHeat:
    """Condense conduction to the nodes of the contact faces.

    The solutions follow when they are first needed, see `NodalResponses`. Every rank calls.
    """
    nodes = nodes_by_group(conduction.spaces, face.traces)
    responses = NodalResponses(conduction, nodes)
    at_points: dict[str, Any] = {f.name: getattr(face, f.name) for f in fields(FaceHeat)}
    return InterfaceHeat(**at_points, nodes=nodes, responses=responses)


def bath_matrix(
    spaces: Spaces, traces, weights: np.ndarray, shifts: tuple[np.ndarray, np.ndarray]
) -> PETSc.Mat:
    """Matrix ``Σ E_iᵀ w s_i E_i`` of the bath at the faces, for `bulk.conduction`; collective."""
    faces = zip(traces, shifts, strict=True)
    first, second = (transfer_matrix(spaces, trace, weights * shift) for trace, shift in faces)
    first.axpy(1.0, second, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    return first


def transfer_matrix(spaces: Spaces, trace: sp.csr_matrix, sizes: np.ndarray) -> PETSc.Mat:
    """Matrix ``Eᵀ diag(sizes) E`` of a transposed trace Eᵀ and sizes (n,) >= 0; collective."""
    root = distributed(spaces, (trace @ sp.diags(np.sqrt(sizes))).tocsr())
    return root.matMult(root.copy().transpose())
