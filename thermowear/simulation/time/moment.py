"""Accepted state of a running-in."""

from __future__ import annotations

from dataclasses import dataclass

from ...serialise import serialisable
from ..interface.sdirk import InterfaceState


@serialisable
@dataclass(frozen=True)
class Moment:
    """Accepted state of the running-in with the data to continue the time loop from it.

    Attributes
    ----------
    time, step : float
        End and size of the last step [s].
    state : InterfaceState
    error : float
        Error estimate of the step; NaN for a given step.
    is_output : bool
        True at an output time.
    distance : float
        Distance from the steady state, see `WearProblem`; NaN without one.
    number : int
        Number of the step.
    begin : float
        Last time that was hit exactly [s].
    wanted : float
        Size of the next step proposed by error control [s].
    """

    time: float
    step: float
    state: InterfaceState
    error: float
    is_output: bool
    distance: float
    number: int
    begin: float
    wanted: float
