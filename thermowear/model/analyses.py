"""Settings of the analyses of a model."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

_MINUTES = 120.0  # s; writing a state takes milliseconds
_SMALL = 0.01
"""Wear that is kept in the gap by default, relative to the dimensions of the bodies."""


@dataclass(frozen=True)
class StaticAnalysis:
    """Analysis without steps in time.

    Attributes
    ----------
    type : str
        ``"initial"``: contact of the unworn faces; ``"steady"``: steady state of wear;
        ``"stability"``: thermoelastic stability.
    """

    cyclic: ClassVar[bool] = False

    type: Literal["initial", "steady", "stability"]


@dataclass(frozen=True)
class StabilityAnalysis(StaticAnalysis):
    """Thermoelastic stability, along the sliding direction too if hot spots are asked for.

    Attributes
    ----------
    hot_spots : tuple of int
        Numbers of hot spots round the axis of an axisymmetric model.
    wave_lengths : tuple of float
        Wave lengths along the sliding, of a section that it is normal to [m].
    mirror : tuple of str
        Surfaces in the mirror plane of a half model: modes may be antisymmetric about it.
    """

    type: Literal["stability"] = "stability"
    hot_spots: tuple[int, ...] = ()
    wave_lengths: tuple[float, ...] = ()
    mirror: tuple[str, ...] = ()

    @property
    def waves(self) -> tuple[float, ...]:
        """Numbers round the axis, or wave numbers along the sliding [1/m]."""
        numbers = tuple(map(float, self.hot_spots))
        return numbers or tuple(2 * math.pi / length for length in self.wave_lengths)


@dataclass(frozen=True)
class SteppedAnalysis:
    """Base of analyses that follow the wear.

    Attributes
    ----------
    output_times : tuple of float
        Times at which a separate interface file is written [s].
    tolerance : float
        Allowed relative error of one step, or of one cycle jump.
    frames : int
        Largest number of intermediate states stored for an animation.
    checkpoint_every : float
        Computing time between checkpoints, besides those at output times [s].
    largest_kept : float
        Wear that may be kept in the gap, relative to the dimensions of the bodies.
    cyclic : bool
        True if the faces move back and forth.
    """

    cyclic: ClassVar[bool] = False

    output_times: tuple[float, ...] = ()
    tolerance: float = 1e-4
    frames: int = 0
    checkpoint_every: float = _MINUTES
    largest_kept: float = _SMALL


@dataclass(frozen=True)
class TimedAnalysis(SteppedAnalysis):
    """Base of analyses that integrate wear in time with adaptive steps.

    Attributes
    ----------
    end_time : float
        End of the computed time [s].
    until : str or None
        ``"steady"``: stop when the steady state is reached within `steady_tolerance`.
    steady_tolerance : float
        Largest distance from the steady state, relative to the largest steady pressure.
    max_steps : int
        Limit of the number of steps with error control.
    hits : tuple of float
        Times at which steps end, beside the output times [s].
    steps : tuple of float
        Ends of the time steps [s], such as those of an earlier run, which are taken without error
        control (internal numerical differentiation; Bock 1981): the results are then smooth
        functions of the parameters. They include the output times and the kinks of the histories,
        and their last ends the run. Empty: error control.
    """

    type: ClassVar[str]

    end_time: float = math.inf
    until: Literal["steady"] | None = None
    steady_tolerance: float = 1e-3
    max_steps: int = 10_000
    hits: tuple[float, ...] = ()
    steps: tuple[float, ...] = ()


@dataclass(frozen=True)
class TransientAnalysis(TimedAnalysis):
    """Running-in; steady within `steady_tolerance`, relative to the largest steady pressure.

    Attributes
    ----------
    adapts : bool
        True if the allowed wear in the gap follows the change by the last geometry update.
    compares : bool
        True if the states are compared with the steady one also where that does not end the run.
    """

    type: ClassVar[str] = "transient"

    adapts: bool = True
    compares: bool = True


@dataclass(frozen=True)
class ReciprocatingAnalysis(TimedAnalysis):
    """Reciprocating wear of body 1 and of the face that it slides on, averaged over cycles.

    The motion of body 1 is ``x = amplitude sin(2 π frequency t)``. Steady once the wear rates along
    each worn face, apart from its ends, deviate from their mean by less than `steady_tolerance`.

    Attributes
    ----------
    amplitude, frequency : float
        [m, Hz]
    positions : int
        Positions of body 1 at which contact is solved, between the ends of the stroke.
    max_jump : float
        Largest number of cycles in a step.
    """

    type: ClassVar[str] = "reciprocating"
    cyclic: ClassVar[bool] = True

    tolerance: float = 1e-3
    steady_tolerance: float = 0.05
    amplitude: float = 0.0
    frequency: float = 1.0
    positions: int = 12
    max_jump: float = math.inf


@dataclass(frozen=True)
class FrettingAnalysis(SteppedAnalysis):
    """Fretting: stick and slip under a load history.

    Attributes
    ----------
    increments : int
        Increments per load segment (from one corner of the history to the next).
    cycles : int
        Number of repetitions of the cycle of the history.
    jump : int or str
        Number of cycles that each computed cycle stands for; ``"auto"``: as many as the tolerance
        allows.
    max_jump : float
        Largest number of cycles that a computed one may stand for.
    """

    type: ClassVar[str] = "fretting"
    cyclic: ClassVar[bool] = True

    tolerance: float = 1e-2
    increments: int = 20
    cycles: int = 1
    jump: int | Literal["auto"] = "auto"
    max_jump: float = math.inf


Analysis = StaticAnalysis | TransientAnalysis | ReciprocatingAnalysis | FrettingAnalysis
