"""Cylinder on a flat under cyclic tangential load.

Partial slip without wear (Cattaneo and Mindlin), and fretting wear under gross slip, also with
adaptive cycle jumps.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....reference.elastic_contact.growing_contact import growing_line
from ....reference.elastic_contact.hertz import MindlinLine, contact_modulus
from ....results import CycleRow, FrictionInterface, Result
from ...check import Check, compare, compare_worst, run_starter

JOHNSON = "Johnson, Contact Mechanics (1985), section 7.2"
MODULUS, RADIUS, THICKNESS = contact_modulus((200e9, 0.3), (200e9, 0.3)), 6e-3, 1e-3
EXACT, PUSH = MindlinLine(120e3, RADIUS, MODULUS, 0.6), 36e3
AWAY = 0.05  # of the half-width: excluded distance from the edges of the stick zones
FORCE, AMPLITUDE, FRICTION = 18.5, 25e-6, 0.9
FLAT, CYLINDER = 2.9e-14, 1.9e-14  # 1/Pa
CYCLES, TOLERANCE = 18000, 1e-2
GROWTH = "quasi-steady growth for elastic bodies, to first order in (a0/a)²"
MCCOLL = (
    "data of McColl, Ding and Leen, Wear 256 (2004) 1114; Llavori's runs with meshes that move and "
    "finite sliding"
)
FINER = "same case with cycle jumps four times smaller"
DEPTHS = {1000: 0.373e-6, 5000: 1.125e-6, 10000: 1.808e-6, CYCLES: 2.7055e-6}
"""Wear depth of the flat by number of cycles [m]."""
BOUND = 9.657e-10
"""Worn section of the flat under gross slip after all cycles [m²]."""


def mindlin() -> Iterator[Check]:
    """Stick zone and shear on loading, half unloaded and reversed; energy per cycle."""
    force = PUSH * THICKNESS
    steps = ", ".join(f'"{f:g} N"' for f in (0, force, 0, -force, 0, force))
    times = ", ".join(f'"{t} s"' for t in range(6))
    result = run_starter(
        "cylinder-stick-slip",
        f"load.history={{time=[{times}], tangential_force=[{steps}]}}",
        f"analysis.output_times=[{times}]",
        "mesh.elements=120",
        "mesh.grading=1.0",
        "mesh.degree=2",
    )
    assert result.friction is not None
    outputs = result.friction.outputs
    yield from _state(outputs[1.0], PUSH, None)
    for time, push in ((2.0, 0.0), (3.0, -PUSH)):
        yield from _state(outputs[time], push, outputs[1.0])
    lost = {row.time: row.dissipated for row in result.friction.rows}
    cycle = (lost[5.0] - lost[1.0]) / THICKNESS
    yield compare("energy of a cycle [J/m]", cycle, EXACT.loss_per_cycle(PUSH), 2e-2, JOHNSON)


def _state(
    found: FrictionInterface, push: float, turned: FrictionInterface | None
) -> Iterator[Check]:
    """Shear, and width of the zone that has stuck since the last load reversal, if any."""
    a = EXACT.normal.half_width
    change = PUSH if turned is None else (PUSH - push) / 2
    shear = EXACT.shear_after(found.x, PUSH, push)
    stuck = [EXACT.stick_half_width(q) for q in (PUSH, change)]
    edges = np.array([a, *stuck])
    away = np.abs(np.abs(found.x)[:, None] - edges).min(axis=1) > AWAY * a
    limit = EXACT.friction * EXACT.normal.peak
    note = f"Q = {push / 1e3:g} N/mm"
    quantity = f"shear at the point of largest deviation, {note} [Pa]"
    yield compare_worst(quantity, -found.shear[away], shear[away], 2e-2, JOHNSON, limit)
    since = found.shear if turned is None else (found.shear - turned.shear) / 2
    width = _sticking_half_width(found, since)
    exact = EXACT.stick_half_width(change)
    yield compare(f"half-width of the stick zone, {note} [m]", width, exact, 1e-2, JOHNSON)


def _sticking_half_width(found: FrictionInterface, shear: np.ndarray) -> float:
    """Half-width at which the shear reaches the friction limit.

    The squared difference to the limit is nearly a parabola, fitted away from the edges.
    """
    missing = EXACT.friction * found.pressure - np.abs(shear)
    inner = missing > 0.3 * missing.max()
    parabola = np.polynomial.Polynomial.fit(found.x[inner], missing[inner] ** 2, 2)
    return float(np.abs(np.diff(parabola.roots())[0])) / 2


def fretting_wear() -> Iterator[Check]:
    """Both bodies wear, against measured and published results; only the cylinder wears."""
    cycles = rubbed(CYLINDER, FLAT)
    yield from _depths(cycles, 5000, 3e-2)
    last = cycles[5000]
    bound = FORCE * 4 * AMPLITUDE * last.cycle
    for body, k, volume in (("cylinder", CYLINDER, 1), ("flat", FLAT, 2)):
        found = getattr(last, f"wear_volume_{volume}") / (k * bound)
        yield compare(f"worn volume over its bound, {body} [1]", found, 0.97, 5e-3, MCCOLL)
    known, energy = (CYLINDER + FLAT) / FRICTION, "k/mu times the dissipated energy"
    found = last.wear_volume_1 + last.wear_volume_2
    yield compare("worn volume, both wear [m³]", found, known * last.dissipated, 1e-9, energy)
    last = rubbed(CYLINDER + FLAT, None)[5000]
    law = growing_line(FORCE / THICKNESS, RADIUS, MODULUS, CYLINDER + FLAT)
    depth = float(law.elastic_depth(last.wear_volume_1 / ((CYLINDER + FLAT) * FORCE)))
    quantity = "depth of the cylinder, which alone wears [m]"
    yield compare(quantity, last.max_wear_1, depth, 1e-2, GROWTH)
    found, quantity = (
        last.wear_volume_1 + last.wear_volume_2,
        "worn volume, the cylinder wears [m³]",
    )
    yield compare(quantity, found, known * last.dissipated, 1e-9, energy)


def rubbed(cylinder: float, flat: float | None) -> dict[int, CycleRow]:
    """Results of 5000 cycles with cycle jumps of 250, by number of cycles."""
    wear = {"cylinder": cylinder} | ({} if flat is None else {"block": flat})
    laws = ", ".join(
        f'{body}={{coefficient="{k} 1/Pa", per="pressure"}}' for body, k in wear.items()
    )
    places = ", ".join(f'"{x} m"' for x in (0, AMPLITUDE, 0, -AMPLITUDE, 0))
    times = '"0 s", "1 s", "2 s", "3 s", "4 s"'
    history = f"time=[{times}], tangential_displacement=[{places}]"
    result = run_starter(
        "cylinder-stick-slip",
        "geometry.zone=0.22 mm",
        "mesh={degree=2, elements=44, grading=1.0}",
        f'load={{force="{FORCE} N", history={{{history}}}}}',
        f"contact.friction={FRICTION}",
        f"wear={{{laws}}}",
        'analysis={type="fretting", increments=5, cycles=5000, jump=250}',
    )
    return _by_number(result)


def fretting_cylinder() -> Iterator[Check]:
    """Depths, worn section and energy in 18 000 cycles; cycle-jump error, actual and estimated."""
    result = run_starter("cylinder-fretting")
    found, last = _by_number(result), result.interface
    yield from _depths(found, CYCLES, 6e-2)
    end = found[CYCLES]
    bound = FLAT * FORCE / THICKNESS * 4 * AMPLITUDE * CYCLES
    yield compare("full-slip bound of the worn section [m²]", bound, BOUND, 1e-4, MCCOLL)
    section = end.wear_volume_2 / THICKNESS
    yield compare("worn section of the flat [m²]", section, 0.97 * BOUND, 3e-2, MCCOLL)
    worn = last.x[last.wear_2 > 0.01 * last.wear_2.max()]
    half_width = float(worn.max() - worn.min()) / 2
    yield compare("half-width of the worn flat [m]", half_width, 0.257e-3, 5e-2, MCCOLL)
    energy = (CYLINDER + FLAT) / FRICTION * end.dissipated
    volume = end.wear_volume_1 + end.wear_volume_2
    yield compare("worn volume [m³]", volume, energy, 1e-9, "k/mu times the energy dissipated")
    # the cycle-jump error is proportional to the square of the jump
    estimated = max(row.error for row in found.values()) / TOLERANCE
    quantity = "largest estimated cycle-jump error over the tolerance [1]"
    yield Check(quantity, estimated, 0.0, estimated, 1.0, "tolerance")
    fine = _by_number(run_starter("cylinder-fretting", f"analysis.tolerance={TOLERANCE / 16}"))
    smaller, quantity = len(fine) / len(found), "ratio of the numbers of cycle jumps [1]"
    yield Check(quantity, smaller, 4.0, abs(smaller / 4 - 1), 0.25, FINER)
    for number in DEPTHS:
        for name, unit in (("max_wear_1", "m"), ("max_wear_2", "m"), ("wear_volume_2", "m³")):
            coarse, exact = (getattr(rows[number], name) for rows in (found, fine))
            quantity = f"{name} after {number} cycles [{unit}]"
            yield compare(quantity, coarse, exact, 1e-2, FINER)


def _depths(cycles: dict[int, CycleRow], most: int, allowed: float) -> Iterator[Check]:
    for number in filter(lambda number: number <= most, DEPTHS):
        quantity = f"depth of the flat after {number} cycles [m]"
        yield compare(quantity, cycles[number].max_wear_2, DEPTHS[number], allowed, MCCOLL)


def _by_number(result: Result) -> dict[int, CycleRow]:
    """Computed cycles by their numbers."""
    assert result.friction is not None
    return {row.cycle: row for row in result.friction.cycles}
