"""Loads that change: straight lines in time between given corners."""

from __future__ import annotations

import numpy as np
from pydantic import model_validator

from . import units
from .section import KeyFault, Section

_CLOSED = 1e-9  # of the largest load: a cycle that ends so near to its begin is closed


class History(Section):
    """Loads of the holder of body 1 at instants; straight lines between them.

    Attributes
    ----------
    time : tuple of float
        Increasing [s].
    force, approach : tuple of float or None
        Along the press [N, m]; at most one of them. Neither: the constant load of the case.
    tangential_force, tangential_displacement : tuple of float or None
        Along x [N, m]; at most one of them. Neither: the holder only moves along the press.
    cycle_start : float or None
        From there to the end the loads may be repeated, cycle by cycle; by default the first of
        the instants with the loads of the last one [s].
    """

    time: tuple[units.Instant, ...]
    force: tuple[units.Force, ...] | None = None
    approach: tuple[units.Length, ...] | None = None
    tangential_force: tuple[units.SignedForce, ...] | None = None
    tangential_displacement: tuple[units.Displacement, ...] | None = None
    cycle_start: units.Instant | None = None

    @model_validator(mode="after")
    def _fits(self):
        if not self.time:
            raise KeyFault("time", "is empty; needs at least one instant")
        if any(b <= a for a, b in zip(self.time, self.time[1:], strict=False)):
            raise KeyFault("time", "must increase")
        pairs = ("force", "approach"), ("tangential_force", "tangential_displacement")
        for first, second in pairs:
            if getattr(self, first) is not None and getattr(self, second) is not None:
                raise KeyFault(second, f"only one of {first} and {second} can be given")
        for key in (key for pair in pairs for key in pair):
            values = getattr(self, key)
            if values is not None and len(values) != len(self.time):
                raise KeyFault(key, f"has {len(values)} values for {len(self.time)} times")
        start = self.cycle_start
        if start is not None:
            if not self.time[0] <= start < self.time[-1]:
                raise KeyFault("cycle_start", "must lie in time, before its end")
            if not self._as_at_the_end(start):
                raise KeyFault("cycle_start", "a cycle must end with the loads that it begins with")
        return self

    @property
    def cycle(self) -> tuple[float, float] | None:
        """Begin and end of what may be repeated [s]; None where nothing can be."""
        starts = self.time[:-1] if self.cycle_start is None else (self.cycle_start,)
        closed = [start for start in starts if self._as_at_the_end(start)]
        return (closed[0], self.time[-1]) if closed else None

    def _as_at_the_end(self, time: float) -> bool:
        """Whether the loads at an instant are those of the last one."""
        now, last = self.at(time), self.at(self.time[-1])
        sizes = {key: max(map(abs, getattr(self, key))) for key in now}
        return all(abs(now[key] - last[key]) <= _CLOSED * sizes[key] for key in now)

    @property
    def tangential(self) -> bool:
        """Whether the holder moves, or is pushed, across the press."""
        return self.tangential_force is not None or self.tangential_displacement is not None

    def at(self, time: float) -> dict[str, float]:
        """Values of the keys that are given, at an instant [s]."""
        keys = ("force", "approach", "tangential_force", "tangential_displacement")
        given = {key: getattr(self, key) for key in keys}
        return {
            key: float(np.interp(time, self.time, values))
            for key, values in given.items()
            if values is not None
        }
