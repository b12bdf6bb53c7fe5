"""Contact with Coulomb friction on the full system: equations, and Newton's method for them.

With gap and slips ``y = (g, -s_0) + B u - R d`` at the points (see `operators.tangential`), a
stiffness γ, and tractions S u = (pressure, shears) of body 1,

    x = P(X),   X = S u - γ y,   P onto p >= 0, |t| <= mu p,

    K u - θ Sᵀ (w/γ) S u - (γ B - θ S)ᵀ (w/γ) x = 0,      Rᵀ w x = F,

with a local compliance c as in `equations`. Without S this is the penalty method, with the elastic
stick stiffness γ; with it Nitsche's method (Chouly et al., An overview of recent results on
Nitsche's method for contact problems, LNCSE 121 (2017) 93). The history variable is the slip s_0 so
far: a point that slips gains ``(t - X_t)/γ``, as the plastic strain in a return mapping; a point
that sticks gains nothing. Differences of the displacements between two increments would do for a
single increment only: while a point sticks, each would add the discretisation error
``(S u - t)/γ``, and stick would creep.

The friction loss ``-t Δs_0`` is never negative.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.optimize import brentq

from ...bulk.mechanics.elasticity import Elasticity
from .newton_matrix import NewtonMatrix
from .nodal_equations import NodalEquations, bordered_step, held
from .point_friction import PointTractions, projected

_TOLERANCE = 1e-10
_STAGNATION_TOLERANCE = 1e-8
"""Relative residual accepted when rounding prevents a further reduction."""
_MAX_ITERATIONS = 30
_MAX_WORK_RATIO = 0.9
"""Largest ratio of the residual work at the end of a full step to that at its start."""
_LENGTH_TOLERANCE = 1e-3


@dataclass(frozen=True)
class FrictionLoading:
    """Loads and history of one increment.

    Attributes
    ----------
    distance : ndarray, shape (c, n)
        Gap, and reversed slips so far, without displacements and free motions [m].
    friction : ndarray, shape (n,)
    compliance : ndarray, shape (n,)
        Local compliance: gap opening per pressure at the point [m/Pa].
    closure : ndarray, shape (c, n, k)
        R of the free motions.
    force : ndarray, shape (k,)
        Loads on them.
    """

    distance: np.ndarray
    friction: np.ndarray
    compliance: np.ndarray
    closure: np.ndarray
    force: np.ndarray


@dataclass(frozen=True)
class FrictionSolution:
    """Solution of one increment.

    Attributes
    ----------
    motion : ndarray, shape (k,)
        Free motions.
    trial : ndarray, shape (c, n)
        Trial tractions X [Pa].
    tractions : PointTractions
    iterations : int
    """

    motion: np.ndarray
    trial: np.ndarray
    tractions: PointTractions
    iterations: int


@dataclass(frozen=True)
class _Unbalanced:
    """Nodal forces (n_owned,), balances (k,) of the motions, and both relative to their terms."""

    forces: np.ndarray
    balance: np.ndarray
    relative: float


class FrictionEquations(NodalEquations):
    """Equations in the module's docstring; collective calls.

    Parameters
    ----------
    elastic : Elasticity
    weights : ndarray, shape (n,)
        Areas of the points [m²].
    trace : csr_matrix, shape (n_owned, c n)
        Bᵀ, component by component.
    stiffness : ndarray, shape (n,)
        Stiffness γ [Pa/m].
    stress : csr_matrix, shape (n_owned, c n), optional
        Sᵀ of Nitsche's method; None for the penalty method.
    theta : int
        θ of Nitsche's method: 1, 0 or -1; unused by the penalty method.
    """

    def __init__(
        self,
        elastic: Elasticity,
        weights: np.ndarray,
        trace: sp.csr_matrix,
        stiffness: np.ndarray,
        stress: sp.csr_matrix | None = None,
        theta: int = 1,
    ):
        super().__init__(elastic)
        self.weights, self.stiffness = weights, stiffness
        self.theta = 0 if stress is None else theta
        components = trace.shape[1] // len(weights)
        self._scale = np.tile(weights / stiffness, components)
        held_trace = held(elastic, trace).multiply(np.tile(stiffness, components))
        self._stress = held(elastic, 0 * trace if stress is None else stress)
        self._closing = (held_trace - self._stress).tocsr()
        self._work = (held_trace - self.theta * self._stress).tocsr()
        operators = self._work, self._closing, self._stress
        self._matrix = NewtonMatrix(
            elastic, *operators, self.theta * self._scale, "none", components
        )

    def solve(self, loading: FrictionLoading, slopes: np.ndarray) -> FrictionSolution | None:
        """Solve one increment by Newton's method; None if it fails.

        Parameters
        ----------
        loading : FrictionLoading
        slopes : ndarray, shape (c, c, n)
            Tractions per trial tractions of the first iteration, which is linear.
        """
        u, d = np.zeros(len(self.elastic.fixed)), np.zeros(len(loading.force))
        trial = self._trial(loading, u, d)
        step = self._step(loading, slopes, self._residual(loading, u, d, _linear(slopes, trial)))
        before, last, status = np.inf, False, np.zeros(0)
        for iteration in range(1, _MAX_ITERATIONS + 1):
            if step is None:
                return None
            u, d = u + step[0], d + step[1]
            trial = self._trial(loading, u, d)
            found = self._projected(loading, trial)
            residual = self._residual(loading, u, d, found.values)
            if not np.isfinite(residual.relative):
                return None
            stuck = residual.relative > 0.1 * before
            small = residual.relative <= (_STAGNATION_TOLERANCE if stuck else _TOLERANCE)
            now = (found.values[0] > 0.0) + 1 * found.sticking
            if small and (last or np.array_equal(now, status)):
                return FrictionSolution(d, trial, found, iteration)
            before, last, status = residual.relative, small, now
            step = self._step(loading, found.slopes, residual)
            if step is not None:
                length = self._length(loading, trial, residual, step)
                step = length * step[0], length * step[1]
        return None

    def _trial(self, loading: FrictionLoading, u: np.ndarray, d: np.ndarray) -> np.ndarray:
        """Trial tractions X, shape (c, n) [Pa]."""
        closing = self._sum(self._closing.T @ u).reshape(loading.distance.shape)
        return -closing - self.stiffness * (loading.distance - loading.closure @ d)

    def _projected(self, loading: FrictionLoading, trial: np.ndarray) -> PointTractions:
        return projected(trial, loading.friction, softening(self.stiffness, loading.compliance))

    def _residual(self, loading: FrictionLoading, u, d, values: np.ndarray) -> _Unbalanced:
        """Residual of equilibrium with given tractions (c, n)."""
        elastic = self.elastic_forces(u)
        contact = self._work @ (self._scale * values.ravel())
        if self.theta:
            stress = self._sum(self._stress.T @ u)
            contact += self.theta * (self._stress @ (self._scale * stress))
        forces = self.elastic.unbalanced(elastic - contact)
        closure = np.concatenate(loading.closure)
        loads = (self.weights * values).ravel()
        balance = closure.T @ loads - loading.force
        carried = np.abs(closure).T @ np.abs(loads) + np.abs(loading.force)
        size = self._largest(elastic, contact)
        relative = self._largest(forces) / size if size != 0.0 else 0.0
        off = np.divide(np.abs(balance), carried, out=np.zeros(len(d)), where=carried > 0.0)
        return _Unbalanced(forces, balance, float(np.max([relative, *off])))

    def _step(self, loading: FrictionLoading, slopes: np.ndarray, residual: _Unbalanced):
        """Newton step of displacements and motions; None if a motion is not constrained."""
        closure, weighted = loading.closure, slopes * self.weights
        moved = np.einsum("ijn,jnk->ink", weighted, closure)  # w x per motion, over γ
        column = -self._work @ np.concatenate(moved)
        per_trial = np.concatenate(np.einsum("ink,ijn->jnk", closure, weighted)).T
        corner = per_trial @ np.concatenate(self.stiffness[:, None] * closure)
        return bordered_step(
            self._matrix.factor(weighted / self.stiffness),
            (residual.forces, column),
            lambda solved: -per_trial @ self._sum(self._closing.T @ solved),
            (residual.balance, corner),
        )

    def _length(self, loading: FrictionLoading, trial, residual: _Unbalanced, step) -> float:
        """Line search: fraction of a Newton step at which the work of the residual vanishes.

        For given pressures the work is the derivative of a convex energy. Whole steps are kept
        unless harmful, see `full_system.step_length`.
        """
        (u, d), shape = step, trial.shape
        closing = self._sum(self._closing.T @ u).reshape(shape)
        change = self.stiffness * (loading.closure @ d) - closing
        factors = self.weights * (loading.closure @ d)
        factors -= (self._scale * self._sum(self._work.T @ u)).reshape(shape)
        stress = self._sum(self._stress.T @ u)
        slope = self._sum(u @ self.elastic_forces(u))
        slope -= self.theta * (stress @ (self._scale * stress))
        now = self._projected(loading, trial).values
        constant = self._sum(u @ residual.forces) + d @ residual.balance - np.vdot(factors, now)

        def work(length: float) -> float:
            there = self._projected(loading, trial + length * change).values
            return float(constant + length * slope + np.vdot(factors, there))

        start, whole = work(0.0), work(1.0)
        if start >= 0.0 or whole <= _MAX_WORK_RATIO * abs(start):
            return 1.0
        return float(brentq(work, 0.0, 1.0, xtol=_LENGTH_TOLERANCE))


def softening(stiffness: np.ndarray, compliance: np.ndarray) -> np.ndarray:
    """Pressure per trial pressure on a local compliance, φ of `equations`, shape (n,)."""
    return 1 / (1 + stiffness * compliance)


def _linear(slopes: np.ndarray, trial: np.ndarray) -> np.ndarray:
    """Tractions (c, n) of slopes (c, c, n) at trial tractions."""
    return np.einsum("ijn,jn->in", slopes, trial)
