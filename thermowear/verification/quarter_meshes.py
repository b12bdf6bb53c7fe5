"""Mesh files of Hertzian contacts in space, as a user would make them with gmsh.

A quarter (x, y > 0) of two bodies that touch at the origin, lengths in mm. They are meshed
independently with curved tetrahedra: the triangles of their faces do not match.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..geometry.mesh.gmsh_session import gmsh_model

NAMES = {
    "length_unit": "1 mm",
    "bodies": {"upper": "UPPER", "lower": "LOWER"},
    "contact": ["UPPER_FACE", "LOWER_FACE"],
    "held": "UPPER_END",
    "fixed": "LOWER_END",
    "symmetry": ["X0"],
    "rollers": ["Y0"],
}
"""Keys of the geometry, but for the path."""
_FACE = 1.5
"""Half-axes of the contact faces over those of the contact."""
_GROWTH = 0.35
"""Increase of the element size per distance."""
_PER_TURN = 12
"""Number of elements round a circle far from the contact."""
_FLAT = 1e-6
"""Tolerance for positions of planes [mm]."""

Shape = Callable[..., list[tuple[int, int]]]
"""Draws a quarter of a body with gmsh's OpenCASCADE kernel."""


@dataclass(frozen=True)
class QuarterPair:
    """Shapes of two bodies; the upper one is held at its top, the lower one fixed at its bottom.

    Attributes
    ----------
    upper, lower : callable
    top, bottom : float
        Levels z of the planes where they are held [mm].
    """

    upper: Shape
    lower: Shape
    top: float
    bottom: float


def sphere_on_block(radius: float, block: float) -> QuarterPair:
    """Half sphere on a round block of equal radius and depth [mm]."""

    def upper(occ):
        ball = occ.addSphere(0, 0, radius, radius)
        # its poles, where gmsh's parameters degenerate, and its seam lie outside the quarter
        occ.rotate([(3, ball)], 0, 0, radius, 1, 1, 0, -math.pi / 2)
        return _common(occ, ball, occ.addBox(0, 0, 0, radius, radius, radius))

    def lower(occ):
        return [(3, occ.addCylinder(0, 0, -block, 0, 0, block, block, angle=math.pi / 2))]

    return QuarterPair(upper, lower, radius, -block)


def crossed_cylinders(upper: float, lower: float) -> QuarterPair:
    """Half cylinders of given radii along y (upper) and along x (lower), of equal length [mm]."""
    length = max(upper, lower)

    def along_y(occ):
        whole = occ.addCylinder(0, 0, upper, 0, length, 0, upper)
        return _common(occ, whole, occ.addBox(0, 0, 0, upper, length, upper))

    def along_x(occ):
        whole = occ.addCylinder(0, 0, -lower, length, 0, 0, lower)
        return _common(occ, whole, occ.addBox(0, 0, -lower, length, lower, lower))

    return QuarterPair(along_y, along_x, upper, -lower)


@dataclass(frozen=True)
class MeshSizes:
    """Element sizes round a contact.

    Attributes
    ----------
    half_axes : tuple of float
        Half-axes of the expected contact along x and y [mm].
    inside, edge : float
        Element size in the contact and at its edge, by the smaller half-axis.
    largest : float [mm]
    """

    half_axes: tuple[float, float]
    inside: float
    edge: float
    largest: float = 4.0

    def expression(self) -> str:
        """Element size as gmsh's ``MathEval``."""
        a, b = self.half_axes
        unit = min(a, b)
        beyond = f"{unit}*(Sqrt((x/{a})^2+(y/{b})^2+(z/{unit})^2)-1)"
        outside = f"0.5*({beyond}+Fabs({beyond}))"
        beside = f"{unit}*(Sqrt((x/{a})^2+(y/{b})^2)-1)"
        return (
            f"min(min({self.largest},{self.inside * unit}+{_GROWTH}*{outside}),"
            f"{self.edge * unit}+{_GROWTH}*Sqrt(({beside})^2+z^2))"
        )


def write_pair(path: Path, pair: QuarterPair, sizes: MeshSizes, order: int = 2) -> Path:
    """Mesh two bodies with cells of an order and write them to one file."""
    with gmsh_model("pair") as gmsh:
        parts = {
            "UPPER": (_with_core(gmsh.model.occ, pair.upper, sizes), pair.top),
            "LOWER": (_with_core(gmsh.model.occ, pair.lower, sizes), pair.bottom),
        }
        gmsh.model.occ.synchronize()
        groups: dict[str, list[int]] = {}
        for name, (volumes, end) in parts.items():
            gmsh.model.addPhysicalGroup(3, volumes, name=name)
            for surface, tag in _surfaces(gmsh.model, name, volumes, end):
                groups.setdefault(surface, []).append(tag)
        for surface, tags in groups.items():
            gmsh.model.addPhysicalGroup(2, tags, name=surface)
        field = gmsh.model.mesh.field
        field.setString(field.add("MathEval", 1), "F", sizes.expression())
        field.setAsBackgroundMesh(1)
        settings = {"MeshSizeFromPoints": 0, "MeshSizeExtendFromBoundary": 0, "Algorithm": 6}
        settings |= {"MeshSizeFromCurvature": _PER_TURN, "HighOrderOptimize": 1}
        for key, value in (settings | {"ElementOrder": order}).items():
            gmsh.option.setNumber(f"Mesh.{key}", value)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))
    return path


def _common(occ, body: int, box: int) -> list[tuple[int, int]]:
    return occ.intersect([(3, body)], [(3, box)])[0]


def _with_core(occ, shape: Shape, sizes: MeshSizes) -> list[int]:
    """Volumes of a body divided by an elliptical cylinder that bounds the contact face."""
    a, b = (_FACE * axis for axis in sizes.half_axes)
    depth = max(a, b)
    body = shape(occ)
    cylinder = occ.addCylinder(0, 0, -depth, 0, 0, 2 * depth, 1.0)
    occ.dilate([(3, cylinder)], 0, 0, 0, a, b, 1.0)
    core = _common(occ, cylinder, occ.addBox(0, 0, -depth, a, b, 2 * depth))
    divided, (own, *_) = occ.fragment(body, core)
    occ.remove([part for part in divided if part not in own], recursive=True)
    return [tag for _, tag in own]


def _surfaces(model, body: str, volumes: list[int], end: float):
    """Names and tags of the planes of symmetry, the end and the contact face of a body."""
    closest = min(volumes, key=lambda tag: abs(model.occ.getCenterOfMass(3, tag)[2]))
    core = {tag for _, tag in model.getBoundary([(3, closest)], oriented=False)}
    planes = {"X0": (0, 0.0), "Y0": (1, 0.0), f"{body}_END": (2, end)}
    outside = model.getBoundary([(3, tag) for tag in volumes], combined=True, oriented=False)
    for _, tag in outside:
        corners = [
            model.getValue(0, point, [])
            for _, point in model.getBoundary([(2, tag)], recursive=True)
        ]
        for name, (axis, level) in planes.items():
            if all(abs(corner[axis] - level) < _FLAT for corner in corners):
                yield name, tag
                break
        else:
            if tag in core:
                yield f"{body}_FACE", tag
