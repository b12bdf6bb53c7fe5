"""Reciprocating punch on a strip, against its steady state and limit cases."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...check import Check, compare, compare_each, compare_worst, run_starter

STARTER = "punch-on-strip-reciprocating"
HALF_WIDTH, AMPLITUDE, THICKNESS = 5e-3, 5e-3, 10e-3
FORCE, COEFFICIENT, SPEED = 2e3, 1e-13, 4 * 5e-3 * 2.0
SLIDING = "k F times the sliding distance"
END = "uniform wear of the punch and of the trough, see `reciprocating_problem`"
IN_PLACE = "running-in of both faces with stationary contact, at the same mean speed"
LAW = '{coefficient="1e-7 1/MPa", per="pressure"}'
PLACES = np.array([0.0, 0.4, 0.8])
"""Positions relative to the half-width of a face."""


def reciprocating() -> Iterator[Check]:
    """Volumes, final rates, wear of one body only, and the limit of small strokes."""
    long = run_starter(STARTER, "analysis={type='reciprocating', cycles=50000}")
    worn = COEFFICIENT * FORCE * (SPEED * long.summary["time_s"])
    for body in (1, 2):
        found = long.summary[f"wear_volume_{body}_m3"]
        yield compare(f"worn volume, body {body} [m³]", found, worn, 1e-9, SLIDING)
    assert long.track is not None
    i, track = long.interface, long.track.last
    for name, x, rate, half, allowed in (
        ("punch", i.x, i.wear_rate_1, HALF_WIDTH, 1e-2),
        ("strip", track.x, track.wear_rate_2, HALF_WIDTH + AMPLITUDE, 2e-2),
    ):
        known = np.full(len(PLACES), _rate(half))
        found = np.interp(PLACES * half, x, rate)
        quantity = f"wear rate at {{:g}} of the half-width, {name} [m/s]"
        yield from compare_each(quantity, PLACES, found, known, allowed, END)
    yield from _one_body()
    yield from _short_strokes()


def _rate(half: float) -> float:
    """Uniform wear rate over a half-width [m/s]."""
    return COEFFICIENT * FORCE * SPEED / (2 * half * THICKNESS)


def _one_body() -> Iterator[Check]:
    """Wear of one body: on a long strip a punch that wears alone has a uniform pressure."""
    cycles = "analysis={{type='reciprocating', cycles={}}}".format
    alone = run_starter(STARTER, f"wear={{punch={LAW}}}", "contact.friction=0", cycles(2000))
    i, known = alone.interface, FORCE / (2 * HALF_WIDTH * THICKNESS)
    inside, place = np.abs(i.x) <= 0.8 * HALF_WIDTH, "at the point of largest deviation within"
    quantity = f"pressure {place} 0.8 of the half-width, punch wears [Pa]"
    yield compare_worst(quantity, i.pressure[inside], known, 1e-3, "a uniform pressure")
    alone = run_starter(STARTER, f"wear={{strip={LAW}}}", cycles(20000))
    assert alone.track is not None
    track, half = alone.track.last, HALF_WIDTH + AMPLITUDE
    inside = np.abs(track.x) <= 0.9 * half
    quantity = f"wear rate {place} 0.9 of the trough, strip wears [m/s]"
    yield compare_worst(quantity, track.wear_rate_2[inside], _rate(half), 1e-2, END)


def _short_strokes() -> Iterator[Check]:
    """Stroke of a hundredth of the punch: both faces wear as in a stationary contact."""
    mesh = (
        "geometry.stroke=0.5 mm",
        "contact.friction=0",
        "mesh={degree=3, elements=24, grading=1.0}",
    )
    stroke = "motion={amplitude='0.05 mm', frequency='200 Hz'}"
    analysis = "analysis={type='reciprocating', end_time='20 s', tolerance=1e-4}"
    short = run_starter(STARTER, analysis, stroke, *mesh)
    analysis, motion = "analysis={type='transient', end_time='20 s'}", "motion={velocity='40 mm/s'}"
    in_place = run_starter(STARTER, analysis, motion, *mesh)
    for body in (1, 2):
        found, known = (
            np.interp(PLACES * HALF_WIDTH, i.x, getattr(i, f"wear_{body}"))
            for i in (short.interface, in_place.interface)
        )
        quantity = f"depth at {{:g}} of the half-width, short strokes, body {body} [m]"
        yield from compare_each(quantity, PLACES, found, known, 1e-2, IN_PLACE)
