"""Fretting path: stick, slip and wear along a load history and through its cycles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...contact.friction.slip_wear import SlipWear, profile
from ...contact.friction.stick_slip import advance, follow
from ...contact.friction.stick_slip_state import Loads, StickSlipState, unloaded
from ...contact.operators.tangential import condense_tangential
from ...errors import CaseError
from ...model.analyses import FrettingAnalysis
from ..system.system import System
from .cycle_jump import adaptive_jumps, fixed_jumps
from .load_path import Increment, LoadPath, LoadSegment, RestartPoint

_ACROSS = (1.0, 0.0)


class FrettingPath:
    """Increments of a contact along its load history and through the cycles.

    Parameters
    ----------
    system : System
    settings : FrettingAnalysis

    Attributes
    ----------
    cycle_of_history : tuple of float or None
        Start and end of the repeated part of the load history [s].
    translations : ndarray, shape (k, 2)
        Unit translations of the holder: along the load, and tangential if so given.
    profiles : tuple of WornProfile
        Worn profiles of the wearing bodies.
    areas : ndarray, shape (m,)
        Areas of the basis functions of the depths [m²].

    Raises
    ------
    CaseError
        If the holder has no load history.
    """

    def __init__(self, system: System, settings: FrettingAnalysis):
        history = system.model.holder.history
        if history is None:
            raise CaseError("load.history: missing; required in a fretting analysis")
        self._holder, self._settings = system.model.holder, settings
        self._path = LoadPath(history, settings.output_times)
        self._friction, self._laws = system.friction, tuple(system.laws.values())
        self.cycle_of_history = history.cycle
        across = [_ACROSS] if history.tangential else []
        self.translations = np.array([system.model.holder.load_direction, *across])
        bodies = system.elastic, system.pairing, system.basis
        with system.phases("condense elasticity"):
            self._contact = condense_tangential(*bodies, self.translations)
        weighted = self._contact.weighted
        self.areas = weighted.sum(axis=0)
        self.profiles = tuple(profile(system.pairing, weighted, body) for body in system.laws)

    def increments(self, last: Increment | None = None) -> Iterator[Increment]:
        """Increments up to the start of the cycles, then through them.

        Either all increments, or the ones after an increment with a restart point.
        """
        restart, passed = RestartPoint(0, unloaded(self._contact, len(self._laws))), -math.inf
        if last is not None:
            assert last.restart is not None
            restart, passed = last.restart, last.segment.end
        if restart.cycle == 0:
            left = (segment for segment in self._path.first_pass() if segment.end > passed)
            for increment in self._along(left, restart.state):
                restart = RestartPoint(0, increment.state)
                yield increment
        if self.cycle_of_history is not None:
            yield from self._cycles_after(restart)

    def _cycles_after(self, restart: RestartPoint) -> Iterator[Increment]:
        """Increments of the cycles after a restart point."""
        settings, count = self._settings, self._settings.cycles
        if settings.jump == "auto":
            stops = self._path.cycles_to_stop_at(count)
            return adaptive_jumps(self, stops, restart, settings.tolerance, settings.max_jump)
        return fixed_jumps(self, self._path.jumped_cycles(count, settings.jump), restart)

    def cycle(self, state: StickSlipState, number: int, repeats: int) -> Iterator[Increment]:
        """See `cycle_jump.Cycles`."""
        return self._along(self._path.cycle(number, repeats), state)

    def equilibrium(self, end: Increment, worn: np.ndarray) -> StickSlipState:
        """See `cycle_jump.Cycles`."""
        state, loads = replace(end.state, worn=worn), self._loads(end.segment.instant)
        found = advance(self._contact, self._friction, state, loads, self._wear(0.0))
        return replace(found, dissipated=state.dissipated)

    def _along(self, segments: Iterator[LoadSegment], state: StickSlipState) -> Iterator[Increment]:
        count = self._settings.increments
        for segment in segments:
            loads, step = self._loads(segment.instant), (segment.end - segment.start) / count
            wear = self._wear(step, segment.repeats)
            states = follow(self._contact, self._friction, [loads], count, state, wear)
            for number, state in enumerate(states, start=1):
                time = segment.end if number == count else segment.start + number * step
                yield Increment(time, segment, number == count, state)

    def _wear(self, duration: float, repeats: int = 1) -> SlipWear:
        return SlipWear(self._laws, self.profiles, self._friction, duration, repeats)

    def _loads(self, instant: float) -> Loads:
        """Loads at a time of the history [s]."""
        given, holder = self._path.history.at(instant), self._holder
        if "force" not in given and "approach" not in given:
            return Loads(normal_force=holder.force, approach=holder.approach, **given)
        return Loads(normal_force=given.pop("force", None), **given)
