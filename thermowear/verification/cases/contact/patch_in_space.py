"""Patch test in space: two blocks of hexahedra or tetrahedra under uniform pressure."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ....case.tables.geometry import Geometry
from ....geometry.mesh.mixed import joined
from ....geometry.mesh.tagged import TaggedMesh
from ....geometry.meshing.cells import (
    divided_hexahedra,
    level,
    mesh_lattice,
    tagged_bodies,
)
from ...check import Check
from .contact_methods import HEIGHTS, METHODS, patch_checks

SIZE = (0.04, 0.03)
CHECKED = (*METHODS, "pointwise")
FACES = (("matching", (3, 3)), ("not matching", (2, 3)))
"""Label, and number of elements along x of each body; along y one fewer."""
DISCRETISATIONS = ((1, 1), (1, 2), (2, 2))
"""Orders of the cells, and degrees of the displacement."""
MIXED = (("tetrahedra", "hexahedra"), ("hexahedra", "tetrahedra"))
MIXED_ORDERS = ((1, 1), (1, 2), (2, 2))
MIXED_COLUMNS = (4, 3), (2, 3)
"""Cells of the upper and lower body where they differ, their orders, and elements along x."""


class PatchInSpace(Geometry):
    """Two stacked blocks with traction-free sides.

    Attributes
    ----------
    columns : tuple of int
        Number of elements along x of each body.
    orders : tuple of int
        Order of the cells of each body, curved inside the blocks and along matching faces.
    tetrahedra : tuple of bool
        For each body, False for hexahedra.
    """

    bodies = ("upper", "lower")
    surfaces = ("upper_face", "upper_end", "lower_face", "lower_end")
    models = ("3d",)
    press_direction = (0.0, 0.0, -1.0)
    held = "upper_end"
    fixed = "lower_end"

    type: str = "patch-3d"
    columns: tuple[int, int]
    orders: tuple[int, int]
    tetrahedra: tuple[bool, bool]

    def contact_area(self) -> float:
        return SIZE[0] * SIZE[1]

    def build(self, mesh, zone=None):
        alike = len(set(zip(self.columns, self.orders, self.tetrahedra, strict=True))) == 1
        return joined([self._block(body, alike) for body in (0, 1)])

    def _block(self, body: int, on_face: bool) -> TaggedMesh:
        """Mesh of one of the bodies, distorted also along the contact face on request."""
        name, n, order = self.bodies[body], self.columns[body], self.orders[body]
        span = ((0.0, HEIGHTS[0]), (-HEIGHTS[1], 0.0))[body]
        limits = (0.0, SIZE[0], n + 1), (0.0, SIZE[1], n), (*span, 3)
        meshed = mesh_lattice([np.linspace(*ends) for ends in limits], order)
        kind = "hexahedron"
        if self.tetrahedra[body]:
            meshed, kind = divided_hexahedra(meshed, order), "tetrahedron"
        claims = {f"{name}_face": level(2, 0.0), f"{name}_end": level(2, sum(span))}
        tagged = tagged_bodies({name: meshed}, claims)
        tagged.points[:] = _distorted(tagged.points, on_face)
        return replace(tagged, cell_type=kind)


def _distorted(points: np.ndarray, on_faces: bool) -> np.ndarray:
    """Points displaced inside the blocks, and along the faces on request."""
    x, y, z = points.T
    within = np.sin(np.pi * x / SIZE[0]) * np.sin(np.pi * y / SIZE[1])
    rows = np.sin(np.pi * z / np.where(z > 0, *HEIGHTS))
    along = within if on_faces else within * rows
    moved = 2e-3 * along * np.cos(60 * y), 1.5e-3 * along * np.cos(50 * x + 1)
    return points + np.column_stack([*moved, 1e-3 * within * rows * np.cos(50 * x + 40 * y)])


def patch_3d() -> Iterator[Check]:
    """Pressure at every point, and approach, for Poisson's ratio 0."""
    for method, cells, (order, degree), (faces, columns) in itertools.product(
        CHECKED, ("hexahedra", "tetrahedra"), DISCRETISATIONS, FACES
    ):
        geometry = PatchInSpace(
            columns=columns, orders=(order, order), tetrahedra=(cells == "tetrahedra",) * 2
        )
        note = f"{cells} of order {order}, degree {degree}, {faces}"
        yield from patch_checks(geometry, "3d", method, degree, note, 1e-10)
    for method, (upper, lower), orders, columns in itertools.product(
        CHECKED, MIXED, MIXED_ORDERS, MIXED_COLUMNS
    ):
        geometry = PatchInSpace(
            columns=columns,
            orders=orders,
            tetrahedra=(upper == "tetrahedra", lower == "tetrahedra"),
        )
        cells = f"{upper} of order {orders[0]} on {lower} of order {orders[1]}"
        note = f"{cells}, {columns[0]} on {columns[1]} columns"
        yield from patch_checks(geometry, "3d", method, max(orders), note, 1e-10)
