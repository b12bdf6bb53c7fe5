"""Frictional contact of bodies that are held, and of condensed bodies."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ...bulk.elasticity.elasticity import Elasticity
from ...parallel import sum_over_ranks
from ..operators.condensation import vector_trace
from ..operators.pressure import Basis, PressureSpace, dense, scaled
from ..operators.rigid_motion import HeldMotion, closure, measured, tangential_frame, travel, weak
from ..operators.thermal_opening import elastic_columns
from ..search.pairing import Contacts
from ..solvers.signorini import solve_contact
from .coulomb import CoulombProblem, CoulombSolution, solve_by_newton, solve_with_fallbacks
from .gross_slip import check_gross_slip_of_holders
from .slip_wear import AnyProfiles, WearSlope, WornProfiles
from .stick_slip_state import Loads, Status, StickSlipState


@dataclass(frozen=True)
class FrictionalContact(PressureSpace):
    """Contact with friction, condensed or on the full system: solves one increment.

    Below, t tangential directions give ``M = m (1 + t)`` coefficients.

    Attributes
    ----------
    gap : ndarray, shape (n,)
        Gap of the unloaded, unworn bodies [m].
    rigid : ndarray, shape (1 + t, n, k)
        R at the points: decrease of gap and slips per unit of each motion of the holder.
    modes : ndarray, shape (M, k)
        Weak R [m²].
    travel : ndarray, shape (n_interfaces, k), in space (n_interfaces, 3, k)
        Displacement of the first body over the second one in the middle of the face per unit of
        each motion: along increasing positions on the face; in space along the axes of the frame
        there, and rotation about its pole, see `faces.normals`.
    held : tuple of HeldMotion
        The k motions.
    """

    gap: np.ndarray
    rigid: np.ndarray
    modes: np.ndarray
    travel: np.ndarray
    held: tuple[HeldMotion, ...]

    @property
    def directions(self) -> int:
        """Number t of tangential directions."""
        return len(self.rigid) - 1

    @cached_property
    def areas(self) -> np.ndarray:
        """Areas of the basis functions, shape (m,) [m²]."""
        return np.asarray(self.weighted.sum(axis=0)).ravel()

    def with_role(self, role: str) -> np.ndarray:
        """True for the motions with a role, shape (k,)."""
        return np.array([motion.role == role for motion in self.held], dtype=bool)

    def stack(self, pressure: np.ndarray, shear: np.ndarray) -> np.ndarray:
        """Coefficients λ, shape (m,), and τ, shape (m, t), as one vector x."""
        return np.concatenate([pressure, shear.T.ravel()])

    def split(self, stacked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Split x into λ and τ, the inverse of `stack`."""
        blocks = stacked.reshape(-1, self.basis.shape[1])
        return blocks[0], blocks[1:].T

    def seen(self, profiles: WornProfiles) -> AnyProfiles:
        """Worn profiles in the basis of the contact, by default their own."""
        return profiles

    @abstractmethod
    def increment(
        self,
        friction: np.ndarray,
        state: StickSlipState,
        guess: StickSlipState,
        loads: Loads,
        worn: np.ndarray,
        lost: np.ndarray | None = None,
        slope: WearSlope | None = None,
    ) -> StickSlipState:
        """State after one implicit increment, without a change of its worn depths.

        Parameters
        ----------
        friction : ndarray, shape (m,)
            Coefficient of friction.
        state : StickSlipState
            State before the increment.
        guess : StickSlipState
            The same, or a state with the same loads.
        loads : Loads
            Loads at the end of the increment.
        worn : ndarray, shape (m,)
            Worn depth before the increment, at the places of its end [m].
        lost : ndarray, shape (m,), optional
            Depth that it wears at zero pressure [m].
        slope : WearSlope, optional
            Depth that it wears per pressure [m/Pa].

        Raises
        ------
        FullSliding
            If the tangential force exceeds the friction limit.
        ComputationError
            If no solution is found.
        """

    def spared(self, state: StickSlipState, after: StickSlipState) -> np.ndarray:
        """Weak gaps by worn depths beyond those of functions that overlap, shape (m, m) [m²].

        What is worn next to the stick zone would open the gap within it, so that its edge slips and
        wears, and so on. There, functions have the gap of their own depth alone; those outside
        share theirs as they slip.
        """
        return np.zeros((len(self.areas),) * 2)

    @abstractmethod
    def lost(self, shear: np.ndarray, slip: np.ndarray, point_slip: np.ndarray) -> np.ndarray:
        """Energy dissipated at the points in an increment, shape (n,) [J/m²].

        Its integral is exactly that of the weak conditions, to which each coefficient contributes
        at least 0.

        Parameters
        ----------
        shear : ndarray, shape (m, t)
            Coefficients τ at the end of the increment [Pa].
        slip : ndarray, shape (m, t)
            Weak slip of the increment [m³].
        point_slip : ndarray, shape (n, t)
            Slip of the increment at the points [m].
        """


def unloaded(
    contact: FrictionalContact, wearing: int = 0, coefficients: int | None = None
) -> StickSlipState:
    """Unloaded initial state.

    Parameters
    ----------
    contact : FrictionalContact
    wearing : int
        Number of wearing bodies.
    coefficients : int, optional
        Number of coefficients of each worn profile, by default that of the contact.
    """
    (n, m), k = contact.basis.shape, contact.modes.shape[1]
    t = contact.directions
    still, free = np.zeros(k), np.full(m, Status.OPEN)
    shears, points = np.zeros((m, t)), np.zeros((n, t))
    worn = np.zeros((wearing, m if coefficients is None else coefficients))
    none = np.zeros(m)
    return StickSlipState(
        none, shears, shears, still, still, free, points, np.zeros(n), worn, *(none,) * 6
    )


@dataclass(frozen=True)
class CondensedFriction(FrictionalContact):
    """Gap and slip of the elastic bodies as functions of pressure and shear.

    Attributes
    ----------
    compliance : ndarray, shape (M, M)
        A, symmetric [m⁵/N].
    """

    compliance: np.ndarray

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
        gap = self.weighted.T @ self.gap + self.mass @ worn + state.spared
        compliance = self.compliance
        if lost is not None:
            opened = self.mass + self.spared(state, guess)
            m, compliance, gap = len(worn), compliance.copy(), gap + opened @ lost
            compliance[:m, :m] += opened @ slope.dense
        given = loads.motions
        free = np.isnan(given)
        fixed = np.where(free, 0.0, given)
        start = self.stack(gap, -state.slip) - self.modes @ fixed
        modes = self.modes[:, free]
        forces, bears_none = loads.forces[free], state.unsheared
        problem = CoulombProblem(compliance, start, modes, forces, friction, bears_none)
        presses, slides = self.with_role("press")[free], self.with_role("slide")[free]
        closed = _predicted_active(problem, guess.pressure > 0, presses)
        near = None
        if guess is not state:
            near = np.append(self.stack(guess.pressure, guess.shear), guess.motion[free])
        solution = solve_by_newton(problem, closed, near)
        if solution is None or (slides.any() and not friction.any()):
            held = [each for each, is_free in zip(self.held, free, strict=True) if is_free]
            check_gross_slip_of_holders(problem, presses, slides, held)
            solution = solve_with_fallbacks(problem, closed)
        return self._state_after(state, solution, free, fixed)

    def spared(self, state: StickSlipState, after: StickSlipState) -> np.ndarray:
        inside = state.part > 0.0
        if not inside.any():
            return np.zeros_like(self.mass)
        slip = after.not_sticking * np.linalg.norm(after.slip - state.slip, axis=1) / self.areas
        slip[inside] = 0.0
        # the mean slip where two functions overlap weighs what one wears in the other
        opened = np.where(inside[:, None], 0.0, self.mass)
        opened *= np.where(inside, 1.0, (slip + slip[:, None]) / 2)
        found = opened.sum(axis=0)
        outside = ~inside & (found > 0.0)
        opened[:, outside] *= self.areas[outside] / found[outside]
        return opened + np.diag(self.areas - opened.sum(axis=0)) - self.mass

    def _state_after(self, state, solution: CoulombSolution, free, fixed) -> StickSlipState:
        """State at the end of the increment from a solution."""
        x = self.stack(solution.pressure, solution.shear)
        motion = fixed.copy()
        motion[free] = solution.motion
        slip, point_slip = self.weak_slip(x, motion), self.point_slip(x, motion)
        lost = self.lost(solution.shear, slip - state.slip, point_slip - state.point_slip)
        closed = np.where(solution.sticking, Status.STICK, Status.SLIP)
        return replace(
            state,
            pressure=solution.pressure,
            shear=solution.shear,
            slip=slip,
            motion=motion,
            force=self.modes.T @ x,
            status=np.where(solution.pressure > 0, closed, Status.OPEN),
            point_slip=point_slip,
            dissipated=state.dissipated + lost,
            iterations=solution.iterations,
        )

    def weak_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Weak slip under coefficients x and motion d of the holder, shape (m, t) [m³]."""
        return self.split(self.compliance @ stacked - self.modes @ motion)[1]

    @abstractmethod
    def point_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        """Slip at the points under coefficients x and motion d of the holder, shape (n, t) [m]."""


@dataclass(frozen=True)
class LineContact(CondensedFriction):
    """Frictional contact of plane bodies, with the slip of the bodies at each point.

    Attributes
    ----------
    response : ndarray, shape (1 + t, n, M)
        Gap and slips at the points per coefficient [m/Pa].
    influence : ndarray, shape (n_owned, M)
        Displacement per coefficient [m/Pa]; weak gap and slips due to any nodal load f are
        ``influenceᵀ f``.
    """

    response: np.ndarray
    influence: np.ndarray

    def point_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        return (self.response[1:] @ stacked - self.rigid[1:] @ motion).T

    def lost(self, shear: np.ndarray, slip: np.ndarray, point_slip: np.ndarray) -> np.ndarray:
        return -((self.basis @ shear) * point_slip).sum(axis=1)


@dataclass(frozen=True)
class SurfaceContact(CondensedFriction):
    """Frictional contact of bodies in space.

    The slip at a point is the mean of the slips of its coefficients, the weak slips over their
    areas, as no displacements are stored: it vanishes exactly where all of them stick.
    """

    def point_slip(self, stacked: np.ndarray, motion: np.ndarray) -> np.ndarray:
        return self.basis @ (self.weak_slip(stacked, motion) / self.areas[:, None])

    def lost(self, shear: np.ndarray, slip: np.ndarray, point_slip: np.ndarray) -> np.ndarray:
        worked = np.maximum(-(shear * slip).sum(axis=1), 0.0)  # rounding where it sticks
        return self.basis @ (worked / self.areas)


def frictional_contact(
    basis: np.ndarray,
    weights: np.ndarray,
    gap: np.ndarray,
    response: np.ndarray,
    rigid: np.ndarray,
    travel: np.ndarray,
    held: Sequence[HeldMotion],
    influence: np.ndarray,
) -> LineContact:
    """Assemble weak operators from responses at the points; arguments as in `LineContact`.

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Area of each point [m²].
    """
    weighted = scaled(weights, basis)
    compliance = np.concatenate([weighted.T @ component for component in response])
    compliance = (compliance + compliance.T) / 2
    modes = weak(weighted, rigid)
    common = basis, weighted, gap, rigid, modes, travel, tuple(held)
    return LineContact(*common, compliance, response, influence)


def condense_tangential(
    elastic: Elasticity,
    contacts: Contacts,
    basis: Basis,
    held: Sequence[HeldMotion],
    frame: np.ndarray | None = None,
) -> CondensedFriction:
    """Condense elasticity to pressure and shear. Every rank calls.

    Parameters
    ----------
    elastic : Elasticity
    contacts : Contacts
    basis : ndarray or csr_array, shape (n, m)
        Ψ, from `pressure.pressure_basis`.
    held : sequence of HeldMotion
        Motions of the holders.
    frame : ndarray, shape (t, n, gdim), optional
        Tangential directions, see `tangential_frame`.

    Raises
    ------
    ComputationError
        If the elastic problem cannot be solved.
    """
    frame = tangential_frame(contacts) if frame is None else frame
    traces = [vector_trace(elastic.spaces, contacts, e) for e in measured(contacts, frame)]
    along = np.stack([travel(contacts, each) for each in held], axis=-1)
    rigid = closure(contacts, held, frame)
    if contacts.in_space:
        weighted = scaled(contacts.weights, basis)
        compliance = _compliance(elastic, traces, weighted)
        modes = weak(weighted, rigid)
        operators = contacts.gap, rigid, modes, along, tuple(held), compliance
        return SurfaceContact(basis, weighted, *operators)
    basis = dense(basis)
    sparse = sp.csr_matrix(scaled(contacts.weights, basis))
    influence = elastic.solve(sp.hstack([trace @ sparse for trace in traces], format="csr"))
    comm = elastic.bodies.comm
    response = sum_over_ranks(comm, np.array([trace.T @ influence for trace in traces]))
    return frictional_contact(
        basis, contacts.weights, contacts.gap, response, rigid, along, held, influence
    )


def _compliance(elastic: Elasticity, traces: list[sp.csr_matrix], weighted: Basis) -> np.ndarray:
    """Compliance A, shape (M, M), from blocks of columns of which nothing is kept. Collective."""
    sparse, spaces = sp.csr_matrix(weighted), elastic.spaces
    loads = sp.hstack([trace @ sparse for trace in traces], format="csr")
    touching = np.flatnonzero(np.diff(loads.indptr))
    body = np.searchsorted(spaces.starts, touching, side="right") - 1
    near, result = loads[touching], np.zeros((loads.shape[1],) * 2)
    for found in elastic_columns(elastic, loads.tocsc()):
        inside = np.flatnonzero(np.isin(body, spaces.groups[found.group]))
        rows = spaces.within(found.group, touching[inside])
        result[:, found.columns] += near[inside].T @ found.displacements[rows]
    result = sum_over_ranks(elastic.bodies.comm, result)
    return (result + result.T) / 2


def _predicted_active(
    problem: CoulombProblem, closed: np.ndarray, presses: np.ndarray
) -> np.ndarray:
    """Predicted active coefficients: the current ones, initially those without friction.

    Without friction only the motions that press are free; a motion that closes no gap is not.
    """
    if np.any(closed):
        return closed
    m = len(closed)
    presses = presses & np.any(problem.modes[:m] != 0.0, axis=0)
    modes, force = problem.modes[:m, presses], problem.force[presses]
    return solve_contact(problem.compliance[:m, :m], problem.offset[:m], modes, force).active
