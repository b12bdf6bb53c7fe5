"""Contact patch test: two distorted blocks of equal width transmit a uniform pressure exactly."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...case import load
from ...case.tables.plane_geometry import PlaneGeometry
from ...geometry.meshing.cells import (
    Claim,
    MeshedBody,
    Sheet,
    grid,
    level,
    mesh_body,
    tagged_bodies,
)
from ...results import Result
from ..check import Check, compare, compare_worst
from ..computed import computed

SOURCE = "Taylor and Papadopoulos 1991, NAFEMS CGS-1: a uniform stress solves the problem exactly"
WIDTH, HEIGHTS, PRESSURE = 0.04, (0.02, 0.03), 50e6
MODULI = (200e9, 70e9)
MATCHING, OTHER = (4, 4), (4, 7)
METHODS = ("condensed", "nitsche", "penalty")


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
        spans = {"upper": (0.0, HEIGHTS[0]), "lower": (-HEIGHTS[1], 0.0)}
        bodies: dict[str, MeshedBody] = {}
        claims: dict[str, Claim] = {}
        for (name, span), n in zip(spans.items(), self.columns, strict=True):
            ends = np.linspace(0.0, WIDTH, n + 1), np.linspace(*span, 4)
            bodies[name] = mesh_body([Sheet(grid(*ends))], order=1)
            claims |= {f"{name}_face": level(1, 0.0), f"{name}_end": level(1, sum(span))}
        tagged = tagged_bodies(bodies, claims)
        if self.triangles:
            halves = tagged.cells[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
            tags = np.repeat(tagged.cell_tags, 2)
            tagged = replace(tagged, cell_type="triangle", cells=halves, cell_tags=tags)
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


def checks() -> Iterator[Check]:
    """Pressure at every point, and approach."""
    for method, triangles, degree in itertools.product(METHODS, (False, True), (1, 2, 3, 4)):
        for columns, allowed in ((MATCHING, 1e-10), (OTHER, 1e-3)):
            yield from _patch(method, triangles, degree, columns, allowed)


def _patch(method, triangles: bool, degree: int, columns, allowed: float) -> Iterator[Check]:
    result = patch(method, triangles, degree, columns)
    cells = "triangles" if triangles else "quadrilaterals"
    faces = "matching" if columns == MATCHING else "not matching"
    note = f"{method}, {cells}, degree {degree}, {faces}"
    quantity = f"pressure at the point of largest deviation, {note} [Pa]"
    yield compare_worst(quantity, result.interface.pressure, PRESSURE, allowed, SOURCE)
    shortened = PRESSURE * sum(h / E for h, E in zip(HEIGHTS, MODULI, strict=True))
    if method == "penalty":
        shortened += PRESSURE / PENALTY
    approach = result.summary["approach_m"]
    yield compare(f"approach, {note} [m]", approach, shortened, allowed, SOURCE)


PENALTY = 1e15


def patch(method: str, triangles: bool, degree: int, columns: tuple[int, int]) -> Result:
    """Contact of the two blocks under a mean pressure, for Poisson's ratio 0."""
    materials = zip(PatchGeometry.bodies, MODULI, strict=True)
    contact: dict = {"method": method}
    if method == "penalty":
        contact["penalty"] = f"{PENALTY} Pa/m"
    tables = {
        "title": "contact patch test",
        "model": "plane-strain",
        "geometry": PatchGeometry(columns=columns, triangles=triangles),
        "mesh": {"degree": degree},
        "bodies": {
            name: {"young_modulus": f"{E} Pa", "poisson_ratio": 0.0} for name, E in materials
        },
        "load": {"mean_pressure": f"{PRESSURE} Pa"},
        "contact": contact,
        "analysis": {"type": "initial"},
    }
    return computed(load(tables))
