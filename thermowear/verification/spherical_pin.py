"""Mesh file of a quarter of a pin with a spherical end on a round block.

Both faces have the same triangles: bodies with a common flat face are meshed by gmsh, and the end
of the pin is rounded afterwards. The contact face ends at the sharp edge of the side of the pin, so
that it can be worn off wholly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..geometry.mesh.gmsh_session import gmsh_model
from ..geometry.mesh.nodes import boundary
from ..geometry.mesh.tagged import TaggedMesh
from ..geometry.meshing.cells import Claim, MeshedBody, every, tagged_bodies
from ..geometry.reading.export import write_mesh

NAMES = {
    "bodies": {"pin": "pin", "block": "block"},
    "contact": ["pin_face", "block_face"],
    "held": "pin_top",
    "fixed": "block_bottom",
    "symmetry": ["pin_x0", "block_x0"],
    "rollers": ["pin_y0", "block_y0"],
}
"""Keys of the geometry, but for the path."""
_GROWTH = 0.35
"""Increase of the element size per distance from the face."""
_SAME = 1e-6
"""Tolerance of positions, relative to the radius of the pin."""


@dataclass(frozen=True)
class SphericalPin:
    """Dimensions of a pin with a spherical end and of the block below it.

    Attributes
    ----------
    sphere : float
        Radius of the end [m].
    radius, height : float
        Of the pin [m].
    block : tuple of float
        Radius and depth of the block [m].
    size : float
        Size of the elements at the face [m].
    order : int
        Order of the tetrahedra.
    """

    sphere: float
    radius: float
    height: float
    block: tuple[float, float]
    size: float
    order: int = 2

    def rise(self, away: np.ndarray) -> np.ndarray:
        """Height of the end at distances from the axis [m]."""
        return away**2 / (self.sphere + np.sqrt(self.sphere**2 - away**2))

    def finer(self, factor: float) -> SphericalPin:
        """Pin of the same dimensions with smaller elements."""
        return replace(self, size=self.size / factor)

    def write(self, path: Path) -> TaggedMesh:
        """Write the mesh to a file, and return it."""
        bodies = self._meshed()
        pin, away = bodies["pin"].points, np.hypot(*bodies["pin"].points[:, :2].T)
        part = 1 - pin[:, 2] / self.height
        rounded = pin + np.outer(self.rise(away) * part, (0.0, 0.0, 1.0))
        bodies["pin"] = replace(bodies["pin"], points=rounded)
        mesh = replace(tagged_bodies(bodies, self._claims()), cell_type="tetrahedron")
        write_mesh(mesh, path)
        return mesh

    def write_section(self, path: Path) -> None:
        """Write a section of both bodies by an axis along y, of triangles, to a file."""
        unit, (radius, depth) = 1.0, self.block
        corners = {
            "pin": [(0.0, 0.0), (self.radius, float(self.rise(np.array(self.radius))))]
            + [(self.radius, self.height), (0.0, self.height)],
            "block": [(0.0, 0.0), (0.0, -depth), (radius, -depth), (radius, 0.0)]
            + [(self.radius, 0.0)],
        }
        sides = {
            "pin": ("face", "side", "top", ""),
            "block": ("", "bottom", "side", "rest", "face"),
        }
        with gmsh_model("section") as gmsh:
            geo, model = gmsh.model.geo, gmsh.model
            for body, places in corners.items():
                points = [geo.addPoint(x / unit, y / unit, 0.0) for x, y in places]
                center = geo.addPoint(0.0, self.sphere, 0.0)
                lines = []
                for k, name in enumerate(sides[body]):
                    ends = points[k], points[(k + 1) % len(points)]
                    arc = (body, name) == ("pin", "face")
                    add = geo.addCircleArc(ends[0], center, ends[1]) if arc else geo.addLine(*ends)
                    lines.append(add)
                    if name:
                        model.addPhysicalGroup(1, [add], name=f"{body}_{name}")
                surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
                model.addPhysicalGroup(2, [surface], name=body)
            geo.synchronize()
            field = model.mesh.field.add("MathEval")
            away = f"Sqrt(x*x+y*y)-{self.radius!r}"
            size = f"{self.size!r}+{_GROWTH}*0.5*({away}+Fabs({away}))"
            model.mesh.field.setString(field, "F", size)
            model.mesh.field.setAsBackgroundMesh(field)
            for option in ("FromPoints", "ExtendFromBoundary"):
                gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
            model.mesh.generate(2)
            model.mesh.setOrder(self.order)
            gmsh.write(str(path))

    def _meshed(self) -> dict[str, MeshedBody]:
        """Both bodies with a common flat face; gmsh computes in radii of the pin."""
        unit, (radius, depth) = self.radius, self.block
        height, radius, depth = self.height / unit, radius / unit, depth / unit
        with gmsh_model("pin") as gmsh:
            occ, mesh = gmsh.model.occ, gmsh.model.mesh
            pin = occ.addCylinder(0, 0, 0, 0, 0, height, 1.0, angle=math.pi / 2)
            block = occ.addCylinder(0, 0, -depth, 0, 0, depth, radius, angle=math.pi / 2)
            occ.fragment([(3, pin)], [(3, block)])
            occ.synchronize()
            away = "0.5*(Sqrt(x*x+y*y+z*z)-1+Fabs(Sqrt(x*x+y*y+z*z)-1))"
            field = mesh.field.add("MathEval")
            mesh.field.setString(field, "F", f"{self.size / unit!r}+{_GROWTH}*{away}")
            mesh.field.setAsBackgroundMesh(field)
            for option in ("FromPoints", "ExtendFromBoundary"):
                gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
            mesh.generate(3)
            mesh.setOrder(self.order)
            return {name: _read(mesh, tag, self.order, unit) for name, tag in _tags(occ)}

    def _claims(self) -> dict[str, Claim]:
        """Predicates of all surfaces, see `tagged_bodies`."""
        near = _SAME * self.radius

        def on(axis: int, value: float) -> Claim:
            return lambda p: np.all(np.abs(p[..., axis] - value) < near, axis=1)

        def on_end(p: np.ndarray) -> np.ndarray:
            rise = self.rise(np.minimum(np.hypot(p[..., 0], p[..., 1]), self.radius))
            return np.all(np.abs(p[..., 2] - rise) < near, axis=1)

        def under_pin(p: np.ndarray) -> np.ndarray:
            inside = np.hypot(p[..., 0], p[..., 1]) < self.radius + near
            return np.all(inside & (np.abs(p[..., 2]) < near), axis=1)

        return {
            **{"pin_x0": on(0, 0.0), "pin_y0": on(1, 0.0), "pin_top": on(2, self.height)},
            **{"pin_face": on_end, "pin_side": every},
            **{"block_x0": on(0, 0.0), "block_y0": on(1, 0.0), "block_face": under_pin},
            **{"block_bottom": on(2, -self.block[1]), "block_rest": on(2, 0.0)},
            "block_side": every,
        }


def _tags(occ) -> list[tuple[str, int]]:
    """Names and tags of the volumes: the pin is above."""
    volumes = [tag for _, tag in occ.getEntities(3)]
    volumes.sort(key=lambda tag: occ.getCenterOfMass(3, tag)[2], reverse=True)
    return list(zip(("pin", "block"), volumes, strict=True))


def _read(mesh, tag: int, order: int, unit: float) -> MeshedBody:
    """Tetrahedra of a volume."""
    nodes = mesh.getElements(3, tag)[2][0].reshape(-1, (order + 1) * (order + 2) * (order + 3) // 6)
    used, cells = np.unique(nodes, return_inverse=True)
    numbers, places, _ = mesh.getNodes()
    at = np.argsort(numbers)[np.searchsorted(np.sort(numbers), used)]
    cells = cells.reshape(nodes.shape).astype(np.int64)
    return MeshedBody(
        unit * places.reshape(-1, 3)[at], cells, boundary("tetrahedron", order, cells)
    )
