"""Fretting of a tube in its support (special case 10), against closed forms.

A tube whose centre moves sideways by d rolls in the larger hole: with their radii R1 and R2 and
the clearance c, the contact travels by ``d R2/c`` along the support, while the tube slips by d. All
points that it passes wear equally.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....reference.elastic_contact.hertz import MindlinLine, contact_modulus
from ....results import Result
from ...check import Check, along, compare, run_starter

STARTER = "tube-in-support"
TUBE, CLEARANCE, THICKNESS = 4.75e-3, 0.05e-3, 10e-3
FORCE, FRICTION, AMPLITUDE, COEFFICIENT = 20.0, 0.5, 5e-6, 5e-14
HOLE = TUBE + CLEARANCE
HERTZ = MindlinLine(
    FORCE / THICKNESS,
    TUBE * HOLE / CLEARANCE,
    contact_modulus((99e9, 0.37), (99e9, 0.37)),
    FRICTION,
)
ENERGY = "k/mu times the dissipated energy"
SLIDING = "rigid tube that slides and rolls, minus stick due to the compliance of the contact"
ROLLING = "rolling in the hole"
MINDLIN = "Cattaneo and Mindlin (Johnson, Contact Mechanics, 1985, section 7.2)"


def fuel_fretting() -> Iterator[Check]:
    """Energy, volume per cycle, depth and width of the worn zone; stick-slip before gross slip."""
    summary = run_starter(STARTER, "analysis.cycles=20000", "analysis.output_times=[]").summary
    known = COEFFICIENT / FRICTION * summary["dissipated_energy_J"]
    for body in (1, 2):
        found = summary[f"wear_volume_{body}_m3"]
        yield compare(f"worn volume, body {body} [m³]", found, known, 1e-9, ENERGY)
    # reduced by the sticking at the turning points
    push = 0.1
    compliance = _pushed(push, 1).summary["tangential_displacement_m"] / push
    known = COEFFICIENT * FORCE * (_weighted_slip() - 4 * compliance * FRICTION * FORCE)
    for body in (1, 2):
        found = summary[f"wear_volume_per_cycle_{body}_m3"]
        yield compare(f"worn volume of a cycle, body {body} [m³]", found, known, 1e-3, SLIDING)
    yield from _zone()
    yield from _sticking()


def _pushed(force: float, increments: int, *overrides: str) -> Result:
    """Tube without wear that is pushed sideways."""
    history = f'time=["0 s", "1 s"], tangential_force=["0 N", "{force} N"]'
    keys = (
        f"load.history={{{history}}}",
        f"analysis={{type='fretting', increments={increments}}}",
    )
    return run_starter(STARTER, *keys, *overrides, without=("wear",))


def _weighted_slip() -> float:
    """Slip per cycle, weighted with the normal over the vertical force; about four times d [m].

    With the tube's centre at an angle α about that of the hole, ``sin α = d/c``, it slips by
    ``c dα`` under ``N = F/(cos α - mu sin α)`` towards larger α. With ``mu = tan φ`` the integral
    is ``cos φ artanh(sin(α + φ))``.
    """
    α, φ = np.arcsin(AMPLITUDE / CLEARANCE), np.arctan(FRICTION)
    ends = np.arctanh(np.sin(φ + np.array([-α, α])))
    return float(2 * CLEARANCE * np.cos(φ) * (ends[1] - ends[0]))


def _zone() -> Iterator[Check]:
    """First cycles: the contact passes each point twice per cycle, with little wear."""
    count = 400
    analysis = f"analysis={{type='fretting', increments=16, cycles={count}, jump={count}}}"
    result = run_starter(STARTER, analysis, "mesh.elements=96")
    i, travel = result.interface, AMPLITUDE * HOLE / CLEARANCE
    inside = np.linspace(-0.6, 0.6, 61) * travel
    for body, path, wear in ((1, TUBE, i.wear_1), (2, HOLE, i.wear_2)):
        passed = 2 * COEFFICIENT * FORCE / THICKNESS * CLEARANCE / path * count
        quantity = f"mean depth where the contact passes, body {body} [m]"
        yield compare(quantity, along(i, inside, wear).mean(), passed, 2e-2, ROLLING)
    assert result.friction is not None
    found = result.friction.cycles[-1].contact_area / THICKNESS / 2
    reach = travel * TUBE / HOLE + HERTZ.normal.half_width
    quantity = "half-width of the zone swept by the contact [m]"
    yield compare(quantity, found, reach, 4e-2, ROLLING)


def _sticking() -> Iterator[Check]:
    """Partial slip with a stick zone. A thick-walled tube approximates a half-space."""
    push = 0.5 * FRICTION * FORCE
    thick = (
        "geometry={type='tube-in-support', tube_radius='4.75 mm', tube_wall='4 mm', "
        "support_clearance='0.05 mm', support_thickness='6 mm', thickness='10 mm'}"
    )
    result = _pushed(push, 10, thick, "mesh.elements=80")
    assert result.friction is not None
    found, line = result.friction.last, push / THICKNESS
    width, known = result.summary["stick_area_m2"] / THICKNESS / 2, HERTZ.stick_half_width(line)
    yield compare("half-width of the stick zone [m]", width, known, 3e-2, MINDLIN)
    for place in (0.0, 0.4):
        x, limit = place * HERTZ.normal.half_width, FRICTION * HERTZ.normal.peak
        shear = float(np.interp([-x, x], found.x, -found.shear).mean())
        quantity, known = f"shear at {place:g} of the half-width [Pa]", float(HERTZ.shear(x, line))
        yield compare(quantity, shear, known, 2e-2, MINDLIN, scale=limit)
