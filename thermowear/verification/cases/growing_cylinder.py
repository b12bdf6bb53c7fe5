"""Cylinder on a block with a contact that grows by wear."""

from __future__ import annotations

from collections.abc import Iterator

from ...reference.growing_contact import GrowingContact, growing_line
from ..check import Check
from .growing import GrowingCase
from .hertz import MODULUS

STARTER = "cylinder-on-block-growing"
FORCE, THICKNESS, RADIUS = 20.0, 1e-3, 10e-3
COEFFICIENT = 1e-14
WIDE = ("mesh.elements=90", "geometry.zone=1.15 mm")

BOTH = ('wear.cylinder={coefficient="5e-9 1/MPa", per="pressure"}',)
SQUARE = ('wear={cylinder={coefficient="1e-10 1/MPa^2", per="pressure", pressure_exponent=2}}',)


def law(exponent: float, coefficient: float) -> GrowingContact:
    """Closed form of the starter case; parameters as in `growing_line`."""
    return growing_line(FORCE / THICKNESS, RADIUS, MODULUS, coefficient, exponent)


def checks() -> Iterator[Check]:
    """Wear of the block, of both bodies, and of the cylinder with the square of the pressure."""
    case = GrowingCase(STARTER, law, COEFFICIENT, 5, FORCE / THICKNESS / 2, 1)
    growth = case.run("", (3, 4, 5, 6))
    yield from growth.checks()
    yield from growth.volumes(COEFFICIENT * FORCE)
    yield from case.run(", a0: a scar of 4 Hertz's", (4, 12.5, 16), *WIDE).from_scar()
    both = case.run(", both wear", (3, 4), *BOTH, coefficient=1.5 * COEFFICIENT)
    yield from both.checks()
    yield from both.volumes(1.5 * COEFFICIENT * FORCE)
    note = ", cylinder wears, b = 2"
    yield from case.run(note, (3, 4, 5), *SQUARE, exponent=2.0, coefficient=1e-22).checks()
    yield from case.peaks()
