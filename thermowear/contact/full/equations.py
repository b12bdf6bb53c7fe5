"""Contact equations on the full system, for the penalty method and Nitsche's method.

With the gap ``g + B u - R d`` at the points, a stiffness γ and a local compliance c,

    p = max(0, P),   P = φ (-(S u + s) - γ (g + B u - R d)),   φ = 1 / (1 + γ c),

    K u - θ Sᵀ (w/γ) (S u + s) - (θ S + γ B_t)ᵀ (w/γ) p = f,      Tᵀ w p = F.

Faces may also have spring-supported degrees of freedom, see `edge_deflection`: they close the gap
as d does, with ``Tᵀ w p`` equal to the spring force.

Without S and s this is the penalty method. With them it is Nitsche's method, which is consistent
for any γ (Chouly, Hild and Renard, Math. Comput. 84 (2015) 1089); θ = 1 is symmetric and needs γ
above a limit (see `nitsche`), θ = -1 works with any γ. Symmetric equations are the
stationarity conditions of a convex energy.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.linalg import block_diag

from ...bulk.field import without_fixed
from ...bulk.mechanics.elasticity import Elasticity
from ..search.pairing import Pairing
from .edge_deflection import EdgeDeflection
from .newton_matrix import NewtonMatrix
from .nodal_equations import NodalEquations, bordered_step, held


@dataclass(frozen=True)
class Loading:
    """Gap, loads and local compliance of one contact problem.

    Attributes
    ----------
    gap : ndarray, shape (n,)
        Gap g at the points, wear and given approach included [m].
    load : ndarray, shape (k,)
        Load F on the free motions of the holder.
    compliance : ndarray, shape (n,)
        Local compliance c >= 0: gap opening per pressure at the point [m/Pa].
    nodal_loads : ndarray, shape (n_owned,)
        Nodal loads f [N].
    thermal_traction : ndarray, shape (n,)
        Normal traction s of body 1 at zero displacement [Pa].
    deflection : EdgeDeflection, optional
        Local deflection of the faces at the edge of the wear.
    """

    gap: np.ndarray
    load: np.ndarray
    compliance: np.ndarray
    nodal_loads: np.ndarray
    thermal_traction: np.ndarray
    deflection: EdgeDeflection | None = None

    def part(self, share: float) -> Loading:
        """Scaled loading; for a given approach the faces are in first contact at share 0."""
        lift = 0.0 if len(self.load) else max(0.0, -float(self.gap.min()))
        return replace(
            self,
            gap=self.gap + (1 - share) * lift,
            load=share * self.load,
            nodal_loads=share * self.nodal_loads,
            thermal_traction=share * self.thermal_traction,
        )


@dataclass(frozen=True)
class Residual:
    """Residual of the equations at a displacement and a motion.

    Attributes
    ----------
    pressure : ndarray, shape (n,)
        Trial pressure P; the pressure where positive [Pa].
    forces : ndarray, shape (n_owned,)
        Unbalanced nodal forces [N].
    balance : ndarray, shape (k,)
        Generalised force of the pressure and the springs on each motion, less the load.
    relative : float
        Larger of both residuals, relative to the size of their terms.
    """

    pressure: np.ndarray
    forces: np.ndarray
    balance: np.ndarray
    relative: float

    @property
    def active(self) -> np.ndarray:
        return self.pressure > 0.0


class _Motions(NamedTuple):
    """Global degrees of freedom of the gap: holder, then spring-supported face points.

    Modes R and w T (n, k), the stiffness of the springs (k, k), zero for the holder, and the load.
    """

    modes: np.ndarray
    weighted_force_modes: np.ndarray
    springs: np.ndarray
    load: np.ndarray


class ContactEquations(NodalEquations):
    """Residual and Newton steps of the equations in the module's docstring; collective calls.

    Parameters
    ----------
    elastic : Elasticity
    pairing : Pairing
    trace, traction : csr_matrix, shape (n_owned, n)
        Bᵀ and B_tᵀ: traces of the gap and of the displacement conjugate to the pressure; the same
        matrix if there is no friction in the section.
    modes, force_modes : ndarray, shape (n, k)
        R and T of the free motions of the holder; k = 0 if there are none.
    stiffness : ndarray, shape (n,)
        Stiffness γ [Pa/m].
    stress : csr_matrix, shape (n_owned, n), optional
        Sᵀ of Nitsche's method; None for the penalty method.
    theta : int
        θ of Nitsche's method: 1, 0 or -1; unused by the penalty method.
    """

    def __init__(
        self,
        elastic: Elasticity,
        pairing: Pairing,
        trace: sp.csr_matrix,
        traction: sp.csr_matrix,
        modes: np.ndarray,
        force_modes: np.ndarray,
        stiffness: np.ndarray,
        stress: sp.csr_matrix | None = None,
        theta: int = 1,
    ):
        super().__init__(elastic)
        self.pairing = pairing
        self.modes, self.stiffness = modes, stiffness
        self.nitsche, self.theta = stress is not None, theta if stress is not None else 0
        self.weighted_force_modes = pairing.weights[:, None] * force_modes
        symmetry = "none"
        if traction is trace and (theta == 1 or not self.nitsche):
            symmetry = "symmetric" if self.nitsche else "definite"
        self._scale = pairing.weights / stiffness
        self._trace, self._traction = held(elastic, trace), held(elastic, traction)
        self._stress = held(elastic, 0 * trace if stress is None else stress)
        self._closing = (self._stress + self._trace.multiply(stiffness)).tocsr()
        self._work = (self.theta * self._stress + self._traction.multiply(stiffness)).tocsr()
        self._all = sp.hstack([self._closing, self._stress, self._work], format="csr").T
        operators = self._work, self._closing, self._stress
        self._matrix = NewtonMatrix(elastic, *operators, self.theta * self._scale, symmetry)

    def gap(self, loading: Loading, displacement: np.ndarray) -> np.ndarray:
        """Gap for zero motion of the holder, shape (n,) [m]."""
        return loading.gap + self._opening(displacement)

    def _opening(self, displacement: np.ndarray) -> np.ndarray:
        """Gap opening B u at the points, for one or several displacements."""
        return self._sum(self._trace.T @ displacement)

    def residual(self, loading: Loading, displacement: np.ndarray, motion: np.ndarray) -> Residual:
        """Residual of both equations, and the pressure."""
        motions, (closing, stress, _) = self._motions(loading), self._at_points(displacement)
        stress = stress + loading.thermal_traction
        opening = closing + self.stiffness * (loading.gap - motions.modes @ motion)
        trial = -self._softening(loading) * (opening + loading.thermal_traction)
        pressure = np.maximum(trial, 0.0)
        contact = self._work @ (self._scale * pressure)
        contact += self.theta * (self._stress @ (self._scale * stress))
        elastic = self.elastic_forces(displacement)
        loads = without_fixed(loading.nodal_loads, self.elastic.fixed)
        forces = self.elastic.unbalanced(elastic - contact - loads)
        balance = (
            motions.weighted_force_modes.T @ pressure + motions.springs @ motion - motions.load
        )
        size = self._largest(elastic, contact, loads)
        carried = np.abs(motions.weighted_force_modes).T @ pressure + np.abs(motions.load)
        own = slice(len(loading.load), None)
        carried[own] = carried[own].max(initial=0.0)  # some of them carry no force
        relative = self._largest(forces) / size if size != 0.0 else 0.0
        off = np.divide(np.abs(balance), carried, out=np.zeros(len(balance)), where=carried > 0)
        return Residual(trial, forces, balance, float(np.max([relative, *off])))

    def newton_step(
        self, loading: Loading, residual: Residual, active: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """Newton step of displacement and motion for given active points.

        None if the active points do not constrain a motion of the holder.

        Raises
        ------
        ComputationError
            If the symmetric variant of Nitsche's method is found unstable.
        """
        pressing, motions = active * self._softening(loading), self._motions(loading)
        column = -self._work @ (pressing[:, None] * self.pairing.weights[:, None] * motions.modes)
        factor = self._matrix.factor(self._scale * pressing)
        # residual with pressure at exactly the active points, tension included
        tension = np.where(active, residual.pressure, 0.0) - np.maximum(residual.pressure, 0.0)
        forces = residual.forces - self._work @ (self._scale * tension)
        balance = residual.balance + motions.weighted_force_modes.T @ tension
        per_motion = pressing[:, None] * (self.stiffness[:, None] * motions.modes)
        row = -motions.weighted_force_modes.T * pressing
        corner = motions.weighted_force_modes.T @ per_motion + motions.springs
        return bordered_step(
            factor,
            (forces, column),
            lambda solved: row @ self._sum(self._closing.T @ solved),
            (balance, corner),
        )

    def along(self, loading: Loading, residual: Residual, step: np.ndarray, motion: np.ndarray):
        """Arguments of `step_length`: work of the residual along a Newton step.

        Returns
        -------
        constant, slope : float
            Part linear in the step length.
        factors, pressure, change : ndarray, shape (n,)
            ``factors · max(0, pressure + length * change)`` is the rest.
        """
        motions, (closing, stress, work) = self._motions(loading), self._at_points(step)
        change = self.stiffness * (motions.modes @ motion) - closing
        change *= self._softening(loading)
        factors = motions.weighted_force_modes @ motion - self._scale * work
        now = np.maximum(residual.pressure, 0.0)
        constant = self._sum(step @ residual.forces) + motion @ residual.balance - factors @ now
        slope = self._sum(step @ self.elastic_forces(step)) + motion @ motions.springs @ motion
        slope -= self.theta * (stress @ (self._scale * stress))
        return constant, slope, factors, residual.pressure, change

    def _motions(self, loading: Loading) -> _Motions:
        own, k = loading.deflection, len(loading.load)
        if own is None:
            return _Motions(self.modes, self.weighted_force_modes, np.zeros((k, k)), loading.load)
        return _Motions(
            np.hstack([self.modes, own.modes]),
            np.hstack([self.weighted_force_modes, self.pairing.weights[:, None] * own.modes]),
            block_diag(np.zeros((k, k)), own.stiffness),
            np.concatenate([loading.load, np.zeros(own.modes.shape[1])]),
        )

    def _softening(self, loading: Loading) -> np.ndarray:
        """Softening factor φ, shape (n,)."""
        return 1 / (1 + self.stiffness * loading.compliance)

    def _at_points(self, displacement: np.ndarray) -> np.ndarray:
        """Displacement mapped to the points: (S + γB) u, S u and (θS + γB_t) u, shape (3, n)."""
        return self._sum(self._all @ displacement).reshape(3, -1)
