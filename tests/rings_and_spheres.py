"""Ring on a plate and sphere on a block in space, meshed by gmsh with tetrahedra."""

from __future__ import annotations

import math

from thermowear.geometry.mesh.gmsh_session import gmsh_model

RING = {"inner": 20.0, "outer": 120.0, "height": 50.0, "plate": 140.0, "depth": 100.0}
"""Dimensions of the starter annular-punch [mm]."""
SPHERE = {"radius": 10.0, "block": 12.0, "depth": 12.0}
"""Dimensions of sphere and block [mm]."""
NAMES = {
    "bodies": {"punch": "UPPER", "plate": "LOWER"},
    "surfaces": {"punch_face": "UPPER_FACE", "plate_face": "LOWER_FACE"}
    | {"punch_top": "TOP", "plate_bottom": "BOTTOM"},
    "contact": ["punch_face", "plate_face"],
    "held": "punch_top",
    "fixed": "plate_bottom",
}


def write_ring(path, whole=False, order=2, far=28.0, near=3.0, **options):
    """Write a quarter (x, y > 0), or the whole, of an annular punch on a plate [mm].

    Cells are small near both edges of the face, where the worn shape is steep.
    """
    sizes, turn = RING, 2 * math.pi if whole else math.pi / 2
    with gmsh_model("ring") as gmsh:
        occ = gmsh.model.occ
        inner, outer = (
            occ.addCylinder(0, 0, 0, 0, 0, sizes["height"], sizes[r], angle=turn)
            for r in ("inner", "outer")
        )
        occ.cut([(3, outer)], [(3, inner)])
        plate = occ.addCylinder(
            0, 0, -sizes["depth"], 0, 0, sizes["depth"], sizes["plate"], angle=turn
        )
        marks = [occ.addDisk(0, 0, 0, sizes[r], sizes[r]) for r in ("inner", "outer")]
        mapped = occ.fragment([(3, plate)], [(2, mark) for mark in marks])[1]
        plates = [tag for dim, tag in mapped[0] if dim == 3]
        loose = [e for found in mapped[1:] for e in found if e[0] == 2]
        occ.synchronize()
        model = gmsh.model
        used = {abs(t) for p in plates for _, t in model.getBoundary([(3, p)], oriented=False)}
        occ.remove([e for e in loose if e[1] not in used], recursive=True)
        occ.synchronize()
        upper = [t for _, t in model.getEntities(3) if t not in plates]
        groups = {"UPPER_FACE": [], "LOWER_FACE": [], "TOP": [], "BOTTOM": [], "X0": [], "Y0": []}
        for _, tag in model.getEntities(2):
            x, y, z = occ.getCenterOfMass(2, tag)
            low = model.getBoundingBox(2, tag)
            above, _ = model.getAdjacencies(2, tag)
            flat = abs(low[5] - low[2]) < 1e-3
            if flat and abs(z) < 1e-6:
                if set(above) & set(upper):
                    groups["UPPER_FACE"].append(tag)
                elif _is_ring(model, tag, sizes):
                    groups["LOWER_FACE"].append(tag)
            elif flat:
                groups["TOP" if z > 0 else "BOTTOM"].append(tag)
            elif abs(x) < 1e-6 and not whole:
                groups["X0"].append(tag)
            elif abs(y) < 1e-6 and not whole:
                groups["Y0"].append(tag)
        model.addPhysicalGroup(3, upper, name="UPPER")
        model.addPhysicalGroup(3, plates, name="LOWER")
        for name, tags in groups.items():
            if tags:
                model.addPhysicalGroup(2, tags, name=name)
        _refine(gmsh, _rims(model, sizes), near, far)
        _generate(gmsh, path, order, options)
    return path


def _is_ring(model, tag, sizes) -> bool:
    low = model.getBoundingBox(2, tag)
    curves = model.getBoundary([(2, tag)], oriented=False)
    radii = [
        max(model.getBoundingBox(1, abs(c))[3], model.getBoundingBox(1, abs(c))[4])
        for _, c in curves
    ]
    near = [any(abs(r - sizes[key]) < 1e-3 for r in radii) for key in ("inner", "outer")]
    return all(near) and max(low[3], low[4]) < sizes["outer"] + 1e-3


def _rims(model, sizes) -> list[int]:
    """Edges of the faces at z = 0 with the inner and the outer radius."""
    found = []
    for _, tag in model.getEntities(1):
        low = model.getBoundingBox(1, tag)
        reach = max(abs(v) for v in (low[0], low[1], low[3], low[4]))
        flat = max(abs(low[2]), abs(low[5])) < 1e-3
        curved = model.getType(1, tag) == "Circle"
        if flat and curved and any(abs(reach - sizes[r]) < 1e-3 for r in ("inner", "outer")):
            found.append(tag)
    return found


def _refine(gmsh, curves, near, far) -> None:
    field = gmsh.model.mesh.field
    field.add("Distance", 1)
    field.setNumbers(1, "CurvesList", curves)
    field.setNumber(1, "Sampling", 200)
    field.add("MathEval", 2)
    field.setString(2, "F", f"min({far}, {near} + 0.45 * F1)")
    field.setAsBackgroundMesh(2)


def _generate(gmsh, path, order, options) -> None:
    given = {
        "MeshSizeExtendFromBoundary": 0,
        "MeshSizeFromPoints": 0,
        "ElementOrder": order,
        "HighOrderOptimize": 1,
    }
    for key, value in (given | options).items():
        gmsh.option.setNumber(f"Mesh.{key}", value)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(path))
