"""Cattaneo-Mindlin problem: a cylinder on a block under cyclic tangential load in partial slip."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.hertz import contact_modulus
from ...reference.mindlin import MindlinLine
from ...results import FrictionInterface
from ..check import Check, compare, compare_worst
from ..starter import run_starter

JOHNSON = "Johnson, Contact Mechanics (1985), section 7.2"
THICKNESS, FORCE, PUSH = 1e-3, 120e3, 36e3
EXACT = MindlinLine(FORCE, 6e-3, contact_modulus((200e9, 0.3), (200e9, 0.3)), 0.6)
AWAY = 0.05  # of the half-width: excluded distance from the edges of the stick zones


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
