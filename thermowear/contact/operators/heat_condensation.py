"""Conduction and thermal distortion of the bodies, condensed to the contact points."""

from __future__ import annotations

from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ...bulk.heat.conduction import Conduction
from ...parallel import sum_over_ranks
from .condensation import CondensedContact
from .heat import BaselineResponse, HeatExchange, InterfaceHeat
from .traces import distributed


@dataclass(frozen=True)
class ThermalDistortion:
    """Thermal distortion: weak gap opened by heat (negative: closed).

    Attributes
    ----------
    per_flux : tuple of ndarray, shape (m, n)
        Weak gap per heat flux into each body at the points, bath included [m³ per W/m²].
    """

    per_flux: tuple[np.ndarray, np.ndarray]

    def per_friction_heat(self, exchange: HeatExchange) -> np.ndarray:
        """Weak gap of coupled faces per friction heat, H, shape (m, n)."""
        first, second = exchange.per_friction_heat
        return self.per_flux[0] @ first + self.per_flux[1] @ second

    def baseline_gap(self, exchange: HeatExchange, baseline: BaselineResponse) -> np.ndarray:
        """Weak gap of coupled faces without friction heat, shape (m,)."""
        assert baseline.opening is not None
        first, second = exchange.into_bath(np.concatenate(baseline.rise))
        return self.per_flux[0] @ first + self.per_flux[1] @ second + baseline.opening


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
    field = conduction.respond(((traces[0] + traces[1]) @ sp.diags(weights)).tocsr())
    Θ1, Θ2 = (sum_over_ranks(comm, trace.T @ field) for trace in traces)
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
        Weak gap per nodal rise, see `gap_per_rise` [m³/K].
    face : InterfaceHeat
    """
    comm = conduction.space.mesh.comm
    adjoint = conduction.adjoint_response(per_rise)
    first, second = (
        sum_over_ranks(comm, (trace.T @ adjoint).T * face.weights) for trace in face.traces
    )
    return ThermalDistortion((first, second))


def gap_per_rise(thermal_load: PETSc.Mat, contact: CondensedContact) -> np.ndarray:
    """Weak gap per nodal temperature rise, shape (n_owned, m) [m³/K].

    Parameters
    ----------
    thermal_load : petsc4py.PETSc.Mat
        Thermal load matrix G, from `Elasticity.thermal_load`.
    contact : CondensedContact
        Contact with stored influence.
    """
    assert contact.influence is not None
    return transpose_product(thermal_load, contact.influence)


def bath_matrix(space, traces, weights: np.ndarray, shift: float) -> PETSc.Mat:
    """Matrix ``Σ E_iᵀ w s E_i`` of the bath at both faces, for `bulk.conduction`; collective."""
    first, second = (
        distributed(space, (trace @ sp.diags(np.sqrt(weights * shift))).tocsr()) for trace in traces
    )
    matrix = first.matMult(first.copy().transpose())
    other = second.matMult(second.copy().transpose())
    matrix.axpy(1.0, other, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    return matrix


def transpose_product(matrix: PETSc.Mat, columns: np.ndarray) -> np.ndarray:
    """Product ``matrixᵀ columns`` by owned rows, shape (n_owned of the matrix's columns, m)."""
    rows, _ = matrix.getSizes()
    right = PETSc.Mat().createDense(
        (rows, columns.shape[1]), array=np.asfortranarray(columns), comm=matrix.comm
    )
    right.assemble()
    result = matrix.transposeMatMult(right)
    return np.array(result.getDenseArray(), order="F")
