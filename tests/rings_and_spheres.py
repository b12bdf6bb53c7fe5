"""Ring on a plate and sphere on a block in space, meshed by gmsh with tetrahedra."""

from __future__ import annotations

import math

from thermowear.geometry.mesh.gmsh_session import gmsh_model

RING = {"inner": 20.0, "outer": 120.0, "height": 50.0, "plate": 140.0, "depth": 100.0}
"""Dimensions of the starter annular-punch [mm]."""
SPHERE = {"radius": 10.0, "block": 12.0, "depth": 12.0}
"""Dimensions of sphere and block [mm]."""
NAMES = {
    "length_unit": "1 mm",
    "bodies": {"punch": "UPPER", "plate": "LOWER"},
    "contact": ["punch_face", "plate_face"],
    "surfaces": {"punch_face": "UPPER_FACE", "plate_face": "LOWER_FACE"}
    | {"punch_top": "TOP", "plate_bottom": "BOTTOM"},
    "held": "punch_top",
    "fixed": "plate_bottom",
}
"""Keys of the geometry of both files, but for symmetry."""
GLUED = NAMES | {"surfaces": NAMES["surfaces"] | {"punch_face": "FACE", "plate_face": "FACE"}}
"""Keys where both bodies share the nodes of their faces."""
QUARTER = {"symmetry": ["X0"], "rollers": ["Y0"]}


def write_ring(path, turn=math.pi / 2, order=2, near=3.0, far=28.0):
    """Write a quarter (x, y > 0), or the whole, of an annular punch on a plate [mm].

    Both bodies share the nodes of their joint. Cells are small near both edges of the face, where
    the worn shape is steep.
    """
    r, R, height = RING["inner"], RING["outer"], RING["height"]
    with gmsh_model("ring") as gmsh:
        occ = gmsh.model.occ
        ring = occ.addCylinder(0, 0, 0, 0, 0, height, R, angle=turn)
        hole = occ.addCylinder(0, 0, 0, 0, 0, height, r, angle=turn)
        occ.cut([(3, ring)], [(3, hole)])
        depth = RING["depth"]
        plate = occ.addCylinder(0, 0, -depth, 0, 0, depth, RING["plate"], angle=turn)
        occ.fragment([(3, ring)], [(3, plate)])
        occ.synchronize()
        _name(gmsh.model, {height: "TOP", -depth: "BOTTOM"}, turn < 6, ring, plate)
        rims = [
            tag
            for _, tag in gmsh.model.getEntities(1)
            if gmsh.model.getType(1, tag) == "Circle" and _level(gmsh.model, 1, tag) == 0.0
            if not math.isclose(_reach(gmsh.model, tag), RING["plate"], rel_tol=1e-3)
        ]
        field = gmsh.model.mesh.field
        field.add("Distance", 1)
        field.setNumbers(1, "CurvesList", rims)
        field.setNumber(1, "Sampling", 200)
        field.add("MathEval", 2)
        field.setString(2, "F", f"min({far}, {near} + 0.45 * F1)")
        _generate(gmsh, path, order)
    return path


def write_quarter_sphere(path, order=2, near=0.12, zone=0.6):
    """Write a quarter of a half sphere on a round block [mm], meshed independently.

    Cells are of size `near` in the contact zone, up to the distance `zone` from its middle.
    """
    R, block, depth, turn = SPHERE["radius"], SPHERE["block"], SPHERE["depth"], math.pi / 2
    with gmsh_model("sphere") as gmsh:
        occ = gmsh.model.occ
        upper = occ.addSphere(0, 0, R, R, -1, -turn, 0.0, turn)
        lower = occ.addCylinder(0, 0, -depth, 0, 0, depth, block, angle=turn)
        occ.synchronize()
        _name(gmsh.model, {R: "TOP", -depth: "BOTTOM"}, True, upper, lower)
        field = gmsh.model.mesh.field
        field.add("MathEval", 2)
        size = f"{near} + 0.35 * max(0, sqrt(x^2 + y^2 + z^2) - {zone})"
        field.setString(2, "F", f"min({R / 4}, {size})")
        _generate(gmsh, path, order)
    return path


def _level(model, dim, tag) -> float | None:
    """Z of a flat curve or surface."""
    box = model.getBoundingBox(dim, tag)
    return round((box[2] + box[5]) / 2, 3) + 0.0 if box[5] - box[2] < 1e-3 else None


def _reach(model, curve) -> float:
    box = model.getBoundingBox(1, curve)
    return max(abs(box[k]) for k in (0, 1, 3, 4))


def _name(model, levels, cut, upper, lower) -> None:
    """Physical groups: both bodies, top and bottom, planes of symmetry, the (common) faces."""
    groups: dict[str, list[int]] = {}
    for _, tag in model.getEntities(2):
        x, y, _ = model.occ.getCenterOfMass(2, tag)
        volumes, level = set(model.getAdjacencies(2, tag)[0]), _level(model, 2, tag)
        if level in levels:
            groups.setdefault(levels[level], []).append(tag)
        elif cut and min(abs(x), abs(y)) < 1e-6:
            groups.setdefault("X0" if abs(x) < 1e-6 else "Y0", []).append(tag)
        elif volumes == {upper, lower}:
            groups.setdefault("FACE", []).append(tag)
        elif volumes == {lower} and level == 0.0:
            groups.setdefault("LOWER_FACE", []).append(tag)
        elif model.getType(2, tag) == "Sphere":
            groups.setdefault("UPPER_FACE", []).append(tag)
    model.addPhysicalGroup(3, [upper], name="UPPER")
    model.addPhysicalGroup(3, [lower], name="LOWER")
    for name, tags in groups.items():
        model.addPhysicalGroup(2, tags, name=name)


def _generate(gmsh, path, order) -> None:
    gmsh.model.mesh.field.setAsBackgroundMesh(2)
    options = {"MeshSizeExtendFromBoundary": 0, "MeshSizeFromPoints": 0, "ElementOrder": order}
    for key, value in (options | {"HighOrderOptimize": 1}).items():
        gmsh.option.setNumber(f"Mesh.{key}", value)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(path))
