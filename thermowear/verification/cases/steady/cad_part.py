"""Parts from STEP files drawn by OpenCASCADE: mass properties and hot steady states.

A pad with chamfers and slots on a block, two blocks with one-dimensional heat flow, and a quarter
of the ring of special case 8. Contact faces are found, supports are named by points and planes.
"""

from __future__ import annotations

import math
import tempfile
import tomllib
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ....case import load
from ....case.starters import starter_text
from ....errors import CaseNote
from ....geometry.mesh.gmsh_session import gmsh_model, write_step
from ....geometry.mesh.mixed import block_of
from ....geometry.mesh.nodes import slopes
from ....lagrange import gauss
from ....results import Result
from ...check import Check, compare, compare_worst, computed, run_starter
from .annular_punch import AMBIENT, CLOSED_FORM, FORCE
from .ring_in_space import AXISYMMETRIC, STEADY, along_radius

DRAWING, OCC, ONE_DIMENSIONAL = "drawing", "mass properties of OpenCASCADE", "1D heat conduction"
LENGTH, WIDTH, HEIGHT = 60.0, 40.0, 12.0
"""Sizes of the pad along y, x and z [mm]."""
CHAMFER, SLOT = (6.0, 2.0), (4.0, 6.0)
"""Length and depth of the chamfers at both ends; width and depth of the two slots [mm]."""
SLOTS = (-10.0, 10.0)
"""Positions of the slots along y [mm]."""
BLOCK = (60.0, 90.0, 15.0)
"""Sizes of the block below, along x, y and z [mm]."""
LOAD, SPEED, FRICTION, K = 2000.0, 0.5, 0.4, 1e-14
COLD = 293.15
IRON = {"young_modulus": "120 GPa", "poisson_ratio": 0.26, "conductivity": "48 W/(m K)"}
IRON |= {"expansion": "1.1e-5 1/K"}
LINING = {"young_modulus": "1.2 GPa", "poisson_ratio": 0.3, "conductivity": "1.2 W/(m K)"}
LINING |= {"expansion": "1.4e-5 1/K"}


def cad_part() -> Iterator[Check]:
    """Volumes, areas, forces, heat, pressures, temperatures and shape of parts from CAD."""
    with tempfile.TemporaryDirectory() as folder:
        yield from _slotted_pad(Path(folder))
        yield from _blocks(Path(folder))
        yield from _ring(Path(folder))


Draw = Callable[[Any], Any]


def _written(folder: Path, **draws: Draw) -> dict[str, str]:
    """STEP files by the names of the bodies."""
    for name, draw in draws.items():
        with gmsh_model(name) as gmsh:
            draw(gmsh.model.occ)
            gmsh.model.occ.synchronize()
            write_step(gmsh, folder / f"{name}.step")
    return {name: str(folder / f"{name}.step") for name in draws}


def _box(occ, size: tuple[float, float, float], low: float) -> int:
    return occ.addBox(-size[0] / 2, -size[1] / 2, low, *size)


def _draw_pad(occ) -> None:
    pad = _box(occ, (WIDTH, LENGTH, HEIGHT), 0.0)
    long, deep = CHAMFER
    tools = []
    for sign in (-1, 1):
        end = sign * LENGTH / 2
        places = (end, 0.0), (end - sign * long, 0.0), (end, deep)
        points = [occ.addPoint(-WIDTH, y, z) for y, z in places]
        lines = [occ.addLine(points[k - 1], points[k]) for k in range(3)]
        face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
        tools += [e for e in occ.extrude([(2, face)], 2 * WIDTH, 0, 0) if e[0] == 3]
    width, depth = SLOT
    for y in SLOTS:
        tools.append((3, occ.addBox(-WIDTH, y - width / 2, -1.0, 2 * WIDTH, width, depth + 1.0)))
    occ.cut([(3, pad)], tools)


def _tables(files: dict[str, str], surfaces: dict[str, Any], **tables: Any) -> dict[str, Any]:
    """Tables of a block that slides along x on another one, with given temperatures at the ends."""
    first, second = files
    return {
        "model": "3d",
        "geometry": {
            "type": "cad",
            "paths": files,
            "held": "top",
            "fixed": "bottom",
            "surfaces": surfaces,
        },
        "load": {"force": f"{LOAD!r} N"},
        "motion": {"velocity": f"{SPEED!r} m/s"},
        "contact": {"friction": FRICTION},
        "wear": {first: {"coefficient": f"{K!r} 1/Pa", "per": "pressure"}},
        "bodies": {first: LINING, second: IRON},
        "heat": {
            "ambient": f"{COLD} K",
            "temperature": {"top": f"{COLD} K", "bottom": f"{COLD} K"},
        },
        "analysis": {"type": "steady"},
    } | tables


def _slotted_pad(folder: Path) -> Iterator[Check]:
    """Pad with chamfers and slots: its drawing, OpenCASCADE's mass properties, and balances."""
    files = _written(folder, pad=_draw_pad, block=lambda occ: _box(occ, BLOCK, -BLOCK[2]))
    surfaces = {
        "top": {"point": ["3 mm", "20 mm", f"{HEIGHT} mm"]},
        "bottom": {"plane": "z", "at": f"{-BLOCK[2]} mm"},
    }
    mesh = {"degree": 2, "size": "10 mm", "contact_size": "5 mm", "grading": 0.7}
    result = computed(case := load(_tables(files, surfaces, mesh=mesh)))
    tagged = case.tagged_mesh()
    area = WIDTH * (LENGTH - 2 * CHAMFER[0] - len(SLOTS) * SLOT[0])
    lost = CHAMFER[0] * CHAMFER[1] + len(SLOTS) * SLOT[0] * SLOT[1]
    volume = WIDTH * (LENGTH * HEIGHT - lost)
    meshed = 1e9 * _volume(tagged, "pad")
    yield compare("volume of the pad [mm³]", meshed, volume, 1e-9, DRAWING)
    yield compare("volume of the pad [mm³]", meshed, _mass(files["pad"]), 1e-9, OCC)
    face = 1e6 * _area(tagged, "pad_face")
    yield compare("area of the contact face of the pad [mm²]", face, area, 1e-9, DRAWING)
    i, s = result.interface, result.summary
    pressed = LOAD / (1e-6 * area)
    yield compare_worst(
        "pressure at the point of largest deviation [Pa]", i.pressure, pressed, 1e-6, CLOSED_FORM
    )
    heat = FRICTION * LOAD * SPEED
    yield compare("friction power [W]", s["friction_power_W"], heat, 1e-9, CLOSED_FORM)
    into = i.weight @ (i.heat_flux_1 + i.heat_flux_2)
    yield compare("heat into both bodies [W]", into, heat, 1e-9, CLOSED_FORM)
    balance = heat * (1 + s["heat_balance_relative_error"])
    yield compare("heat removed at both ends [W]", balance, heat, 1e-9, CLOSED_FORM)
    yield compare("force on the contact [N]", i.weight @ i.pressure, LOAD, 1e-9, CLOSED_FORM)
    speed = s["rigid_wear_velocity_m_per_s"]
    yield compare(
        "wear velocity of the holder [m/s]", speed, K * pressed * SPEED, 1e-6, CLOSED_FORM
    )


def _blocks(folder: Path) -> Iterator[Check]:
    """Two blocks of one section with meshes that do not match: heat flows along z alone."""
    sizes = {"upper": (20.0, 30.0, 10.0), "lower": (20.0, 30.0, 15.0)}
    files = _written(
        folder,
        upper=lambda occ: _box(occ, sizes["upper"], 0.0),
        lower=lambda occ: _box(occ, sizes["lower"], -sizes["lower"][2]),
    )
    surfaces = {"top": {"plane": "z", "at": "10 mm"}, "bottom": {"plane": "z", "at": "-15 mm"}}
    mesh = {"degree": 2, "size": "8 mm", "bodies": {"lower": {"size": "6 mm"}}}
    i = computed(load(_tables(files, surfaces, mesh=mesh))).interface
    pressure = LOAD / 600e-6
    ways = 1.2 / 10e-3, 48.0 / 15e-3
    rise = FRICTION * pressure * SPEED / sum(ways)
    for name, found in (("upper", i.temperature_1), ("lower", i.temperature_2)):
        quantity = f"temperature rise of the {name} block, largest deviation [K]"
        yield compare_worst(quantity, found - COLD, rise, 1e-7, ONE_DIMENSIONAL)
    flux = np.average(i.heat_flux_2, weights=i.weight)
    yield compare(
        "mean heat flux into the lower block [W/m²]", flux, ways[1] * rise, 1e-8, ONE_DIMENSIONAL
    )


def _draw_quarter(inner: float, outer: float, low: float, high: float) -> Draw:
    """Quarter x, y > 0 of a ring or a cylinder round the z-axis."""

    def draw(occ) -> None:
        whole = occ.addCylinder(0, 0, low, 0, 0, high - low, outer, angle=math.pi / 2)
        if inner > 0.0:
            hole = occ.addCylinder(0, 0, low, 0, 0, high - low, inner, angle=math.pi / 2)
            occ.cut([(3, whole)], [(3, hole)])

    return draw


def _ring(folder: Path) -> Iterator[Check]:
    """Quarter of the ring of special case 8, hot, compared with an axisymmetric run."""
    files = _written(
        folder,
        punch=_draw_quarter(20.0, 120.0, 0.0, 50.0),
        plate=_draw_quarter(0.0, 140.0, -100.0, 0.0),
    )
    tables = tomllib.loads(starter_text(STEADY))
    planes = {
        f"{body}_on_{axis}": {"plane": axis, "at": "0 mm", "body": body}
        for body in files
        for axis in "xy"
    }
    tables |= {
        "model": "3d",
        "geometry": {
            "type": "cad",
            "paths": files,
            "held": "punch_top",
            "fixed": "plate_bottom",
            "rotation_center": ["0 mm", "0 mm"],
            "symmetry": ["punch_on_x", "plate_on_x"],
            "rollers": ["punch_on_y", "plate_on_y"],
            "surfaces": planes
            | {
                "punch_top": {"plane": "z", "at": "50 mm"},
                "plate_bottom": {"plane": "z", "at": "-100 mm"},
            },
        },
        "mesh": {"degree": 2, "size": "25 mm", "contact_size": "10 mm", "grading": 0.25},
        "load": {"force": f"{FORCE / 4!r} N"},
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseNote)  # a sector lacks the twist by friction
        found = computed(load(tables))
    yield from _compared_ring(found, run_starter(STEADY))


def _compared_ring(found: Result, flat: Result) -> Iterator[Check]:
    i = found.interface
    r = np.hypot(i.x, i.y)
    steady = FORCE / (2 * math.pi * 0.1) / r
    quantity = "pressure of the ring, hot, at the point of largest deviation [Pa]"
    yield compare_worst(quantity, i.pressure, steady, 1e-3, CLOSED_FORM)
    for name, values in (("ring", "temperature_1"), ("plate", "temperature_2")):
        quantity = f"temperature rise of the {name}, hot, at the point of largest deviation [K]"
        rises = getattr(i, values) - AMBIENT, along_radius(flat, values, i) - AMBIENT
        yield compare_worst(quantity, *rises, 1e-2, AXISYMMETRIC)
    heights = i.shape - along_radius(flat, "shape", i)
    heights -= np.average(heights, weights=i.weight)
    extent = flat.summary["shape_range_m"]
    quantity = "deviation of the worn shape of the ring from the axisymmetric one, hot [m]"
    yield compare(quantity, np.abs(heights).max(), 0.0, 2e-2, AXISYMMETRIC, extent)
    torque = flat.summary["friction_torque_Nm"] / 4
    quantity = "friction torque of a quarter of the ring, hot [N m]"
    yield compare(quantity, found.summary["friction_torque_Nm"], torque, 1e-4, AXISYMMETRIC)


def _volume(mesh, body: str) -> float:
    """Volume of the curved cells of a body [m³]."""
    block = block_of(mesh, body)
    cells = block.points[block.cells[block.cell_tags == block.tags_of([body])[0]]]
    points, weights = gauss(3 * block.order - 3, block.cell_type)
    tangents = np.einsum("qdk,cki->cqdi", slopes(block.cell_type, block.order, points), cells)
    return float(np.linalg.det(tangents).sum(axis=0) @ weights)


def _area(mesh, surface: str) -> float:
    """Area of the facets of a surface [m²]."""
    facets = mesh.points[mesh.facets_of(surface)]
    points, weights = gauss(2 * mesh.order, mesh.facet_type)
    tangents = np.einsum("qdk,fki->fqdi", slopes(mesh.facet_type, mesh.order, points), facets)
    normals = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    return float(np.linalg.norm(normals, axis=2).sum(axis=0) @ weights)


def _mass(path: str) -> float:
    """Volume of the solid of a STEP file by OpenCASCADE [mm³]."""
    with gmsh_model("mass") as gmsh:
        solids = gmsh.model.occ.importShapes(path, True, "step")
        return float(sum(gmsh.model.occ.getMass(*solid) for solid in solids))
