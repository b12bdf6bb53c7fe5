"""Incremental solution of stick and slip under a load history (Coulomb friction).

Coulomb friction is history dependent: each state follows from the previous one. It is rate
independent: a load history is a polygon, given by its corners. Wear: see `slip_wear`; signs: see
`tangential`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ...errors import ComputationError
from ..operators.frictional_contact import FrictionalContact
from ..solvers.signorini import solve_contact
from ..wear.implicit_step import newton_with_wear
from .coulomb import CoulombProblem, CoulombSolution
from .coulomb_solver import solve_by_newton, solve_with_fallbacks
from .gross_slip import FullSliding, check_gross_slip
from .slip_wear import IncrementWear, SlipWear
from .stick_slip_state import Loads, Status, StickSlipState, unloaded

_MAX_HALVINGS = 6
_WEAR_TOLERANCE = 1e-6  # of the depth worn in the increment
_NOT_CONVERGED = (
    "contact: the iteration for slip and wear of an increment did not converge; take smaller "
    "increments, or let each computed cycle stand for fewer (analysis.jump)"
)


def advance(
    contact: FrictionalContact,
    friction: float | np.ndarray,
    state: StickSlipState,
    loads: Loads,
    wear: SlipWear | None = None,
) -> StickSlipState:
    """State after one implicit increment: the conditions hold at its end.

    Parameters
    ----------
    contact : FrictionalContact
    friction : float or ndarray, shape (m,)
        Coefficient of friction, one or one per pressure coefficient.
    state : StickSlipState
        State before the increment.
    loads : Loads
        Loads at the end of the increment.
    wear : SlipWear, optional
        Wear in the increment, by default none.

    Raises
    ------
    FullSliding
        If the tangential force exceeds the friction limit.
    ComputationError
        If no solution is found.
    """
    given = loads.motions
    if len(given) != len(state.motion):
        raise ValueError(f"loads: the holders have {len(state.motion)} motions, not {len(given)}")
    friction = np.broadcast_to(np.asarray(friction, dtype=float), len(state.pressure))
    mean = contact.mass
    # motions given at the end, or the current ones if free
    travel = contact.travel @ np.where(np.isnan(given), state.motion, given)
    worn = state.worn.sum(axis=0) if wear is None else wear.depth_at_contact(state.worn, travel)

    def solve(lost: np.ndarray, slope: np.ndarray, guess: StickSlipState) -> StickSlipState:
        """Solve contact with the worn depths ``lost + slope λ``."""
        gap = contact.weighted.T @ contact.gap + mean @ (worn + lost)
        compliance = contact.compliance.copy()
        compliance[: len(slope), : len(slope)] += mean @ slope
        return _increment(contact, friction, state, guess, loads, compliance, gap)

    no_slope = np.zeros_like(mean)
    after = solve(no_slope[0], no_slope, state)
    if wear is None:
        return after
    by_slip = IncrementWear(wear, state, mean.sum(axis=1), travel)
    if by_slip.value(after.pressure, after).any():
        after = newton_with_wear(solve, by_slip, after, _WEAR_TOLERANCE, _NOT_CONVERGED)
    depths = by_slip.profiles(after)
    lost = wear.repeats * (after.dissipated - state.dissipated)
    return replace(after, worn=state.worn + depths, dissipated=state.dissipated + lost)


def _increment(contact, friction, state, guess, loads: Loads, compliance, gap) -> StickSlipState:
    """State after one increment with a given elastic and local compliance.

    The guess is the previous state or one with the same loads.
    """
    given = loads.motions
    free = np.isnan(given)
    fixed = np.where(free, 0.0, given)
    start = contact.stack(gap, -state.slip) - contact.modes @ fixed
    modes = contact.modes[:, free]
    problem = CoulombProblem(compliance, start, modes, loads.forces[free], friction)
    presses, slides = contact.with_role("press")[free], contact.with_role("slide")[free]
    closed = _predicted_active(problem, guess.pressure > 0, presses)
    near = None
    if guess is not state:
        near = np.append(contact.stack(guess.pressure, guess.shear), guess.motion[free])
    solution = solve_by_newton(problem, closed, near)
    if solution is None or (slides.any() and not friction.any()):
        held = [each for each, is_free in zip(contact.held, free, strict=True) if is_free]
        for holder in dict.fromkeys(held[k].holder for k in np.flatnonzero(slides)):
            own = [k for k in np.flatnonzero(slides) if held[k].holder == holder]
            check_gross_slip(problem, presses, np.array(own), [held[k] for k in own])
        solution = solve_with_fallbacks(problem, closed)
    return _state_after(contact, state, solution, free, fixed)


def _state_after(contact, state, solution: CoulombSolution, free, fixed) -> StickSlipState:
    """State at the end of the increment from a solution."""
    x = contact.stack(solution.pressure, solution.shear)
    motion = fixed.copy()
    motion[free] = solution.motion
    slip, point_slip = contact.weak_slip(x, motion), contact.point_slip(x, motion)
    lost = contact.lost(solution.shear, slip - state.slip, point_slip - state.point_slip)
    closed = np.where(solution.sticking, Status.STICK, Status.SLIP)
    return replace(
        state,
        pressure=solution.pressure,
        shear=solution.shear,
        slip=slip,
        motion=motion,
        force=contact.modes.T @ x,
        status=np.where(solution.pressure > 0, closed, Status.OPEN),
        point_slip=point_slip,
        dissipated=state.dissipated + lost,
        iterations=solution.iterations,
    )


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


def follow(
    contact: FrictionalContact,
    friction: float | np.ndarray,
    corners: Iterable[Loads],
    increments: int,
    state: StickSlipState | None = None,
    wear: SlipWear | None = None,
) -> Iterator[StickSlipState]:
    """Follow a polygonal load history from a state, by default the unloaded one.

    Parameters
    ----------
    contact : FrictionalContact
    friction : float or ndarray, shape (m,)
        See `advance`.
    corners : iterable of Loads
        Loads at the corners, each reached linearly from the state before; along a motion, control
        may change between force and displacement.
    increments : int
        Number between two corners; an increment is halved if no solution is found.
    state : StickSlipState, optional
    wear : SlipWear, optional
        Wear of each increment, see `advance`.

    Yields
    ------
    StickSlipState
        State after each increment.

    Raises
    ------
    FullSliding, ComputationError
        See `advance`.
    """
    state = unloaded(contact) if state is None else state
    for corner in corners:
        origin = state
        for step in range(1, increments + 1):
            loads = corner.after(origin.force, origin.motion, step / increments)
            state = _halving(contact, friction, state, loads, wear, _MAX_HALVINGS)
            yield state


def _halving(contact, friction, state, loads: Loads, wear, halvings: int) -> StickSlipState:
    """Advance in one step, or in two halves if that fails."""
    try:
        return advance(contact, friction, state, loads, wear)
    except FullSliding:
        raise
    except ComputationError:
        if halvings == 0:
            raise
    half, wear = loads.after(state.force, state.motion, 0.5), wear and wear.halved()
    middle = _halving(contact, friction, state, half, wear, halvings - 1)
    return _halving(contact, friction, middle, loads, wear, halvings - 1)
