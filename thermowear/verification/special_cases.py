"""The nine special cases of Páczelt and Mróz: closed forms, and running-in by finite elements."""

from __future__ import annotations

from collections.abc import Iterator

from .check import Check, Checks
from .closed_forms import CLOSED_FORMS
from .finite_elements import running_in
from .ring_story import story

_RUNS: dict[str, tuple[tuple[str, tuple[str, ...], tuple[str, ...]], ...]] = {
    "case-1": (
        ("punch-on-strip", (), ()),
        ("punch-on-strip", (), ("heat",)),
    ),
    "case-2": (("rectangular-punch", (), ()),),
    "case-3": (
        ("block-on-disk", (), ()),
        ("block-on-disk", (), ("heat",)),
        ("block-on-disk", ("motion.angular_velocity=-0.3 rad/s",), ()),
        ("block-on-disk", ("geometry.arc_start=-0.2 rad", "geometry.arc_end=0.7 rad"), ("heat",)),
    ),
    "case-4": (
        ("ring-segment-on-disk", (), ()),
        ("ring-segment-on-disk", ("motion.angular_velocity=-1 rad/s",), ()),
    ),
    "case-5": (
        ("pivoted-block", (), ()),
        ("pivoted-block", ("motion.velocity=50 mm/s",), ()),
    ),
    "case-6": (
        ("punch-on-strip-tilting", (), ()),
        ("punch-on-strip-tilting", ("motion.velocity=50 mm/s",), ()),
    ),
    "case-7": (
        ("drum-brake", (), ()),
        ("drum-brake", ("motion.angular_velocity=5 rad/s",), ()),
    ),
    "case-8": (
        ("annular-punch", (), ()),
        ("annular-punch-conical", (), ()),
        ("annular-punch-toroidal", (), ()),
    ),
    "case-9": (
        ("disk-brake", (), ()),
        ("disk-brake", (), ("heat",)),
    ),
}
"""Starter case, overrides and tables left out of each running-in."""


def _checks_of(id: str) -> Checks:
    def checks() -> Iterator[Check]:
        yield from CLOSED_FORMS[id]()
        for starter, overrides, without in _RUNS[id]:
            yield from running_in(id, starter, *overrides, without=without)
        if id == "case-8":
            yield from story(id)

    return checks


CHECKS: dict[str, Checks] = {id: _checks_of(id) for id in _RUNS}
"""By id."""
