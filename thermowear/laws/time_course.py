"""Piecewise linear course of values in time, constant beyond its ends or periodic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TimeCourse:
    """Instants of a course in time, possibly periodic.

    Attributes
    ----------
    time : tuple of float
        Increasing instants [s].
    repeat : bool
        True if the course is periodic from the last instant on.
    """

    time: tuple[float, ...]
    repeat: bool

    @property
    def period(self) -> float:
        """Time from the first instant to the last [s]."""
        return self.time[-1] - self.time[0]

    def instant(self, time: float) -> float:
        """Time mapped to the range between the first and the last instant [s]."""
        begin, end = self.time[0], self.time[-1]
        if self.repeat and time > end:
            return begin + (time - begin) % self.period
        return min(max(time, begin), end)

    def value(self, values: Sequence[float], time: float) -> float:
        """Interpolate values given at the instants at a time."""
        return float(np.interp(self.instant(time), self.time, values))

    def corners(self, end: float) -> tuple[float, ...]:
        """Corner times after 0 and up to a time, repetitions included [s]."""
        times = np.array(self.time)
        if self.repeat:
            again = np.arange(math.ceil(max(end - times[-1], 0.0) / self.period) + 1)
            cycles = times[1:] + self.period * again[:, None]
            times = np.concatenate([times[:1], cycles.ravel()])
        return tuple(float(time) for time in times if 0 < time <= end)


@dataclass(frozen=True)
class TimeFunction:
    """Piecewise linear function of time.

    Attributes
    ----------
    course : TimeCourse
    values : tuple of float
        Values at its instants, in SI.
    """

    course: TimeCourse
    values: tuple[float, ...]

    def at(self, time: float) -> float:
        """Value at a time [s]."""
        return self.course.value(self.values, time)

    def corners(self, end: float) -> tuple[float, ...]:
        """Corner times after 0 and up to a time, repetitions included [s]."""
        return self.course.corners(end)
