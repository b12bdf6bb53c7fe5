"""Contact patch test: two distorted blocks of equal width transmit a uniform pressure exactly."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from ...case import load
from ...case.tables.plane_geometry import PlaneGeometry
from ...geometry.mesh.gmsh_session import gmsh_model, tagged_mesh
from ...geometry.meshing.blocks import Interval, add_grid
from ..check import Check, compare, compare_worst
from ..starter import computed

SOURCE = "Taylor and Papadopoulos 1991, NAFEMS CGS-1: a uniform stress solves the problem exactly"
WIDTH, HEIGHTS, PRESSURE = 0.04, (0.02, 0.03), 50e6
MODULI = (200e9, 70e9)
FACES = (("matching", (4, 4), 1e-10), ("not matching", (4, 7), 1e-3))
"""Label, numbers of elements along the contact, and tolerance."""
METHODS, PENALTY = ("condensed", "nitsche", "penalty"), 1e15


class PatchGeometry(PlaneGeometry):
    """Two stacked blocks with traction-free sides.

    Attributes
    ----------
    columns : tuple of int
        Number of elements along the contact of each body.
    triangles : bool
    """

    bodies = ("upper", "lower")
    surfaces = ("upper_face", "upper_end", "lower_face", "lower_end")
    models = ("plane-strain", "plane-stress")
    held = "upper_end"
    fixed = "lower_end"

    type: str = "patch"
    columns: tuple[int, int]
    triangles: bool

    def contact_area(self) -> float:
        return WIDTH * self.thickness

    def build(self, mesh, zone=None):
        with gmsh_model("patch") as gmsh:
            spans = ((0.0, HEIGHTS[0]), (-HEIGHTS[1], 0.0))
            upper, lower = (
                add_grid(gmsh.model, [Interval(0.0, WIDTH, n)], [Interval(*span, 3)])
                for n, span in zip(self.columns, spans, strict=True)
            )
            gmsh.model.geo.synchronize()
            for name, grid in (("upper", upper), ("lower", lower)):
                gmsh.model.addPhysicalGroup(2, grid.surfaces, name=name)
            curves = (upper.bottom, upper.top, lower.top, lower.bottom)
            for name, curve in zip(self.surfaces, curves, strict=True):
                gmsh.model.addPhysicalGroup(1, curve, name=name)
            gmsh.model.mesh.generate(2)
            if self.triangles:
                gmsh.model.mesh.splitQuadrangles(1.0)
            tagged = tagged_mesh(gmsh.model, self.bodies, self.surfaces)
        tagged.points[:] = _distorted(tagged.points)
        return tagged


def _distorted(points: np.ndarray) -> np.ndarray:
    """Points displaced inside the blocks and along the faces."""
    x, y = points.T
    within = np.sin(np.pi * x / WIDTH)
    rows = np.sin(np.pi * y / np.where(y > 0, HEIGHTS[0], HEIGHTS[1]))
    moved = 0.06 * WIDTH * within * np.cos(7 * x / WIDTH + 150 * y)
    raised = 0.1 * HEIGHTS[0] * rows * np.cos(9 * x / WIDTH + 3)
    return points + np.column_stack([moved, raised])


def patch() -> Iterator[Check]:
    """Pressure at every point, and approach, for Poisson's ratio 0."""
    for method, cells, degree, (faces, columns, allowed) in itertools.product(
        METHODS, ("quadrilaterals", "triangles"), (1, 2, 3, 4), FACES
    ):
        materials = zip(PatchGeometry.bodies, MODULI, strict=True)
        stiff = {"penalty": f"{PENALTY} Pa/m"} if method == "penalty" else {}
        tables = {
            "title": "contact patch test",
            "model": "plane-strain",
            "geometry": PatchGeometry(columns=columns, triangles=cells == "triangles"),
            "mesh": {"degree": degree},
            "bodies": {
                name: {"young_modulus": f"{E} Pa", "poisson_ratio": 0.0} for name, E in materials
            },
            "load": {"mean_pressure": f"{PRESSURE} Pa"},
            "contact": {"method": method} | stiff,
            "analysis": {"type": "initial"},
        }
        result, note = computed(load(tables)), f"{method}, {cells}, degree {degree}, {faces}"
        quantity = f"pressure at the point of largest deviation, {note} [Pa]"
        yield compare_worst(quantity, result.interface.pressure, PRESSURE, allowed, SOURCE)
        shortened = PRESSURE * sum(h / E for h, E in zip(HEIGHTS, MODULI, strict=True))
        shortened += PRESSURE / PENALTY if stiff else 0.0
        approach = result.summary["approach_m"]
        yield compare(f"approach, {note} [m]", approach, shortened, allowed, SOURCE)
