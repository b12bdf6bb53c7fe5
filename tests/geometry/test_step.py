"""STEP files of worn bodies, read back by the kernel that CAD has too."""

import math
from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.bulk.mesh_motion import serial_extension
from thermowear.errors import CaseError
from thermowear.geometry.cad.design import Design
from thermowear.geometry.cad.step import face_grid, write_faceted, write_prism, write_section
from thermowear.geometry.cad.worn_body import moved_body, only_body
from thermowear.geometry.mesh.gmsh_session import gmsh_model
from thermowear.verification.spherical_pin import SphericalPin

from ..case.starter import STEADY
from ..contact.solids import two_solids
from ..simulation.space import BRAKE, PUNCH
from .measure import volumes
from .test_design import ARC, HEIGHT, INNER, OUTER, RADIUS, body_of, flat, round_one, waves

KERNEL = 1e-5  # of the volume: how well OpenCASCADE integrates over B-splines


def read(path):
    """Volume [mm³], corners of the bounding box [mm], and kinds of the surfaces of a solid."""
    with gmsh_model("read") as gmsh:
        gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        ((dim, solid),) = gmsh.model.getEntities(3)
        volume = gmsh.model.occ.getMass(dim, solid)
        box = np.array(gmsh.model.occ.getBoundingBox(dim, solid)).reshape(2, 3)
        kinds = sorted(gmsh.model.getType(*face) for face in gmsh.model.getEntities(2))
    return volume, box, kinds


def level(design: Design) -> Design:
    """Design with zero depth."""
    return Design(**{**vars(design), "depth": np.zeros(len(design.depth))})


def written(path, mesh, face, design, **how):
    write_section(mesh, design, face, path, **how)
    return read(path)


@pytest.mark.parametrize("part", [1.0, 0.25])
def test_a_turned_section(tmp_path, part):
    """requirement: ring, or part of it, in millimetres; its volume less what is worn off."""
    mesh, face = body_of(STEADY)
    how = {"turn": 2 * math.pi * part}
    volume, box, _ = written(tmp_path / "ring.step", mesh, face, flat(), **how)
    unworn, *_ = written(tmp_path / "new.step", mesh, face, level(flat()), **how)
    r = np.linspace(INNER, OUTER, 100_001)
    lost = part * 1e9 * 2 * math.pi * np.trapezoid(r * waves(r), r)
    whole = part * 1e9 * math.pi * (OUTER**2 - INNER**2) * HEIGHT
    assert unworn == pytest.approx(whole, rel=1e-9)
    assert volume == pytest.approx(whole - lost, rel=KERNEL)
    assert unworn - volume == pytest.approx(lost, rel=5e-3)
    assert box[1, 1] == pytest.approx(1e3 * HEIGHT)
    assert box[1, 0] == pytest.approx(1e3 * OUTER, abs=1e-6)


def test_the_face_passes_through_the_design(tmp_path):
    """requirement: the worn face lies on the points of the design, to a nanometre."""
    mesh, face = body_of(STEADY)
    design = flat()
    write_section(mesh, design, face, tmp_path / "bar.step", thick=1e-3)
    with gmsh_model("read") as gmsh:
        gmsh.model.occ.importShapes(str(tmp_path / "bar.step"))
        gmsh.model.occ.synchronize()
        for x, depth in zip(design.points[::7, 0], design.depth[::7], strict=True):
            point = (1e3 * x, 1e3 * depth, 0.0)
            nearest = [
                np.linalg.norm(np.array(gmsh.model.getClosestPoint(*entity, point)[0]) - point)
                for entity in gmsh.model.getEntities(2)
            ]
            assert min(nearest) < 1e-6


def test_an_extruded_section_with_an_arc(tmp_path):
    """requirement: thickness to both sides; upright sides end on the worn arc."""
    mesh, face = body_of("block-on-disk")
    volume, box, kinds = written(tmp_path / "b.step", mesh, face, round_one(), thick=0.01)
    half = RADIUS * math.sin(ARC)
    block = 2 * half * (RADIUS + 0.012) - RADIUS**2 * (ARC + math.sin(ARC) * math.cos(ARC))
    worn = 3e-6 * 2 * ARC * RADIUS
    assert volume == pytest.approx(1e9 * 0.01 * (block - worn), rel=KERNEL)
    assert box[:, 2] == pytest.approx([-5.0, 5.0])
    assert box[:, 0] == pytest.approx([-1e3 * half, 1e3 * half])
    assert kinds.count("Plane") == 5


def test_a_half_is_written_whole(tmp_path):
    """requirement: the part that is made, not the half that is computed."""
    mesh, face = body_of("cylinder-on-block-growing")
    x = mesh.points[np.unique(mesh.facets[mesh.facet_tags == mesh.surfaces.index(face) + 1])]
    x = x[np.argsort(x[:, 0])]
    out = (x - [0.0, 0.01]) / 0.01
    zero = np.zeros(len(x))
    design = Design(1, x, 0.01 * np.arcsin(out[:, 0]), out, zero, zero, zero)
    volume, box, _ = written(tmp_path / "c.step", mesh, face, design, thick=1e-3, half=True)
    assert volume == pytest.approx(math.pi / 2 * 10**2, rel=KERNEL)
    assert box[:, 0] == pytest.approx([-10.0, 10.0])


def test_holes_and_steps(tmp_path):
    """requirement: a bore stays; beyond a face that is lowered the surface steps up again."""
    mesh, face = body_of("block-on-disk", 1)
    angle = np.linspace(-ARC, ARC, 90)
    out = np.column_stack([np.sin(angle), np.cos(angle)])
    depth = np.full(90, 1e-4)
    design = Design(2, RADIUS * out, RADIUS * angle, out, depth, depth, depth)
    volume, _, kinds = written(tmp_path / "d.step", mesh, face, design, thick=0.01)
    worn = ARC * (RADIUS**2 - (RADIUS - 1e-4) ** 2)
    ring = math.pi * (RADIUS**2 - 0.008**2)
    assert volume == pytest.approx(1e9 * 0.01 * (ring - worn), rel=KERNEL)
    assert kinds.count("Cylinder") >= 2


# ---- in space ----


def grid_of(tables, parts=("punch",), face="punch_face"):
    mesh = only_body(tw.load(tables).tagged_mesh(), parts)
    return mesh, face_grid(mesh, face)


def in_space(points, depth) -> Design:
    out, nothing = np.tile([0.0, 0.0, -1.0], (len(points), 1)), np.full(len(points), np.nan)
    return Design(1, points, nothing, out, nothing, nothing, depth)


def test_a_rectangular_prism(tmp_path):
    """requirement: a solid on a B-spline surface, its volume less what is worn off."""
    mesh, grid = grid_of(PUNCH)
    points = grid.reshape(-1, 3)
    depth = 1e-4 * (1 + points[:, 0] / 0.06 + (points[:, 1] / 0.04) ** 2)
    write_prism(mesh, in_space(points, depth), "punch_face", tmp_path / "p.step")
    volume, box, kinds = read(tmp_path / "p.step")
    assert volume == pytest.approx(60 * 80 * (50 - 0.1 * (1 + 1 / 3)), rel=KERNEL)
    assert "BSpline surface" in kinds
    assert box[1, :2] == pytest.approx([30, 40])


def test_a_sector_of_a_ring(tmp_path):
    """requirement: curved sides as well."""
    mesh, grid = grid_of(BRAKE, ("pad",), "pad_face")
    points = grid.reshape(-1, 3)
    depth = 1e-2 * np.hypot(points[:, 0], points[:, 1])
    write_prism(mesh, in_space(points, depth), "pad_face", tmp_path / "p.step")
    volume, *_ = read(tmp_path / "p.step")
    whole = math.pi / 6 * (120**2 - 80**2) * 15
    lost = 1e-2 * math.pi / 9 * (120**3 - 80**3)
    # cells of the second order are as near to the arcs
    assert volume == pytest.approx(whole - lost, rel=1e-4)


def test_the_grid_of_a_face_knows_no_holes():
    """requirement: rows of facets in any order make one grid."""
    _, grid = grid_of(PUNCH)
    assert not np.isnan(grid).any()
    steps = np.diff(grid[..., :2], axis=0), np.diff(grid[..., :2], axis=1)
    for step in steps:
        assert len(np.unique(np.sign(np.round(step.reshape(-1, 2), 9)), axis=0)) == 1


def test_a_place_that_cannot_be_written(tmp_path):
    """requirement: one line, and nothing left behind."""
    mesh, face = body_of(STEADY)
    with pytest.raises(CaseError, match="cannot be written"):
        write_section(mesh, flat(), face, tmp_path / "none" / "ring.step", turn=1.0)
    assert not list(tmp_path.iterdir())


def test_nothing_is_said(tmp_path, capfd):
    """requirement: OpenCASCADE's chatter does not reach the terminal."""
    mesh, face = body_of(STEADY)
    write_section(mesh, flat(), face, tmp_path / "ring.step", turn=1.0)
    assert capfd.readouterr() == ("", "")


# ---- of any shape ----


@pytest.mark.parametrize("order", [1, 2])
def test_a_body_of_tetrahedra(tmp_path, order):
    """requirement: one solid with the volume of the mesh; plane sides are single faces."""
    pin = SphericalPin(10e-3, 6e-3, 10e-3, (9e-3, 6e-3), 2e-3, order)
    mesh = only_body(pin.write(tmp_path / "pin.msh"), ("pin",))
    write_faceted(mesh, "pin_face", tmp_path / "pin.step")
    volume, box, kinds = read(tmp_path / "pin.step")
    # triangles between the nodes are within 1 % of curved facets
    known = 1e9 * volumes(mesh, "pin").sum()
    assert volume == pytest.approx(known, rel=KERNEL if order == 1 else 0.01)
    assert box[1] == pytest.approx([6, 6, 10], rel=1e-3)
    assert set(kinds) == {"Plane"}
    worn, curved = (len(mesh.facets_of(f"pin_{name}")) for name in ("face", "side"))
    others = len(kinds) - 3 - order**2 * worn  # without the top and planes of symmetry
    assert curved <= others <= order**2 * curved


def test_the_face_of_tetrahedra_sinks(tmp_path):
    """requirement: by the depth of the design, and the volume with it."""
    mesh = only_body(
        SphericalPin(1.0, 6e-3, 10e-3, (9e-3, 6e-3), 1.5e-3).write(tmp_path / "pin.msh"), ("pin",)
    )
    points = mesh.points[np.unique(mesh.facets_of("pin_face"))]
    depth = 1e-4 * (1 + points[:, 0] / 6e-3)
    moved = moved_body(mesh, in_space(points, depth), "pin_face", serial_extension)
    on_face = np.unique(mesh.facets_of("pin_face"))
    assert (moved - mesh.points)[on_face, 2] == pytest.approx(depth, rel=1e-4, abs=0.0)
    worn = replace(mesh, points=moved)
    lost = volumes(mesh, "pin").sum() - volumes(worn, "pin").sum()
    assert lost == pytest.approx(1e-4 * 36e-6 * (math.pi / 4 + 1 / 3), rel=1e-3, abs=0.0)
    write_faceted(worn, "pin_face", tmp_path / "worn.step")
    found = read(tmp_path / "worn.step")[0]
    write_faceted(mesh, "pin_face", tmp_path / "pin.step")
    assert read(tmp_path / "pin.step")[0] - found == pytest.approx(1e9 * lost, rel=0.02)


def test_a_hollow_solid(tmp_path):
    """requirement: a cavity is no part of the solid."""
    mesh = two_solids(((4, 4, 4), (2, 2, 2)), 1, cell_type="tetrahedron")
    middle = mesh.points[mesh.cells].mean(axis=1)
    upper = mesh.points[mesh.cells[mesh.cell_tags == 1]].reshape(-1, 3)
    part = (middle - upper.min(axis=0)) / np.ptp(upper, axis=0)
    hollow = (mesh.cell_tags == 1) & ~np.all((part > 0.25) & (part < 0.75), axis=1)
    mesh = replace(mesh, cells=mesh.cells[hollow], cell_tags=mesh.cell_tags[hollow])
    write_faceted(mesh, "upper_face", tmp_path / "hollow.step")
    volume, *_ = read(tmp_path / "hollow.step")
    assert volume == pytest.approx(1e9 * volumes(mesh, "upper").sum(), rel=KERNEL)
    assert volume == pytest.approx(1e9 * np.ptp(upper, axis=0).prod() * 7 / 8, rel=KERNEL)
