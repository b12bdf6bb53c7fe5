"""Frictional contact of condensed bodies, with pressure and shear as unknowns."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ...bulk.mechanics.elasticity import Elasticity
from ...parallel import sum_over_ranks
from ..operators.pressure import Basis, dense, scaled
from ..operators.tangential import (
    HeldMotion,
    closure,
    measured,
    tangential_frame,
    travel,
    weak,
)
from ..operators.thermal_opening import elastic_columns
from ..operators.traces import vector_trace
from ..search.contacts import Contacts
from ..solvers.signorini import solve_contact
from .coulomb import CoulombProblem, CoulombSolution
from .coulomb_solver import solve_by_newton, solve_with_fallbacks
from .frictional_contact import FrictionalContact
from .gross_slip import check_gross_slip_of_holders
from .stick_slip_state import Loads, Status, StickSlipState


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
