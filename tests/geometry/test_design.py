"""Designs of worn faces: tables, what is between their points, and how the body follows."""

from dataclasses import replace

import meshio
import numpy as np
import pytest

import thermowear as tw
from thermowear.bulk.mesh_motion import serial_extension
from thermowear.errors import CaseError
from thermowear.geometry.cad.design import HEADERS, Design, add_table, from_table, read_table
from thermowear.geometry.cad.design import write_table as write
from thermowear.geometry.cad.worn_body import moved_body, only_body, write_design_mesh
from thermowear.geometry.moving.outline import loops
from thermowear.geometry.reading.export import write_mesh

from ..case.starter import STEADY, tables
from ..simulation.space import PUNCH
from .measure import areas

INNER, OUTER, HEIGHT = 0.02, 0.12, 0.05
ARC, RADIUS = 0.5, 0.02


def waves(x):
    """A depth that is nowhere negative [m]."""
    return 2e-5 * (1.2 + np.sin(60 * x))


def flat(body=1, count=80, ends=(INNER, OUTER)) -> Design:
    """A design of the flat ring or of the plate under it."""
    x = np.linspace(*ends, count)
    out = np.tile([0.0, -1.0 if body == 1 else 1.0], (count, 1))
    depth, points = waves(x), np.column_stack([x, np.zeros(count)])
    return Design(body, points, x - x[0], out, depth.max() - depth, depth.max() - depth, depth)


def round_one() -> Design:
    """A design of the block on the disk: as deep at every angle."""
    angle = np.linspace(-ARC, ARC, 90)
    out = -np.column_stack([np.sin(angle), np.cos(angle)])
    depth = np.full(90, 3e-6)
    return Design(1, -RADIUS * out, RADIUS * (angle + ARC), out, 0 * depth, 0 * depth, depth)


def body_of(name: str, index: int = 0, changes=None):
    """A body of a starter case, its face, and the case."""
    case = tw.load(tables(name, changes))
    geometry = case.geometry
    parts = geometry.parts_of(geometry.bodies[index])
    return only_body(case.tagged_mesh(), parts), geometry.contact[index]


def area(mesh) -> float:
    """Total area of all cells [m²]."""
    return sum(areas(mesh, body).sum() for body in mesh.bodies)


# ---- between the points ----


def test_depth_between_points():
    """requirement: a smooth curve through the points of the face, and of no other."""
    design, x = flat(), np.linspace(INNER, OUTER, 333)
    on_face = np.column_stack([x, np.zeros(333)])
    assert design.depth_at(on_face) == pytest.approx(waves(x), abs=1e-10)
    for off in ([0.0, 0.01], [0.01, 0.0]):
        with pytest.raises(ValueError, match=r"0\.01 m away from the contact face"):
            design.depth_at(on_face + off)


def test_depth_on_an_arc_of_few_points():
    """requirement: places along a curved face are found though the points lie far apart."""
    angle, between = np.linspace(-0.8, 0.8, 9), np.linspace(-0.79, 0.79, 41)
    out = -np.column_stack([np.sin(angle), np.cos(angle)])
    depth = 1e-5 * (1 + angle)
    design = Design(1, -RADIUS * out, RADIUS * angle, out, depth, depth, depth)
    at = RADIUS * np.column_stack([np.sin(between), np.cos(between)])
    assert design.depth_at(at) == pytest.approx(1e-5 * (1 + between), rel=1e-3)
    assert design.normals_at(at) == pytest.approx(-at / RADIUS, abs=1e-2)


def test_depth_in_space():
    """requirement: interpolated over a face in space, from points in any order."""
    x, y = np.random.default_rng(1).uniform(-0.03, 0.03, (2, 900))
    points = np.column_stack([x, y, 0 * x])
    depth = 1e-5 * (2 + np.cos(50 * x) * np.sin(40 * y))
    out = np.tile([0.0, 0.0, -1.0], (900, 1))
    nothing = np.full(900, np.nan)
    design = Design(1, points, nothing, out, nothing, nothing, depth)
    at = 0.9 * points[::7]
    exact = 1e-5 * (2 + np.cos(50 * at[:, 0]) * np.sin(40 * at[:, 1]))
    assert design.depth_at(at) == pytest.approx(exact, abs=2e-8)


# ---- tables ----


@pytest.mark.parametrize("ending", [".csv", ".msh", ".vtu", ".step"])
def test_a_table_goes_through_every_format(tmp_path, ending):
    """requirement: every format carries the design, digit by digit."""
    file, design = tmp_path / f"design{ending}", flat(body=2)
    if ending == ".csv":
        write(design, file)
    else:
        file.write_text("first line\nsecond line, -1.5, --\n", encoding="utf-8")
        add_table(design, file)
    found = from_table(read_table(file), 2)
    assert found.body == 2
    for name in ("points", "s", "normals", "shape", "shape_along_press", "depth"):
        assert getattr(found, name) == pytest.approx(getattr(design, name), rel=1e-14, abs=0)


def test_a_file_without_a_table(tmp_path):
    """requirement: a table of an earlier run is no design."""
    file = tmp_path / "profile.csv"
    file.write_text("s_m,shape_m\n0,0\n1,0\n", encoding="utf-8")
    assert read_table(file) is None


@pytest.mark.parametrize(
    ("spoil", "text"),
    [
        (lambda t: t.replace("normal_y", "normal"), "no column normal_y"),
        (lambda t: t.replace("\n1,", "\n3,"), "column body"),
        (lambda t: t.replace("\n1,", "\n2,", 1), "column body"),
        (
            lambda t: "\n".join([*t.split("\n")[:5], "1,a,b,c,d,e,f,g,h,i,j"]),
            "that are not numbers",
        ),
        (lambda t: "\n".join(t.split("\n")[:3]), "fewer than 4 rows"),
        (lambda t: "\n".join([*t.split("\n")[:-2], "1,0.1,0,0,1,0,-1,0,0,0,25"]), "in metres"),
    ],
)
def test_spoiled_tables(tmp_path, spoil, text):
    """requirement: what is wrong with a table is said."""
    file = tmp_path / "design.csv"
    write(flat(), file)
    file.write_text(spoil(file.read_text()), encoding="utf-8")
    with pytest.raises(ValueError, match=text):
        from_table(read_table(file), 2)


def test_headers_name_their_units():
    """requirement: the columns of a profile, with the depth and the body."""
    assert HEADERS[:5] == ("body", "x_m", "y_m", "z_m", "s_m")
    assert HEADERS[-3:] == ("shape_m", "shape_along_press_m", "depth_m")


def test_a_place_that_cannot_be_written(tmp_path):
    """requirement: one line, no traceback."""
    with pytest.raises(CaseError, match="cannot be written"):
        write(flat(), tmp_path / "none" / "design.csv")


# ---- bodies ----


def test_one_body_alone():
    """requirement: a body with its zones and surfaces, nothing of the other one."""
    mesh, _ = body_of("drum-brake")
    assert mesh.bodies == ("shoe", "lining")
    assert mesh.surfaces == ("shoe_face", "shoe_inside", "shoe_side")
    length = np.radians(110.0)
    assert area(mesh) == pytest.approx(length / 2 * (0.1**2 - 0.087**2), rel=1e-7)
    lining = areas(mesh, "lining").sum()
    assert lining == pytest.approx(length / 2 * (0.1**2 - 0.095**2), rel=1e-7)


def test_an_outline_is_cut_at_its_corners():
    """requirement: a loop of straight sides, with the face as one of them."""
    mesh, face = body_of(STEADY)
    (pieces,) = loops(mesh, face)
    assert len(pieces) == 4
    (own,) = [piece for piece in pieces if piece.is_face]
    assert mesh.points[own.nodes][:, 1] == pytest.approx(0.0)
    assert all(pieces[k - 1].nodes[-1] == pieces[k].nodes[0] for k in range(4))


def test_a_hole_is_a_loop_of_its_own():
    """requirement: the bore of the disk runs round the other way, in one piece."""
    mesh, face = body_of("block-on-disk", 1)
    rim, bore = sorted(loops(mesh, face), key=len, reverse=True)
    assert [piece.is_face for piece in bore] == [False]
    assert np.linalg.norm(mesh.points[bore[0].nodes], axis=1) == pytest.approx(8e-3)
    assert sum(piece.is_face for piece in rim) == 1


@pytest.mark.parametrize("degree", [1, 3])
def test_the_ring_loses_what_is_worn(degree):
    """requirement: the area that the design takes off, sides upright, back where it was."""
    mesh, face = body_of(STEADY, changes={"mesh.degree": degree, "mesh.elements": 24})
    design = flat()
    moved = replace(mesh, points=moved_body(mesh, design, face, serial_extension))
    off = np.linalg.norm(moved.points - mesh.points, axis=1)
    assert off.max() == pytest.approx(waves(np.pi / 120), rel=2e-2)
    on_top = np.abs(mesh.points[:, 1] - HEIGHT) < 1e-12
    assert off[on_top] == pytest.approx(0.0)
    assert moved.points[:, 0] == pytest.approx(mesh.points[:, 0], abs=1e-15)
    lost = 2e-5 * (1.2 * 0.1 + (np.cos(60 * INNER) - np.cos(60 * OUTER)) / 60)
    assert area(mesh) - area(moved) == pytest.approx(lost, rel=2e-2)


def test_ends_of_an_arc_slide_along_the_sides():
    """requirement: upright sides stay upright though the face is worn along slanting normals."""
    mesh, face = body_of("block-on-disk")
    moved = replace(mesh, points=moved_body(mesh, round_one(), face, serial_extension))
    side = RADIUS * np.sin(ARC)
    at_side = np.abs(np.abs(mesh.points[:, 0]) - side) < 1e-12
    assert np.abs(moved.points[at_side, 0]) == pytest.approx(side, abs=1e-15)
    worn = mesh.facets[mesh.facet_tags == mesh.surfaces.index(face) + 1]
    radius = np.linalg.norm(moved.points[np.unique(worn)], axis=1)
    assert radius == pytest.approx(RADIUS + 3e-6, abs=2e-9)
    lost = 2 * ARC * RADIUS * 3e-6
    assert area(mesh) - area(moved) == pytest.approx(lost, rel=1e-3)


def test_a_prism_in_space_sinks():
    """requirement: the face takes on the shape, the top stays."""
    case = tw.load(PUNCH)
    mesh = only_body(case.tagged_mesh(), ("punch",))
    x, y = (
        v.ravel() for v in np.meshgrid(np.linspace(-0.03, 0.03, 13), np.linspace(-0.04, 0.04, 13))
    )
    out, nothing = np.tile([0.0, 0.0, -1.0], (169, 1)), np.full(169, np.nan)
    depth = 1e-5 * (1 + x / 0.03)
    design = Design(1, np.column_stack([x, y, 0 * x]), nothing, out, nothing, nothing, depth)
    moved = moved_body(mesh, design, "punch_face", serial_extension)
    bottom, top = mesh.points[:, 2] < 1e-12, mesh.points[:, 2] > 0.05 - 1e-12
    sunk = 1e-5 * (1 + mesh.points[bottom, 0] / 0.03)
    assert moved[bottom, 2] == pytest.approx(sunk, abs=1e-11)
    assert moved[top] == pytest.approx(mesh.points[top])


@pytest.mark.parametrize("ending", [".msh", ".vtu"])
def test_mesh_files(tmp_path, ending):
    """requirement: quadratic at least, with how far each node was moved."""
    mesh, face = body_of(STEADY, changes={"mesh.degree": 1})
    file = tmp_path / f"ring{ending}"
    write_design_mesh(mesh, flat(), face, file, serial_extension)
    add_table(flat(), file)
    found = meshio.read(file)
    assert found.cells[0].type == "quad9"
    told = found.point_data["displacement_m"]
    points = found.points - told
    assert points.min(axis=0)[:2] == pytest.approx([INNER, 0.0], abs=1e-12)
    on_face = np.abs(points[:, 1]) < 1e-12
    assert told[on_face, 1] == pytest.approx(waves(points[on_face, 0]), abs=1e-9)


def test_a_mesh_is_written_as_before(tmp_path):
    """requirement: ``mesh`` writes no data at points."""
    case = tw.load(tables(STEADY))
    write_mesh(case.tagged_mesh(), tmp_path / "both.vtu")
    assert not meshio.read(tmp_path / "both.vtu").point_data
