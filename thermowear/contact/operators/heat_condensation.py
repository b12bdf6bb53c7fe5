"""Conduction and thermal distortion of the bodies, condensed to the contact points."""

from __future__ import annotations

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...bulk.heat.conduction import Conduction
from ...parallel import sum_over_ranks
from .condensation import blocks
from .heat import InterfaceHeat, ThermalDistortion
from .traces import distributed


def condense_heat(
    conduction: Conduction,
    weights: np.ndarray,
    basis: np.ndarray,
    traces: tuple[sp.csr_matrix, sp.csr_matrix],
    shift: float,
    partition: float | np.ndarray,
) -> InterfaceHeat:
    """Condense conduction to the contact points; parameters as in `InterfaceHeat`.

    Every rank calls.
    """
    comm = conduction.space.mesh.comm
    # the bodies are uncoupled in the bulk: one solution serves a column of both faces
    heat = ((traces[0] + traces[1]) @ sp.diags(weights)).tocsc()
    found = []
    for columns in blocks(len(weights), conduction.space.mesh.topology.dim):
        field = conduction.respond(heat[:, columns].tocsr())
        found.append([trace.T @ field for trace in traces])
    Θ1, Θ2 = (sum_over_ranks(comm, np.hstack(columns)) for columns in zip(*found, strict=True))
    return InterfaceHeat(weights, basis, traces, shift, (Θ1, Θ2), partition)


def condense_distortion(
    conduction: Conduction, per_rise: np.ndarray, face: InterfaceHeat
) -> ThermalDistortion:
    """Condense ``Ψᵀ w B K⁻¹ G K_T⁻¹ Eᵀ w``: weak gap from heat at the contact.

    With the known elastic influence this costs one (adjoint) thermal solution per pressure function
    and no elastic one. Every rank calls.

    Parameters
    ----------
    conduction : Conduction
    per_rise : ndarray, shape (n_owned, m)
        Weak gap per nodal rise, see `Influence` [m³/K].
    face : InterfaceHeat
    """
    mesh, found = conduction.space.mesh, []
    for columns in blocks(per_rise.shape[1], mesh.topology.dim):
        adjoint = conduction.adjoint_response(per_rise[:, columns])
        found.append([(trace.T @ adjoint).T * face.weights for trace in face.traces])
    first, second = (
        sum_over_ranks(mesh.comm, np.vstack(rows)) for rows in zip(*found, strict=True)
    )
    return ThermalDistortion((first, second))


def bath_matrix(space, traces, weights: np.ndarray, shift: float) -> PETSc.Mat:
    """Matrix ``Σ E_iᵀ w s E_i`` of the bath at both faces, for `bulk.conduction`; collective."""
    first, second = (
        distributed(space, (trace @ sp.diags(np.sqrt(weights * shift))).tocsr()) for trace in traces
    )
    matrix = first.matMult(first.copy().transpose())
    other = second.matMult(second.copy().transpose())
    matrix.axpy(1.0, other, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    return matrix
