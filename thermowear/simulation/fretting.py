"""Fretting: sticking, slipping and wear under a history of loads."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..case.analyses import Fretting
from ..case.schema import Case
from ..contact.loads import Loads
from ..contact.slip_wear import Profile, SlipWear, profile
from ..contact.stick_slip import follow, unloaded
from ..contact.tangential import FrictionalContact, condense_tangential
from ..laws.motions import translation
from .fretting_record import FrettingRecord, Instant
from .guarded import go_through
from .load_path import legs
from .observer import Observer
from .outcome import Outcome
from .system import System

_ACROSS = (1.0, 0.0)


def fretting(system: System, observer: Observer) -> Outcome:
    """Follow the history of loads and its cycles.

    What was computed before an error or Ctrl-C is kept.
    """
    translations = _translations(system.case)
    with system.phases("condense elasticity"):
        condensed = condense_tangential(system.elastic, system.pairing, system.basis, translations)
    profiles = tuple(profile(system.pairing, condensed.weighted, body) for body in system.laws)
    record = FrettingRecord(system, translations, profiles, observer)
    instants = _instants(system, condensed, profiles)
    _, stopped = go_through(system, "load steps", instants, record.keep)
    with system.phases("bodies"):
        contact, bodies, interface = record.interface()
    return Outcome(
        contact=contact,
        motion=translation(record.last.motion @ translations),
        state=bodies,
        interface=interface,
        extra=record.extra(),
        history=[],
        outputs=record.outputs,
        friction=record.history(),
        stopped=stopped,
    )


def _translations(case: Case) -> np.ndarray:
    """Unit motions of the holder: along the press, and across it where the history says so."""
    directions = [case.geometry.press_direction]
    if case.load.history is not None and case.load.history.tangential:
        directions.append(_ACROSS)
    return np.array(directions)


def _instants(
    system: System, contact: FrictionalContact, profiles: tuple[Profile, ...]
) -> Iterator[Instant]:
    """Each increment's end, leg by leg."""
    settings, history = system.case.analysis, system.case.load.history
    assert isinstance(settings, Fretting)
    assert history is not None  # the case has been checked
    count, laws = settings.increments, tuple(system.laws.values())
    state = unloaded(contact, len(laws))
    for leg in legs(history, settings):
        loads, step = _loads(system.case, leg.instant), (leg.end - leg.start) / count
        wear = SlipWear(laws, profiles, step, leg.repeats)
        states = follow(contact, system.friction, [loads], count, state, wear)
        for number, state in enumerate(states, start=1):
            time = leg.end if number == count else leg.start + number * step
            yield Instant(time, leg, number == count, state)


def _loads(case: Case, instant: float) -> Loads:
    """Loads at an instant of the history [s]."""
    history = case.load.history
    assert history is not None
    given = history.at(instant)
    if "force" not in given and "approach" not in given:
        return Loads(normal_force=case.force(), approach=case.approach(), **given)
    return Loads(normal_force=given.pop("force", None), **given)
