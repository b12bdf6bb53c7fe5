"""Materials of the two faces at the contact points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from .material import Material

WHY = "the material lies on a contact face"


@dataclass(frozen=True)
class Facing:
    """Parts of the bodies that face each other at the contact points.

    Attributes
    ----------
    parts : tuple of str
        Names of the parts.
    at : tuple of ndarray of int, shape (n,)
        Index of the part that bears the face of body 1 and of body 2 at each point.
    """

    parts: tuple[str, ...]
    at: tuple[np.ndarray, np.ndarray]

    def of(
        self, materials: Mapping[str, Material], value: Callable[[Material], float]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Material property at the points of both faces, shape (n,) each.

        Parameters
        ----------
        materials : mapping of str to Material
            Materials by part.
        value : callable
            Property of a material.
        """
        first, second = (self._on_face(materials, value, at) for at in self.at)
        return first, second

    def effusivities(self, materials: Mapping[str, Material]) -> tuple[np.ndarray, np.ndarray]:
        """Thermal effusivities at the points of both faces [W sqrt(s)/(m² K)].

        Raises
        ------
        CaseError
            If a material on a contact face does not define what it follows from.
        """
        return self.of(materials, lambda material: material.effusivity(WHY))

    def _on_face(
        self,
        materials: Mapping[str, Material],
        value: Callable[[Material], float],
        at: np.ndarray,
    ) -> np.ndarray:
        values = np.zeros(len(self.parts))
        for index in np.unique(at):
            values[index] = value(materials[self.parts[index]])
        return values[at]
