"""Meshes of bodies in space that are read from files."""

import re
import warnings
from dataclasses import replace

import meshio
import numpy as np
import pytest

import thermowear as tw
from thermowear.case.tables.mesh import MeshTable
from thermowear.case.values.section import MODEL
from thermowear.errors import CaseError
from thermowear.geometry.geometries.mesh_file import MeshFile
from thermowear.geometry.mesh.nodes import facet_nodes, shape_functions, slopes
from thermowear.geometry.mesh.tagged import compact, scaled_jacobians
from thermowear.geometry.reading.contents import VTK_ORDER
from thermowear.geometry.reading.export import write_mesh
from thermowear.lagrange import gauss

from ..conftest import NAMES
from ..contact.solids import bent, straight, two_solids
from ..solid_meshes import BLOCKS, DISK, GLUED, PAD, write_blocks


def geometry(path, **keys):
    return MeshFile.model_validate(
        {"type": "file", "path": str(path)} | keys, context={MODEL: "3d"}
    )


def read(path, **keys):
    return geometry(path, **keys).build(MeshTable(), None)


def volume(mesh, body):
    cells = mesh.points[mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]]
    points, weights = gauss(2 * mesh.order + 1, mesh.cell_type)
    tangents = np.einsum("qdk,cki->cqdi", slopes(mesh.cell_type, mesh.order, points), cells)
    return np.linalg.det(tangents).sum(axis=0) @ weights


def outward(mesh, surface):
    """Integral of the outward normal over a surface, shape (3,)."""
    facets = mesh.points[mesh.facets_of(surface)]
    points, weights = gauss(2 * mesh.order + 1, mesh.facet_type)
    tangents = np.einsum("qdk,fki->fqdi", slopes(mesh.facet_type, mesh.order, points), facets)
    return np.einsum("q,fqi->i", weights, np.cross(tangents[:, :, 0], tangents[:, :, 1]))


def check_blocks(mesh):
    """Volumes, and areas of all surfaces with outward normals, of the blocks of `write_blocks`."""
    assert volume(mesh, "pad") == pytest.approx(np.prod(PAD), rel=1e-9)
    assert volume(mesh, "disk") == pytest.approx(np.prod(DISK), rel=1e-9)
    assert scaled_jacobians(mesh).min() > 0.01
    pad, disk = PAD[0] * PAD[1], DISK[0] * DISK[1]
    face = disk if "DISK_FACE" in mesh.surfaces and len(mesh.facets_of("DISK_FACE")) else pad
    face = pad if outward(mesh, "DISK_FACE")[2] < 0.9 * disk else face
    for surface, area in {"PAD_FACE": -pad, "DISK_FACE": face, "PAD_BACK": pad}.items():
        assert outward(mesh, surface) == pytest.approx([0, 0, area], abs=1e-8)
    assert outward(mesh, "DISK_BOTTOM") == pytest.approx([0, 0, -disk], abs=1e-8)
    own = [np.unique(mesh.cells[mesh.cell_tags == tag]) for tag in (1, 2)]
    assert not len(np.intersect1d(*own))
    assert np.isin(mesh.facets_of("PAD_FACE"), own[0]).all()
    assert np.isin(mesh.facets_of("DISK_FACE"), own[1]).all()


@pytest.mark.parametrize("form", [(2.2, 0), (2.2, 1), (4.1, 0), (4.1, 1)])
@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("hexahedra", [False, True])
def test_meshes_of_gmsh(tmp_path, form, order, hexahedra):
    """
    requirement: .msh of both versions, text and binary, of any order; bodies that share the nodes
    of their joint are split there, and a named joint belongs to both.
    """
    version, binary = form
    glued = bool(binary)
    path = write_blocks(
        *(tmp_path / "a.msh", order, hexahedra, glued, 12.0),
        MshFileVersion=version,
        Binary=binary,
    )
    mesh = read(path, **(GLUED if glued else BLOCKS))
    assert mesh.cell_type == ("hexahedron" if hexahedra else "tetrahedron")
    assert mesh.order == order
    check_blocks(mesh)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("hexahedra", [False, True])
@pytest.mark.parametrize("incomplete", [0, 1])
@pytest.mark.parametrize("nodes", [0, 1])
def test_abaqus_files_of_gmsh(tmp_path, order, hexahedra, incomplete, nodes):
    """
    requirement: .inp as gmsh writes it: C3D4, C3D8, C3D10, C3D20 (completed to 27 nodes), surfaces
    as sets of shells.
    """
    options = {"SecondOrderIncomplete": incomplete, "SaveGroupsOfNodes": nodes}
    path = write_blocks(tmp_path / "a.inp", order, hexahedra, False, 12.0, **options)
    mesh = read(path, **BLOCKS)
    assert mesh.order == order
    check_blocks(mesh)


def curved(cell_type, order):
    """Two curved blocks whose straight and mid nodes are told apart by their volumes."""
    return two_solids(((2, 2, 2), (3, 2, 2)), order, (bent, straight), cell_type)


def same_solids(mesh, made):
    for body in made.bodies:
        assert volume(mesh, body) == pytest.approx(volume(made, body), rel=1e-10)
    for surface in mesh.surfaces:
        assert outward(mesh, surface) == pytest.approx(outward(made, surface), abs=1e-12)


@pytest.mark.parametrize("ending", ["msh", "inp", "vtu", "xdmf"])
@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_exports_are_read_back(tmp_path, ending, cell_type, order):
    """
    requirement: curved cells in the node order of every format; a wrong order changes the volume.
    """
    if order == 3 and ending != "msh":
        pytest.skip("cells of the third order only in .msh")
    made, path = curved(cell_type, order), tmp_path / f"mesh.{ending}"
    write_mesh(made, path)
    keys = NAMES
    if ending in ("vtu", "xdmf"):
        numbers = {n: str(i) for i, n in enumerate((*made.bodies, *made.surfaces), start=1)}
        used = [*NAMES["contact"], NAMES["held"], NAMES["fixed"]]
        keys = NAMES | {"bodies": {name: numbers[name] for name in made.bodies}}
        keys["surfaces"] = {name: numbers[name] for name in used}
    mesh = read(path, **keys)
    assert mesh.order == order
    if ending == "inp" and cell_type == "hexahedron" and order == 2:  # 20 nodes
        assert volume(mesh, "upper") == pytest.approx(volume(made, "upper"), rel=1e-3)
    else:
        same_solids(mesh, made)


def test_hexahedra_of_twenty_nodes(tmp_path):
    """
    requirement: nodes inside faces and cells lie where the shape functions of 20 nodes imply.
    """
    made = curved("hexahedron", 2)
    write_mesh(made, tmp_path / "a.inp")
    mesh = read(tmp_path / "a.inp", **NAMES)
    x = mesh.points[mesh.cells]
    for face in facet_nodes("hexahedron", 2):
        *sides, centre = np.moveaxis(x[:, face], 1, 0)
        assert np.sum(sides[4:], axis=0) / 2 - np.sum(sides[:4], axis=0) / 4 == pytest.approx(
            centre, abs=1e-15
        )
    # 1/4 of the nodes in edges, -1/4 of the corners
    assert x[:, 8:20].sum(axis=1) / 4 - x[:, :8].sum(axis=1) / 4 == pytest.approx(
        x[:, 26], abs=1e-15
    )
    values = shape_functions("hexahedron", 2, np.array([[0.3, 0.6, 0.2]]))
    assert values.sum() == pytest.approx(1.0)


@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
@pytest.mark.parametrize("order", [1, 2])
def test_families_of_med(tmp_path, cell_type, order):
    """
    requirement: .med by the names of its groups, with cells in MED's (mirrored) orientation.
    """
    if (cell_type, order) == ("hexahedron", 2):
        pytest.skip("meshio writes no hexahedra of 27 nodes to .med")
    made = curved(cell_type, order)
    kind = {("tetrahedron", 1): "tetra", ("tetrahedron", 2): "tetra10"}.get(
        (cell_type, order), "hexahedron"
    )
    facet = {3: "triangle", 6: "triangle6", 4: "quad"}[made.facets.shape[1]]
    cells = made.cells[:, np.argsort(VTK_ORDER[kind])] if kind in VTK_ORDER else made.cells
    if cell_type == "tetrahedron":
        mirrored = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8][: cells.shape[1]]
    else:
        mirrored = [0, 3, 2, 1, 4, 7, 6, 5]
    mesh = meshio.Mesh(made.points, [(kind, cells[:, mirrored]), (facet, made.facets)])
    n = len(made.bodies)
    mesh.cell_data["cell_tags"] = [-made.cell_tags.astype(int), -(made.facet_tags + n).astype(int)]
    mesh.cell_tags = {-i: [s] for i, s in enumerate((*made.bodies, *made.surfaces), start=1)}
    mesh.point_tags = {}
    meshio.write(tmp_path / "a.med", mesh)
    found = read(tmp_path / "a.med", **NAMES)
    same_solids(found, made)


DECK = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
11, 0., 0., -2.
12, 1., 0., -2.
13, 1., 1., -2.
14, 0., 1., -2.
*ELEMENT, TYPE=C3D8R, ELSET=UPPER
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=DC3D8, ELSET=LOWER
2, 11, 12, 13, 14, 1, 2, 3, 4
*NSET, NSET=TOP
5, 6, 7, 8
*SURFACE, NAME=UPPER_FACE
UPPER, S1
*SURFACE, NAME=LOWER_FACE, TYPE=ELEMENT
2, S2
*SURFACE, NAME=BOTTOM
LOWER, S1
"""
DECK_NAMES = {
    "bodies": {"upper": "UPPER", "lower": "LOWER"},
    "contact": ["UPPER_FACE", "LOWER_FACE"],
    "held": "TOP",
    "fixed": "BOTTOM",
}


def test_surfaces_of_abaqus(tmp_path):
    """
    requirement: *SURFACE by sides of solid elements or their sets, *NSET; shared nodes are split.
    """
    (tmp_path / "a.inp").write_text(DECK)
    mesh = read(tmp_path / "a.inp", **DECK_NAMES)
    assert len(mesh.points) == 16
    assert volume(mesh, "lower") == pytest.approx(2.0)
    for surface, normal in {"UPPER_FACE": -1, "LOWER_FACE": 1, "TOP": 1, "BOTTOM": -1}.items():
        assert outward(mesh, surface) == pytest.approx([0, 0, normal])


SIDES = {
    "C3D4": ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], "0 1 2, 0 3 1, 1 3 2, 2 3 0"),
    "C3D8": (
        [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))],
        "0 1 2 3, 4 7 6 5, 0 4 5 1, 1 5 6 2, 2 6 7 3, 3 7 4 0",
    ),
}


@pytest.mark.parametrize("kind", SIDES)
def test_sides_of_abaqus(tmp_path, kind):
    """
    requirement: S1 to S6 as numbered in Abaqus' manual.
    """
    corners, sides = SIDES[kind]
    count = len(corners)
    corners = np.array(corners, dtype=float)
    for number, side in enumerate(sides.split(","), start=1):
        nodes = [
            f"{first + i}, {x}, {y}, {z}"
            for first, low in ((1, 0), (1 + count, 5))
            for i, (x, y, z) in enumerate(corners + [0, 0, low])
        ]
        ids = [", ".join(str(first + i) for i in range(count)) for first in (1, 1 + count)]
        other = 1 + number % len(sides.split(","))
        deck = ["*NODE", *nodes, f"*ELEMENT, TYPE={kind}, ELSET=LOWER", f"1, {ids[0]}"]
        deck += [f"*ELEMENT, TYPE={kind}, ELSET=UPPER", f"2, {ids[1]}"]
        for body, at in (("UPPER", 2), ("LOWER", 1)):
            deck += [f"*SURFACE, NAME={body}_FACE", f"{at}, S{number}"]
            deck += [f"*SURFACE, NAME={body}_END", f"{body}, S{other}"]
        (tmp_path / "a.inp").write_text("\n".join(deck))
        keys = DECK_NAMES | {"held": "UPPER_END", "fixed": "LOWER_END"}
        mesh = read(tmp_path / "a.inp", **keys)
        expected = corners[[int(k) for k in side.split()]]
        assert mesh.points[mesh.facets_of("LOWER_FACE")[0]].mean(axis=0) == pytest.approx(
            expected.mean(axis=0)
        )


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("C3D8R", "C3D6"), "geometry.path: .* elements of type C3D6 are not supported"),
        (("C3D8R", "C3D4"), "an element of type C3D4 does not have 4 nodes"),
        (("5, 0., 0., 1.", "5, 0., 0., nan"), "not finite"),
        (("LOWER, S1", "LOWER, S2"), "geometry.surfaces: 'LOWER_FACE' and 'BOTTOM' share 1 facets"),
    ],
)
def test_broken_abaqus_files(tmp_path, change, expected):
    """
    requirement: one clear line.
    """
    assert change[0] in DECK
    (tmp_path / "a.inp").write_text(DECK.replace(*change))
    with pytest.raises(CaseError) as error:
        tw.load(file_tables(tmp_path / "a.inp", **DECK_NAMES)).tagged_mesh()
    (line,) = error.value.faults
    assert re.search(expected, line), line


def file_tables(path, **keys):
    """Case with the file as geometry."""
    bodies = keys["bodies"]
    first, second = bodies
    return {
        "model": "3d",
        "geometry": {"type": "file", "path": str(path)} | keys,
        "mesh": {"degree": 1},
        "bodies": {
            first: {"young_modulus": "100 GPa", "poisson_ratio": 0.3},
            second: {"like": first},
        },
        "load": {"force": "1 kN"},
        "analysis": {"type": "initial"},
    }


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"half": True}, "geometry.half: requires a plane model; in space list"),
        ({"thickness": "1 mm"}, "geometry.thickness: requires a plane model"),
        ({"rotation_center": ["1 mm"]}, "geometry.rotation_center"),
    ],
)
def test_keys_of_plane_models(tmp_path, changes, expected):
    """
    requirement: keys without meaning in space are refused at their path.
    """
    with pytest.raises(CaseError) as error:
        tw.load(file_tables("a.msh", **(BLOCKS | changes)))
    assert error.value.faults[0].startswith(expected)


def test_a_turning_body_without_its_axis(tmp_path):
    """
    requirement: the missing key of the geometry is named.
    """
    tables = file_tables("a.msh", **BLOCKS) | {"motion": {"angular_velocity": "1 rad/s"}}
    with pytest.raises(CaseError) as error:
        tw.load(tables)
    assert error.value.faults == [
        "motion.angular_velocity: not supported; a 3d model needs motion.velocity, or "
        "geometry.rotation_center (of the axis along z) if body 2 rotates"
    ]


def test_keys_of_space_in_plane_models():
    """
    requirement: rollers and an axis are refused in sections.
    """
    tables = file_tables("a.msh", **BLOCKS) | {"model": "plane-strain"}
    for key, value in {"rollers": ["A"], "rotation_center": ["0 mm", "0 mm"]}.items():
        with pytest.raises(CaseError) as error:
            tw.load(tables | {"geometry": tables["geometry"] | {key: value}})
        assert error.value.faults[0] == f"geometry.{key}: requires a 3d model"


def test_a_case_is_written_out_again(tmp_path):
    """
    requirement: the resolved case is the same case.
    """
    path = write_blocks(tmp_path / "a.msh")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        case = tw.load(file_tables(path, length_unit="1 mm", **BLOCKS))
        assert tw.load(tw.case.as_plain(case)) == case
        assert len(case.tagged_mesh().cells) > 0
    assert case.geometry.press_direction == (0.0, 0.0, -1.0)


def test_a_file_for_each_body(tmp_path):
    """
    requirement: bodies in files of their own, of different formats, with the same names in both.
    """
    made = two_solids(((2, 2, 2), (3, 2, 2)), 2, (bent, straight), "tetrahedron")
    paths = {}
    for tag, (body, ending) in enumerate({"upper": "msh", "lower": "inp"}.items(), start=1):
        chosen = made.cell_tags == tag
        own = np.isin(made.facets, made.cells[chosen]).all(axis=1)
        tags = made.facet_tags[own] - made.facet_tags[own].min() + 1
        names = tuple(n.replace(body, "body") for n in made.surfaces if n.startswith(body))
        alone = replace(
            made,
            cells=made.cells[chosen],
            cell_tags=np.ones(chosen.sum(), dtype=np.int32),
            facets=made.facets[own],
            facet_tags=tags,
            bodies=("BODY",),
            surfaces=names,
        )
        paths[body] = str(tmp_path / f"{body}.{ending}")
        write_mesh(compact(alone), tmp_path / f"{body}.{ending}")
    keys = NAMES | {"bodies": {"upper": "BODY", "lower": "BODY"}}
    names = [*NAMES["contact"], NAMES["held"], NAMES["fixed"]]
    keys["surfaces"] = {n: n.replace("upper", "body").replace("lower", "body") for n in names}
    tables = file_tables("", **keys)
    tables["geometry"] = {k: v for k, v in tables["geometry"].items() if k != "path"}
    tables["geometry"]["paths"] = paths
    case = tw.load(tables)
    same_solids(case.tagged_mesh(), made)
    assert tw.load(tw.case.as_plain(case)) == case
    for change, expected in (
        ({"paths": {"upper": "a.msh"}}, "geometry.paths: needs a file for each of: upper, lower"),
        ({"path": "a.msh"}, "geometry.paths: only one of path and paths can be given"),
    ):
        with pytest.raises(CaseError) as error:
            tw.load(tables | {"geometry": tables["geometry"] | change})
        assert error.value.faults[0] == expected
    tables["geometry"]["paths"] = paths | {"lower": str(tmp_path / "no.inp")}
    with pytest.raises(CaseError, match=r"geometry.paths.lower: .*no.inp cannot be read: No such"):
        tw.load(tables).tagged_mesh()


def test_mean_pressure_on_the_faces_of_the_file(tmp_path):
    """
    requirement: without a given area, the lesser one of both faces, projected along the load.
    """
    path = write_blocks(tmp_path / "a.msh", 2)
    tables = file_tables(path, length_unit="1 mm", **BLOCKS)
    tables["load"] = {"mean_pressure": "2 MPa"}
    assert tw.load(tables).force() == pytest.approx(2 * PAD[0] * PAD[1], rel=1e-12)
    tables["geometry"]["contact_area"] = "100 mm^2"
    assert tw.load(tables).force() == pytest.approx(200.0, rel=1e-12)
