"""Materials of the parts of the bodies that touch at the points of a contact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...errors import CaseError
from .materials import Properties

_KEYS = {"effusivity": ("conductivity", "density", "specific_heat")}
"""What properties of a material follow from; others are keys themselves."""

Materials = Callable[[str], tuple[str, Properties]]
"""Key's path and material of a part, by its name."""


@dataclass(frozen=True)
class Facing:
    """The parts that touch at the points of a contact.

    Attributes
    ----------
    parts : tuple of str
        Names of parts.
    at : tuple of ndarray of int, shape (n,)
        Which of them bears the face of body 1 and of body 2 at each point.
    """

    parts: tuple[str, ...]
    at: tuple[np.ndarray, np.ndarray]

    def of(self, materials: Materials, key: str) -> tuple[np.ndarray, np.ndarray]:
        """A property of the materials at the points of both faces, shape (n,) each.

        Raises
        ------
        CaseError
            If a material that touches lacks it.
        """
        first, second = (self._on_face(materials, key, at) for at in self.at)
        return first, second

    def _on_face(self, materials: Materials, key: str, at: np.ndarray) -> np.ndarray:
        values = np.zeros(len(self.parts))
        for index in np.unique(at):
            path, material = materials(self.parts[index])
            for needed in _KEYS.get(key, (key,)):
                if getattr(material, needed) is None:
                    raise CaseError(f"{path}.{needed}: missing; it lies on a contact face")
            values[index] = getattr(material, key)
        return values[at]
