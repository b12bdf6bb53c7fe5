"""Condensed contact, Nitsche's method and the penalty method: patch test, and agreement."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ....case import load
from ....case.tables.geometry import Geometry
from ....case.tables.plane_geometry import PlaneGeometry
from ....geometry.meshing.cells import (
    Claim,
    MeshedBody,
    Sheet,
    grid,
    level,
    mesh_body,
    tagged_bodies,
)
from ....results import Result
from ...check import Check, compare, compare_each, compare_worst, computed, run_starter

SOURCE = "Taylor and Papadopoulos 1991, NAFEMS CGS-1: a uniform stress solves the problem exactly"
WIDTH, HEIGHTS, PRESSURE = 0.04, (0.02, 0.03), 50e6
MODULI = (200e9, 70e9)
FACES = (("matching", (4, 4), 1e-10), ("not matching", (4, 7), 1e-3))
"""Label, numbers of elements along the contact, and tolerance."""
METHODS, PENALTY = ("condensed", "nitsche", "penalty"), 1e15
CONDENSED = "same case with condensed contact"
THEORY = "penalty error proportional to 1/penalty (Kikuchi and Oden, Contact Problems, 1988, ch. 3)"
HALF_WIDTH = 0.496e-3
COMPARED = {
    "hertz": ((0.0, 0.95 * HALF_WIDTH), (1e16, 1e17, 1e18)),
    "annular punch": ((0.025, 0.115), (1e14, 1e15, 1e16)),
}
"""Range of the compared pressures, and penalties."""
_PUNCH = ("analysis.type=initial", "mesh.degree=6", "mesh.elements=16")


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


def patch() -> Iterator[Check]:
    """Pressure at every point, and approach, for Poisson's ratio 0."""
    for method, cells, degree, (faces, columns, allowed) in itertools.product(
        METHODS, ("quadrilaterals", "triangles"), (1, 2, 3, 4), FACES
    ):
        geometry = PatchGeometry(columns=columns, triangles=cells == "triangles")
        note = f"{cells}, degree {degree}, {faces}"
        yield from patch_checks(geometry, "plane-strain", method, degree, note, allowed)


def patch_checks(
    geometry: Geometry, model: str, method: str, degree: int, note: str, allowed: float
) -> Iterator[Check]:
    """Pressure and approach of two blocks by a method."""
    materials = zip(geometry.bodies, MODULI, strict=True)
    stiff = {"penalty": f"{PENALTY} Pa/m"} if method == "penalty" else {}
    tables = {
        "title": "contact patch test",
        "model": model,
        "geometry": geometry,
        "mesh": {"degree": degree},
        "bodies": {
            name: {"young_modulus": f"{E} Pa", "poisson_ratio": 0.0} for name, E in materials
        },
        "load": {"mean_pressure": f"{PRESSURE} Pa"},
        "contact": {"method": method} | stiff,
        "analysis": {"type": "initial"},
    }
    result, note = computed(load(tables)), f"{method}, {note}"
    quantity = f"pressure at the point of largest deviation, {note} [Pa]"
    yield compare_worst(quantity, result.interface.pressure, PRESSURE, allowed, SOURCE)
    shortened = PRESSURE * sum(h / E for h, E in zip(HEIGHTS, MODULI, strict=True))
    shortened += PRESSURE / PENALTY if stiff else 0.0
    approach = result.summary["approach_m"]
    yield compare(f"approach, {note} [m]", approach, shortened, allowed, SOURCE)


def methods_agree() -> Iterator[Check]:
    """Pressure away from edges; convergence order of the penalty error."""
    for case, (ends, penalties) in COMPARED.items():
        x = np.linspace(*ends, 400)
        condensed = _solved(case, "condensed")
        compared = {
            f"Nitsche, theta = {theta}": _solved(case, "nitsche", f"contact.theta={theta}")
            for theta in (1, 0, -1)
        }
        stiff = [_solved(case, "penalty", f"contact.penalty={p} Pa/m") for p in penalties]
        compared[f"penalty {penalties[-1]:g} Pa/m"] = stiff[-1]
        for note, result in compared.items():
            found, known = (
                np.interp(x, i.x, i.pressure) for i in (result.interface, condensed.interface)
            )
            quantity = f"pressure at the point of largest deviation, {note}, {case} [Pa]"
            yield compare_worst(quantity, found, known, 1e-3, CONDENSED)
        approaches = np.array([result.summary["approach_m"] for result in stiff])
        slopes = -np.diff(np.log10(approaches - condensed.summary["approach_m"]))
        quantity = f"slope of the approach, penalty from {{:g}} Pa/m, {case} [1]"
        yield from compare_each(quantity, penalties[:-1], slopes, (1.0, 1.0), 0.1, THEORY)


def _solved(case: str, method: str, *overrides: str) -> Result:
    """Unworn contact of a starter case by a method."""
    keys = f"contact.method={method}", *overrides
    if case == "hertz":
        return run_starter("cylinder-on-block", 'load={force="2230 N"}', "mesh.elements=16", *keys)
    return run_starter("annular-punch", *keys, *_PUNCH, without=("heat",))
