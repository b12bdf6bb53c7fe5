"""Ring on a plate (special case 8) in space, from a mesh file of quadratic tetrahedra.

A quarter between planes of symmetry, and the whole ring. Temperatures and shape are singular at the
rims of the face: the rows of elements shrink towards them. Round the circumference elements may be
long, as the solution is axisymmetric.
"""

from __future__ import annotations

import math
import tempfile
import tomllib
import warnings
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ....case import load
from ....case.starters import starter_text
from ....errors import CaseNote
from ....geometry.mesh.nodes import boundary
from ....geometry.mesh.tagged import compact
from ....geometry.meshing.cells import (
    MeshedBody,
    divided_hexahedra,
    level,
    mesh_lattice,
    tagged_bodies,
)
from ....geometry.meshing.divisions import growing, joined
from ....geometry.reading.export import write_mesh
from ....results import InterfaceFields, Result
from ...check import Check, along, compare, computed, run_starter
from .annular_punch import AMBIENT, CLOSED_FORM, FORCE

AXISYMMETRIC = "axisymmetric run of degree 8"
HEIGHT, PLATE, DEPTH = 0.05, 0.14, 0.1
"""Height of the ring, radius and height of the plate [m]."""
FACE_ENDS = 1e-3 * np.array(
    [20, 20.4, 20.9, 21.6, 22.6, 24.2, 26.6, 30, 35, 42]
    + [51, 63, 77, 91, 101, 108.5, 113.5, 116.8, 118.6, 119.5, 120]
)
"""Ends of the rows of elements [m]: in an element, the pressure is linear, and falls with 1/r."""
EDGE = 1e-3
"""Distance from the rims of the face beyond which running-in is compared: pressures peak there."""
STEADY, RUNNING_IN = "annular-punch", "annular-punch-running-in"
HOT = {
    "motion": {"angular_velocity": "0.02 rad/s"},
    "analysis": {
        "type": "transient",
        "end_time": "50000 s",
        "output_times": ["500 s", "2500 s", "10000 s"],
        "tolerance": 1e-3,
    },
}
"""Running-in with friction heat, stable: perturbations round the ring grow from 0.042 rad/s."""
_ORDER = 2


def ring_3d() -> Iterator[Check]:
    """A quarter: hot steady state, running-in without heat (8T) and with it."""
    yield from _compared(0.25)


def ring_3d_whole() -> Iterator[Check]:
    """The whole ring, twisted by friction: the same states as of a quarter."""
    yield from _compared(1.0)


def _compared(share: float) -> Iterator[Check]:
    """Part of a ring, compared with axisymmetric runs."""
    quarter = share < 1.0
    with tempfile.TemporaryDirectory() as place:
        path = write_ring(Path(place) / "ring.msh", FACE_ENDS, 3 if quarter else 12, not quarter)
        run = partial(in_space, path, quarter=quarter)
        yield from compared_steady(run(STEADY), share)
        yield from compared_running_in(run(RUNNING_IN), run_starter(RUNNING_IN), share, "")
        flat = computed(load(tomllib.loads(starter_text(STEADY)) | HOT))
        yield from compared_running_in(run(STEADY, HOT), flat, share, ", hot")


def in_space(
    path: Path, name: str, changes: dict[str, Any] | None = None, quarter: bool = True
) -> Result:
    """Compute a starter of the ring, with other tables, from a mesh file by `write_ring`."""
    tables = tomllib.loads(starter_text(name)) | (changes or {})
    geometry = {
        "type": "file",
        "path": str(path),
        "bodies": {"punch": "punch", "plate": "plate"},
        "contact": ["punch_face", "plate_face"],
        "held": "punch_top",
        "fixed": "plate_bottom",
        "rotation_center": ["0 mm", "0 mm"],
    }
    if quarter:
        geometry["symmetry"] = ["punch_on_x", "plate_on_x"]
        geometry["rollers"] = ["punch_on_y", "plate_on_y"]
    force = FORCE * (0.25 if quarter else 1.0)
    tables |= {"model": "3d", "geometry": geometry, "mesh": {"degree": 2}}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseNote)  # a sector lacks the twist by friction
        return computed(load(tables | {"load": {"force": f"{force!r} N"}}))


def write_ring(
    path: Path,
    ends: np.ndarray,
    sectors: int,
    whole: bool = False,
    ratio: float = 2.5,
    rows: int = 3,
) -> Path:
    """Write ring and plate, their faces with the same nodes, as tetrahedra of order 2.

    Parameters
    ----------
    path : Path
    ends : ndarray
        Radii of the ends of the elements on the face [m].
    sectors : int
        Number of elements round the circumference.
    whole : bool
        By default a quarter, x, y > 0.
    ratio : float
        Size ratio of successive rows away from the face; the first ones are as thin as the
        narrowest on the face.
    rows : int
        Least number of rows over the height of a body.
    """
    first = float(np.diff(ends).min())
    inside = ends[0] - growing(0.0, ends[0], first, 1 / ratio, ends[0])[::-1]
    outside = growing(ends[-1], PLATE, first, 1 / ratio, PLATE)
    up, down = (growing(0.0, h, first, 1 / ratio, h / rows) for h in (HEIGHT, DEPTH))
    angles = np.linspace(0.0, math.tau if whole else math.tau / 4, sectors + 1)
    bodies = {
        "punch": _turned(ends, angles, up),
        "plate": _turned(joined(inside, ends, outside), angles, -down[::-1]),
    }
    levels = {"punch_face": (2, 0.0), "punch_top": (2, HEIGHT)}
    levels |= {"plate_face": (2, 0.0), "plate_bottom": (2, -DEPTH)}
    if not whole:
        levels |= {f"{body}_on_{axis}": (k, 0.0) for body in bodies for k, axis in enumerate("xy")}
    mesh = tagged_bodies(bodies, {name: level(*at) for name, at in levels.items()})
    write_mesh(compact(replace(mesh, cell_type="tetrahedron")), path)
    return path


def _turned(radii: np.ndarray, angles: np.ndarray, heights: np.ndarray) -> MeshedBody:
    """Tetrahedra of a section turned about the axis."""

    def place(p):
        r, angle, z = np.moveaxis(p, -1, 0)
        return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)

    closed = angles[-1] > 6.0
    body = mesh_lattice((radii, angles, heights), _ORDER, place, closed)
    body = divided_hexahedra(body, _ORDER)
    counts = _ORDER * (len(radii) - 1) + 1, _ORDER * (len(angles) - 1) + (not closed)
    return body if radii[0] > 0.0 else _merged_on_axis(body, counts)


def _merged_on_axis(body: MeshedBody, counts: tuple[int, int]) -> MeshedBody:
    """Body with one node for all that lie on the axis; cells that become flat are left out.

    Edges that then have the same ends are merged too: of the nodes in the first row of elements,
    those on diagonals move to the next ray.

    Parameters
    ----------
    body : MeshedBody
        Divided lattice of order 2 that begins on the axis.
    counts : tuple of int
        Number of its nodes along the radius and round the axis.
    """
    shape = (*counts, len(body.points) // math.prod(counts))
    row, ray, height = np.indices(shape).reshape(3, -1)
    ray[row == 0] = 0
    ray[row == 1] = (ray[row == 1] + 1) // 2 * 2 % (counts[1] + counts[1] % 2)
    cells = np.ravel_multi_index((row, ray, height), shape)[body.cells]
    corners = np.sort(cells[:, :4], axis=1)
    cells = cells[np.all(np.diff(corners, axis=1) > 0, axis=1)]
    return MeshedBody(body.points, cells, boundary("tetrahedron", _ORDER, cells))


def compared_steady(found: Result, share: float) -> Iterator[Check]:
    """Steady state, compared with the axisymmetric one at every point."""
    flat, i = run_starter(STEADY), found.interface
    heights, extent = i.shape - along_radius(flat, "shape", i), flat.summary["shape_range_m"]
    heights -= np.average(heights, weights=i.weight)
    where, part = "at the point of largest deviation", _part(share)
    at = int(np.abs(heights).argmax())
    known = along_radius(flat, "shape", i)[at]
    quantity = f"worn shape, hot, {where}, {part} [m]"
    yield compare(quantity, known + heights[at], known, 1e-2, AXISYMMETRIC, extent)
    for quantity, values, exact, allowed in (
        ("temperature rise", i.temperature_1, along_radius(flat, "temperature_1", i), 5e-3),
        (
            "temperature rise of the plate",
            i.temperature_2,
            along_radius(flat, "temperature_2", i),
            5e-3,
        ),
    ):
        rises = values - AMBIENT, exact - AMBIENT
        yield _worst(f"{quantity}, hot, {where}, {part} [K]", *rises, allowed, AXISYMMETRIC)
    steady = FORCE / (2 * math.pi * (FACE_ENDS[-1] - FACE_ENDS[0])) / _radius(i)
    quantity = f"pressure, hot, {where}, {part} [Pa]"
    yield _worst(quantity, i.pressure, steady, 1e-3, CLOSED_FORM)
    for quantity, key, of_whole in (
        ("friction torque, hot, {} [N m]", "friction_torque_Nm", share),
        ("wear velocity of the holder, hot, {} [m/s]", "rigid_wear_velocity_m_per_s", 1.0),
    ):
        known = of_whole * flat.summary[key]
        yield compare(quantity.format(part), found.summary[key], known, 1e-3, AXISYMMETRIC)


def compared_running_in(found: Result, flat: Result, share: float, note: str) -> Iterator[Check]:
    """Histories at every point up to `EDGE` from the rims."""
    states, known = (
        result.outputs | {result.history[-1].time: result.interface} for result in (found, flat)
    )
    for time, i in states.items():
        exact = replace(flat, interface=known[time])
        r, end = _radius(i), f"{note}, {_part(share)}"
        chosen = (r > FACE_ENDS[0] + EDGE) & (r < FACE_ENDS[-1] - EDGE)
        for quantity, name in (("pressure [Pa]", "pressure"), ("wear depth [m]", "wear_1")):
            what, _, unit = quantity.rpartition(" ")
            quantity = f"{what} at {time:g} s at the point of largest deviation{end} {unit}"
            values = getattr(i, name)[chosen], along_radius(exact, name, i)[chosen]
            yield _worst(quantity, *values, 1e-2, AXISYMMETRIC)
        if np.isfinite(i.temperature_1).all():
            rises = i.temperature_1 - AMBIENT, along_radius(exact, "temperature_1", i) - AMBIENT
            quantity = f"temperature rise at {time:g} s at the point of largest deviation{end} [K]"
            yield _worst(quantity, *rises, 5e-3, AXISYMMETRIC)
        lost = share * (known[time].weight @ known[time].wear_1)
        quantity = f"worn volume at {time:g} s{end} [m³]"
        yield compare(quantity, i.weight @ i.wear_1, lost, 1e-3, AXISYMMETRIC)


def _part(share: float) -> str:
    return "whole ring" if share == 1.0 else "quarter of the ring"


def _radius(interface: InterfaceFields) -> np.ndarray:
    return np.hypot(interface.x, interface.y)


def along_radius(flat: Result, name: str, interface: InterfaceFields) -> np.ndarray:
    """Values of an axisymmetric run at the radii of points in space."""
    return along(flat.interface, _radius(interface), getattr(flat.interface, name))


def _worst(quantity: str, found, known, allowed: float, source: str) -> Check:
    """Comparison at the point of the largest relative deviation."""
    at = int(np.abs(found / known - 1.0).argmax())
    return compare(quantity, found[at], known[at], allowed, source)
