"""Sphere on a block with a contact that grows by wear: a pin-on-disc test."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.growing_contact import GrowingContact, growing_point
from ..check import Check, compare
from .growing import RIGID, GrowingCase, grown, worn_half_width
from .hertz import MODULUS

STARTER = "sphere-on-block-growing"
FORCE, RADIUS = 10.385, 50e-3
COEFFICIENT = 1.33e-13
MOMENT = 3

SQUARE = ('wear={block={coefficient="1.33e-9 1/MPa^2", per="pressure", pressure_exponent=2}}',)
PUBLISHED = {0.32: 2.7426, 0.64: 3.2543}
"""Contact radius over Hertz's, by sliding distance [m]."""


def law(exponent: float, coefficient: float) -> GrowingContact:
    """Closed form of the starter case; parameters as in `growing_point`."""
    return growing_point(FORCE, RADIUS, MODULUS, coefficient, exponent)


def checks() -> Iterator[Check]:
    """Wear of the sphere, and of the block with the square of the pressure."""
    case = GrowingCase(STARTER, law, COEFFICIENT, MOMENT, FORCE / np.pi, 2)
    growth = case.run("", (3, 4, 5, 6))
    yield from growth.checks()
    yield from growth.volumes(COEFFICIENT * FORCE)
    yield from case.run(", a0: a scar of 2 Hertz's", (2, 6.1, 6.5)).from_scar()
    note = ", block wears, b = 2"
    yield from case.run(note, (3, 5), *SQUARE, exponent=2.0, coefficient=1.33e-21).checks()
    yield from case.peaks()
    published = grown(STARTER, tuple(PUBLISHED), "mesh.elements=60")
    for (distance, ratio), state in zip(PUBLISHED.items(), published.values(), strict=True):
        found = worn_half_width(state, MOMENT) / growth.law.start
        yield compare(f"radius over a0 after {distance:g} m [1]", found, ratio, 1e-2, RIGID)
