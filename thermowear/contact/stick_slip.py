"""Stick and slip under loads that change: Coulomb friction by increments.

Friction remembers where the faces stuck, so that a state follows from the state before it. Nothing
depends on the rate: a load history is a polygon, given by its corners. Signs: see `tangential`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from ..errors import ComputationError
from .complementarity import solve_contact
from .coulomb import CoulombProblem, CoulombSolution
from .coulomb_solver import solve_directly, solve_patiently
from .loads import Loads
from .tangential import FrictionalContact

_HALVINGS = 6


class FullSliding(ComputationError):
    """The given tangential force is more than friction carries."""


class Status(IntEnum):
    """Of a coefficient."""

    OPEN = 0
    STICK = 1
    SLIP = 2


@dataclass(frozen=True)
class StickSlipState:
    """The interface under load, and what it remembers.

    Attributes
    ----------
    pressure : ndarray, shape (m,)
        Coefficients λ [Pa].
    shear : ndarray, shape (m, t)
        Coefficients τ of the traction on body 1 [Pa].
    slip : ndarray, shape (m, t)
        Of body 1 over body 2 since the unloaded state, in the mean, open or not [m³].
    motion, force : ndarray, shape (k,)
        Translations of the holder and its forces on body 1 [m, N].
    status : ndarray of int, shape (m,)
        `Status` of each coefficient in the last increment.
    point_slip : ndarray, shape (n, t)
        Slip at the points [m].
    dissipated : ndarray, shape (n,)
        Energy ``-∫ t ds`` lost at the points so far [J/m²]. Its integral is exactly that of the
        conditions in the mean, where each coefficient's share is never negative; values at single
        points of sticking zones scatter about zero as the slip there does.
    iterations : int
        Of Newton's method in the last increment.
    """

    pressure: np.ndarray
    shear: np.ndarray
    slip: np.ndarray
    motion: np.ndarray
    force: np.ndarray
    status: np.ndarray
    point_slip: np.ndarray
    dissipated: np.ndarray
    iterations: int = 0


def unloaded(contact: FrictionalContact) -> StickSlipState:
    """The state before any load."""
    (n, m), k = contact.basis.shape, contact.modes.shape[1]
    t = len(contact.response) - 1
    still, free = np.zeros(k), np.full(m, Status.OPEN)
    coefficients, points = np.zeros((m, t)), np.zeros((n, t))
    return StickSlipState(
        np.zeros(m), coefficients, coefficients, still, still, free, points, np.zeros(n)
    )


def stored_energy(contact: FrictionalContact, state: StickSlipState) -> float:
    """Elastic energy ``xᵀ A x / 2`` of both bodies [J]."""
    x = contact.stack(state.pressure, state.shear)
    return float(x @ contact.compliance @ x) / 2


def advance(
    contact: FrictionalContact,
    friction: float | np.ndarray,
    state: StickSlipState,
    loads: Loads,
    gap: np.ndarray | None = None,
) -> StickSlipState:
    """The state after one increment, at the end of which the conditions hold.

    Parameters
    ----------
    contact : FrictionalContact
    friction : float or ndarray, shape (m,)
        Coulomb's coefficient, one or by coefficient.
    state : StickSlipState
        Before.
    loads : Loads
        At the end.
    gap : ndarray, shape (n,), optional
        Of the unloaded bodies at the end, with wear; by default unworn [m].

    Raises
    ------
    FullSliding
        If the tangential force is more than friction carries.
    ComputationError
        If no solution is found.
    """
    given = loads.motions
    if len(given) != len(state.motion):
        raise ValueError(f"loads: the holder has {len(state.motion)} motions, not {len(given)}")
    free = np.isnan(given)
    fixed = np.where(free, 0.0, given)
    unworn = contact.gap if gap is None else gap
    start = contact.stack(contact.weighted.T @ unworn, -state.slip) - contact.modes @ fixed
    problem = CoulombProblem(
        contact.compliance,
        start,
        contact.modes[:, free],
        loads.forces[free],
        np.broadcast_to(np.asarray(friction, dtype=float), len(state.pressure)),
    )
    closed = _expected(problem, state, bool(free[0]))
    solution = solve_directly(problem, closed)
    if solution is None:
        if len(free) > 1 and free[1]:
            _refuse_sliding(problem, bool(free[0]))
        solution = solve_patiently(problem, closed)
    return _after(contact, state, solution, free, fixed)


def _after(contact, state, solution: CoulombSolution, free, fixed) -> StickSlipState:
    """The state that a solution leads to."""
    x = contact.stack(solution.pressure, solution.shear)
    motion = fixed.copy()
    motion[free] = solution.motion
    slip = contact.split(contact.compliance @ x - contact.modes @ motion)[1]
    point_slip = contact.point_slip(x, motion)
    traction = contact.basis @ solution.shear
    lost = -(traction * (point_slip - state.point_slip)).sum(axis=1)
    closed = np.where(solution.sticking, Status.STICK, Status.SLIP)
    return StickSlipState(
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


def _expected(problem: CoulombProblem, state: StickSlipState, pressed: bool) -> np.ndarray:
    """Coefficients that will probably press: those that do, at first those without friction."""
    if np.any(state.pressure > 0):
        return state.pressure > 0
    m, k = len(state.pressure), int(pressed)
    modes, force = problem.modes[:m, :k], problem.force[:k]
    return solve_contact(problem.compliance[:m, :m], problem.offset[:m], modes, force).active


def _refuse_sliding(problem: CoulombProblem, pressed: bool) -> None:
    """Raise where all of the contact sliding carries less than the tangential force.

    Sliding makes the shear a multiple of the pressure, which then solves a problem of contact.
    """
    m, k = len(problem.friction), int(pressed)
    asked = problem.force[k]
    across = problem.modes[m : 2 * m, k] * np.sign(asked)
    drag = problem.friction * np.sign(across)  # τ = drag λ holds back
    compliance = problem.compliance[:m, :m] + problem.compliance[:m, m : 2 * m] * drag
    modes = problem.modes[:m, :k]
    carrying = modes + drag[:, None] * problem.modes[m : 2 * m, :k]
    sliding = solve_contact(
        compliance, problem.offset[:m], modes, problem.force[:k], force_modes=carrying
    )
    λ = sliding.coefficients
    if not np.any(λ > 0):
        raise ComputationError(
            "contact: the bodies do not touch, so that nothing balances a tangential force; give a "
            "tangential displacement, or press"
        )
    most = problem.modes[:m, k] @ λ + problem.modes[m : 2 * m, k] @ (drag * λ)
    if abs(asked) >= (1 - 1e-9) * abs(most):
        raise FullSliding(
            f"contact: body 1 slides; friction carries {abs(most):.6g} N, and the tangential force "
            f"is {abs(asked):.6g} N. Give a smaller force, or a tangential displacement"
        )


def follow(
    contact: FrictionalContact,
    friction: float | np.ndarray,
    corners: Iterable[Loads],
    increments: int,
    state: StickSlipState | None = None,
) -> Iterator[StickSlipState]:
    """Follow a polygon of loads from a state, by default the unloaded one.

    Parameters
    ----------
    contact : FrictionalContact
    friction : float or ndarray, shape (m,)
        See `advance`.
    corners : iterable of Loads
        Reached one after the other, each on a straight line from what is the case before; along a
        motion, force may give way to translation and back.
    increments : int
        Between two corners; halved where no solution is found.

    Yields
    ------
    StickSlipState
        After each increment.

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
            state = _halving(contact, friction, state, loads, _HALVINGS)
            yield state


def _halving(contact, friction, state, loads: Loads, halvings: int) -> StickSlipState:
    """Advance in one step, or in two halves where that fails."""
    try:
        return advance(contact, friction, state, loads)
    except FullSliding:
        raise
    except ComputationError:
        if halvings == 0:
            raise
    half = loads.after(state.force, state.motion, 0.5)
    middle = _halving(contact, friction, state, half, halvings - 1)
    return _halving(contact, friction, middle, loads, halvings - 1)
