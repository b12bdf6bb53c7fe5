"""Floating caliper: both pads carry the force of the piston, and the disk keeps its place.

The starter, with pads of different heights. By action and reaction its pressures are those of a
disk that floats in a fixed caliper.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from typing import Any

from ....case import load
from ....case.starters import starter_text
from ....results import Result
from ...check import Check, compare, compare_worst, computed
from .pad_disk_pad import at_contact

CALIPER = "disk-brake-floating-caliper"
FORCE, SIDES = 500.0, ("inner", "outer")
"""Force of the piston [N], and the contacts."""
FIXED = "disk floating in a fixed caliper"
TWO_FORCES = "brake with a force on each pad"
REACTION = "action and reaction"
ANALYSES: dict[str, dict[str, Any]] = {
    "unworn": {"type": "initial"},
    "steady": {"type": "steady"},
    "after running-in": {"type": "transient", "end_time": "2000 s", "tolerance": 1e-2},
}


def floating_caliper() -> Iterator[Check]:
    """Forces, equal wear, and the same brake with two forces or with a floating disk."""
    for state in ANALYSES:
        found = brake(state)
        for side in SIDES:
            force = found.summary["contacts"][side]["normal_force_N"]
            yield compare(f"force, {side}, {state} [N]", force, FORCE, 1e-12, REACTION)
        hub = found.summary["holders"]["hub"]["guide_force_z_N"]
        yield compare(f"force of the hub, {state} [N]", hub, 0.0, 1e-9, REACTION, FORCE)
        for other, source in (("forces", TWO_FORCES), ("disk", FIXED)):
            yield from _same(found, brake(state, other), f"{state}, {source}", source)
    holders = brake("steady").summary["holders"]
    rates = [holders[name]["rigid_wear_velocity_m_per_s"] for name in ("piston", "caliper")]
    yield compare("wear rate of the caliper, steady [m/s]", rates[1], rates[0], 1e-9, "equal pads")


def _same(found: Result, expected: Result, note: str, source: str) -> Iterator[Check]:
    """Pressures at both contacts."""
    for side in SIDES:
        one, other = (at_contact(result, side).pressure for result in (found, expected))
        quantity = f"pressure, {side}, {note}, largest deviation [Pa]"
        yield compare_worst(quantity, one, other, 1e-9, source)


def brake(state: str, other: str = "") -> Result:
    """Compute the brake in one of `ANALYSES`.

    Parameters
    ----------
    state : str
    other : str, optional
        ``"forces"``: a force on each pad in place of the reaction; ``"disk"``: a disk that floats
        in a fixed caliper.
    """
    tables = tomllib.loads(starter_text(CALIPER))
    tables |= {"analysis": ANALYSES[state], "mesh": {"degree": 3, "elements": 8, "grading": 0.3}}
    holders = tables["holders"]
    if other:
        del holders["piston"]["reaction"]
    if other == "forces":
        holders["caliper"]["force"] = f"{FORCE} N"
    if other == "disk":
        holders["caliper"]["free"] = []
        holders["hub"]["free"] = ["z"]
    return computed(load(tables))
