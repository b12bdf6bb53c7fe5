"""Frictional contact on the full system, by penalty or by Nitsche's method.

With gap and slips ``y = (g, -s_0) + B u - R d`` at the points (see `operators.rigid_motion`), a
stiffness γ, and tractions S u = (pressure, shears) of body 1,

    x = P(X),   X = S u - γ y,   P onto p >= 0, |t| <= mu p,

    K u - θ Sᵀ (w/γ) S u - (γ B - θ S)ᵀ (w/γ) x = 0,      Rᵀ w x = F,

with a local compliance c as in `full_system`. Without S this is the penalty method, with the
elastic stick stiffness γ; with it Nitsche's method (Chouly et al., An overview of recent results on
Nitsche's method for contact problems, LNCSE 121 (2017) 93). The history variable is the slip s_0 so
far: a point that slips gains ``(t - X_t)/γ``, as the plastic strain in a return mapping; a point
that sticks gains nothing. Differences of the displacements between two increments would do for a
single increment only: while a point sticks, each would add the discretisation error
``(S u - t)/γ``, and stick would creep.

The friction loss ``-t Δs_0`` is never negative.

Tractions, slips and worn depths are those of the points, each with a function of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from ...bulk.elasticity.elasticity import Elasticity
from ...errors import ComputationError
from ..friction.frictional_contact import FrictionalContact
from ..friction.gross_slip import check_gross_slip_of_holders
from ..friction.slip_wear import ProfilesAtPoints, WornProfiles
from ..friction.stick_slip_state import Loads, Status, StickSlipState
from ..operators.condensation import vector_trace
from ..operators.pressure import Basis, dense, scaled
from ..operators.rigid_motion import HeldMotion, closure, measured, travel, weak
from ..search.pairing import Contacts
from ..solvers.coupled_positions import AndersonMixing
from .full_system import FullContact, NewtonMatrix, NodalEquations, bordered_step, held
from .nitsche import face_traction


@dataclass(frozen=True)
class PointTractions:
    """Pressure and shear at the points; c = 1 + t components.

    Attributes
    ----------
    values : ndarray, shape (c, n) [Pa]
    slopes : ndarray, shape (c, c, n)
        Derivatives by the trial tractions of the same point.
    sticking : ndarray of bool, shape (n,)
        False also at open points.
    """

    values: np.ndarray
    slopes: np.ndarray
    sticking: np.ndarray


def projected(trial: np.ndarray, friction: np.ndarray, softening: np.ndarray) -> PointTractions:
    """Pressures without tension, and shears projected on the disc of radius ``mu p``.

    Parameters
    ----------
    trial : ndarray, shape (c, n) [Pa]
    friction : ndarray, shape (n,)
    softening : ndarray, shape (n,)
        Pressure per positive trial pressure.
    """
    normal, tangential = softening * trial[0], trial[1:]
    closed = normal > 0.0
    pressure = np.maximum(normal, 0.0)
    radius, length = friction * pressure, np.linalg.norm(tangential, axis=0)
    sticking = closed & (length <= radius)
    direction = tangential / np.where(length > 0.0, length, 1.0)
    shear = np.where(sticking, tangential, radius * direction)
    slips = closed & ~sticking
    slopes = assumed_slopes(closed, sticking, friction * direction, softening)
    turning = slips * radius / np.where(length > 0.0, length, 1.0)
    across = np.eye(len(tangential))[..., None] - direction[:, None] * direction
    slopes[1:, 1:] += turning * across
    return PointTractions(np.vstack([pressure, shear]), slopes, sticking)


def assumed_slopes(
    closed: np.ndarray, sticking: np.ndarray, drag: np.ndarray, softening: np.ndarray
) -> np.ndarray:
    """Derivatives, shape (c, c, n), at points that stick or slip in a fixed direction.

    Parameters
    ----------
    closed, sticking : ndarray of bool, shape (n,)
        Closed points, and those of them that stick.
    drag : ndarray, shape (t, n)
        Shear per pressure of the others.
    softening : ndarray, shape (n,)
    """
    t, n = drag.shape
    slopes = np.zeros((1 + t, 1 + t, n))
    slopes[0, 0] = closed * softening
    slopes[1:, 0] = (closed & ~sticking) * softening * drag
    slopes[np.arange(1, 1 + t), np.arange(1, 1 + t)] = sticking
    return slopes


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
    """Pressure per trial pressure on a local compliance, φ of `full_system`, shape (n,)."""
    return 1 / (1 + stiffness * compliance)


def _linear(slopes: np.ndarray, trial: np.ndarray) -> np.ndarray:
    """Tractions (c, n) of slopes (c, c, n) at trial tractions."""
    return np.einsum("ijn,jn->in", slopes, trial)


_ADVICE = (
    "contact: Newton's method found no pressure and shear that satisfy the friction conditions at "
    'this load; take smaller increments, or use contact.method = "condensed"'
)
_WEAR_ADVICE = (
    "contact: the iteration for pressure and wear of an increment did not converge; take smaller "
    "increments, or let each computed cycle stand for fewer (analysis.jump)"
)
_WEAR_ITERATIONS = 30
_WEAR_TOLERANCE = 1e-6  # of the depth worn in the increment


@dataclass(frozen=True)
class FullFriction(FrictionalContact):
    """Frictional contact with pointwise conditions on all nodal displacements.

    Attributes
    ----------
    contacts : Contacts
        With one interface.
    trace : csr_matrix, shape (n_owned, (1 + t) n)
        Bᵀ of gap and slips.
    stress : csr_matrix or None, shape (n_owned, (1 + t) n)
        Sᵀ of pressure and shears; None for the penalty method.
    depths : ndarray, shape (m, m_Ψ)
        Basis of the worn profiles at the points.
    equations : FrictionEquations
    """

    contacts: Contacts
    trace: sp.csr_matrix
    stress: sp.csr_matrix | None
    depths: np.ndarray
    equations: FrictionEquations

    def seen(self, profiles: WornProfiles) -> ProfilesAtPoints:
        return ProfilesAtPoints(profiles, self.depths, self.areas)

    def increment(
        self,
        friction,
        state: StickSlipState,
        guess: StickSlipState,
        loads: Loads,
        worn,
        lost=None,
        slope=None,
    ) -> StickSlipState:
        if lost is None:
            return self._increment(friction, state, guess, loads, worn, np.zeros(len(worn)))
        worn = worn + lost
        lumped = slope.lumped  # the rest, between points, by iteration
        rest = slope @ guess.pressure - lumped * guess.pressure
        mixing = AndersonMixing(_WEAR_ITERATIONS)
        for _ in range(_WEAR_ITERATIONS):
            guess = self._increment(friction, state, guess, loads, worn + rest, lumped)
            found = slope @ guess.pressure
            left = found - lumped * guess.pressure - rest
            if np.abs(left).max() <= _WEAR_TOLERANCE * np.abs(found).max():
                return guess
            rest = mixing.next(rest, left)
        raise ComputationError(_WEAR_ADVICE)

    def _increment(
        self, friction, state: StickSlipState, guess: StickSlipState, loads: Loads, worn, compliance
    ) -> StickSlipState:
        """State after an increment with a worn depth and a local compliance (m,) [m, m/Pa]."""
        free = np.isnan(loads.motions)
        fixed = np.where(free, 0.0, loads.motions)
        distance = np.vstack([self.gap + self.basis @ worn, -state.point_slip.T])
        problem = _Increment(
            self,
            FrictionLoading(
                distance - self.rigid @ fixed,
                self.basis @ friction,
                self.basis @ compliance,
                self.rigid[..., free],
                loads.forces[free],
            ),
            friction,
            self.modes[:, free],
        )
        presses, slides = self.with_role("press")[free], self.with_role("slide")[free]
        solution = self._solved(problem, guess, guess is state, presses)
        if solution is None or (slides.any() and not friction.any()):
            held = [each for each, is_free in zip(self.held, free, strict=True) if is_free]
            check_gross_slip_of_holders(problem, presses, slides, held)
            solution = problem.from_frictionless(presses)
        return self._state_after(state, solution, free, fixed)

    def _solved(
        self, problem: _Increment, guess: StickSlipState, sticks: bool, presses: np.ndarray
    ) -> FrictionSolution | None:
        """Solution from the points that press in a guess, all of them sticking if it is older."""
        if not np.any(guess.pressure > 0.0):
            return problem.sticking(problem.frictionless(presses) > 0.0)
        pressure = self.basis @ guess.pressure
        if sticks:
            return problem.sticking(pressure > 0.0)
        shear = (self.basis @ guess.shear).T
        sticking = self.basis @ (guess.status == Status.STICK) > 0.0
        drag = shear / np.where(pressure > 0.0, pressure, 1.0)
        return problem.solve(pressure > 0.0, sticking, drag)

    def _state_after(
        self, state: StickSlipState, solution: FrictionSolution, free, fixed
    ) -> StickSlipState:
        """State at the end of the increment from a solution."""
        motion = fixed.copy()
        motion[free] = solution.motion
        values, kept = solution.tractions.values, self._kept
        slid = ((values - solution.trial)[1:] / self.equations.stiffness).T
        point_slip = (state.point_slip + slid)[kept]
        pressure, shear = values[0, kept], values[1:, kept].T
        sticking = np.where(solution.tractions.sticking[kept], Status.STICK, Status.SLIP)
        slip = self.areas[:, None] * point_slip
        lost = self.lost(shear, slip - state.slip, slip)
        return replace(
            state,
            pressure=pressure,
            shear=shear,
            slip=slip,
            motion=motion,
            force=self.modes.T @ self.stack(pressure, shear),
            status=np.where(pressure > 0.0, sticking, Status.OPEN),
            point_slip=self.basis @ point_slip,
            dissipated=state.dissipated + lost,
            iterations=solution.iterations,
        )

    def lost(self, shear: np.ndarray, slip: np.ndarray, point_slip: np.ndarray) -> np.ndarray:
        return self.basis @ -((shear * slip).sum(axis=1) / self.areas)

    @property
    def _kept(self) -> np.ndarray:
        """Points with an area, shape (m,)."""
        return np.flatnonzero(self.contacts.weights > 0.0)


@dataclass(frozen=True)
class _Increment:
    """Contact problem of one increment, see `gross_slip.SlidingProblem`."""

    contact: FullFriction
    loading: FrictionLoading
    friction: np.ndarray
    modes: np.ndarray

    @property
    def force(self) -> np.ndarray:
        return self.loading.force

    def sticking(self, closed: np.ndarray) -> FrictionSolution | None:
        """Solution from points (n,) that are expected to press and to stick."""
        none = np.zeros((self.contact.directions, len(closed)))
        return self.solve(closed, closed, none)

    def solve(
        self, closed: np.ndarray, sticking: np.ndarray, drag: np.ndarray
    ) -> FrictionSolution | None:
        """Solution from an expected contact, see `assumed_slopes`."""
        equations = self.contact.equations
        soft = softening(equations.stiffness, self.loading.compliance)
        return equations.solve(self.loading, assumed_slopes(closed, sticking, drag, soft))

    def from_frictionless(self, presses: np.ndarray) -> FrictionSolution:
        """Solution from the contact without friction.

        Raises
        ------
        ComputationError
            If none is found.
        """
        solution = self.sticking(self.frictionless(presses) > 0.0)
        if solution is None:
            raise ComputationError(_ADVICE)
        return solution

    def frictionless(self, presses: np.ndarray) -> np.ndarray:
        """Pressure at the points where only the motions that press are free, shape (n,) [Pa]."""
        return self._pressure(presses, np.zeros((self.contact.directions, len(self.friction))))

    def sliding_pressure(self, presses: np.ndarray, drag: np.ndarray) -> np.ndarray:
        return self._pressure(presses, drag)[self.contact._kept]

    def _pressure(self, presses: np.ndarray, drag: np.ndarray) -> np.ndarray:
        """Pressure at the points with a shear of `drag` times the pressure, shape (n,) [Pa]."""
        contact, loading = self.contact, self.loading
        n, moves = loading.distance.shape[1], loading.closure[:, :, presses]
        closes = np.any(moves[0] != 0.0, axis=0)  # others carry no load without friction
        moves = moves[:, :, closes]
        along = np.vstack([np.ones(n), (contact.basis @ drag.T).T])
        traces = contact.trace[:, :n], contact.trace @ sp.vstack([sp.diags(a) for a in along])
        full = FullContact(
            contact.equations.elastic,
            contact.contacts.only,
            traces[0],
            traces[1].tocsr() if drag.any() else traces[0],
            moves[0],
            np.einsum("cn,cnk->nk", along, moves),
            contact.equations.stiffness,
            None if contact.stress is None else -contact.stress[:, :n],
            contact.equations.theta,
        )
        force = loading.force[presses][closes]
        return full.solve(loading.distance[0], force, loading.compliance).pressure


def full_friction(
    elastic: Elasticity,
    contacts: Contacts,
    depths: Basis,
    held: Sequence[HeldMotion],
    frame: np.ndarray,
    stiffness: np.ndarray,
    theta: int | None = None,
) -> FullFriction:
    """Frictional contact on the full system. Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    contacts : Contacts
        With one interface.
    depths : ndarray or csr_array, shape (n, m_Ψ)
        Basis Ψ of the worn profiles.
    held : sequence of HeldMotion
        Motions of the holders.
    frame : ndarray, shape (t, n, gdim)
        Tangential directions, see `tangential_frame`.
    stiffness : ndarray, shape (n,)
        Stiffness γ [Pa/m].
    theta : int, optional
        θ of Nitsche's method; the penalty method without it.
    """
    weights, pairing = contacts.weights, contacts.only
    trace = _stacked(vector_trace(elastic.spaces, contacts, e) for e in measured(contacts, frame))
    stress = None
    if theta is not None:
        directions = -contacts.normals, *frame
        stress = _stacked(face_traction(elastic, pairing, e) for e in directions)
    equations = FrictionEquations(
        elastic, weights, trace, stiffness, stress, 0 if theta is None else theta
    )
    basis = _point_functions(contacts)
    weighted, rigid = scaled(weights, basis), closure(contacts, held, frame)
    along = np.stack([travel(contacts, each) for each in held], axis=-1)
    space = basis, weighted, contacts.gap, rigid, weak(weighted, rigid), along, tuple(held)
    own = dense(depths)[weights > 0.0]
    return FullFriction(*space, contacts, trace, stress, own, equations)


def _stacked(blocks) -> sp.csr_matrix:
    return sp.hstack(list(blocks)).tocsr()


def _point_functions(contacts: Contacts) -> sp.csr_array:
    """Basis of values at the points with an area, shape (n, m).

    Points without, on an axis, have the values of the nearest one.
    """
    own = contacts.weights > 0.0
    nearest = cKDTree(contacts.points[own]).query(contacts.points)[1]
    n = len(nearest)
    return sp.csr_array((np.ones(n), (np.arange(n), nearest)), shape=(n, int(own.sum())))
