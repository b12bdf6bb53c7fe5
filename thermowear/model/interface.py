"""Interface of two bodies: contact faces and the laws of friction, heat and wear."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np

from ..laws.formulas import PlaceFunction, typical_value
from ..laws.histories import TimeFunction
from ..laws.interfaces import (
    Constant,
    Law,
    Multiplied,
    Multipliers,
    PressureConductance,
    harmonic_mean,
)
from .body import WHY, Facing, Material
from .conditions import Motion
from .face_wear import Wear


@dataclass(frozen=True)
class HardnessConductance:
    """Conductance in proportion to the pressure over the hardness of the faces.

    Attributes
    ----------
    coefficient : float
        [1/m], see `laws.interfaces`.
    """

    coefficient: float

    def law(self, facing: Facing, materials: Mapping[str, Material]) -> PressureConductance:
        """Conductance at the contact points of two faces."""
        k = facing.of(materials, lambda material: material.known("conductivity", WHY))
        hardness = facing.of(materials, lambda material: material.known("hardness", WHY))
        return PressureConductance(self.coefficient, harmonic_mean(*k), harmonic_mean(*hardness))


@dataclass(frozen=True)
class ContactMethod:
    """Contact solver and its parameters.

    Attributes
    ----------
    name : str
        ``"condensed"``: static condensation of the bodies to the interface; ``"pointwise"``: the
        same with contact conditions at each point, without wear, heat and friction; ``"penalty"``
        and ``"nitsche"``: full system.
    penalty : float or None
        Penalty stiffness, by default from the mesh [Pa/m].
    theta : int
        Variant of Nitsche's method: 1 symmetric, 0 incomplete, -1 skew-symmetric.
    gamma : float or None
        Stabilisation parameter of Nitsche's method, in units of ``E degree² / h``.
    """

    name: Literal["condensed", "pointwise", "penalty", "nitsche"] = "condensed"
    penalty: float | None = None
    theta: int = 1
    gamma: float | None = None


@dataclass(frozen=True)
class Interface:
    """Pair of contact faces, and their laws.

    Attributes
    ----------
    faces : tuple of str
        Contact surfaces of body 1 and of body 2.
    bodies : tuple of int
        Indices of these bodies in the model.
    name : str
        Name for results and messages; empty for the only interface of a pair.
    motion : Motion
        Sliding of body 1 over body 2.
    friction : Law
        Coefficient of friction in the direction of sliding.
    friction_factors : Multipliers
        Tabulated factors of the friction.
    friction_history : TimeFunction or None
        Time-dependent factor of the friction.
    transverse_friction : float
        Coefficient of friction across the sliding direction, on inclined faces (mu_d of Páczelt
        and Mróz).
    conductance : Law, HardnessConductance or None
        Contact conductance, without it perfect contact [W/(m² K)].
    gap_conductance : float
        Conductance of separated faces [W/(m² K)].
    partition : float or str
        Fraction of the friction heat released on body 1; ``"effusivity"``: ``e1/(e1 + e2)``.
    wear : mapping of int to FaceWear or CompositeWear
        Wear of both faces by index (0 is body 1); faces that do not wear are left out.
    closes_by_wear : bool
        True if the gap between opposite points closes by wear where faces wear in place, as in
        continued sliding; False if by elastic deflection, as in fretting.
    compliance : float
        Compliance of a soft layer between the faces [m/Pa].
    fluid_pressure : PlaceFunction or None
        Pressure of a fluid on both faces, touching or open, besides that of the contact [Pa].
    initial_shape : str or None
        File with an initial worn shape.
    pressure_degree : int, str or None
        Degree of the pressure space, by default one below the displacement; ``"lobatto"``: nodal
        values at Gauss-Lobatto points.
    method : ContactMethod
    """

    faces: tuple[str, str]
    bodies: tuple[int, int] = (0, 1)
    name: str = ""
    motion: Motion = field(default_factory=Motion)
    friction: Law = field(default_factory=lambda: Constant(0.0))
    friction_factors: Multipliers = field(default_factory=Multipliers)
    friction_history: TimeFunction | None = None
    transverse_friction: float = 0.0
    conductance: Law | HardnessConductance | None = None
    gap_conductance: float = 0.0
    partition: float | Literal["effusivity"] = 0.5
    wear: Mapping[int, Wear] = field(default_factory=dict)
    closes_by_wear: bool = True
    compliance: float = 0.0
    fluid_pressure: PlaceFunction | None = None
    initial_shape: str | None = None
    pressure_degree: int | Literal["lobatto"] | None = None
    method: ContactMethod = field(default_factory=ContactMethod)

    @property
    def table(self) -> str:
        """Table of the case file that describes it, for messages."""
        return self.path("contact")

    def path(self, short: str) -> str:
        """Path of a table or key of the case file, for messages: its table, or a short one.

        Short cases have other tables than that of the contact for its motion, heat and wear.
        """
        return f"contacts.{self.name}" if self.name else short

    @cached_property
    def friction_law(self) -> Law:
        """Friction with its tabulated factors, without its history in time."""
        factors = self.friction_factors
        return Multiplied(self.friction, factors) if factors.variables else self.friction

    @cached_property
    def nominal_friction(self) -> float:
        """Coefficient of friction without its factors; of a law, its value in a typical state."""
        return typical_value(self.friction)

    @property
    def friction_varies(self) -> bool:
        """True if the friction depends on time, temperature, pressure or speed."""
        return bool(self.friction_law.variables) or self.friction_history is not None

    @property
    def varies(self) -> bool:
        """True if friction, wear or conductance depend on temperature, pressure or speed."""
        return (
            not isinstance(self.conductance, Constant | None)
            or bool(self.friction_law.variables)
            or any(wear.varies for wear in self.wear.values())
        )

    @property
    def of_temperature(self) -> list[str]:
        """Kinds of its laws that depend on temperature: friction, wear."""
        laws = [own for wear in self.wear.values() for own in wear.each]
        wear = [v for own in laws for v in (own.law.variables, own.factors.variables)]
        found = {"friction": [self.friction_law.variables], "wear": wear}
        return [kind for kind, each in found.items() if any("T" in names for names in each)]

    @property
    def coated(self) -> bool:
        """True if a face has layers."""
        return any(wear.has_layers for wear in self.wear.values())

    @property
    def worn_through(self) -> Interface:
        """Interface of faces that have lost all their layers."""
        return replace(self, wear={index: own.worn_through for index, own in self.wear.items()})

    @property
    def wearing_in_place(self) -> dict[int, float]:
        """Typical wear rates of the faces that close the gap by wear in place, by index [m/s]."""
        return {
            index: wear.typical_rate(self.nominal_friction)
            for index, wear in self.wear.items()
            if self.closes_by_wear and wear.in_place
        }

    def conductance_law(self, facing: Facing, materials: Mapping[str, Material]) -> Law | None:
        """Contact conductance at the points [W/(m² K)]; None: perfect contact."""
        given = self.conductance
        return given.law(facing, materials) if isinstance(given, HardnessConductance) else given

    def heat_partition(
        self, facing: Facing, materials: Mapping[str, Material]
    ) -> float | np.ndarray:
        """Fraction of the friction heat released into body 1, shape (n,) or uniform."""
        if not isinstance(self.partition, str):
            return self.partition
        e1, e2 = facing.effusivities(materials)
        return e1 / (e1 + e2)
