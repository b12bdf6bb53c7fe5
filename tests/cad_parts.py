"""Parts drawn and written by gmsh's OpenCASCADE, as CAD programs do."""

from __future__ import annotations

import importlib.util
import math

from thermowear.geometry.mesh.gmsh_session import gmsh_model, write_step

from .conftest import DEMOS

PAD, PLATE = (20.0, 30.0, 10.0), (40.0, 50.0, 15.0)
"""Sizes of the blocks of `write_blocks` [mm]."""


def cad_pad():
    """Script that draws the parts of the starter, as a module."""
    spec = importlib.util.spec_from_file_location("cad_pad", DEMOS / "cad_pad.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def block(occ, size, low):
    """Block centred on the z-axis above a height."""
    return occ.addBox(-size[0] / 2, -size[1] / 2, low, *size)


_MILLIMETRES = "LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.)"
UNITS = {
    "mm": (_MILLIMETRES, "", 1e-3),
    "m": (_MILLIMETRES.replace(".MILLI.", "$"), "", 1.0),
    "inch": (
        "CONVERSION_BASED_UNIT('INCH',#9001) LENGTH_UNIT() NAMED_UNIT(#9000)",
        "#9000 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n"
        "#9001 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9002);\n"
        f"#9002 = ( {_MILLIMETRES} );\n",
        25.4e-3,
    ),
}
"""Units of STEP files: the entity, further ones, and the unit [m]."""


def write(path, *draws, unit="mm"):
    """Write the solids that functions of ``occ`` draw; the ending selects STEP or BREP.

    Parameters
    ----------
    path : Path
    *draws : callable
    unit : str
        Unit of the lengths in the file, those that are drawn.
    """
    with gmsh_model("parts") as gmsh:
        for draw in draws:
            draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        if path.suffix == ".brep":
            gmsh.write(str(path))
            return path
        write_step(gmsh, path)
    entity, others, _ = UNITS[unit]
    text = path.read_text("ascii")
    assert _MILLIMETRES in text
    end = text.rindex("ENDSEC;")
    path.write_text(text[:end].replace(_MILLIMETRES, entity) + others + text[end:], "ascii")
    return path


def write_blocks(folder, unit="mm", ending=".step"):
    """Write a block on a larger one, in a file each; returns the files by body."""
    return {
        "pad": str(write(folder / f"pad{ending}", lambda occ: block(occ, PAD, 0.0), unit=unit)),
        "plate": str(
            write(folder / f"plate{ending}", lambda occ: block(occ, PLATE, -PLATE[2]), unit=unit)
        ),
    }


def bush(occ, inner, outer, half, length):
    """Part of a bush round the z-axis, over an angle [deg] on both sides of the x-axis."""
    axis = occ.addPoint(0, 0, 0)
    ends = [
        occ.addPoint(r * math.cos(math.radians(a)), r * math.sin(math.radians(a)), 0)
        for r, a in ((inner, -half), (outer, -half), (outer, half), (inner, half))
    ]
    sides = [
        occ.addLine(ends[0], ends[1]),
        occ.addCircleArc(ends[1], axis, ends[2]),
        occ.addLine(ends[2], ends[3]),
        occ.addCircleArc(ends[3], axis, ends[0]),
    ]
    face = occ.addPlaneSurface([occ.addCurveLoop(sides)])
    occ.extrude([(2, face)], 0, 0, length)
