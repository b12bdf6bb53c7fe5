"""Fretting analysis: stick, slip and wear under a load history."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...case.tables.analyses import Fretting
from ...case.tables.schema import Case
from ...contact.friction.loads import Loads
from ...contact.friction.slip_wear import SlipWear, WornProfile, profile
from ...contact.friction.stick_slip import advance, follow
from ...contact.friction.stick_slip_state import StickSlipState, unloaded
from ...contact.operators.tangential import FrictionalContact, condense_tangential
from ...laws.motions import translation
from ...results import Result
from ..model.system import System
from ..results.recording import FinalState
from ..results.summary import conclude
from ..runtime.guarded_loop import go_through
from ..runtime.observer import Observer
from .cycle_jump import adaptive_jumps, fixed_jumps
from .fretting_record import Fretted, FrettingRecord
from .increments import Increment, RestartPoint
from .load_path import LoadSegment, by_fixed_jumps, cycle_legs, first_pass, to_stop_at

_ACROSS = (1.0, 0.0)


def fretting(
    system: System, observer: Observer, before: Fretted | None = None
) -> tuple[FinalState, Result]:
    """Follow the load history and its cycles, from the start or from a checkpoint.

    Results computed before an error or Ctrl-C are kept.
    """
    translations = _translations(system.case)
    with system.phases("condense elasticity"):
        condensed = condense_tangential(system.elastic, system.pairing, system.basis, translations)
    profiles = tuple(profile(system.pairing, condensed.weighted, body) for body in system.laws)
    record = FrettingRecord(system, translations, profiles, observer)
    last = None if before is None else record.go_on(before)
    instants = _Path(system, condensed, profiles).instants(last)
    _, stopped = go_through(system, "load steps", instants, record, observer, last)
    with system.phases("bodies"):
        contact, bodies, interface = record.interface()
    motion = translation(record.last.motion @ translations)
    return conclude(
        FinalState(system, contact, motion, bodies),
        interface,
        record.extra(),
        outputs=record.outputs,
        friction=record.history(),
        stopped=stopped,
    )


def _translations(case: Case) -> np.ndarray:
    """Unit holder translations: along the load, and tangential if the history prescribes it."""
    directions = [case.geometry.press_direction]
    if case.load.history is not None and case.load.history.tangential:
        directions.append(_ACROSS)
    return np.array(directions)


class _Path:
    """Increments of a contact along the load history of its case and through its cycles."""

    def __init__(
        self, system: System, contact: FrictionalContact, profiles: tuple[WornProfile, ...]
    ):
        settings, history = system.case.analysis, system.case.load.history
        assert isinstance(settings, Fretting)
        assert history is not None  # the case has been checked
        self.areas = contact.weighted.sum(axis=0)
        self._case, self._settings, self._history = system.case, settings, history
        self._contact, self._friction = contact, system.friction
        self._laws, self._profiles = tuple(system.laws.values()), profiles

    def instants(self, last: Increment | None = None) -> Iterator[Increment]:
        """Increments up to the start of the cycles, then through them.

        Either all increments, or the ones after an increment with a restart point.
        """
        history, settings = self._history, self._settings
        behind, passed = RestartPoint(0, unloaded(self._contact, len(self._laws))), -math.inf
        if last is not None:
            assert last.behind is not None
            behind, passed = last.behind, last.leg.end
        if behind.cycle == 0:
            legs = (leg for leg in first_pass(history, settings.output_times) if leg.end > passed)
            for instant in self._along(legs, behind.state):
                behind = RestartPoint(0, instant.state)
                yield instant
        if history.cycle is not None:
            yield from self.going_on(behind)

    def going_on(self, behind: RestartPoint) -> Iterator[Increment]:
        """Increments of the cycles after a restart point."""
        count = int(self._case.cycles or 1)
        history, settings = self._history, self._settings
        if settings.jump == "auto":
            stops = to_stop_at(history, settings, count)
            longest = self._case.wear.max_jump or math.inf
            return adaptive_jumps(self, stops, behind, settings.tolerance, longest)
        assert isinstance(settings.jump, int)
        numbers = by_fixed_jumps(history, settings, count, settings.jump)
        return fixed_jumps(self, numbers, behind)

    def cycle(self, state: StickSlipState, number: int, repeats: int) -> Iterator[Increment]:
        """See `cycle_jump.Cycles`."""
        times = self._settings.output_times
        return self._along(cycle_legs(self._history, times, number, repeats), state)

    def settled(self, end: Increment, worn: np.ndarray) -> StickSlipState:
        """See `cycle_jump.Cycles`."""
        state, loads = replace(end.state, worn=worn), _loads(self._case, end.leg.instant)
        settled = advance(self._contact, self._friction, state, loads, self._wear(0.0))
        return replace(settled, dissipated=state.dissipated)

    def _along(self, legs: Iterator[LoadSegment], state: StickSlipState) -> Iterator[Increment]:
        count = self._settings.increments
        for leg in legs:
            loads, step = _loads(self._case, leg.instant), (leg.end - leg.start) / count
            wear = self._wear(step, leg.repeats)
            states = follow(self._contact, self._friction, [loads], count, state, wear)
            for number, state in enumerate(states, start=1):
                time = leg.end if number == count else leg.start + number * step
                yield Increment(time, leg, number == count, state)

    def _wear(self, duration: float, repeats: int = 1) -> SlipWear:
        return SlipWear(self._laws, self._profiles, self._friction, duration, repeats)


def _loads(case: Case, instant: float) -> Loads:
    """Loads at a time of the history [s]."""
    history = case.load.history
    assert history is not None
    given = history.at(instant)
    if "force" not in given and "approach" not in given:
        return Loads(normal_force=case.force(), approach=case.approach(), **given)
    return Loads(normal_force=given.pop("force", None), **given)
