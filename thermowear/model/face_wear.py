"""Wear of a contact face: one law, or one for each of its materials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..errors import CaseError
from ..laws.distribution import IN_PLACE, Distribution, InPlace
from ..laws.expressions import Region
from ..laws.formulas import typical_value
from ..laws.interfaces import Law, LocalState, Multipliers
from ..laws.wear import law_by_point, layers_of
from .tracks import Track


@dataclass(frozen=True)
class FaceWear:
    """Wear of one face.

    Attributes
    ----------
    law : Law
        A `LayeredWear` for a face with layers.
    factors : Multipliers
        Tabulated factors of the rate, by the temperature of the face, the pressure and the speed.
    friction_exponent : float
        Exponent of the coefficient of friction in a law per friction stress; 0 in other laws.
    track : Distribution or Track
        In place, at a constant duty factor, or along a track that passes the contact.
    per : str or None
        Stress that a coefficient of wear multiplies, for the summary; None for other laws.
    """

    law: Law
    factors: Multipliers = field(default_factory=Multipliers)
    friction_exponent: float = 0.0
    track: Distribution | Track = IN_PLACE
    per: str | None = None

    @property
    def each(self) -> tuple[FaceWear, ...]:
        """The different laws of the face."""
        return (self,)

    @property
    def in_place(self) -> bool:
        """True if the face wears where it is pressed."""
        return isinstance(self.track, InPlace)

    def distribution(
        self, points: np.ndarray, weights: np.ndarray, thickness: float
    ) -> Distribution:
        """Distribution of the wear at contact points.

        Parameters
        ----------
        points : ndarray, shape (n, gdim) [m]
        weights : ndarray, shape (n,) [m²]
        thickness : float
            Thickness of a plane model; 1 in the others [m].
        """
        if isinstance(self.track, Distribution):
            return self.track
        return self.track.distribution(points, weights, thickness)

    @property
    def varies(self) -> bool:
        """True if the rate depends on temperature or depth, or has tabulated factors.

        The law of each layer counts, not the passage from one to the next.
        """
        variables = layers_of(self.law).inner_variables
        return bool(variables & {"T", "depth"} or self.factors.variables)

    @property
    def has_layers(self) -> bool:
        """True if the face is coated."""
        return bool(layers_of(self.law).thickness)

    @property
    def worn_through(self) -> FaceWear:
        """Wear of the face without its layers."""
        return replace(self, law=layers_of(self.law).substrate) if self.has_layers else self

    def typical_rate(self, friction: float) -> float:
        """Wear rate in a typical state [m/s]."""
        return typical_value(self.law, friction)

    def factor(self, at: LocalState, relative_friction: np.ndarray | None) -> np.ndarray:
        """Factor of the rate at points (n,) by tables and by the friction, over its nominal one."""
        found = self.factors.value(at)
        if self.friction_exponent and relative_friction is not None:
            found = found * relative_friction**self.friction_exponent
        return found

    def law_at(self, groups: np.ndarray) -> Law:
        """Law of the contact points, from the group of the material at each (n,)."""
        return self.law

    def group_of(self, part: str) -> int | None:
        """Group of a part of the body: the index of its law in `each`; None without a law."""
        return 0

    def stress_by_part(self, body: str) -> dict[str, str]:
        """Stress that the coefficient multiplies, by the name of the body, for the summary."""
        return {} if self.per is None else {body: self.per}


@dataclass(frozen=True)
class CompositeWear:
    """Wear of a face of several materials, each in place by its own law, all as one body.

    Attributes
    ----------
    parts : mapping of str to FaceWear
        Wear by part of the body; in place, without layers.
    regions : mapping of str to (Region, FaceWear)
        Regions of the face whose wear takes the place of that of the part, by name.
    """

    parts: Mapping[str, FaceWear]
    regions: Mapping[str, tuple[Region, FaceWear]] = field(default_factory=dict)

    @property
    def _named(self) -> dict[str, FaceWear]:
        """Wear by part and by region."""
        return {**self.parts, **{name: wear for name, (_, wear) in self.regions.items()}}

    def __post_init__(self) -> None:
        coated = [part for part, wear in self._named.items() if wear.has_layers]
        if coated:
            raise CaseError(f"wear of {coated[0]}: a face of several materials may have no layers")

    @cached_property
    def each(self) -> tuple[FaceWear, ...]:
        """The different laws of the face."""
        different: list[FaceWear] = []
        for wear in (*self.parts.values(), *(wear for _, wear in self.regions.values())):
            if wear not in different:
                different.append(wear)
        return tuple(different)

    @property
    def in_place(self) -> bool:
        """True: no face of several materials wears along a track."""
        return True

    def distribution(
        self, points: np.ndarray, weights: np.ndarray, thickness: float
    ) -> Distribution:
        """Distribution of the wear at contact points: in place."""
        return IN_PLACE

    @property
    def has_layers(self) -> bool:
        """False: no face of several materials is coated."""
        return False

    @property
    def worn_through(self) -> CompositeWear:
        """Wear without layers: the same, as it has none."""
        return self

    @property
    def varies(self) -> bool:
        """True if any of the rates does."""
        return any(wear.varies for wear in self.each)

    def typical_rate(self, friction: float) -> float:
        """Mean of the wear rates in a typical state [m/s]."""
        return float(np.mean([wear.typical_rate(friction) for wear in self.each]))

    def law_at(self, groups: np.ndarray) -> Law:
        """Law of the contact points, from the group of the material at each (n,)."""
        return law_by_point([wear.law for wear in self.each], groups)

    def group_of(self, part: str) -> int | None:
        """Group of a part of the body: the index of its law in `each`; None without a law."""
        return self.each.index(self.parts[part]) if part in self.parts else None

    def stress_by_part(self, body: str) -> dict[str, str]:
        """Stress that a coefficient multiplies, by part, for the summary."""
        found = {part: wear.per for part, wear in self.parts.items()}
        found |= {f"{body}.{name}": wear.per for name, (_, wear) in self.regions.items()}
        return {part: per for part, per in found.items() if per is not None}


Wear = FaceWear | CompositeWear
"""Wear of one face."""
