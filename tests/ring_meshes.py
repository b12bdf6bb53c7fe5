"""Meshes of disk brakes in space, of sectors of rings made by gmsh as its users do.

As a module, ``python3 -m tests.ring_meshes``, it writes the mesh of the starter two-pads-3d.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from thermowear.case import starters
from thermowear.geometry.mesh.gmsh_session import gmsh_model

WHOLE = (-math.pi, math.pi)
_APART = 1e4
"""Distance of the rings as they are meshed: gmsh would unite those that touch."""


@dataclass(frozen=True)
class Ring:
    """Sector of a ring about the z-axis, with hexahedra.

    Attributes
    ----------
    name : str
        Cell set; its surfaces are ``NAME_TOP``, ``NAME_BOTTOM``, ``NAME_INSIDE``, ``NAME_OUTSIDE``
        and, of a part of the circle, ``NAME_START`` and ``NAME_END``. Faces of rings beside the
        one in the middle are ``NAME_TOP_REST`` and ``NAME_BOTTOM_REST``.
    radii : sequence of float
        Ends of its one ring or three of them.
    heights : tuple of float
    angles : tuple of float
        Range about the z-axis [rad].
    cells : tuple of int
        Number of cells along the radius (of the ring in the middle), the angle and the height.
    """

    name: str
    radii: Sequence[float]
    heights: tuple[float, float]
    angles: tuple[float, float]
    cells: tuple[int, int, int]


def write_rings(path: Path, rings: Sequence[Ring], order: int = 2) -> Path:
    """Write rings, which share no nodes, in the unit of their lengths.

    Parameters
    ----------
    path : Path
        The ending selects the format.
    rings : sequence of Ring
    order : int
        Order of the cells.
    """
    with gmsh_model("rings") as gmsh:
        entities = []
        for number, ring in enumerate(rings):
            entities.append(_add(gmsh.model, ring, number * _APART))
        gmsh.option.setNumber("Mesh.ElementOrder", order)
        gmsh.model.mesh.generate(3)
        for number, (ring, own) in enumerate(zip(rings, entities, strict=True)):
            _place(gmsh.model.mesh, ring, own, number * _APART)
        gmsh.write(str(path))
    return path


def _place(mesh, ring: Ring, entities: list[tuple[int, int]], lifted: float) -> None:
    """Move the nodes of a ring to their exact places, those within the ring on circles, too.

    gmsh divides arcs to 1e-9 of their length, and leaves edges inside a plane straight.
    """
    along, around, up = ring.cells
    widths = list(pairwise(ring.radii))
    cells = [along if k == len(widths) // 2 else 1 for k in range(len(widths))]
    radii, angles, heights = (
        np.unique(np.concatenate([np.linspace(*ends, 2 * n + 1) for ends, n in parts]))
        for parts in (
            zip(widths, cells, strict=True),
            [(ring.angles, around)],
            [(ring.heights, up)],
        )
    )
    for entity in entities:
        tags, places, _ = mesh.getNodes(*entity)
        x, y, z = places.reshape(-1, 3).T
        r, a = _nearest(radii, np.hypot(x, y)), _nearest(angles, np.arctan2(y, x))
        exact = np.stack([r * np.cos(a), r * np.sin(a), _nearest(heights, z - lifted)], axis=1)
        for tag, place in zip(tags, exact, strict=True):
            mesh.setNode(tag, place, [])


def _nearest(levels: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Nearest level of each value."""
    return levels[np.abs(values[:, None] - levels).argmin(axis=1)]


def _add(model, ring: Ring, lifted: float) -> list[tuple[int, int]]:
    """Add a ring, and its physical groups, above its place; returns its entities."""
    before, bottom = set(model.getEntities()), ring.heights[0] + lifted
    geo, rings = model.geo, len(ring.radii) - 1
    low, high = ring.angles
    parts = 4 if ring.angles == WHOLE else 1
    ends = [low + (high - low) * k / parts for k in range(parts + 1)]
    along, around, up = ring.cells
    circles = [_circle(geo, radius, bottom, ends, around) for radius in ring.radii]
    faces, places = [], []
    for k, ((starts, inside), (stops, outside)) in enumerate(pairwise(circles)):
        cells = along if k == rings // 2 else 1
        lines = zip(starts, stops, strict=True)
        spokes = [_divided(geo, geo.addLine(*ends_), cells) for ends_ in lines]
        for j in range(parts):
            sides = [spokes[j], outside[j], -spokes[(j + 1) % len(spokes)], -inside[j]]
            faces.append(geo.addPlaneSurface([geo.addCurveLoop(sides)]))
            geo.mesh.setTransfiniteSurface(faces[-1])
            geo.mesh.setRecombine(2, faces[-1])
            places.append(k)
    height = ring.heights[1] - ring.heights[0]
    made = geo.extrude([(2, face) for face in faces], 0, 0, height, [up], recombine=True)
    groups: dict[str, list[int]] = {}
    for face, k, found in zip(faces, places, zip(*[iter(made)] * 6, strict=True), strict=True):
        top, volume, *walls = (tag for _, tag in found)
        rest = "" if k == rings // 2 else "_REST"
        named = {"": volume, f"_TOP{rest}": top, f"_BOTTOM{rest}": face}
        outer = {"_INSIDE": (3, k == 0), "_OUTSIDE": (1, k == rings - 1)}
        outer |= {"_START": (0, parts == 1), "_END": (2, parts == 1)}
        named |= {name: walls[side] for name, (side, is_outer) in outer.items() if is_outer}
        for name, tag in named.items():
            groups.setdefault(name, []).append(tag)
    geo.synchronize()
    for name, tags in groups.items():
        model.addPhysicalGroup(2 if name else 3, tags, name=f"{ring.name}{name}")
    return [entity for entity in model.getEntities() if entity not in before]


def _circle(geo, radius: float, z: float, ends: Sequence[float], cells: int):
    """Points and arcs of a circle; the last point of a whole one is the first."""
    whole = ends[-1] - ends[0] > 2 * math.pi - 1e-9
    center = geo.addPoint(0, 0, z)
    angles = ends[:-1] if whole else ends
    points = [geo.addPoint(radius * math.cos(a), radius * math.sin(a), z) for a in angles]
    following = [*points[1:], points[0]] if whole else points[1:]
    arcs = [
        _divided(geo, geo.addCircleArc(one, center, other), cells // (len(ends) - 1))
        for one, other in zip(points, following, strict=False)
    ]
    return points, arcs


def _divided(geo, curve: int, cells: int) -> int:
    geo.mesh.setTransfiniteCurve(curve, cells + 1)
    return curve


def starter_rings() -> list[Ring]:
    """Pads of different thickness with back plates, and the disk of the starter two-pads-3d."""
    rings, angles = [], (-math.pi / 6, math.pi / 6)
    rings.append(Ring("DISK", (60, 75, 135, 140), (-6, 6), WHOLE, (4, 24, 2)))
    for name, levels in (("UPPER", (6, 20, 25)), ("LOWER", (-6, -15, -20))):
        face, glued, back = levels
        pad, plate = ((min(ends), max(ends)) for ends in ((face, glued), (glued, back)))
        rings.append(Ring(name, (80, 130), pad, angles, (3, 5, 1)))
        rings.append(Ring(f"{name}_PLATE", (78, 132), plate, angles, (2, 4, 1)))
    return rings


STARTER_MESH = Path(starters.__file__).with_name("two-pads-3d.msh")

if __name__ == "__main__":
    write_rings(STARTER_MESH, starter_rings())
