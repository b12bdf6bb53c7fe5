"""Incremental solution of stick and slip under a load history (Coulomb friction).

Coulomb friction is history dependent: each state follows from the previous one. It is rate
independent: a load history is a polygon, given by its corners. Wear: see `slip_wear`; signs: see
`contact.operators.rigid_motion`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ...errors import ComputationError
from ..wear.implicit_step import newton_with_wear
from .frictional_contact import FrictionalContact, unloaded
from .gross_slip import FullSliding
from .slip_wear import IncrementWear, SlipWear, WearSlope
from .stick_slip_state import Loads, StickSlipState

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
    # motions given at the end, or the current ones if free
    travel = contact.travel @ np.where(np.isnan(given), state.motion, given)
    worn = np.zeros(len(friction))
    if len(state.worn):
        own = state.worn if wear is None else wear.depths_at_contact(state.worn, travel)
        worn = own.sum(axis=0)

    def solve(lost: np.ndarray, slope: WearSlope, guess: StickSlipState) -> StickSlipState:
        """Solve contact with the depths ``lost + slope λ`` worn by the increment."""
        return contact.increment(friction, state, guess, loads, worn, lost, slope)

    after = contact.increment(friction, state, state, loads, worn)
    if wear is None:
        return after
    by_slip = IncrementWear(wear, state, contact.areas, travel, contact.travel @ state.motion)
    if by_slip.value(after.pressure, after).any():
        rounding = by_slip.rounding(after.pressure)
        after = newton_with_wear(solve, by_slip, after, _WEAR_TOLERANCE, _NOT_CONVERGED, rounding)
    depths = by_slip.depths(after.pressure, after)
    if state.crossed.any():
        slipped = after.slip - state.slip, after.point_slip - state.point_slip
        others = contact.lost(after.shear * ~state.crossed[:, None], *slipped)
        across = contact.basis @ by_slip.dissipated(after)
        after = replace(after, dissipated=state.dissipated + others + across)
    if state.part.any():
        outside = state.part < 1.0
        excess = state.excess + np.where(outside, depths.sum(axis=0), 0.0)
        unrelieved = state.unrelieved + np.where(outside, by_slip.unrelieved(after), 0.0)
        spared = state.spared + contact.spared(state, after) @ by_slip.at_contact(depths)
        after = replace(after, excess=excess, unrelieved=unrelieved, spared=spared)
    worn = state.worn + by_slip.profiles(depths)
    lost = wear.repeats * (after.dissipated - state.dissipated)
    return replace(after, worn=worn, dissipated=state.dissipated + lost)


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
