"""Values given at instants: straight lines between them, constant before and after, or repeated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TimeCourse:
    """Instants of a course, which may repeat itself.

    Attributes
    ----------
    time : tuple of float
        Increasing [s].
    repeat : bool
        From the last instant on the course goes on as from the first one.
    """

    time: tuple[float, ...]
    repeat: bool

    @property
    def period(self) -> float:
        """Time from the first instant to the last [s]."""
        return self.time[-1] - self.time[0]

    def instant(self, time: float) -> float:
        """The instant between the first and the last one that a time stands for [s]."""
        begin, end = self.time[0], self.time[-1]
        if self.repeat and time > end:
            return begin + (time - begin) % self.period
        return min(max(time, begin), end)

    def value(self, values: Sequence[float], time: float) -> float:
        """Interpolated value at a time, of values at the instants."""
        return float(np.interp(self.instant(time), self.time, values))

    def corners(self, end: float) -> tuple[float, ...]:
        """Ends of straight lines after 0 and up to a time, repetitions included [s]."""
        times = np.array(self.time)
        if self.repeat:
            again = np.arange(math.ceil(max(end - times[-1], 0.0) / self.period) + 1)
            cycles = times[1:] + self.period * again[:, None]
            times = np.concatenate([times[:1], cycles.ravel()])
        return tuple(float(time) for time in times if 0 < time <= end)
