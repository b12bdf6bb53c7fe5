"""A block on a block as a section, and in space: the section extruded, or turned about an axis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from thermowear.geometry.mesh.tagged import TaggedMesh
from thermowear.geometry.meshing.cells import (
    Sheet,
    grid,
    level,
    mesh_body,
    mesh_lattice,
    tagged_bodies,
)

Place = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Meshed:
    """Source of a mesh that is there already."""

    tagged: TaggedMesh
    path: None = None

    def mesh(self, zone):
        return self.tagged

    def expected_zone(self, force, approach, modulus):
        return None


@dataclass(frozen=True)
class Blocks:
    """Section of two blocks that meet at a height 0.

    Surfaces are ``upper_face``, ``upper_end``, ``upper_sides``, and ``lower_face`` and so on; in
    space also ``upper_low`` and ``upper_high``, the ends of the extrusion.

    Attributes
    ----------
    upper, lower : tuple of ndarray
        Ends of the elements along the face, and along the height, increasing [m].
    place : callable
        Map of the section, coordinates (..., 2).
    """

    upper: tuple[np.ndarray, np.ndarray]
    lower: tuple[np.ndarray, np.ndarray]
    place: Place = np.asarray

    def section(self) -> Meshed:
        """Quadrilaterals of the section."""
        bodies = {n: mesh_body([Sheet(grid(*ends))], 1) for n, ends in self._ends.items()}
        tagged = tagged_bodies(bodies, self._levels(1))
        return Meshed(replace(tagged, points=self.place(tagged.points)))

    def extruded(self, ends: np.ndarray, axis: int) -> Meshed:
        """Hexahedra along x (axis 0) or y (1), the height along z."""

        def place(p):
            section, found = self.place(p[..., [1 - axis, 2]]), p.copy()
            found[..., [1 - axis, 2]] = section
            return found

        return self._in_space(ends, axis, place, 1)

    def turned(self, angles: np.ndarray) -> Meshed:
        """Hexahedra of order 2 round the z-axis, the coordinate along the face as the radius.

        Angles up to 2 π make a whole ring, without ends.
        """

        def place(p):
            r, z = np.moveaxis(self.place(p[..., [0, 2]]), -1, 0)
            return np.stack([r * np.cos(p[..., 1]), r * np.sin(p[..., 1]), z], axis=-1)

        return self._in_space(angles, 1, place, 2)

    @property
    def _ends(self):
        return {"upper": self.upper, "lower": self.lower}

    def _in_space(self, ends: np.ndarray, axis: int, place: Place, order: int) -> Meshed:
        bodies = {}
        for name, (along, up) in self._ends.items():
            lattice = (ends, along, up) if axis == 0 else (along, ends, up)
            bodies[name] = mesh_lattice(lattice, order, closed=order > 1 and ends[-1] > 6.0)
        sides = {
            f"{name}_{side}": level(axis, end)
            for name in bodies
            for side, end in (("low", ends[0]), ("high", ends[-1]))
        }
        levels = self._levels(2)
        tagged = tagged_bodies(bodies, sides | levels)
        return Meshed(replace(tagged, points=place(tagged.points)))

    def _levels(self, axis: int):
        return {
            f"{name}_{side}": level(axis, end)
            for name, (_, up) in self._ends.items()
            for side, end in (("face", 0.0), ("end", up[0] if name == "lower" else up[-1]))
        }
