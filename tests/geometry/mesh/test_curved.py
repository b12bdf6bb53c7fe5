"""Curved faces of straight-sided cells: nodes on known shapes, valid cells, right pressures."""

import warnings

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import CaseError, CaseNote
from thermowear.geometry.mesh.curved import curved, curving
from thermowear.geometry.mesh.gmsh_session import gmsh_model
from thermowear.geometry.mesh.nodes import boundary
from thermowear.geometry.mesh.tagged import TaggedMesh, scaled_jacobians
from thermowear.geometry.reading.assembly import bodies_in
from thermowear.geometry.reading.contents import Named
from thermowear.geometry.reading.file_contents import read_contents

from ...scripting.from_case import CELLS, FACETS, own_mesh

STEEL = {"young_modulus": "210 GPa", "poisson_ratio": 0.3}
ALUMINIUM = {"young_modulus": "70 GPa", "poisson_ratio": 0.33}


def solid(path, shape: str, size: float) -> TaggedMesh:
    """Body B whose curved surfaces are S."""
    with gmsh_model(shape) as gmsh:
        model, occ = gmsh.model, gmsh.model.occ
        if shape == "cap":
            tag = occ.addSphere(0, 0, 0, 1, angle1=-np.pi / 2, angle2=-np.pi / 4)
        elif shape == "ellipsoid":
            tag = occ.addSphere(0, 0, 0, 1)
            occ.dilate([(3, tag)], 0, 0, 0, 1, 1.5, 0.8)
        else:
            of = occ.addCylinder if shape == "cylinder" else occ.addCone
            tag = of(0, 0, 0, 0, 0, 1, 1, *(() if shape == "cylinder" else (0.4,)))
        occ.synchronize()
        model.addPhysicalGroup(3, [tag], name="B")
        around = [abs(t) for _, t in model.getBoundary([(3, tag)])]
        bent = [t for t in around if model.getType(2, t) != "Plane"]
        model.addPhysicalGroup(2, bent, name="S")
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        model.mesh.generate(3)
        gmsh.write(str(path))
    return read(path)


def read(path) -> TaggedMesh:
    named = [Named("S", ("S",), "geometry.surfaces", 0)]
    (block,) = bodies_in(read_contents(path, 3), {"b": ("B",)}, named, {}).blocks
    return block


OFF = {
    "cap": lambda x: np.linalg.norm(x, axis=1) - 1,
    "cylinder": lambda x: np.hypot(x[:, 0], x[:, 1]) - 1,
    "cone": lambda x: (np.hypot(x[:, 0], x[:, 1]) - 1 + 0.6 * x[:, 2]) / np.hypot(1, 0.6),
    "ellipsoid": lambda x: np.sqrt(x[:, 0] ** 2 + (x[:, 1] / 1.5) ** 2 + (x[:, 2] / 0.8) ** 2) - 1,
}
"""Distance from each shape, of the ellipsoid relative to its half axes."""


def farthest(mesh: TaggedMesh, shape: str) -> float:
    return float(np.abs(OFF[shape](mesh.points[np.unique(mesh.facets_of("S"))])).max())


@pytest.mark.parametrize("shape", ["cap", "cylinder", "cone"])
def test_simple_shapes(tmp_path, shape):
    """
    requirement: nodes lie on the sphere, cylinder or cone to rounding, those on rims stay in the
    planes beyond, and the cells are valid.
    """
    straight = solid(tmp_path / "a.msh", shape, 0.35)
    (mesh,) = curved(straight, ["S"], "key").blocks
    assert mesh.order == 2
    assert farthest(mesh, shape) < 1e-12
    assert scaled_jacobians(mesh).min() > 0.05
    around = boundary("tetrahedron", 2, mesh.cells)
    flat = around[~np.isin(around, mesh.facets_of("S")).all(axis=1)]
    levels = {"cap": [-np.sqrt(0.5)], "cylinder": [0.0, 1.0], "cone": [0.0, 1.0]}[shape]
    assert np.abs(mesh.points[flat, 2, None] - levels).min(axis=-1).max() < 1e-12


def test_other_smooth_shapes(tmp_path):
    """
    requirement: on an ellipsoid, the distance of nodes falls like the cube of the size of cells or
    faster, and is below a fifth of that of the flat facets.
    """
    sizes, off = (0.4, 0.2), []
    for size in sizes:
        straight = solid(tmp_path / "a.msh", "ellipsoid", size)
        found = curving(straight, ["S"])
        assert scaled_jacobians(found.mesh).min() > 0.05
        off.append(farthest(found.mesh, "ellipsoid"))
        assert off[-1] < 0.2 * found.heights["S"]
    assert off[1] < 0.25 * off[0]


def ring(rows: np.ndarray, columns: int = 6) -> TaggedMesh:
    """Quarter of a ring between radii, its inner face S, of quadrilaterals."""
    angles = np.linspace(0, np.pi / 2, columns + 1)
    points = np.array([[r * np.cos(a), r * np.sin(a)] for r in rows for a in angles])
    start = np.arange(len(rows) - 1)[:, None] * (columns + 1) + np.arange(columns)
    first = start.ravel()
    cells = np.column_stack([first, first + columns + 1, first + columns + 2, first + 1])
    facets = np.column_stack([np.arange(columns) + 1, np.arange(columns)])
    return TaggedMesh(
        points,
        "quadrilateral",
        cells,
        np.ones(len(cells), np.int32),
        facets,
        np.ones(columns, np.int32),
        ("b",),
        ("S",),
    )


def test_thin_rows():
    """
    requirement: rows of cells thinner than the arcs are high are valid: nodes further inside
    follow; where they cannot, the surface and the remedy are named.
    """
    height = 1 - np.cos(np.pi / 24)
    rows = 1 + height * np.array([0.0, 0.2, 0.5, 1.0, 3.0, 10.0, 40.0])
    (mesh,) = curved(ring(rows), ["S"], "key").blocks
    radii = np.linalg.norm(mesh.points[np.unique(mesh.facets_of("S"))], axis=1)
    np.testing.assert_allclose(radii, 1.0, rtol=1e-12)
    assert scaled_jacobians(mesh).min() > 0.2
    with pytest.raises(CaseError, match=r"key: 6 cells would be tangled, one at .*; refine"):
        curved(ring(np.array([1.0, 1 + 0.1 * height])), ["S"], "key")


def test_edges_stay():
    """
    requirement: flats that meet at an angle are no curve, but a plate with many flats at small ones
    is; nothing is curved twice.
    """
    mesh = ring(np.array([1.0, 1.5]), 2)  # 45 degrees
    assert curving(mesh, ["S"]).heights == {"S": 0.0}
    (once,) = curved(ring(np.array([1.0, 1.5])), ["S"], "key").blocks
    assert curving(once, ["S"]).heights == {"S": 0.0}


def pin_in_hole(path, order: int) -> None:
    """Pin of radius 10 in a hole 0.5 µm wider, in a square block, with meshes that do not fit."""
    clearance = 5e-4
    with gmsh_model("pin") as gmsh:
        model, occ = gmsh.model, gmsh.model.occ
        disk, bore = occ.addDisk(0, 0, 0, 10, 10), occ.addDisk(0, 0, 0, 4, 4)
        ((_, pin),), _ = occ.cut([(2, disk)], [(2, bore)])
        square = occ.addRectangle(-20, -20 - clearance, 0, 40, 40)
        hole = occ.addDisk(0, -clearance, 0, 10 + clearance, 10 + clearance)
        ((_, block),), _ = occ.cut([(2, square)], [(2, hole)])
        line = occ.addLine(occ.addPoint(-30, -2, 0), occ.addPoint(30, -2, 0))
        _, parts = occ.fragment([(2, pin), (2, block)], [(1, line)])
        occ.synchronize()
        bodies = [[tag for dim, tag in of if dim == 2] for of in parts[:2]]
        for name, tags in zip(("PIN", "BLOCK"), bodies, strict=True):
            model.addPhysicalGroup(2, tags, name=name)
            groups: dict[str, list[int]] = {}
            for _, curve in model.getBoundary([(2, tag) for tag in tags], combined=True):
                low, high = (x[0] for x in model.getParametrizationBounds(1, abs(curve)))
                x, y, _ = model.getValue(1, abs(curve), [(low + high) / 2])
                radius = np.hypot(x, y)
                if 9 < radius < 11 and y < -2:
                    groups.setdefault(f"{name}_FACE", []).append(abs(curve))
                elif radius < 5 or y < -19.9:
                    groups.setdefault(f"{name}_HELD", []).append(abs(curve))
            for surface, curves in groups.items():
                model.addPhysicalGroup(1, curves, name=surface)
        field = model.mesh.field
        sizes = field.add("Constant")
        field.setNumbers(sizes, "SurfacesList", bodies[0])
        field.setNumber(sizes, "VIn", 1.5)
        field.setNumber(sizes, "VOut", 2.3)
        field.setAsBackgroundMesh(sizes)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        model.mesh.generate(2)
        model.mesh.setOrder(order)
        gmsh.write(str(path))


def pin_case(path, **keys) -> tw.Case:
    return tw.load(
        {
            "model": "plane-strain",
            "geometry": {
                "type": "file",
                "path": str(path),
                "length_unit": "1 mm",
                "thickness": "10 mm",
                "bodies": {"pin": "PIN", "block": "BLOCK"},
                "contact": ["PIN_FACE", "BLOCK_FACE"],
                "held": "PIN_HELD",
                "fixed": "BLOCK_HELD",
            }
            | keys,
            "mesh": {"degree": 2},
            "bodies": {"pin": STEEL, "block": ALUMINIUM},
            "load": {"force": "20 kN"},
            "analysis": {"type": "initial"},
        }
    )


LARGEST = 154.6e6
"""Largest pressure with cells of order 2, the same on two meshes [Pa]."""


def test_pin_in_hole(tmp_path):
    """
    requirement: a pin in a hole with a clearance of 0.5 µm on straight-sided cells: a note with the
    key, and with it 154.6 MPa, the value on cells of order 2 (383 MPa without); the same in Python.
    """
    pin_in_hole(tmp_path / "a.msh", 1)
    with pytest.warns(CaseNote, match=r'jump by up to 13°.*geometry.curved = .*"BLOCK_FACE"'):
        straight = pin_case(tmp_path / "a.msh").tagged_mesh()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        case = pin_case(tmp_path / "a.msh", curved=True)
        found = tw.run(case).interface.pressure.max()
    assert found == pytest.approx(LARGEST, rel=0.02)
    mesh, cells, facets = own_mesh(straight)
    tag_of = dict(zip(straight.surfaces, FACETS, strict=False))
    pin, block = (
        tw.Body(
            name,
            mesh,
            cells,
            facets,
            {CELLS[index]: tw.Material(modulus, ratio)},
            fixed=() if index == 0 else tag_of["BLOCK_HELD"],
            curved=[tag_of[s] for s in straight.surfaces if s.startswith(name.upper())],
        )
        for index, (name, modulus, ratio) in enumerate(
            [("pin", "210 GPa", 0.3), ("block", "70 GPa", 0.33)]
        )
    )
    faces = pin.surface(tag_of["PIN_FACE"]), block.surface(tag_of["BLOCK_FACE"])
    holder = tw.Holder(pin.surface(tag_of["PIN_HELD"]), force="20 kN")
    model = tw.Model(
        [tw.Interface(*faces)], [holder], kinematics="plane-strain", thickness="10 mm", degree=2
    )
    assert model.initial().result.interface.pressure.max() == pytest.approx(found, rel=1e-9)


def test_unknown_surfaces(tmp_path):
    """
    requirement: a surface that the case does not name is an error at the key.
    """
    with pytest.raises(CaseError, match=r"geometry.curved: unknown surface 'PIN'; must"):
        pin_case(tmp_path / "a.msh", curved=["PIN"])
