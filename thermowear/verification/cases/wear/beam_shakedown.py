"""Wear shakedown of a beam over a gap."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ....reference.beam import EXAMPLE, PLACES, TABLE, BeamState, WornBeam
from ....results import Result
from ...check import Check, compare, compare_each, compare_worst, run_starter

STARTER = "beam-on-foundation"
COMPUTED = "200 Hermite elements, independent implicit steps"
SHEAR = (
    "beam theory with shear flexibility (Timoshenko; A_s by Cowper, J. Appl. Mech. 33 (1966) 335)"
)
FREE = "free deflection of the same finite elements minus the gap"
BELOW = "Páczelt and Mróz: 1e-7 MPa"

MESH = ("mesh.degree=2", 'wear.update="never"')
"""Beam theory has the bending stiffness of the unworn section."""
SMOOTH = ("contact.friction=0.0", 'wear.beam={coefficient="7.5e-4 1/MPa", per="pressure"}')
"""Wear without friction in the section, as in beam theory."""
NEVER = ("geometry.gap=5 mm", 'analysis={type="initial"}')
"""Gap that is too large for contact."""

_EULER_STEPS = 6000
"""Number of implicit Euler steps (10 ms at the end) with which the whole table was computed. The
pressure ``e^(-λ t)``, λ = 0.30/s, decays too slowly by a factor ``e^(λ² Δt t / 2)``: 2.7 % after
60 s."""
_CONVERGED = 4e-2
"""Tolerance of converged pressure and reaction after 60 s: error of those steps, and rounding to
the table's two digits."""


def beam_shakedown() -> Iterator[Check]:
    """Beam theory against the table, finite elements against beam theory, and the final state."""
    for state in EXAMPLE.states(list(TABLE)):
        yield from _against_table(EXAMPLE, state, "beam theory", _CONVERGED)
    for state in EXAMPLE.states(list(TABLE), _EULER_STEPS, EXAMPLE.euler):
        yield from _against_table(EXAMPLE, state, "beam theory, implicit Euler", 1e-2)
    # shear stiffness G A_s of a rectangle with A_s = A 10 (1 + ν)/(12 + 11 ν), ν = 0.3
    modulus, part = EXAMPLE.young_modulus / (2 * (1 + 0.3)), 10 * (1 + 0.3) / (12 + 11 * 0.3)
    shear_stiffness = modulus * part * EXAMPLE.height * EXAMPLE.width
    flexible = replace(EXAMPLE, shear_stiffness=shear_stiffness)
    states = flexible.states(list(TABLE))
    smooth = run_starter(STARTER, *MESH, *SMOOTH)
    yield from _against_theory(flexible, states, smooth, "")
    yield from _against_theory(flexible, states, run_starter(STARTER, *MESH), ", friction")
    yield from _end(smooth, run_starter(STARTER, *MESH, *SMOOTH, *NEVER))


def _against_table(
    beam: WornBeam, state: BeamState, what: str, allowed_at_last: float
) -> Iterator[Check]:
    largest, place, reaction, zone, depths = TABLE[state.time]
    x, pressure = 1e3 * beam.x, state.pressure
    ends = x[pressure > 0][[0, -1]]
    allowed = allowed_at_last if state.time == 60.0 else 1e-2
    force = beam.area * pressure.sum()
    rows = [
        ("largest pressure", "MPa", pressure.max() / 1e6, largest, allowed),
        ("its position", "mm", x[pressure.argmax()], place, 1e-2),
        ("reaction", "N", force, reaction, allowed),
        ("start of the zone", "mm", ends[0], zone[0], 1e-2),
        ("end of the zone", "mm", ends[1], zone[1], 1e-2),
    ]
    worn = 1e3 * np.interp(PLACES, beam.x, state.worn)
    for at, found, known in zip(PLACES, worn, depths, strict=True):
        rows.append((f"depth at x = {1e3 * at:g} mm", "mm", found, known, 1e-2))
    for name, unit, found, known, within in rows:
        quantity = f"{what}, {name} at {state.time:g} s [{unit}]"
        yield compare(quantity, found, known, within, COMPUTED)


def _against_theory(
    beam: WornBeam, states: list[BeamState], result: Result, note: str
) -> Iterator[Check]:
    interfaces = result.outputs | {result.history[-1].time: result.interface}
    for state in states:
        if state.time < 0.8:  # the point load of beam theory matters while the zone is small
            continue
        interface = interfaces[state.time]
        found = np.interp(PLACES, interface.x, interface.wear_1)
        known = np.interp(PLACES, beam.x, state.worn)
        quantity = f"depth at x = {{:g}} mm, {state.time:g} s{note} [m]"
        yield from compare_each(quantity, 1e3 * PLACES, found, known, 3e-2, SHEAR)


def _end(result: Result, free: Result) -> Iterator[Check]:
    """Final worn shape at the point of largest deviation, and final pressure."""
    left = np.maximum(5e-3 - free.interface.gap - EXAMPLE.gap, 0.0)
    quantity = "final wear depth at the point of largest deviation, relative to the largest [m]"
    yield compare_worst(quantity, result.interface.wear_1, left, 1e-2, FREE)
    pressure = result.interface.pressure.max() / 1e6
    yield Check("pressure after 60 s [MPa]", pressure, 1e-6, pressure / 1e-6, 1.0, BELOW)
