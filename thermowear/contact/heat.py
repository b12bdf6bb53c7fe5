"""Heat at the interface: friction heat, its partition, exchange between the faces, distortion.

The bodies are linear and are condensed to their contact points once; what couples them
(conductance, perfect contact, separated points) is solved here on small dense matrices.
"""

from __future__ import annotations

from dataclasses import dataclass

from petsc4py import PETSc

import numpy as np
import scipy.sparse as sp

from ..bulk.conduction import Conduction
from ..parallel import sum_over_ranks
from .condensation import CondensedContact
from .traces import distributed


@dataclass(frozen=True)
class ThermalState:
    """Heat at the contact points, shape (n,) each; index 0 is body 1.

    Attributes
    ----------
    rise : tuple of ndarray
        Temperature of each face over the ambient [K].
    flux : tuple of ndarray
        Heat into each body [W/m²].
    """

    rise: tuple[np.ndarray, np.ndarray]
    flux: tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class InterfaceHeat:
    """Both conducting bodies, condensed to the contact points.

    Attributes
    ----------
    weights : ndarray, shape (n,)
        Areas [m²].
    basis : ndarray, shape (n, m)
        Ψ, the space of the exchanged heat in perfect contact.
    traces : tuple of csr_matrix, shape (n_owned, n)
        Eᵀ of each face.
    shift : float
        Heat transfer to a bath at ambient that the factorised conduction holds on both faces, and
        that is taken out again here [W/(m² K)].
    response : tuple of ndarray, shape (n, n)
        Face rise per heat flux at the points, the bath included [m² K/W].
    resting : tuple of ndarray, shape (n,)
        Face rise without any heat at the contact (given temperatures) [K].
    conductance : float or None
        Of closed contact [W/(m² K)]; None: equal temperatures.
    partition : float
        Part of the friction heat set free on body 1.
    """

    weights: np.ndarray
    basis: np.ndarray
    traces: tuple[sp.csr_matrix, sp.csr_matrix]
    shift: float
    response: tuple[np.ndarray, np.ndarray]
    resting: tuple[np.ndarray, np.ndarray]
    conductance: float | None
    partition: float

    def exchange(self, closed: np.ndarray) -> HeatExchange:
        """Couple the faces where they touch.

        Parameters
        ----------
        closed : ndarray of bool, shape (n,)
            Points that exchange heat; separated ones do not.
        """
        n = len(self.weights)
        identity = np.eye(n)
        share = (self.partition, 1.0 - self.partition)
        Θ1, Θ2 = self.response
        s = self.shift
        if self.conductance is None:
            modes = self.basis[:, np.any(self.basis[closed] > 0, axis=0)] * closed[:, None]
            modes = modes[:, self.weights @ modes > 0]
            tie = modes.T * self.weights
            count = modes.shape[1]
        else:
            modes, count = np.zeros((n, 0)), 0
            tie = np.zeros((0, n))
        h = (self.conductance or 0.0) * closed
        matrix = np.block(
            [
                [identity - Θ1 * (s - h), -Θ1 * h, -Θ1 @ modes],
                [-Θ2 * h, identity - Θ2 * (s - h), Θ2 @ modes],
                [-tie, tie, np.zeros((count, count))],
            ]
        )
        right = np.zeros((2 * n + count, n + 1))
        for i in (0, 1):
            right[i * n : (i + 1) * n, :n] = share[i] * self.response[i]
            right[i * n : (i + 1) * n, n] = self.resting[i]
        solution = np.linalg.solve(matrix, right)
        rise = (solution[:n], solution[n : 2 * n])
        crossing = h[:, None] * (rise[1] - rise[0]) + modes @ solution[2 * n :]
        friction = np.hstack([identity, np.zeros((n, 1))])
        flux = (share[0] * friction + crossing, share[1] * friction - crossing)
        return HeatExchange(self, rise, flux)

    def nodal_heat(self, state: ThermalState, bath: bool) -> np.ndarray:
        """Nodal heat of the contact [W], owned rows; with what the bath gives where asked."""
        shift = self.shift if bath else 0.0
        first, second = (
            trace @ (self.weights * (flux + shift * rise))
            for trace, rise, flux in zip(self.traces, state.rise, state.flux, strict=True)
        )
        return first + second


@dataclass(frozen=True)
class HeatExchange:
    """Everything thermal as an affine function of the friction heat at the points.

    Attributes
    ----------
    interface : InterfaceHeat
    rise, flux : tuple of ndarray, shape (n, n + 1)
        Last column: without friction heat.
    """

    interface: InterfaceHeat
    rise: tuple[np.ndarray, np.ndarray]
    flux: tuple[np.ndarray, np.ndarray]

    def state(self, friction_heat: np.ndarray) -> ThermalState:
        """Temperatures and fluxes due to friction heat [W/m²] at the points."""
        q = np.append(friction_heat, 1.0)
        return ThermalState(
            (self.rise[0] @ q, self.rise[1] @ q), (self.flux[0] @ q, self.flux[1] @ q)
        )


@dataclass(frozen=True)
class ThermalDistortion:
    """Weak gap that heat opens (negative: closes).

    Attributes
    ----------
    per_flux : tuple of ndarray, shape (m, n)
        Per heat flux into each body at the points, the bath included [m³ per W/m²].
    resting : ndarray, shape (m,)
        Without any heat at the contact (given temperatures) [m³].
    """

    per_flux: tuple[np.ndarray, np.ndarray]
    resting: np.ndarray

    def per_friction_heat(self, exchange: HeatExchange) -> tuple[np.ndarray, np.ndarray]:
        """H of coupled faces: weak gap per friction heat (m, n), and without it (m,)."""
        shift = exchange.interface.shift
        first, second = (
            matrix @ (flux + shift * rise)
            for matrix, flux, rise in zip(self.per_flux, exchange.flux, exchange.rise, strict=True)
        )
        total = first + second
        return total[:, :-1], total[:, -1] + self.resting


def condense_heat(
    conduction: Conduction,
    weights: np.ndarray,
    basis: np.ndarray,
    traces: tuple[sp.csr_matrix, sp.csr_matrix],
    shift: float,
    conductance: float | None,
    partition: float,
) -> InterfaceHeat:
    """Condense conduction to the contact points; parameters as in `InterfaceHeat`.

    Every rank calls.
    """
    comm = conduction.space.mesh.comm
    # the bodies do not touch in the bulk: one solution serves a column of both faces
    field = conduction.respond(((traces[0] + traces[1]) @ sp.diags(weights)).tocsr())
    still = conduction.solve(np.zeros(field.shape[0]))
    Θ1, Θ2 = (sum_over_ranks(comm, trace.T @ field) for trace in traces)
    T1, T2 = (sum_over_ranks(comm, trace.T @ still) for trace in traces)
    response, resting = (Θ1, Θ2), (T1, T2)
    return InterfaceHeat(weights, basis, traces, shift, response, resting, conductance, partition)


def condense_distortion(
    conduction: Conduction,
    thermal_load: PETSc.Mat,
    contact: CondensedContact,
    face: InterfaceHeat,
) -> ThermalDistortion:
    """Condense ``Ψᵀ w B K⁻¹ G K_T⁻¹ Eᵀ w``: heat at the contact to the weak gap.

    The elastic influence is at hand, so this costs one thermal solution per pressure function and
    no elastic one. Every rank calls.

    Parameters
    ----------
    conduction : Conduction
    thermal_load : petsc4py.PETSc.Mat
        G, from `Elasticity.thermal_load`.
    contact : CondensedContact
        With its influence.
    face : InterfaceHeat
    """
    comm = conduction.space.mesh.comm
    assert contact.influence is not None
    per_rise = transpose_product(thermal_load, contact.influence)
    adjoint = conduction.respond(per_rise)
    still = conduction.solve(np.zeros(len(per_rise)))
    first, second = (
        sum_over_ranks(comm, (trace.T @ adjoint).T * face.weights) for trace in face.traces
    )
    return ThermalDistortion((first, second), sum_over_ranks(comm, per_rise.T @ still))


def bath_matrix(space, traces, weights: np.ndarray, shift: float) -> PETSc.Mat:
    """``Σ E_iᵀ w s E_i``: the bath at both faces, for `bulk.conduction`. Every rank calls."""
    first, second = (
        distributed(space, (trace @ sp.diags(np.sqrt(weights * shift))).tocsr()) for trace in traces
    )
    matrix = first.matMult(first.copy().transpose())
    other = second.matMult(second.copy().transpose())
    matrix.axpy(1.0, other, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    return matrix


def transpose_product(matrix: PETSc.Mat, columns: np.ndarray) -> np.ndarray:
    """``matrixᵀ columns`` by owned rows, shape (n_owned of the matrix's columns, m)."""
    rows, _ = matrix.getSizes()
    right = PETSc.Mat().createDense(
        (rows, columns.shape[1]), array=np.asfortranarray(columns), comm=matrix.comm
    )
    right.assemble()
    result = matrix.transposeMatMult(right)
    return np.array(result.getDenseArray(), order="F")
