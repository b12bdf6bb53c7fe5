"""Contact on the full system: Newton's method on all nodal displacements.

With the gap ``g + B u - R d`` at the points, a stiffness γ and a local compliance c,

    p = max(0, P),   P = φ (-(S u + s) - γ (g + B u - R d)),   φ = 1 / (1 + γ c),

    K u - θ Sᵀ (w/γ) (S u + s) - (θ S + γ B_t)ᵀ (w/γ) p = f,      Tᵀ w p = F.

Faces may also have spring-supported degrees of freedom, see `edge_deflection`: they close the gap
as d does, with ``Tᵀ w p`` equal to the spring force.

Without S and s this is the penalty method. With them it is Nitsche's method, which is consistent
for any γ (Chouly, Hild and Renard, Math. Comput. 84 (2015) 1089); θ = 1 is symmetric and needs γ
above a limit (see `nitsche`), θ = -1 works with any γ. Symmetric equations are the
stationarity conditions of a convex energy.

Nothing is condensed: an independent check of the condensed solution, and a basis for nonlinear bulk
behaviour.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

from petsc4py import PETSc

import numpy as np
import scipy
import scipy.sparse as sp
from scipy.linalg import block_diag

from ...bulk.elasticity.elasticity import Elasticity, supported
from ...bulk.solvers.direct import multiply
from ...bulk.solvers.groups import AnyFactor, factorised
from ...bulk.spaces import distributed, without_fixed
from ...errors import ComputationError
from ...parallel import sum_over_ranks
from ...serialise import serialisable
from ..operators.pressure import Basis, PressureSpace, scaled
from ..search.pairing import Pairing
from ..solvers.signorini import solve_contact
from .edge_deflection import EdgeDeflection

_SINGULAR = 1e12
"""Condition number of the border from which a motion is not constrained."""


class NodalEquations:
    """Equilibrium of elastic bodies at their nodes; collective calls."""

    def __init__(self, elastic: Elasticity):
        self.elastic = elastic

    def elastic_forces(self, displacement: np.ndarray) -> np.ndarray:
        """Elastic nodal forces K u, zero at supported degrees of freedom."""
        return without_fixed(multiply(self.elastic.stiffness, displacement), self.elastic.fixed)

    def _sum(self, values):
        return sum_over_ranks(self.elastic.bodies.comm, values)

    def _largest(self, *arrays: np.ndarray) -> float:
        largest = np.max([np.abs(array).max(initial=0.0) for array in arrays])
        return float(np.max(self.elastic.bodies.comm.allgather(largest)))


def held(elastic: Elasticity, matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Transposed trace without supported rows and without rounding noise."""
    kept = without_fixed(matrix, elastic.fixed)
    kept.data[np.abs(kept.data) < 1e-14 * np.abs(kept.data).max(initial=0.0)] = 0.0
    kept.eliminate_zeros()
    return kept


def bordered_step(
    factor: AnyFactor,
    nodal: tuple[np.ndarray, np.ndarray],
    row: Callable[[np.ndarray], np.ndarray],
    border: tuple[np.ndarray, np.ndarray],
) -> tuple[np.ndarray, np.ndarray] | None:
    """Newton step of displacements and motions, by elimination of the displacements.

    None if a motion is not constrained. Every rank calls.

    Parameters
    ----------
    factor : AnyFactor
        Factor of the derivative of the nodal forces by the displacements.
    nodal : tuple
        Residual of the nodal forces, and its derivative by the motions, (n_owned, k).
    row : callable
        Derivative of the balances, applied to displacements (n_owned, columns).
    border : tuple
        Residual of the balances (k,), and its derivative by the motions (k, k).
    """
    (forces, column), (balance, corner) = nodal, border
    solved = factor.solve(np.column_stack([-forces, column]))
    step, column = solved[:, 0], solved[:, 1:]
    if len(balance) == 0:
        return step, np.zeros(0)
    response = row(solved)
    schur = corner - response[:, 1:]
    size = np.sqrt(np.abs(np.diag(schur)))
    if size.min() == 0.0 or np.linalg.cond(schur / np.outer(size, size)) > _SINGULAR:
        return None
    motion = np.linalg.solve(schur, -balance - response[:, 0])
    return step - column @ motion, motion


_SAME_PATTERN = PETSc.Mat.Structure.SAME_NONZERO_PATTERN
_SUBSET_PATTERN = PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN
_DIFFERENT_PATTERN = PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN


class NewtonMatrix:
    """Matrix ``K - Sᵀ diag(b) S + W a C``, with factors a that vary from step to step.

    K is the supported stiffness. W and C are kept for all points, open or closed, so that sparsity
    pattern and elimination order are computed only once. With several components of the tractions
    the operators list those of all points one component after the other, and a couples the
    components at each point. All methods are collective.

    Parameters
    ----------
    elastic : Elasticity
    work, closing, stress : csr_matrix, shape (n_owned, components n)
        W, Cᵀ and Sᵀ, without supported rows.
    subtracted : ndarray, shape (components n,)
        Factors b.
    symmetry : str
        Symmetry as in `DirectSolver`.
    components : int
        Number of components of the tractions.
    """

    def __init__(
        self,
        elastic: Elasticity,
        work: sp.csr_matrix,
        closing: sp.csr_matrix,
        stress: sp.csr_matrix,
        subtracted: np.ndarray,
        symmetry: str,
        components: int = 1,
    ):
        self._symmetry, self._dim, self._fixed = symmetry, elastic.bodies.dim, elastic.fixed
        self._border = elastic.joints.border(range(len(elastic.each)), slice(None))
        fixed = supported(elastic.stiffness, elastic.fixed)
        if subtracted.any():
            columns = distributed(elastic.spaces, stress)
            rows = columns.copy().transpose()
            _scale_rows(rows, subtracted)
            fixed.axpy(-1.0, columns.matMult(rows), _DIFFERENT_PATTERN)
        self._columns = distributed(elastic.spaces, work)
        self._rows = distributed(elastic.spaces, closing).transpose()
        self._coupling = _pointwise(components, work.shape[1] // components, self._rows.comm)
        self._weighted_rows = self._coupling.matMult(self._rows)
        self._product = self._columns.matMult(self._weighted_rows)
        self._matrix = fixed.copy()
        self._matrix.axpy(1.0, self._product, _DIFFERENT_PATTERN)
        self._constant = self._matrix.copy()
        self._constant.zeroEntries()
        self._constant.axpy(1.0, fixed, _SUBSET_PATTERN)
        self._factor: AnyFactor | None = None
        self._factors = np.zeros(0)

    def factor(self, factors: np.ndarray) -> AnyFactor:
        """Factorise the matrix for values of a, shape (n,) or (components, components, n).

        Raises
        ------
        ComputationError
            If the symmetric variant of Nitsche's method is found unstable.
        """
        if self._factor is not None and np.array_equal(self._factors, factors):
            return self._factor
        _set_pointwise(self._coupling, factors if factors.ndim == 3 else factors[None, None])
        self._coupling.matMult(self._rows, self._weighted_rows)
        self._columns.matMult(self._weighted_rows, self._product)
        self._constant.copy(self._matrix, _SAME_PATTERN)
        self._matrix.axpy(1.0, self._product, _SUBSET_PATTERN)
        if self._factor is None:
            known = self._border, self._fixed, self._symmetry, self._dim
            self._factor = factorised(self._matrix, *known)
        else:
            self._factor.repeat()
        if self._symmetry == "symmetric" and self._factor.negative_pivots:
            self._factors = np.zeros(0)
            raise ComputationError(
                "contact: Nitsche's method is unstable with this stabilisation; make contact.gamma "
                "larger or set contact.theta = -1"
            )
        self._factors = factors
        return self._factor


def _scale_rows(matrix: PETSc.Mat, factors: np.ndarray) -> None:
    """Multiply the rows, one per contact point, by factors replicated on all ranks."""
    scale = matrix.createVecLeft()
    first, last = scale.getOwnershipRange()
    scale.setArray(factors[first:last])
    matrix.diagonalScale(scale, None)


def _pointwise(components: int, count: int, comm: PETSc.Comm) -> PETSc.Mat:
    """Square matrix that couples the components at each of a number of points."""
    size = components * count
    matrix = PETSc.Mat().createAIJ(((PETSc.DECIDE, size),) * 2, nnz=components, comm=comm)
    _set_pointwise(matrix, np.zeros((components, components, count)))
    return matrix


def _set_pointwise(matrix: PETSc.Mat, values: np.ndarray) -> None:
    """Set the entries to values (components, components, n), replicated on all ranks."""
    c, _, n = values.shape
    first, last = matrix.getOwnershipRange()
    rows = np.arange(first, last)
    columns = np.arange(c) * n + (rows % n)[:, None]
    starts = np.arange(0, c * len(rows) + 1, c)
    entries = values.transpose(0, 2, 1).reshape(c * n, c)[first:last]
    indices = (each.astype(PETSc.IntType) for each in (starts, columns.ravel()))
    matrix.setValuesCSR(*indices, np.ascontiguousarray(entries.ravel()))
    matrix.assemble()


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


_TOLERANCE = 1e-10
_STAGNATION_TOLERANCE = 1e-8
"""Relative residual accepted when rounding prevents a further reduction."""
_MAX_ITERATIONS = 25
_MIN_LOAD_STEP = 1 / 16
_COARSE_FUNCTIONS = {1: (24, 5), 2: (8, 3)}
"""Number of pressure functions along each direction of the coarse problem that gives the initial
guess, and number of them across the contact that suffices, by the dimension of the face."""
_MAX_REFINEMENTS = 3
"""Largest number of coarse refinements."""
_ACTIVE_PRESSURE_RATIO = 0.15
"""Fraction of the coarse peak pressure above which points are active at first: too small a contact
gains all penetrating points at once, while too large a contact loses only its outermost points in
each iteration."""
_ONE_DIRECTION = 1e-9
"""Relative size of the components at rounding level of directions that are all the same."""
_MAX_WORK_RATIO = 0.9
"""Largest ratio of the residual work at the end of a full step to that at its start."""


@serialisable
@dataclass(frozen=True)
class FullSolution:
    """Contact solution of the full system.

    Attributes
    ----------
    displacement : ndarray, shape (n_owned,) [m]
    motion : ndarray, shape (k,)
        Motion d of the holder.
    pressure : ndarray, shape (n,) [Pa]
    iterations : int
        Newton iterations over all load steps.
    """

    displacement: np.ndarray
    motion: np.ndarray
    pressure: np.ndarray
    iterations: int

    @property
    def active(self) -> np.ndarray:
        """Points with positive pressure, shape (n,)."""
        return self.pressure > 0.0


def resolved_pressure(
    basis: Basis, weights: np.ndarray, pressure: np.ndarray, directions: np.ndarray
) -> np.ndarray:
    """Pressure without tension in the pressure space nearest to one of single points, (n,) [Pa].

    Of equal resultant force. Without a pressure space, pressures scatter in cells that the edge of
    contact crosses, and follow what is singular as far as the points do; this is what converges.

    Parameters
    ----------
    basis : ndarray or csr_array, shape (n, m)
        Basis Ψ.
    weights, pressure : ndarray, shape (n,)
    directions : ndarray, shape (n, gdim)
        Traction per pressure.
    """
    space = PressureSpace(basis, scaled(weights, basis))
    # on a plane face with friction all are one direction: one condition, not one for each component
    _, sizes, axes = np.linalg.svd(directions, full_matrices=False)
    directions = directions @ axes[sizes > _ONE_DIRECTION * sizes[0]].T
    areas, force = space.weak(directions), directions.T @ (weights * pressure)
    return basis @ solve_contact(space.mass, -space.weak(pressure), areas, force).coefficients


class FullContact(ContactEquations):
    """Contact of two elastic bodies; parameters as in `ContactEquations`.

    All methods are collective: every rank calls them.
    """

    def solve(
        self,
        gap: np.ndarray,
        load: np.ndarray,
        compliance: np.ndarray | None = None,
        nodal_loads: np.ndarray | None = None,
        thermal_traction: np.ndarray | None = None,
        start: FullSolution | None = None,
        deflection: EdgeDeflection | None = None,
    ) -> FullSolution:
        """Solve contact; parameters as in `Loading`, and a neighbouring solution as initial guess.

        If Newton's method does not converge, the load is applied in steps.

        Raises
        ------
        ComputationError
            If there is no solution, or none is found.
        """
        nothing = np.zeros(len(gap))
        loading = Loading(
            gap,
            load,
            nothing if compliance is None else compliance,
            np.zeros(len(self.elastic.fixed)) if nodal_loads is None else nodal_loads,
            nothing if thermal_traction is None or not self.nitsche else thermal_traction,
            deflection,
        )
        self._check(loading)
        # relative to the start: a far approach would lose the digits of the deformation
        origin = start.motion if start else self._held(loading, np.zeros(len(loading.nodal_loads)))
        near = replace(loading, gap=gap - self.modes @ origin)
        start = replace(start, motion=0 * origin) if start else self._guess(near)
        found = self._newton(near, start)[0] or self._in_steps(near)
        return replace(found, motion=origin + found.motion)

    def _check(self, loading: Loading) -> None:
        """Raise for values that are not finite, and for loads that no pressure can carry."""
        given = loading.gap, loading.load, loading.compliance, loading.thermal_traction
        wrong = sum(np.sum(~np.isfinite(values)) for values in (*given, loading.nodal_loads))
        if self._sum(wrong):
            raise ComputationError("contact: gap, loads or temperatures are not finite")
        if np.any(loading.load != 0.0):
            scale = np.abs(self.weighted_force_modes).sum(axis=0)
            scale[scale == 0.0] = 1.0
            forces, target = self.weighted_force_modes / scale, loading.load / scale
            # nnls treats small columns as zero: only their directions matter
            size = np.linalg.norm(forces, axis=1, keepdims=True)
            directions = forces[size[:, 0] > 0] / size[size[:, 0] > 0]
            if (
                scipy.optimize.nnls(directions.T, target / np.linalg.norm(target))[1]
                > _STAGNATION_TOLERANCE
            ):
                raise ComputationError("contact: the load cannot be carried by the contact zone")

    def _guess(self, loading: Loading) -> FullSolution:
        """Initial guess: contact with a coarse pressure space on the contact zone."""
        own = self.elastic.solve(loading.nodal_loads)
        s = _coordinates(self.pairing)
        count, enough = _COARSE_FUNCTIONS[s.shape[1]]
        start, end = s.min(axis=0), s.max(axis=0)
        for _ in range(_MAX_REFINEMENTS):
            found = self._coarse(loading, own, _hats(s, start, end))
            pressing = s[found.active]
            width = (end - start) / count
            if np.all(np.ptp(pressing, axis=0) > enough * width):
                break
            start, end = pressing.min(axis=0) - width, pressing.max(axis=0) + width
        return found

    def _coarse(self, loading: Loading, own: np.ndarray, hats: np.ndarray) -> FullSolution:
        """Contact with hat functions (n, m) as pressures.

        Costs one elastic solution per function, and no factorisation.
        """
        weighted = self.pairing.weights[:, None] * hats
        fields = self.elastic.solve(self._traction @ sp.csr_matrix(weighted))
        softness = loading.compliance + (0.0 if self.nitsche else 1 / self.stiffness)
        opened = self._opening(fields) + softness[:, None] * hats
        everywhere = np.ones(len(loading.gap))
        try:
            coarse = solve_contact(
                weighted.T @ opened,
                weighted.T @ self.gap(loading, own),
                weighted.T @ self.modes,
                loading.load,
                force_modes=hats.T @ self.weighted_force_modes,
            )
        except ComputationError:  # Newton's method reports the cause, if any
            return FullSolution(own, np.zeros(len(loading.load)), everywhere, 0)
        pressure = hats @ coarse.coefficients
        if not pressure.any():
            return FullSolution(own, coarse.motion, everywhere, 0)
        inner = np.maximum(pressure - _ACTIVE_PRESSURE_RATIO * pressure.max(), 0.0)
        return FullSolution(own + fields @ coarse.coefficients, coarse.motion, inner, 0)

    def _held(self, loading: Loading, displacement: np.ndarray) -> np.ndarray:
        """Motion of the holder that carries the load on springs γ, for fixed bodies.

        Newton's method from all springs closed: with one motion each step ends at or beyond the
        solution, so convergence is monotonic.
        """
        gap = self.gap(loading, displacement)
        springs = self.weighted_force_modes * self.stiffness[:, None]
        closed: np.ndarray = np.ones(len(gap), dtype=bool)
        motion = np.zeros(len(loading.load))
        for _ in range(_MAX_ITERATIONS):
            matrix, right = springs[closed].T @ self.modes[closed], springs[closed].T @ gap[closed]
            motion = np.linalg.lstsq(matrix, loading.load + right, rcond=None)[0]
            pressing = self.modes @ motion > gap
            if np.array_equal(pressing, closed) or not pressing.any():
                break
            closed = pressing
        return motion

    def _newton(self, loading: Loading, start: FullSolution) -> tuple[FullSolution | None, int]:
        """Newton's method: solution, None if it does not converge, and number of iterations."""
        own = 0 if loading.deflection is None else loading.deflection.modes.shape[1]
        u, d = start.displacement, np.append(start.motion, np.zeros(own))
        before, active, last = np.inf, np.zeros(0, dtype=bool), False
        for iteration in range(_MAX_ITERATIONS):
            residual = self.residual(loading, u, d)
            stuck = iteration > 0 and residual.relative > 0.1 * before
            small = residual.relative <= (_STAGNATION_TOLERANCE if stuck else _TOLERANCE)
            kept = not residual.active.any() or np.array_equal(active, residual.active)
            if small and (kept or last):
                pressure = np.maximum(residual.pressure, 0.0)
                held = d[: len(loading.load)]
                return FullSolution(u, held, pressure, iteration), iteration
            if not np.isfinite(residual.relative):
                return None, iteration
            # pressures are off by up to thirty times the residual; a step that keeps the active set
            # is exact but for rounding, others are followed by a last one (mostly the same factor)
            before, last = residual.relative, small
            guessed = iteration == 0 and not small and bool(start.active.any())
            active = (start if guessed else residual).active
            step = self.newton_step(loading, residual, active)
            if step is None:  # too few active points to constrain the holder: restore equilibrium
                d = np.append(self._held(loading, u), np.zeros(own))
                continue
            length = step_length(*self.along(loading, residual, *step))
            u, d = u + length * step[0], d + length * step[1]
        return None, _MAX_ITERATIONS

    def _in_steps(self, loading: Loading) -> FullSolution:
        """Apply the load in steps, halved where Newton's method fails."""
        share, step, spent = 0.0, 0.5, _MAX_ITERATIONS
        solution = None
        while share < 1.0:
            part = loading.part(min(1.0, share + step))
            found, iterations = self._newton(part, solution or self._guess(part))
            spent += iterations
            if found is not None:
                solution, share, step = found, min(1.0, share + step), 2 * step
            elif step < _MIN_LOAD_STEP:
                raise ComputationError(self._advice())
            else:
                step /= 2
        assert solution is not None
        return replace(solution, iterations=spent)

    def _advice(self) -> str:
        change = "make contact.penalty smaller"
        if self.nitsche:
            change = "leave contact.gamma at its default, set contact.theta = -1"
        return (
            "contact: Newton's method found no equilibrium, however small the load; "
            f'{change}, or use contact.method = "condensed"'
        )


def _coordinates(pairing: Pairing) -> np.ndarray:
    """Coordinates of the contact points: position along a face, principal axes of a surface."""
    if pairing.points.shape[1] == 2:
        return pairing.carrying.position[:, None]
    centred = pairing.points - pairing.points.mean(axis=0)
    return centred @ np.linalg.svd(centred.T @ centred)[2][:2].T


def _hats(s: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Piecewise linear functions of equal width on part of the face, shape (n, m).

    Products of those along each coordinate (n, dim), between a start and an end (dim,).
    """
    count = int(np.sum(np.all((s >= start) & (s <= end), axis=1)))
    most = min(_COARSE_FUNCTIONS[s.shape[1]][0], int((count // 3) ** (1 / s.shape[1])))
    hats = np.ones((len(s), 1))
    for along, first, last in zip(s.T, start, end, strict=True):
        knots = np.linspace(first, last, max(2, most))
        distance = np.abs(along[:, None] - knots) / (knots[1] - knots[0])
        part = np.maximum(1.0 - distance, 0.0)
        hats = (hats[:, :, None] * part[:, None]).reshape(len(s), -1)
    return hats[:, hats.sum(axis=0) > 0.5]  # some may contain too few points


def step_length(
    constant: float, slope: float, factors: np.ndarray, pressure: np.ndarray, change: np.ndarray
) -> float:
    """Exact line search: fraction of the Newton step, from the work of the residual along it.

    The work ``constant + slope a + factors · max(0, pressure + a change)`` is the derivative of the
    energy, if one exists: continuous, piecewise linear, and increasing, so that its zero is the
    minimum along the step. Full steps are kept unless harmful, since they end exactly at the
    solution once the active set no longer changes.
    """

    def work(a):
        pressing = np.maximum(pressure + np.multiply.outer(a, change), 0.0)
        return constant + slope * a + pressing @ factors

    start, whole = work(np.array([0.0, 1.0]))
    if start >= 0.0 or whole <= _MAX_WORK_RATIO * abs(start):
        return 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        kinks = -pressure / change
    kinks = np.unique(np.concatenate([[0.0, 1.0], kinks[(kinks > 0.0) & (kinks < 1.0)]]))
    values = work(kinks)
    after = int(np.argmax(values > 0.0))
    a, b = kinks[after - 1], kinks[after]
    fa, fb = values[after - 1], values[after]
    return float(a + (b - a) * fa / (fa - fb))
