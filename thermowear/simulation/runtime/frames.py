"""Selection of the states that are kept as animation frames."""

from __future__ import annotations

from collections.abc import Callable

from ...case.tables.analyses import Fretting, Timed
from ...case.tables.schema import Case
from ...laws.motions import RigidMotion
from ...results import Frame, InterfaceFields, WornTrack
from ..interface.body_state import BodyState, ContactState
from ..model.system import System
from ..results.fields import sample
from .observer import Observer

Shown = tuple[ContactState, RigidMotion, BodyState, InterfaceFields]


class FrameRecorder:
    """Recorder of a limited number of frames, evenly spaced by step number.

    An error-controlled loop takes short steps where the state changes fast, so step numbers are a
    better clock than time. Their total is not known in advance: all steps are kept until there are
    too many, then every second, then every fourth. The computation does not depend on frames.

    Parameters
    ----------
    case : Case
        Case whose analysis limits the number of frames.
    observer : Observer
        Observer that receives the frames.
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
        """Record a state if its step number is selected. Every rank calls.

        Parameters
        ----------
        system : System
        number : int
            Step number, from 0.
        time : float
            [s]
        bodies : callable
            Contact, motion of the holder, bodies and interface, evaluated only if needed.
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
    """Smallest power of two with at most `most` multiples from 0 to a number."""
    every = 1
    while number // every >= most:
        every *= 2
    return every
