"""Draw the parts of the starter ``cad-pad``: a caliper pad and a brake disk, as STEP files.

    scripts/env python3 demos/cad_pad.py FOLDER

The lining has chamfers at both ends and a slot in the middle; the piston leaves its mark on the
back plate. Solids and faces have labels, as CAD programs write them.
"""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path

import gmsh
import numpy as np

LINING, PLATE = (84.0, 124.0, 26.0, 11.0), (80.0, 128.0, 30.0, 5.0)
"""Inner and outer radius [mm], half of the angle [deg], thickness [mm]."""
CHAMFER = (8.0, 2.5)
"""Length and depth of the chamfers [mm]."""
SLOT = (3.0, 7.0)
"""Width and depth of the slot [mm]."""
PISTON = (104.0, 16.0)
"""Distance of the axis of the piston from that of the disk, and its radius [mm]."""
DISK, TRACK = (66.0, 130.0, 12.0), (83.0, 125.0)
"""Inner and outer radius, and thickness [mm]; the same of the rubbed ring of its face z = 0."""


def sector(occ, inner: float, outer: float, half: float, low: float, high: float) -> int:
    """Sector of a ring, symmetric about the x-axis; angle in degrees."""
    ends = [
        (r * math.cos(math.radians(a)), r * math.sin(math.radians(a)))
        for r, a in ((inner, -half), (outer, -half), (outer, half), (inner, half))
    ]
    a, b, c, d = (occ.addPoint(x, y, low) for x, y in ends)
    center = occ.addPoint(0.0, 0.0, low)
    sides = [occ.addLine(a, b), occ.addCircleArc(b, center, c), occ.addLine(c, d)]
    sides.append(occ.addCircleArc(d, center, a))
    face = occ.addPlaneSurface([occ.addCurveLoop(sides)])
    return next(tag for dim, tag in occ.extrude([(2, face)], 0, 0, high - low) if dim == 3)


def draw_pad(occ) -> None:
    """Lining on z = 0 below its back plate."""
    lining = sector(occ, *LINING[:3], 0.0, LINING[3])
    inner, outer, half, _ = LINING
    long, deep = CHAMFER
    for sign in (-1, 1):
        angle = sign * math.radians(half)
        wedge = [(0.0, 0.0), (-sign * long, 0.0), (0.0, deep)]  # along the path, and upwards
        along, out = (-math.sin(angle), math.cos(angle)), (math.cos(angle), math.sin(angle))
        points = [
            occ.addPoint(
                (inner - 5) * out[0] + s * along[0], (inner - 5) * out[1] + s * along[1], z
            )
            for s, z in wedge
        ]
        lines = [occ.addLine(points[k], points[k - 2]) for k in range(3)]
        face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
        reach = outer - inner + 10
        cut = occ.extrude([(2, face)], reach * out[0], reach * out[1], 0.0)
        occ.cut([(3, lining)], [entity for entity in cut if entity[0] == 3])
    width, depth = SLOT
    slot = occ.addBox(inner - 5, -width / 2, -1.0, outer - inner + 10, width, depth + 1.0)
    occ.cut([(3, lining)], [(3, slot)])
    plate = sector(occ, *PLATE[:3], LINING[3], LINING[3] + PLATE[3])
    mark = occ.addDisk(PISTON[0], 0.0, LINING[3] + PLATE[3], PISTON[1], PISTON[1])
    occ.fragment([(3, plate)], [(2, mark)])


def draw_disk(occ) -> None:
    """Ring below z = 0, with the ring that the pad rubs on."""
    inner, outer, thick = DISK
    whole = occ.addCylinder(0, 0, -thick, 0, 0, thick, outer)
    hole = occ.addCylinder(0, 0, -thick, 0, 0, thick, inner)
    ring, _ = occ.cut([(3, whole)], [(3, hole)])
    circles = [(1, occ.addCircle(0, 0, 0, radius)) for radius in TRACK]
    occ.fragment(ring, circles)


def face_label(place: np.ndarray, area: float) -> str:
    """Label of a face of the pad or the disk by its centre and area, empty without one."""
    x, y, z = place
    top = LINING[3] + PLATE[3]
    if abs(z - top) < 1e-6:
        return "PISTON" if abs(area - math.pi * PISTON[1] ** 2) < 1.0 else "PLATE_BACK"
    if abs(z + DISK[2]) < 1e-6:
        return "DISK_BOTTOM"
    if z == 0.0 and math.hypot(x, y) < 1e-3:
        rubbed = abs(area - math.pi * (TRACK[1] ** 2 - TRACK[0] ** 2)) < 1.0
        return "" if rubbed else "DISK_REST"
    if z < 0.0 and math.hypot(x, y) < 1e-3:
        return "DISK_INSIDE" if area < 2 * math.pi * 1.01 * DISK[0] * DISK[2] else "DISK_OUTSIDE"
    return ""


def write(path: Path, draw, solids: list[str]) -> None:
    """Write a STEP file with labels, without its date.

    Parameters
    ----------
    path : Path
    draw : callable
        Draws with ``gmsh.model.occ``, in millimetres.
    solids : list of str
        Labels of the solids.
    """
    gmsh.initialize(["-noenv"], interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
        gmsh.model.add("read")  # faces are listed as in the file
        occ = gmsh.model.occ
        occ.importShapes(str(path))
        faces = [tag for _, tag in occ.getEntities(2)]
        labels = [face_label(np.array(occ.getCenterOfMass(2, f)), occ.getMass(2, f)) for f in faces]
    finally:
        gmsh.finalize()
    path.write_text(labelled(path.read_text("ascii"), solids, labels), "ascii")


def labelled(text: str, solids: list[str], faces: list[str]) -> str:
    """STEP file with labels of its solids and faces in their order."""
    for kind, labels in (("MANIFOLD_SOLID_BREP", solids), ("ADVANCED_FACE", faces)):
        names = iter(labels)
        text = re.sub(rf"= {kind}\('[^']*'", lambda _: f"= {kind}('{next(names)}'", text)  # noqa: B023
    text = re.sub(r"Open CASCADE STEP translator \d+\.\d+ [\d.]+", "part", text)
    return re.sub(r"'\d{4}-\d\d-\d\dT[\d:]+'", "'2026-01-01T00:00:00'", text)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    write(folder / "cad-pad.step", draw_pad, ["LINING", "PLATE"])
    write(folder / "cad-disk.step", draw_disk, ["DISK"])
