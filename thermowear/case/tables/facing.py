"""Materials of the two faces at the contact points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...errors import CaseError
from .materials import Properties

_KEYS = {"effusivity": ("conductivity", "density", "specific_heat")}
"""Keys of a material that a derived property follows from; other properties are keys themselves."""

Materials = Callable[[str], tuple[str, Properties]]
"""Function from the name of a part to the key's path and the material of the part."""


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

    def of(self, materials: Materials, key: str) -> tuple[np.ndarray, np.ndarray]:
        """Material property at the points of both faces, shape (n,) each.

        Raises
        ------
        CaseError
            If a material on a contact face does not define it.
        """
        first, second = (self._on_face(materials, key, at) for at in self.at)
        return first, second

    def _on_face(self, materials: Materials, key: str, at: np.ndarray) -> np.ndarray:
        values = np.zeros(len(self.parts))
        for index in np.unique(at):
            path, material = materials(self.parts[index])
            for needed in _KEYS.get(key, (key,)):
                if getattr(material, needed) is None:
                    raise CaseError(
                        f"{path}.{needed}: missing; the material lies on a contact face"
                    )
            values[index] = getattr(material, key)
        return values[at]
