"""Curved tetrahedra of one body by gmsh, refined around a round contact."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...errors import CaseError
from ..mesh.gmsh_session import gmsh_model
from ..mesh.nodes import boundary, turned
from .cells import MeshedBody
from .divisions import check_count

MOST_TETRAHEDRA = 1_000_000
"""Largest number of tetrahedra of a body."""
_GROWTH = 0.35
"""Increase of the element size per distance from the contact."""
_PER_CUBE = 8.0
"""Number of tetrahedra in a cube of their size."""
_PER_TURN = 16
"""Number of elements round a circle far from the contact."""
_TETRAHEDRON = {1: 4, 2: 11}
"""Element types of gmsh by order."""

Draw = Callable[..., None]
"""Draw a body with gmsh's OpenCASCADE kernel in a length unit: ``draw(occ)``."""


@dataclass(frozen=True)
class RoundZone:
    """Element sizes around a round contact in the plane z = 0.

    Attributes
    ----------
    center : float
        Distance of its centre from the origin, along x [m].
    radius : float [m]
    inside : float
        Element size in the middle [m].
    edge : float
        Element size at its edge [m].
    largest : float
        Largest element size of the body [m].
    """

    center: float
    radius: float
    inside: float
    edge: float
    largest: float

    def expressions(self, unit: float) -> tuple[str, str]:
        """Sizes due to the contact and to its edge, as gmsh's ``MathEval``, in a length unit."""
        center, radius, inside, edge = (
            f"({value / unit!r})" for value in (self.center, self.radius, self.inside, self.edge)
        )
        beside = f"(Sqrt((x-{center})*(x-{center})+y*y)-{radius})"
        outside = f"(0.5*({beside}+Fabs({beside})))"
        from_zone = f"Sqrt({outside}*{outside}+z*z)"
        from_edge = f"Sqrt({beside}*{beside}+z*z)"
        return f"{inside}+{_GROWTH}*{from_zone}", f"{edge}+{_GROWTH}*{from_edge}"

    def cells(self, volume: float) -> float:
        """Estimate of the number of tetrahedra of a body of a volume [m³]."""
        far = np.geomspace(1e-3 * self.edge, max(self.largest / _GROWTH, self.radius), 400)
        size = np.minimum(self.inside + _GROWTH * far, self.largest)
        near_edge = np.minimum(self.edge + _GROWTH * far, self.inside)
        within = math.pi * self.radius**2 / self.inside**2
        shells = np.trapezoid(2 * math.pi * (self.radius + far) ** 2 / size**3, far)
        tori = np.trapezoid(2 * math.pi**2 * self.radius * far / near_edge**3, far[:])
        tori -= np.trapezoid(2 * math.pi**2 * self.radius * far / self.inside**3, far)
        return _PER_CUBE * (within + shells + max(tori, 0.0) + volume / self.largest**3)


def mesh_solid(draw: Draw, zone: RoundZone, volume: float, order: int, unit: float) -> MeshedBody:
    """Mesh a solid by gmsh.

    Parameters
    ----------
    draw : callable
        Draws the solid, all lengths divided by `unit`.
    zone : RoundZone
    volume : float
        Volume of the solid, for an estimate of the number of cells [m³].
    order : int
        Order of the cells, 1 or 2.
    unit : float
        Length in which gmsh computes, as its tolerances are absolute [m].

    Raises
    ------
    CaseError
        If there were too many cells, or gmsh fails.
    """
    check_count(zone.cells(volume), most=MOST_TETRAHEDRA)
    with gmsh_model("solid") as gmsh:
        draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        _set_sizes(gmsh, zone, unit)
        try:
            gmsh.model.mesh.generate(3)
            gmsh.model.mesh.setOrder(order)
            if order > 1:
                gmsh.model.mesh.optimize("HighOrder")
        except Exception as trouble:  # gmsh raises nothing more specific
            raise CaseError(f"geometry: gmsh could not mesh the body: {trouble}") from None
        return _read(gmsh.model, order, unit)


def _set_sizes(gmsh, zone: RoundZone, unit: float) -> None:
    fields = gmsh.model.mesh.field
    parts = []
    for expression in zone.expressions(unit):
        parts.append(fields.add("MathEval"))
        fields.setString(parts[-1], "F", expression)
    least = fields.add("Min")
    fields.setNumbers(least, "FieldsList", parts)
    fields.setAsBackgroundMesh(least)
    settings = {
        "MeshSizeMin": 0.3 * zone.edge / unit,
        "MeshSizeMax": zone.largest / unit,
        "MeshSizeFromPoints": 0,
        "MeshSizeExtendFromBoundary": 0,
        "MeshSizeFromCurvature": _PER_TURN,
        "Algorithm": 6,
        "Algorithm3D": 1,
        "Optimize": 1,
    }
    for name, value in settings.items():
        gmsh.option.setNumber(f"Mesh.{name}", value)


def _read(model, order: int, unit: float) -> MeshedBody:
    """Tetrahedra of a meshed model, and their boundary."""
    kinds, _, nodes = model.mesh.getElements(3)
    if list(kinds) != [_TETRAHEDRON[order]]:
        raise CaseError("geometry: gmsh could not mesh the body with tetrahedra")
    tags, coordinates, _ = model.mesh.getNodes()
    count = (order + 1) * (order + 2) * (order + 3) // 6
    used, cells = np.unique(nodes[0].astype(np.int64), return_inverse=True)
    row = np.empty(int(tags.max()) + 1, dtype=np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = unit * coordinates.reshape(-1, 3)[row[used]]
    cells = cells.reshape(-1, count).astype(np.int64)
    sides = points[cells[:, 1:4]] - points[cells[:, :1]]
    inverted = np.linalg.det(sides) < 0
    cells[inverted] = cells[inverted][:, turned("tetrahedron", order)]
    return MeshedBody(points, cells, boundary("tetrahedron", order, cells))
