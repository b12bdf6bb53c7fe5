"""Piecewise linear functions of time, constant beyond their ends or periodic; load histories."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

_CLOSED = 1e-9  # of the largest value: a cycle that ends so near to its begin is closed
TANGENTIAL = (
    ("tangential_force", "tangential_displacement"),
    ("tangential_force_y", "tangential_displacement_y"),
    ("torque", "twist"),
)
"""Tangential loads: force and displacement along the first direction, in space along the second
one, and about the axis of the load."""
KEYS = ("force", "approach", "moment", *(key for pair in TANGENTIAL for key in pair))


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

    def interpolate(self, values: Sequence[float], time: float) -> float:
        """Interpolate values given at the instants at a time."""
        if self.repeat and time > self.time[-1]:
            time = self.time[0] + (time - self.time[0]) % self.period
        return float(np.interp(time, self.time, values))

    def corners(self, end: float) -> tuple[float, ...]:
        """Corner times after 0 and up to a time, repetitions included [s]."""
        times = np.array(self.time)
        if self.repeat:
            again = np.arange(math.ceil(max(end - times[-1], 0.0) / self.period) + 1)
            cycles = times[1:] + self.period * again[:, None]
            times = np.concatenate([times[:1], cycles.ravel()])
        return tuple(float(time) for time in times if 0 < time <= end)


@dataclass(frozen=True)
class TimeFunction(TimeCourse):
    """Piecewise linear function of time.

    Attributes
    ----------
    values : tuple of float
        Values at the instants, in SI.
    """

    values: tuple[float, ...]

    def at(self, time: float) -> float:
        """Value at a time [s]."""
        return self.interpolate(self.values, time)


@dataclass(frozen=True)
class LoadHistory(TimeCourse):
    """Loads at instants, with straight lines between them.

    Attributes
    ----------
    force : tuple of float or None
        Forces along the load direction, in place of an approach; without both, the constant load
        [N].
    approach : tuple of float or None
        Displacements along the load direction, in place of forces [m].
    tangential_force : tuple of float or None
        Forces along x [N].
    tangential_displacement : tuple of float or None
        Displacements along x, in place of forces [m].
    cycle_start : float or None
        Start of the cycle that may be repeated up to the end; by default the first of the instants
        with the loads of the last one [s].
    moment : tuple of float or None
        Moments about the pivot in a section, anticlockwise [N m].
    tangential_force_y : tuple of float or None
        Forces along y, in space [N].
    tangential_displacement_y : tuple of float or None
        Displacements along y, in place of forces [m].
    torque : tuple of float or None
        Torques about the axis through the pivot against the load direction, by the right-hand rule,
        in space [N m].
    twist : tuple of float or None
        Rotations about this axis, in place of torques [rad].
    """

    force: tuple[float, ...] | None = None
    approach: tuple[float, ...] | None = None
    tangential_force: tuple[float, ...] | None = None
    tangential_displacement: tuple[float, ...] | None = None
    cycle_start: float | None = None
    moment: tuple[float, ...] | None = None
    tangential_force_y: tuple[float, ...] | None = None
    tangential_displacement_y: tuple[float, ...] | None = None
    torque: tuple[float, ...] | None = None
    twist: tuple[float, ...] | None = None

    @property
    def tangential(self) -> bool:
        """True if the holder has a tangential displacement or force, or a twist."""
        return any(self.drives(number) for number in range(len(TANGENTIAL)))

    def drives(self, number: int) -> bool:
        """True if it has a load of those in `TANGENTIAL` of a number."""
        return any(getattr(self, key) is not None for key in TANGENTIAL[number])

    @property
    def in_space(self) -> tuple[str, ...]:
        """Keys of the loads that only bodies in space can have."""
        keys = (key for pair in TANGENTIAL[1:] for key in pair)
        return tuple(key for key in keys if getattr(self, key) is not None)

    @property
    def only_tangential(self) -> bool:
        """True for loads across the load direction alone."""
        others = self.force, self.approach, self.moment
        return self.tangential and all(load is None for load in others)

    def ends_as(self, time: float) -> bool:
        """True if the loads at an instant equal those of the last one."""
        now, last = self.at(time), self.at(self.time[-1])
        sizes = {key: max(map(abs, getattr(self, key))) for key in now}
        return all(abs(now[key] - last[key]) <= _CLOSED * sizes[key] for key in now)

    def at(self, time: float) -> dict[str, float]:
        """Values of the given loads, by key, at a time [s]."""
        given = {key: getattr(self, key) for key in KEYS}
        return {k: self.interpolate(v, time) for k, v in given.items() if v is not None}

    def factor_at(self, time: float) -> float:
        """Force at a time [s] relative to the largest one; 1 where the force is constant."""
        return 1.0 if self.force is None else self.at(time)["force"] / max(self.force)


@dataclass(frozen=True)
class LoadHistories:
    """Load histories of several holders, with a cycle common to all.

    Loads are constant after the last instant of their own history.

    Attributes
    ----------
    each : tuple of LoadHistory
    """

    each: tuple[LoadHistory, ...]

    @property
    def time(self) -> tuple[float, ...]:
        """Instants of all histories, in order [s]."""
        return tuple(sorted({time for history in self.each for time in history.time}))

    @property
    def cycle(self) -> tuple[float, float] | None:
        """Begin and end of the cycle that may be repeated [s]; None if there is none.

        It begins at the latest given start, else at the first instant at which all loads are those
        of the end.
        """
        times, starts = self.time, [history.cycle_start for history in self.each]
        given = [start for start in starts if start is not None]
        candidates = (max(given),) if given else times[:-1]
        closed = [start for start in candidates if all(one.ends_as(start) for one in self.each)]
        return (closed[0], times[-1]) if closed else None

    def end(self, cycles: int) -> float:
        """Time at the end of a number of cycles [s]."""
        cycle, last = self.cycle, self.time[-1]
        return last if cycle is None else last + (cycles - 1) * (last - cycle[0])
