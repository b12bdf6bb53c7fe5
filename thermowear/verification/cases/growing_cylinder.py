"""Cylinder on a block with a contact that grows by wear."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.growing_contact import GrowingContact, growing_line
from ..check import Check
from .growing import FULL, Growth, grown
from .hertz import MODULUS

ID = "growing-cylinder"
STARTER = "cylinder-on-block-growing"
FORCE, THICKNESS, RADIUS = 20.0, 1e-3, 10e-3
COEFFICIENT = 1e-14
MESH = ("mesh.elements=60",)
ELEMENTS, PLACES = (40, 80, 160), (3, 3.55, 4.1, 4.65, 5.2, 5.75, 6)
WIDE = ("mesh.elements=90", "geometry.zone=1.15 mm")

BOTH = ('wear.cylinder={coefficient="5e-9 1/MPa", per="pressure"}',)
SQUARE = ('wear={cylinder={coefficient="1e-10 1/MPa^2", per="pressure", pressure_exponent=2}}',)


def checks() -> Iterator[Check]:
    """Wear of the block, of both bodies, and of the cylinder with the square of the pressure."""
    growth = run("", 1.0, COEFFICIENT, (3, 4, 5, 6))
    yield from growth.checks()
    yield from growth.volumes(COEFFICIENT * FORCE)
    scar = run(", a0: a scar of 4 Hertz's", 1.0, COEFFICIENT, (4, 12.5, 16), *WIDE)
    yield from scar.from_scar()
    both = run(", both wear", 1.0, 1.5 * COEFFICIENT, (3, 4), *BOTH)
    yield from both.checks()
    yield from both.volumes(1.5 * COEFFICIENT * FORCE)
    yield from run(", cylinder wears, b = 2", 2.0, 1e-22, (3, 4, 5), *SQUARE).checks()
    for elements in ELEMENTS:
        mesh = f", {elements} elements", f"mesh.elements={elements}"
        peaks = run(mesh[0], 1.0, COEFFICIENT, PLACES, mesh[1])
        yield from peaks.peaks(FORCE / THICKNESS / 2, 1)
    for method in FULL:
        keys = f"mesh.elements={ELEMENTS[0]}", f"contact.method={method}"
        peaks = run(f", {ELEMENTS[0]} elements, {method}", 1.0, COEFFICIENT, PLACES[:3], *keys)
        yield from peaks.peaks(FORCE / THICKNESS / 2, 1)


def law(exponent: float, coefficient: float) -> GrowingContact:
    """Closed form of the starter case; parameters as in `growing_line`."""
    return growing_line(FORCE / THICKNESS, RADIUS, MODULUS, coefficient, exponent)


def run(
    note: str, exponent: float, coefficient: float, multiples: tuple[float, ...], *overrides: str
) -> Growth:
    """Run up to multiples of the first half-width, by the closed form of rigid bodies."""
    grows = law(exponent, coefficient)
    distances = grows.distance(grows.start * np.array(multiples))
    return Growth(ID, note, grows, 5, grown(STARTER, distances, *MESH, *overrides))
