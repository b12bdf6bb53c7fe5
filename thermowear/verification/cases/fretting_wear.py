"""Fretting wear of a cylinder on a block under gross slip."""

from __future__ import annotations

from collections.abc import Iterator

from ...reference.growing_contact import growing_line
from ...reference.hertz import contact_modulus
from ...results import CycleRow, Result
from ..check import Check, compare
from ..starter import run_starter

FORCE, THICKNESS, RADIUS, AMPLITUDE, FRICTION = 18.5, 1e-3, 6e-3, 25e-6, 0.9
FLAT, CYLINDER = 2.9e-14, 1.9e-14  # 1/Pa
GROWTH = "quasi-steady growth for elastic bodies, to first order in (a0/a)²"
MCCOLL = (
    "data of McColl, Ding and Leen, Wear 256 (2004) 1114; Llavori's runs with meshes that move and "
    "finite sliding"
)
DEPTHS = {1000: 0.373e-6, 5000: 1.125e-6}
"""Wear depth of the flat by number of cycles [m]."""


def checks() -> Iterator[Check]:
    """Both bodies wear, against measured and published results; only the cylinder wears."""
    cycles = rubbed(CYLINDER, FLAT)
    for number, depth in DEPTHS.items():
        quantity = f"depth of the flat after {number} cycles [m]"
        yield compare(quantity, cycles[number].max_wear_2, depth, 3e-2, MCCOLL)
    last = cycles[5000]
    bound = FORCE * 4 * AMPLITUDE * last.cycle
    for body, k, volume in (("cylinder", CYLINDER, 1), ("flat", FLAT, 2)):
        quantity = f"worn volume over its bound, {body} [1]"
        found = getattr(last, f"wear_volume_{volume}") / (k * bound)
        yield compare(quantity, found, 0.97, 5e-3, MCCOLL)
    yield from _balance(last, CYLINDER + FLAT, "both wear")
    last = rubbed(CYLINDER + FLAT, None)[5000]
    law = growing_line(
        FORCE / THICKNESS, RADIUS, contact_modulus((200e9, 0.3), (200e9, 0.3)), CYLINDER + FLAT
    )
    slid = last.wear_volume_1 / ((CYLINDER + FLAT) * FORCE)
    quantity = "depth of the cylinder, which alone wears [m]"
    yield compare(quantity, last.max_wear_1, float(law.elastic_depth(slid)), 1e-2, GROWTH)
    yield from _balance(last, CYLINDER + FLAT, "the cylinder wears")


def rubbed(cylinder: float, flat: float | None) -> dict[int, CycleRow]:
    """Results of 5000 cycles with cycle jumps of 250, by number of cycles."""
    wear = {"cylinder": cylinder} | ({} if flat is None else {"block": flat})
    laws = ", ".join(
        f'{body}={{coefficient="{k} 1/Pa", per="pressure"}}' for body, k in wear.items()
    )
    result: Result = run_starter(
        "cylinder-stick-slip",
        "geometry.zone=0.22 mm",
        "mesh={degree=2, elements=44, grading=1.0}",
        f'load={{force="{FORCE} N", history={{{_cycle_history(AMPLITUDE)}}}}}',
        f"contact.friction={FRICTION}",
        f"wear={{{laws}}}",
        'analysis={type="fretting", increments=5, cycles=5000, jump=250}',
    )
    assert result.friction is not None
    return {row.cycle: row for row in result.friction.cycles}


def _cycle_history(amplitude: float) -> str:
    """History of one cycle, as text of the case."""
    places = ", ".join(f'"{x} m"' for x in (0, amplitude, 0, -amplitude, 0))
    return f'time=["0 s", "1 s", "2 s", "3 s", "4 s"], tangential_displacement=[{places}]'


def _balance(row: CycleRow, coefficient: float, note: str) -> Iterator[Check]:
    """Shear traction is mu p in the slip zone: wear volume from the dissipated energy."""
    found = row.wear_volume_1 + row.wear_volume_2
    known = coefficient / FRICTION * row.dissipated
    quantity = f"worn volume, {note} [m³]"
    yield compare(quantity, found, known, 1e-9, "k/mu times the dissipated energy")
