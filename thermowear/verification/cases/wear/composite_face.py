"""Face of several materials (composite face), each wearing by its own linear law, all as one body.

At a uniform speed every material wears as fast as the whole, ``V = k_i p_i v``: the pressures are
``p_i = p̄ k_eff / k_i`` with ``1/k_eff = Σ (A_i / A) / k_i``. If body 2 wears, too, k_i is the sum
of both coefficients at a place.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ....case import load
from ....geometry.mesh.tagged import TaggedMesh, compact
from ....geometry.meshing.cells import (
    MeshedBody,
    Sheet,
    divided_hexahedra,
    grid,
    level,
    mesh_body,
    mesh_lattice,
    tagged_bodies,
)
from ....geometry.reading.export import write_mesh
from ....results import Result
from ...check import Check, compare, compare_worst, computed

SOURCE = "closed form: equal wear rates, p_i = p̄ k_eff/k_i"
START, BORDER, END = 0.02, 0.03, 0.05
"""Ends of the face, and the border between its materials [m]."""
DEPTH, HEIGHT = 0.02, 0.01
"""Extent of the bodies along y in space, and their height [m]."""
PRESSURE, SPEED = 2e6, 0.1
"""Mean pressure [Pa] and sliding speed [m/s]."""
COEFFICIENTS = {"upper": 2e-14, "insert": 7e-14, "lower": 3e-14, "inlay": 5e-15}
"""Wear coefficients by material [1/Pa]; the insert and the inlay lie behind the border."""
MODULI = {"upper": 4e9, "insert": 1e9, "lower": 20e9, "inlay": 60e9}
"""Young's moduli by material [Pa]."""
_ELEMENTS = 4, 6
"""Numbers of elements before and behind the border."""


@dataclass(frozen=True)
class Composite:
    """Case of two blocks of two materials each.

    Attributes
    ----------
    model : str
    cells : str
        Type of the cells.
    bodies : tuple of str
        Bodies that wear.
    """

    model: str
    cells: str = "quadrilateral"
    bodies: tuple[str, ...] = ("upper",)

    @property
    def note(self) -> str:
        """Short description."""
        who = "body 1 wears" if self.bodies == ("upper",) else "both bodies wear"
        return f"{self.model}, {self.cells}s, {who}"

    def run(self, analysis: dict[str, Any], **tables: Any) -> Result:
        """Compute an analysis on a mesh file with the materials as cell sets."""
        with tempfile.TemporaryDirectory() as place:
            path = Path(place) / "blocks.msh"
            write_mesh(compact(self.mesh()), path)
            return computed(load(self.tables(path) | tables | {"analysis": analysis}))

    def tables(self, path: Path) -> dict[str, Any]:
        """Tables of the case, without its analysis."""
        sets = {"upper": ["upper", "insert"], "lower": ["lower", "inlay"]}
        geometry = {
            "type": "file",
            "path": str(path),
            "bodies": sets,
            "contact": ["upper_face", "lower_face"],
            "held": "upper_end",
            "fixed": "lower_end",
        }
        if self.model == "plane-strain":
            geometry["thickness"] = f"{DEPTH} m"
        solids = {
            name: {"young_modulus": f"{E} Pa", "poisson_ratio": 0.3} for name, E in MODULI.items()
        }
        turns = self.model == "axisymmetric"  # its wear shall not depend on the speed
        laws: dict[str, dict[str, Any]] = {
            name: {"coefficient": f"{k * SPEED} (m/s)/Pa", "velocity_exponent": 0.0}
            if turns
            else {"coefficient": f"{k} 1/Pa"}
            for name, k in COEFFICIENTS.items()
        }
        return {
            "model": self.model,
            "geometry": geometry,
            "mesh": {"degree": 2},
            "bodies": {
                body: {"materials": {name: solids[name] for name in names}}
                for body, names in sets.items()
            },
            "wear": {
                body: {"materials": {name: laws[name] | {"per": "pressure"} for name in sets[body]}}
                for body in self.bodies
            },
            "motion": {"angular_velocity": "1 rad/s"} if turns else {"velocity": f"{SPEED} m/s"},
            "load": {"force": f"{PRESSURE * self.area} N"},
        }

    def mesh(self) -> TaggedMesh:
        """Mesh of both bodies, with matching faces."""
        spans = {"upper": (0.0, HEIGHT), "lower": (-HEIGHT, 0.0)}
        names = zip(spans.items(), ("insert", "inlay"), strict=True)
        bodies = {body: self._block(span, zone) for (body, span), zone in names}
        vertical = 2 if self.model == "3d" else 1
        claims = {f"{body}_face": level(vertical, 0.0) for body in spans}
        claims |= {f"{body}_end": level(vertical, sum(span)) for body, span in spans.items()}
        return replace(tagged_bodies(bodies, claims), cell_type=self.cells)

    def _block(self, span: tuple[float, float], zone: str) -> MeshedBody:
        before = np.linspace(START, BORDER, _ELEMENTS[0] + 1)
        behind = np.linspace(BORDER, END, _ELEMENTS[1] + 1)
        rows = np.linspace(*span, 3)
        if self.model != "3d":
            return mesh_body([Sheet(grid(before, rows)), Sheet(grid(behind, rows), zone=zone)], 1)
        body = mesh_lattice((np.append(before, behind[1:]), np.linspace(0.0, DEPTH, 3), rows), 2)
        if self.cells == "tetrahedron":
            body = divided_hexahedra(body, 2)
        middle = body.points[body.cells, 0].mean(axis=1)
        return replace(body, zones={zone: np.flatnonzero(middle > BORDER)})

    @property
    def areas(self) -> np.ndarray:
        """Areas of both materials, shape (2,) [m²]."""
        if self.model == "axisymmetric":
            return math.pi * np.diff(np.square([START, BORDER, END]))
        return DEPTH * np.diff([START, BORDER, END])

    @property
    def area(self) -> float:
        """Area of the face [m²]."""
        return float(self.areas.sum())

    @property
    def coefficients(self) -> np.ndarray:
        """Sum of the coefficients of both bodies in front of and behind the border (2,) [1/Pa]."""
        pairs = {"upper": ("upper", "insert"), "lower": ("lower", "inlay")}
        each = [[COEFFICIENTS[name] for name in pairs[body]] for body in self.bodies]
        return np.sum(each, axis=0)

    @property
    def effective(self) -> float:
        """Coefficient of the whole face, k_eff [1/Pa]."""
        return self.area / float(np.sum(self.areas / self.coefficients))

    def pressure(self, result: Result) -> np.ndarray:
        """Steady pressure at the contact points of a result, twice at the border, (n,) [Pa]."""
        x, found = result.interface.x, result.interface.pressure
        before, behind = PRESSURE * self.effective / self.coefficients
        at_border = np.where(found > PRESSURE, max(before, behind), min(before, behind))
        exact = np.where(x < BORDER, before, behind)
        return np.where(np.abs(x - BORDER) < 1e-9, at_border, exact)


STEADY = (
    Composite("plane-strain"),
    Composite("plane-strain", bodies=("upper", "lower")),
    Composite("axisymmetric"),
    Composite("3d", "hexahedron"),
    Composite("3d", "tetrahedron"),
    Composite("3d", "hexahedron", ("upper", "lower")),
)
RUNNING_IN = (
    Composite("plane-strain"),
    Composite("plane-strain", bodies=("upper", "lower")),
    Composite("axisymmetric"),
    Composite("3d", "hexahedron"),
)
TIME = 4e4
"""Duration of the running-in [s]; body 1 loses 3 % of its height, and its mesh follows.

Where both bodies wear, their faces form a step, which remains in the gap.
"""


def composite_face() -> Iterator[Check]:
    """Steady pressures at every point, and the state at the end of the running-in."""
    for case in STEADY:
        result = case.run({"type": "steady"})
        yield from _compared(case, result, "steady", 1e-9)
    for case in RUNNING_IN:
        analysis = {"type": "transient", "end_time": f"{TIME} s", "tolerance": 1e-3}
        yield from _compared(case, case.run(analysis), "after running-in", 1e-3)


def _compared(case: Composite, result: Result, state: str, allowed: float) -> Iterator[Check]:
    i, steady = result.interface, case.effective * PRESSURE * SPEED
    note = f"{state}, {case.note}"
    quantity = f"pressure at the point of largest deviation, {note} [Pa]"
    yield compare_worst(quantity, i.pressure, case.pressure(result), allowed, SOURCE)
    quantity = f"wear rate at the point of largest deviation, {note} [m/s]"
    yield compare_worst(quantity, i.wear_rate_1 + i.wear_rate_2, steady, allowed, SOURCE)
    carried = float(i.weight @ i.pressure)
    yield compare(f"force, {note} [N]", carried, PRESSURE * case.area, 1e-9, "equilibrium")
