"""Frictional contact on the full system, by penalty or by Nitsche's method.

Tractions, slips and worn depths are those of the points, each with a function of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...bulk.mechanics.elasticity import Elasticity
from ...errors import ComputationError
from ..friction.frictional_contact import FrictionalContact
from ..friction.gross_slip import check_gross_slip_of_holders
from ..friction.slip_wear import ProfilesAtPoints, WornProfiles
from ..friction.stick_slip_state import Loads, Status, StickSlipState
from ..operators.pressure import Basis, dense, scaled
from ..operators.tangential import HeldMotion, closure, measured, travel, weak
from ..operators.traces import vector_trace
from ..search.contacts import Contacts
from ..solvers.anderson import AndersonMixing
from .friction_equations import (
    FrictionEquations,
    FrictionLoading,
    FrictionSolution,
    softening,
)
from .full_system import FullContact
from .nitsche import face_traction
from .point_friction import assumed_slopes

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
        """Solution from an expected contact, see `point_friction.assumed_slopes`."""
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
