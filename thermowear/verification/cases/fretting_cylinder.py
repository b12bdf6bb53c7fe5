"""Fretting of a cylinder on a flat, 18 000 cycles with adaptive cycle jumps."""

from __future__ import annotations

from collections.abc import Iterator

from ...results import CycleRow, Result
from ..check import Check, compare
from ..starter import run_starter

STARTER = "cylinder-fretting"
FORCE, THICKNESS, AMPLITUDE, FRICTION = 18.5, 1e-3, 25e-6, 0.9
FLAT, CYLINDER = 2.9e-14, 1.9e-14  # 1/Pa
CYCLES, TOLERANCE = 18000, 1e-2
MCCOLL = (
    "data of McColl, Ding and Leen, Wear 256 (2004) 1114; Llavori's runs with meshes that move and "
    "finite sliding"
)
FINER = "same case with cycle jumps four times smaller"
DEPTHS = {1000: 0.373e-6, 5000: 1.125e-6, 10000: 1.808e-6, CYCLES: 2.7055e-6}
"""Wear depth of the flat by number of cycles [m]."""
BOUND = 9.657e-10
"""Worn section of the flat under gross slip [m²]."""


def checks() -> Iterator[Check]:
    """Depths, worn section and energy; cycle-jump error, actual and estimated."""
    result = run_starter(STARTER)
    found, last = _by_number(result), result.interface
    for number, depth in DEPTHS.items():
        quantity = f"depth of the flat after {number} cycles [m]"
        yield compare(quantity, found[number].max_wear_2, depth, 6e-2, MCCOLL)
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
    yield from _jumps(found)


def _jumps(found: dict[int, CycleRow]) -> Iterator[Check]:
    """The cycle-jump error is proportional to the square of the jump."""
    estimated = max(row.error for row in found.values())
    quantity = "largest estimated cycle-jump error over the tolerance [1]"
    yield Check(quantity, estimated / TOLERANCE, 0.0, estimated / TOLERANCE, 1.0, "tolerance")
    fine = _by_number(run_starter(STARTER, f"analysis.tolerance={TOLERANCE / 16}"))
    smaller = len(fine) / len(found)
    yield Check(
        "ratio of the numbers of cycle jumps [1]", smaller, 4.0, abs(smaller / 4 - 1), 0.25, FINER
    )
    for number in DEPTHS:
        for name in ("max_wear_1", "max_wear_2", "wear_volume_2"):
            coarse, exact = (getattr(rows[number], name) for rows in (found, fine))
            quantity = f"{name} after {number} cycles [{'m³' if 'vol' in name else 'm'}]"
            yield compare(quantity, coarse, exact, 1e-2, FINER)


def _by_number(result: Result) -> dict[int, CycleRow]:
    assert result.friction is not None
    return {row.cycle: row for row in result.friction.cycles}
