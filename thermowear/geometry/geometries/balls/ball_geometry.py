"""Base of the geometries of a ball in space: its lower half, of curved tetrahedra."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ....case.tables.geometry import Geometry, keyed
from ....case.values.section import Switch
from ....case.values.units import Length
from ...meshing.cells import MeshedBody
from ...meshing.tetrahedra import mesh_solids

_ORDER = 2
"""Largest cell order; never above the displacement degree, so that rigid rotations are exact."""


class BallGeometry(Geometry):
    """Base class: a ball on another body, pressed along -z, each with a surface ``NAME_middle``.

    Attributes
    ----------
    radius : float
        Radius of the ball [m].
    half : bool
        Mesh only y >= 0; bodies and loads are symmetric about y = 0, and forces are those on the
        meshed half.
    """

    models = ("3d",)
    press_direction = (0.0, 0.0, -1.0)
    along_paths = False

    radius: Length
    half: Switch = False

    @keyed
    def rollers(self) -> tuple[str, ...]:
        return tuple(f"{body}_middle" for body in self.bodies) if self.half else ()

    def meshed(
        self, mesh, zones: Mapping[str, Any], drawing: Callable[[tuple[str, ...]], Callable]
    ) -> dict[str, MeshedBody]:
        """Mesh the bodies, together where they have equal elements.

        Parameters
        ----------
        mesh : thermowear.case.tables.schema.Mesh
        zones : mapping
            Element sizes by body, as of `mesh_solids`.
        drawing : callable
            Function that draws some of the bodies, by their names.
        """
        order = min(mesh.degree, _ORDER)
        one, other = (mesh.face(body) for body in self.bodies)
        groups = [zones] if one == other else [{name: each} for name, each in zones.items()]
        bodies: dict[str, MeshedBody] = {}
        for group in groups:
            bodies |= mesh_solids(drawing(tuple(group)), group, order, self.radius)
        return bodies
