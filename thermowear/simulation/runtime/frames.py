"""Which states on the way are kept for an animation."""

from __future__ import annotations

from collections.abc import Callable

from ...case.tables.analyses import Fretting, Timed
from ...case.tables.schema import Case
from ...laws.motions import RigidMotion
from ..interface.body_state import BodyState, ContactState
from ..model.system import System
from ..results.fields import sample
from ..results.result import Frame, Interface, WornTrack
from .observer import Observer

Shown = tuple[ContactState, RigidMotion, BodyState, Interface]


class FrameRecorder:
    """Steps of an analysis, evenly by their number, at most so many.

    An error-controlled loop takes short steps where much happens: its steps are the clock that
    shows it. How many there will be is not known before, so all are kept until there are too many,
    then every second, then every fourth. What is computed does not depend on being watched.

    Parameters
    ----------
    case : Case
        Whose analysis says how many.
    observer : Observer
        Told of each of them.
    """

    def __init__(self, case: Case, observer: Observer):
        settings = case.analysis
        assert isinstance(settings, Timed | Fretting)
        self._most = settings.frames
        self._observer = observer

    def take(
        self,
        system: System,
        number: int,
        time: float,
        bodies: Callable[[], Shown],
        track: Callable[[], WornTrack] | None = None,
    ) -> None:
        """Keep a state if its turn has come. Every rank calls.

        Parameters
        ----------
        system : System
        number : int
            Of the step, from 0.
        time : float
            [s]
        bodies : callable
            Contact, motion of the holder, bodies and interface, which take time to compute.
        track : callable, optional
        """
        if not self._most:
            return
        every = spacing(number, self._most)
        if number % every:
            return
        with system.phases("frames"):
            _, motion, state, interface = bodies()
            fields = sample(system, state, motion)
            worn = None if track is None else track()
            self._observer.frame(Frame(number, every, time, interface, fields, worn))


def spacing(number: int, most: int) -> int:
    """The least power of two whose multiples from 0 to a number are at most so many."""
    every = 1
    while number // every >= most:
        every *= 2
    return every
