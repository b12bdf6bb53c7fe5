"""Common runs and checks of contacts that grow by wear, up to multiples of the first half-width."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...reference.growing_contact import GrowingContact
from ...results import InterfaceFields, Result
from ..check import Check, compare
from ..starter import run_starter

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
_SEEN = 0.9e-2
"""Largest relative effect of elasticity for which closed forms of rigid bodies are compared."""


@dataclass(frozen=True)
class Growth:
    """Run of a contact that grows by wear.

    Attributes
    ----------
    note : str
        Label of the run.
    law : GrowingContact
        Closed form.
    moment : int
        ``a²`` over the mean ``x²`` of a parabola that falls to zero at a, weighted by its depth: 5
        over a half-width, 3 over a radius.
    states : dict of float to InterfaceFields
        Interfaces by sliding distance [m].
    """

    note: str
    law: GrowingContact
    moment: int
    states: dict[float, InterfaceFields]

    def checks(self) -> Iterator[Check]:
        """Half-width and depth of the worn zone against the closed forms."""
        for distance, state in self.states.items():
            place = f"at {float(self.law.half_width(distance)) / self.law.start:.3g} a0{self.note}"
            found = worn_half_width(state, self.moment), float((state.wear_1 + state.wear_2)[0])
            rigid = self.law.half_width(distance), self.law.depth(distance)
            elastic = self.law.elastic_half_width(distance), self.law.elastic_depth(distance)
            names = f"half-width {place} [m]", f"depth {place} [m]"
            for name, value, hard, soft in zip(names, found, rigid, elastic, strict=True):
                yield compare(name, value, float(soft), 1e-2, ELASTIC)
                if abs(soft / hard - 1) < _SEEN:
                    yield compare(f"{name}, rigid", value, float(hard), 1e-2, RIGID)

    def from_scar(self) -> Iterator[Check]:
        """Checks from the first state on, against the closed form of rigid bodies only.

        That worn zone is the start a0. It is several times wider than Hertz's, and the effect of
        the elastic dent decreases as the contact widens.
        """
        (begun, scar), *later = self.states.items()
        law = replace(self.law, start=worn_half_width(scar, self.moment))
        for distance, state in later:
            slid = distance - begun
            place = f"at {float(law.half_width(slid)) / law.start:.3g} a0{self.note}"
            found = worn_half_width(state, self.moment), float((state.wear_1 + state.wear_2)[0])
            known = float(law.half_width(slid)), float(law.depth(slid))
            for name, value, rigid in zip(("half-width", "depth"), found, known, strict=True):
                yield compare(f"{name} {place}, rigid [m]", value, rigid, 1e-2, RIGID)

    def peaks(self, load: float, power: int) -> Iterator[Check]:
        """Largest pressure against the uniform one, for any position of the edge in an element.

        The load is half the force per length, or the force over π; uniform: load over ``a^power``.
        """
        for distance, state in self.states.items():
            a = float(self.law.elastic_half_width(distance))
            place = f"at {float(self.law.half_width(distance)) / self.law.start:.3g} a0{self.note}"
            found, uniform = float(state.pressure.max()), load / a**power
            yield compare(f"largest pressure {place} [Pa]", found, uniform, 5e-2, ELASTIC)

    def volumes(self, rate: float) -> Iterator[Check]:
        """Wear volume against ``k F s``; `rate` is k F [m²]."""
        for distance, state in self.states.items():
            volume = state.weight @ (state.wear_1 + state.wear_2)
            quantity = f"volume after {distance:.4g} m{self.note} [m³]"
            yield compare(quantity, volume, rate * distance, 1e-3, ARCHARD)


@dataclass(frozen=True)
class GrowingCase:
    """Starter case of a contact that grows by wear.

    Attributes
    ----------
    starter : str
    law : callable
        Closed form for an exponent and a coefficient of wear.
    coefficient : float
        Coefficient of wear of the starter case [1/Pa].
    moment : int
        See `Growth`.
    load, power
        See `Growth.peaks`.
    """

    starter: str
    law: Callable[[float, float], GrowingContact]
    coefficient: float
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
        law = self.law(exponent, coefficient or self.coefficient)
        distances = law.distance(law.start * np.array(multiples))
        states = grown(self.starter, distances, "mesh.elements=60", *overrides)
        return Growth(note, law, self.moment, states)

    def peaks(self) -> Iterator[Check]:
        """Largest pressures on all meshes, and by the methods on the full system."""
        for elements in ELEMENTS:
            growth = self.run(f", {elements} elements", PLACES, f"mesh.elements={elements}")
            yield from growth.peaks(self.load, self.power)
        for method in FULL:
            keys = f"mesh.elements={ELEMENTS[0]}", f"contact.method={method}"
            growth = self.run(f", {ELEMENTS[0]} elements, {method}", PLACES[:3], *keys)
            yield from growth.peaks(self.load, self.power)


def grown(starter: str, distances, *overrides: str) -> dict[float, InterfaceFields]:
    """Interfaces of a starter case after increasing sliding distances [m]."""
    times = [float(s) / SPEED for s in distances]
    outputs = ", ".join(f'"{t!r} s"' for t in times[:-1])
    keys = f"analysis.end_time={times[-1]!r} s", f"analysis.output_times=[{outputs}]"
    result: Result = run_starter(starter, *keys, *overrides)
    states = [*(result.outputs[t] for t in times[:-1]), result.interface]
    return {float(s): state for s, state in zip(distances, states, strict=True)}


def worn_half_width(interface: InterfaceFields, moment: int) -> float:
    """Half-width of the parabola with the second moment of the wear depth [m].

    Unlike the last contact point it does not jump from element to element.
    """
    worn = interface.weight * (interface.wear_1 + interface.wear_2)
    return float(np.sqrt(moment * (worn @ interface.x**2) / worn.sum()))
