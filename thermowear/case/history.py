"""Loads that change: straight lines in time between given corners."""

from __future__ import annotations

import numpy as np
from pydantic import model_validator

from . import units
from .section import KeyFault, Section


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
    """

    time: tuple[units.Instant, ...]
    force: tuple[units.Force, ...] | None = None
    approach: tuple[units.Length, ...] | None = None
    tangential_force: tuple[units.SignedForce, ...] | None = None
    tangential_displacement: tuple[units.Displacement, ...] | None = None

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
        return self

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
