"""Body: its materials and supports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from .material import Material


@dataclass(frozen=True)
class Body:
    """Elastic and heat-conducting body.

    Attributes
    ----------
    name : str
    materials : mapping of str to Material
        Materials by part of the mesh; the first part has the name of the body.
    fixed : tuple of str
        Clamped surfaces, also the one on the rigid holder.
    rollers : tuple of str
        Surfaces that cannot move along y, but freely along x.
    surfaces : tuple of str
        Named surfaces.
    ring : float
        Volume of the body relative to that in the model: a rotating body whose whole ring passes
        under another one that covers a sector conducts, stores and cools as a whole.
    """

    name: str
    materials: Mapping[str, Material]
    fixed: tuple[str, ...] = ()
    rollers: tuple[str, ...] = ()
    surfaces: tuple[str, ...] = ()
    ring: float = 1.0

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of the parts of the mesh."""
        return tuple(self.materials)

    @property
    def compliance(self) -> float:
        """Plane-strain compliance of the body's own material [1/Pa]."""
        return self.materials[self.name].compliance
