"""Sphere on a block with a contact that grows by wear: a pin-on-disc test."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.growing_contact import GrowingContact, growing_point
from ..check import Check, compare
from .growing import FULL, RIGID, Growth, grown, worn_half_width
from .hertz import MODULUS

ID = "growing-sphere"
STARTER = "sphere-on-block-growing"
FORCE, RADIUS = 10.385, 50e-3
COEFFICIENT = 1.33e-13
MOMENT = 3
MESH = ("mesh.elements=60",)
ELEMENTS, PLACES = (40, 80, 160), (3, 3.55, 4.1, 4.65, 5.2, 5.75, 6)

SQUARE = ('wear={block={coefficient="1.33e-9 1/MPa^2", per="pressure", pressure_exponent=2}}',)
PUBLISHED = {0.32: 2.7426, 0.64: 3.2543}
"""Contact radius over Hertz's, by sliding distance [m]."""


def checks() -> Iterator[Check]:
    """Wear of the sphere, and of the block with the square of the pressure."""
    growth = run("", 1.0, COEFFICIENT, (3, 4, 5, 6))
    yield from growth.checks()
    yield from growth.volumes(COEFFICIENT * FORCE)
    scar = run(", a0: a scar of 2 Hertz's", 1.0, COEFFICIENT, (2, 6.1, 6.5))
    yield from scar.from_scar()
    yield from run(", block wears, b = 2", 2.0, 1.33e-21, (3, 5), *SQUARE).checks()
    for elements in ELEMENTS:
        mesh = f", {elements} elements", f"mesh.elements={elements}"
        peaks = run(mesh[0], 1.0, COEFFICIENT, PLACES, mesh[1])
        yield from peaks.peaks(FORCE / np.pi, 2)
    for method in FULL:
        keys = f"mesh.elements={ELEMENTS[0]}", f"contact.method={method}"
        peaks = run(f", {ELEMENTS[0]} elements, {method}", 1.0, COEFFICIENT, PLACES[:3], *keys)
        yield from peaks.peaks(FORCE / np.pi, 2)
    published = grown(STARTER, tuple(PUBLISHED), *MESH)
    for (distance, ratio), state in zip(PUBLISHED.items(), published.values(), strict=True):
        found = worn_half_width(state, MOMENT) / growth.law.start
        quantity = f"radius over a0 after {distance:g} m [1]"
        yield compare(ID, quantity, found, ratio, 1e-2, RIGID)


def law(exponent: float, coefficient: float) -> GrowingContact:
    """Closed form of the starter case; parameters as in `growing_point`."""
    return growing_point(FORCE, RADIUS, MODULUS, coefficient, exponent)


def run(
    note: str, exponent: float, coefficient: float, multiples: tuple[float, ...], *overrides: str
) -> Growth:
    """Run up to multiples of the first radius, by the closed form of rigid bodies."""
    grows = law(exponent, coefficient)
    distances = grows.distance(grows.start * np.array(multiples))
    return Growth(ID, note, grows, MOMENT, grown(STARTER, distances, *MESH, *overrides))
