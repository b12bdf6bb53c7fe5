"""Cylinder and sphere on a block with contacts that grow by wear, to multiples of Hertz's."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ....reference.elastic_contact.growing_contact import (
    GrowingContact,
    growing_line,
    growing_point,
)
from ....results import InterfaceFields
from ...check import Check, compare, run_starter
from ..contact.hertz import MODULUS

RIGID = "Argatov, Wear 271 (2011) 1147, rigid bodies"
ELASTIC = (
    "Argatov, with the dent of a uniform pressure (Johnson, Contact Mechanics, 1985, ch. 2, 3)"
)
ARCHARD = "Archard's law"
SPEED = 0.05
FULL = ("penalty", "nitsche")
"""Methods on the full system: slower, so on the coarsest mesh and not as far."""
ELEMENTS, PLACES = (40, 80, 160), (3, 3.55, 4.1, 4.65, 5.2, 5.75, 6)
"""Meshes, and multiples of the first half-width, for the largest pressures."""
PUBLISHED = {0.32: (2.7426, 1.6924e-6), 0.64: (3.2543, 2.3829e-6)}
"""Pin on disc: contact radius over Hertz's, and depth [m], by sliding distance [m]."""
_SEEN = 0.9e-2
"""Largest relative effect of elasticity for which closed forms of rigid bodies are compared."""


@dataclass(frozen=True)
class GrowingCase:
    """Starter case of a contact that grows by wear.

    Attributes
    ----------
    starter : str
    law : callable
        Closed form for a coefficient and an exponent of wear.
    coefficient : float
        Coefficient of wear of the starter case [1/Pa].
    force : float [N]
    moment : int
        ``a²`` over the mean ``x²`` of a parabola that falls to zero at a, weighted by its depth: 5
        over a half-width, 3 over a radius.
    load, power : float, int
        Uniform pressure: load over ``a^power``. The load is half the force per length, or the force
        over π.
    """

    starter: str
    law: Callable[..., GrowingContact]
    coefficient: float
    force: float
    moment: int
    load: float
    power: int

    def run(
        self,
        note: str,
        multiples: Sequence[float],
        *overrides: str,
        exponent: float = 1.0,
        coefficient: float | None = None,
    ) -> Growth:
        """Run up to multiples of the first half-width, by the closed form of rigid bodies."""
        law = self.law(coefficient or self.coefficient, exponent)
        return self.to(note, law, law.distance(law.start * np.array(multiples)), *overrides)

    def to(self, note: str, law: GrowingContact, distances, *overrides: str) -> Growth:
        """Run to increasing sliding distances [m]."""
        times = [float(s) / SPEED for s in distances]
        outputs = ", ".join(f'"{t!r} s"' for t in times[:-1])
        keys = f"analysis.end_time={times[-1]!r} s", f"analysis.output_times=[{outputs}]"
        result = run_starter(self.starter, *keys, "mesh.elements=60", *overrides)
        states = [*(result.outputs[t] for t in times[:-1]), result.interface]
        return Growth(self, note, law, dict(zip(map(float, distances), states, strict=True)))

    def peaks(self) -> Iterator[Check]:
        """Largest pressures on all meshes, and by the methods on the full system."""
        for elements in ELEMENTS:
            growth = self.run(f", {elements} elements", PLACES, f"mesh.elements={elements}")
            yield from growth.peaks()
        for method in FULL:
            keys = f"mesh.elements={ELEMENTS[0]}", f"contact.method={method}"
            growth = self.run(f", {ELEMENTS[0]} elements, {method}", PLACES[:3], *keys)
            yield from growth.peaks()


@dataclass(frozen=True)
class Growth:
    """Run of a contact that grows by wear.

    Attributes
    ----------
    case : GrowingCase
    note : str
        Label of the run.
    law : GrowingContact
        Closed form.
    states : dict of float to InterfaceFields
        Interfaces by sliding distance [m].
    """

    case: GrowingCase
    note: str
    law: GrowingContact
    states: dict[float, InterfaceFields]

    def checks(self) -> Iterator[Check]:
        """Half-width and depth of the worn zone against the closed forms."""
        for name, found, rigid, elastic in self._sizes():
            soft = float(elastic())
            yield compare(f"{name} [m]", found, soft, 1e-2, ELASTIC)
            if abs(soft / rigid - 1) < _SEEN:
                yield compare(f"{name} [m], rigid", found, rigid, 1e-2, RIGID)

    def from_scar(self) -> Iterator[Check]:
        """Checks from the first state on, against the closed form of rigid bodies only.

        That worn zone is the start a0. It is several times wider than Hertz's, and the effect of
        the elastic dent decreases as the contact widens.
        """
        (begun, scar), *later = self.states.items()
        law = replace(self.law, start=worn_half_width(scar, self.case.moment))
        since = replace(self, law=law, states={s - begun: state for s, state in later})
        for name, found, rigid, _ in since._sizes():
            yield compare(f"{name}, rigid [m]", found, rigid, 1e-2, RIGID)

    def peaks(self) -> Iterator[Check]:
        """Largest pressure against the uniform one, for any position of the edge in an element."""
        for distance, state in self.states.items():
            a = float(self.law.elastic_half_width(distance))
            found, uniform = float(state.pressure.max()), self.case.load / a**self.case.power
            quantity = f"largest pressure {self._place(distance)} [Pa]"
            yield compare(quantity, found, uniform, 5e-2, ELASTIC)

    def volumes(self, coefficient: float) -> Iterator[Check]:
        """Wear volume against ``k F s``."""
        rate = coefficient * self.case.force
        for distance, state in self.states.items():
            volume = state.weight @ (state.wear_1 + state.wear_2)
            quantity = f"volume after {distance:.4g} m{self.note} [m³]"
            yield compare(quantity, volume, rate * distance, 1e-3, ARCHARD)

    def _sizes(self) -> Iterator[tuple[str, float, float, Callable]]:
        """Name of each size, its computed value, that of rigid bodies, and that of elastic ones."""
        law = self.law
        for s, state in self.states.items():
            width, place = worn_half_width(state, self.case.moment), self._place(s)
            elastic = partial(law.elastic_half_width, s)
            yield f"half-width {place}", width, float(law.half_width(s)), elastic
            depth = float((state.wear_1 + state.wear_2)[0])
            yield f"depth {place}", depth, float(law.depth(s)), partial(law.elastic_depth, s)

    def _place(self, distance: float) -> str:
        relative = float(self.law.half_width(distance)) / self.law.start
        return f"at {relative:.3g} a0{self.note}"


def worn_half_width(interface: InterfaceFields, moment: int) -> float:
    """Half-width of the parabola with the second moment of the wear depth [m].

    Unlike the last contact point it does not jump from element to element.
    """
    worn = interface.weight * (interface.wear_1 + interface.wear_2)
    return float(np.sqrt(moment * (worn @ interface.x**2) / worn.sum()))


CYLINDER = GrowingCase(
    starter="cylinder-on-block-growing",
    law=partial(growing_line, 20.0 / 1e-3, 10e-3, MODULUS),
    coefficient=1e-14,
    force=20.0,
    moment=5,
    load=20.0 / 1e-3 / 2,
    power=1,
)
SPHERE = GrowingCase(
    starter="sphere-on-block-growing",
    law=partial(growing_point, 10.385, 50e-3, MODULUS),
    coefficient=1.33e-13,
    force=10.385,
    moment=3,
    load=10.385 / np.pi,
    power=2,
)


def growing_cylinder() -> Iterator[Check]:
    """Wear of the block, of both bodies, and of the cylinder with the square of the pressure."""
    k = CYLINDER.coefficient
    growth = CYLINDER.run("", (3, 4, 5, 6))
    yield from growth.checks()
    yield from growth.volumes(k)
    wide = ("mesh.elements=90", "geometry.zone=1.15 mm")
    yield from CYLINDER.run(", a0: a scar of 4 Hertz's", (4, 12.5, 16), *wide).from_scar()
    other = 'wear.cylinder={coefficient="5e-9 1/MPa", per="pressure"}'
    both = CYLINDER.run(", both wear", (3, 4), other, coefficient=1.5 * k)
    yield from both.checks()
    yield from both.volumes(1.5 * k)
    square = 'cylinder={coefficient="1e-10 1/MPa^2", per="pressure", pressure_exponent=2}'
    options = {"exponent": 2.0, "coefficient": 1e-22}
    note = ", cylinder wears, b = 2"
    yield from CYLINDER.run(note, (3, 4, 5), f"wear={{{square}}}", **options).checks()
    yield from CYLINDER.peaks()


def growing_sphere() -> Iterator[Check]:
    """Wear of the sphere, and of the block with the square of the pressure."""
    growth = SPHERE.run("", (3, 4, 5, 6))
    yield from growth.checks()
    yield from growth.volumes(SPHERE.coefficient)
    yield from SPHERE.run(", a0: a scar of 2 Hertz's", (2, 6.1, 6.5)).from_scar()
    square = 'block={coefficient="1.33e-9 1/MPa^2", per="pressure", pressure_exponent=2}'
    options = {"exponent": 2.0, "coefficient": 1.33e-21}
    note = ", block wears, b = 2"
    yield from SPHERE.run(note, (3, 5), f"wear={{{square}}}", **options).checks()
    yield from SPHERE.peaks()
    for distance, state in SPHERE.to("", growth.law, PUBLISHED).states.items():
        found, (ratio, _) = worn_half_width(state, 3) / growth.law.start, PUBLISHED[distance]
        yield compare(f"radius over a0 after {distance:g} m [1]", found, ratio, 1e-2, RIGID)
