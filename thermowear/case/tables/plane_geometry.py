"""Base classes of geometries for plane models."""

from __future__ import annotations

from typing import ClassVar

from ..values.section import Switch
from ..values.units import Length
from .geometry import Geometry, keyed


class PlaneGeometry(Geometry):
    """Base of geometries for plane models.

    Attributes
    ----------
    thickness : float
        Thickness that forces refer to [m].
    """

    name: ClassVar[str] = ""

    thickness: Length = 1e-3

    @keyed
    def thickness_factor(self) -> float | None:
        return self.thickness


class HalvableGeometry(PlaneGeometry):
    """Base of plane geometries with optional symmetry about x = 0.

    Attributes
    ----------
    half : bool
        Mesh only x >= 0; bodies and loads are symmetric about x = 0.
    """

    name: ClassVar[str] = ""

    half: Switch = False

    @keyed
    def thickness_factor(self) -> float | None:
        return 2 * self.thickness if self.half else self.thickness
