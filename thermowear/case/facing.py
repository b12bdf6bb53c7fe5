"""The materials of parts of bodies, and of those that touch at points of the contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import CaseError
from .materials import Properties, check_named, resolve_like

if TYPE_CHECKING:
    from .schema import Case

_KEYS = {"effusivity": ("conductivity", "density", "specific_heat")}
"""What properties of a material follow from; others are keys themselves."""


def material_of(case: Case, part: str) -> tuple[str, Properties]:
    """The key's path of the table that has the material of a part, and the material.

    Raises
    ------
    ValueError
        If ``like`` names no body, or comes back to itself.
    """
    geometry, bodies = case.geometry, case.bodies
    owner = geometry.zones.get(part, part)
    name = part if part in bodies else owner
    chosen = geometry.set_of.get(part)
    if chosen is None and not bodies[name].has_own and bodies[name].materials:
        chosen = next(iter(bodies[name].materials))  # all of its cells are in sets
    if chosen is None:
        found = resolve_like(bodies, name)
        return f"bodies.{found}", bodies[found]
    own = bodies[owner].materials[chosen]
    if own.like is None:
        return f"bodies.{owner}.materials.{chosen}", own
    check_named(bodies, own.like)
    found = resolve_like(bodies, own.like)
    return f"bodies.{found}", bodies[found]


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

    def of(self, case: Case, key: str) -> tuple[np.ndarray, np.ndarray]:
        """A property of the materials at the points of both faces, shape (n,) each.

        Raises
        ------
        CaseError
            If a material that touches lacks it.
        """
        first, second = (self._on_face(case, key, at) for at in self.at)
        return first, second

    def _on_face(self, case: Case, key: str, at: np.ndarray) -> np.ndarray:
        values = np.zeros(len(self.parts))
        for index in np.unique(at):
            path, material = material_of(case, self.parts[index])
            for needed in _KEYS.get(key, (key,)):
                if getattr(material, needed) is None:
                    raise CaseError(f"{path}.{needed}: missing; it lies on a contact face")
            values[index] = getattr(material, key)
        return values[at]
