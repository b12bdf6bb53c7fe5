"""Meshes that are read from files."""

import textwrap
import warnings

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case.tables.mesh import MeshTable
from thermowear.errors import CaseError, CaseNote
from thermowear.geometry.geometries.mesh_file import MeshFile
from thermowear.geometry.geometries.on_block import CylinderOnBlock
from thermowear.geometry.mesh.gmsh_session import gmsh_model
from thermowear.geometry.reading.export import write_mesh

from ..case.starter import STEADY, changed, tables
from ..conftest import NAMES, two_blocks
from .measure import areas, edges, scaled_jacobians, unnamed
from .plain import NUMBERED, blocks, meshio_file


def file_geometry(path, **keys):
    return MeshFile.model_validate({"type": "file", "path": str(path)} | NAMES | keys)


def read(path, **keys):
    return file_geometry(path, **keys).build(MeshTable(), None)


def fault(path, **keys):
    with pytest.raises(CaseError) as error:
        read(path, **keys)
    assert len(error.value.faults) == 1
    assert "\n" not in error.value.faults[0]
    return error.value.faults[0]


def numbered(mesh):
    """Keys for formats without names: numbers as written by the export."""
    number = {name: str(i) for i, name in enumerate((*mesh.bodies, *mesh.surfaces), start=1)}
    return {
        "bodies": {name: number[name] for name in mesh.bodies},
        "surfaces": {name: number[name] for name in mesh.surfaces},
    }


def gmsh_blocks(path, version=4.1, order=1, triangles=False, glued=False, names=True, **options):
    """Two blocks of 40 x 20 and 40 x 30, in the unit of the file, as a user of gmsh makes them."""
    with gmsh_model("blocks") as gmsh:
        model, occ = gmsh.model, gmsh.model.occ
        upper, lower = occ.addRectangle(50, 0, 0, 40, 20), occ.addRectangle(50, -30, 0, 40, 30)
        if glued:
            occ.fragment([(2, upper)], [(2, lower)])
        occ.synchronize()
        box = model.getEntitiesInBoundingBox
        lines = {
            "FACE": box(49, -1, -1, 91, 1, 1, dim=1),
            "TOP": box(49, 19, -1, 91, 21, 1, dim=1),
            "BOTTOM": box(49, -31, -1, 91, -29, 1, dim=1),
        }
        for name, body in {"PUNCH": upper, "PLATE": lower}.items():
            model.addPhysicalGroup(2, [body], name=name if names else "")
        for name, found in lines.items():
            model.addPhysicalGroup(1, [tag for _, tag in found], name=name if names else "")
        gmsh.option.setNumber("Mesh.MeshSizeMax", 8)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.RecombineAll", 0 if triangles else 1)
        gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 3)
        gmsh.option.setNumber("Mesh.ElementOrder", order)
        for key, value in options.items():
            gmsh.option.setNumber(f"Mesh.{key}", value)
        model.mesh.generate(2)
        gmsh.write(str(path))
    return path


GMSH_NAMES = {
    "length_unit": "1 mm",
    "bodies": {"punch": "PUNCH", "plate": "PLATE"},
    "surfaces": {"punch_face": "FACE", "plate_face": "FACE"},
    "contact": ["punch_face", "plate_face"],
    "held": "TOP",
    "fixed": "BOTTOM",
}


@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.parametrize(("order", "triangles"), [(1, False), (2, False), (2, True), (3, True)])
@pytest.mark.parametrize("glued", [False, True])
def test_meshes_of_gmsh(tmp_path, version, order, triangles, glued):
    """
    requirement: .msh of both versions, any order; the unit of length; bodies that share the nodes
    of the contact come apart.
    """
    mesh = read(gmsh_blocks(tmp_path / "a.msh", version, order, triangles, glued), **GMSH_NAMES)
    assert mesh.cell_type == ("triangle" if triangles else "quadrilateral")
    assert mesh.order == order
    assert areas(mesh, "punch").sum() == pytest.approx(40e-3 * 20e-3, rel=1e-9)
    assert areas(mesh, "plate").sum() == pytest.approx(40e-3 * 30e-3, rel=1e-9)
    assert scaled_jacobians(mesh).min() > 0.1
    for face in ("punch_face", "plate_face"):
        x, y = np.moveaxis(edges(mesh, face), 2, 0)
        assert np.all(np.abs(y) < 1e-12)
        assert np.ptp(x) == pytest.approx(40e-3, rel=1e-9)
    own = [set(mesh.cells[mesh.cell_tags == tag].ravel()) for tag in (1, 2)]
    assert own[0].isdisjoint(own[1])
    for tag, face in ((1, "punch_face"), (2, "plate_face")):
        of_face = mesh.facets[mesh.facet_tags == mesh.surfaces.index(face) + 1]
        assert set(of_face.ravel()) <= own[tag - 1]


@pytest.mark.parametrize("version", [2.2, 4.1])
def test_binary_meshes_of_gmsh(tmp_path, version):
    """
    requirement: binary files are the same meshes as those of text.
    """
    text = read(gmsh_blocks(tmp_path / "a.msh", version, 2), **GMSH_NAMES)
    binary = read(gmsh_blocks(tmp_path / "b.msh", version, 2, Binary=1), **GMSH_NAMES)
    np.testing.assert_allclose(binary.points, text.points, atol=1e-15)
    np.testing.assert_array_equal(binary.cells, text.cells)
    np.testing.assert_array_equal(binary.facets, text.facets)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize("incomplete", [0, 1])
@pytest.mark.parametrize("nodes", [0, 1])
def test_abaqus_files_of_gmsh(tmp_path, order, triangles, incomplete, nodes):
    """
    requirement: .inp as gmsh writes it: CPS3, 4, 6, 8 or M3D9, lines T3D2 and T3D3 (end, middle,
    end) in sets of elements, and sets of nodes of the same names.
    """
    options = {"SecondOrderIncomplete": incomplete, "SaveGroupsOfNodes": nodes}
    path = gmsh_blocks(tmp_path / "a.inp", 4.1, order, triangles, **options)
    mesh = read(path, **GMSH_NAMES)
    assert mesh.order == order
    assert areas(mesh, "punch").sum() == pytest.approx(40e-3 * 20e-3, rel=1e-9)
    for face in ("punch_face", "plate_face"):
        x, y = np.moveaxis(edges(mesh, face), 2, 0)
        assert np.all(np.abs(y) < 1e-12)
        assert np.ptp(x) == pytest.approx(40e-3, rel=1e-9)


def test_numbers_stand_for_physical_groups_without_names(tmp_path):
    """
    requirement: physical tags without names go by their numbers.
    """
    keys = GMSH_NAMES | {
        "bodies": {"punch": "1", "plate": "2"},
        "surfaces": {"punch_face": "3", "plate_face": "3", "top": "4", "bottom": "5"},
        "held": "top",
        "fixed": "bottom",
    }
    path = gmsh_blocks(tmp_path / "a.msh", 2.2, names=False)
    mesh = read(path, **keys)
    assert areas(mesh, "punch").sum() == pytest.approx(40e-3 * 20e-3, rel=1e-9)


@pytest.mark.parametrize("ending", ["msh", "inp", "vtu", "xdmf"])
def test_exports_are_read_back(tmp_path, ending):
    """
    requirement: what `thermowear mesh -o` writes can be read as a case's geometry.
    """
    made = two_blocks()
    path = tmp_path / f"mesh.{ending}"
    write_mesh(made, path)
    mesh = read(path, **(numbered(made) if ending in ("vtu", "xdmf") else {}))
    assert mesh.bodies == made.bodies
    for body in made.bodies:
        assert areas(mesh, body).sum() == pytest.approx(areas(made, body).sum(), rel=1e-12)
    assert set(mesh.surfaces) <= set(made.surfaces)
    for surface in mesh.surfaces:
        one, two = (np.sort(edges(m, surface)[:, :2].sum(axis=(1, 2))) for m in (mesh, made))
        np.testing.assert_allclose(one, two, atol=1e-12)


@pytest.mark.parametrize("ending", ["msh", "inp", "vtu", "xdmf"])
def test_curved_exports_are_read_back(tmp_path, ending):
    """
    requirement: cells of the third order as such, or as cells of the second whose nodes lie on
    them.
    """
    cylinder = CylinderOnBlock(
        type="cylinder-on-block", radius="10 mm", block_width="40 mm", block_height="20 mm"
    )
    made = cylinder.build(MeshTable(elements=20), (-5e-4, 5e-4))
    path = tmp_path / f"mesh.{ending}"
    write_mesh(made, path)
    keys = numbered(made) if ending in ("vtu", "xdmf") else {"bodies": {b: b for b in made.bodies}}
    keys |= {"contact": list(cylinder.contact), "held": cylinder.held, "fixed": cylinder.fixed}
    keys.setdefault("surfaces", {name: name for name in made.surfaces})
    mesh = read(path, **keys)
    assert mesh.order == (3 if ending == "msh" else 2)
    assert unnamed(mesh) == 0
    for body in made.bodies:
        assert areas(mesh, body).sum() == pytest.approx(areas(made, body).sum(), rel=1e-3)
    p = edges(mesh, "cylinder_face")
    np.testing.assert_allclose(np.hypot(p[..., 0], p[..., 1] - 1e-2), 1e-2, rtol=1e-8)


DECK = """\
    ** two cells of eight nodes, numbered clockwise in body 2
    *HEADING
    *Node, NSET=ALL
    1, 0., 0.
    2, 1., 0.
    3, 1., 1.
    4, 0., 1.
    5, .5, 0.
    6, 1.2, .5
    7, .5, 1.
    8, 0., .5
    11, 0., 0., 0.
    12, 1., 0., 0.
    13, 1., -1., 0.
    14, 0., -1., 0.
    15, .5, 0., 0.
    16, 1., -.5, 0.
    17, .5, -1., 0.
    18, 0., -.5, 0.
    *Element, type=CPS8R, elset=PUNCH
    1, 1, 2, 3, 4, 5, 6, 7, 8
    *Element, type=CPS8R
    2, 11, 12, 13, 14, 15,
    16, 17, 18
    *Elset, elset=PLATE, generate
    2, 2, 1
    *Nset, nset=TOP
    3, 4, 7
    *Nset, nset=NOTHING
    1, 3
    *Nset, nset=BOTTOM, generate
    13, 14
    *Nset, nset=BOTTOM
    17
    *Surface, name=PUNCH_FACE, type=element
    PUNCH, S1
    *Surface, name=PLATE_FACE
    2, S1
    """
DECK_NAMES = {
    "bodies": {"punch": "PUNCH", "plate": "PLATE"},
    "contact": ["PUNCH_FACE", "PLATE_FACE"],
    "held": "TOP",
    "fixed": "BOTTOM",
}


def deck(tmp_path, *changes):
    text = textwrap.dedent(DECK)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "deck.inp"
    path.write_text(text)
    return path


def test_abaqus(tmp_path):
    """
    requirement: sets of elements and of nodes, surfaces, cells of eight nodes (which get a node in
    the middle), cells listed clockwise.
    """
    mesh = read(deck(tmp_path), **DECK_NAMES)
    assert mesh.cells.shape == (2, 9)
    assert areas(mesh, "plate") == pytest.approx([1.0], rel=1e-12)
    assert areas(mesh, "punch") == pytest.approx([1.0 + 2 / 3 * 0.2], rel=1e-12)
    centre = mesh.points[mesh.cells[mesh.cell_tags == 1][0, 8]]
    assert centre == pytest.approx([0.6, 0.5], abs=1e-12)
    assert np.all(edges(mesh, "TOP")[..., 1] == 1.0)
    assert np.all(edges(mesh, "BOTTOM")[..., 1] == -1.0)
    for face in ("PUNCH_FACE", "PLATE_FACE"):
        assert edges(mesh, face).shape == (1, 3, 2)
        assert np.all(edges(mesh, face)[..., 1] == 0.0)


@pytest.mark.parametrize(
    "kind", ["CPS8", "CPE8", "CAX8", "CPE8RH", "CAX8RT", "CPEG8", "cps8r", "M3D8", "S8R5"]
)
def test_kinds_of_abaqus_elements(tmp_path, kind):
    """
    requirement: plane stress and strain, generalised, axisymmetric, membranes and shells.
    """
    changes = [(f"type=CPS8R{end}", f"type={kind}{end}") for end in (", elset", "\n")]
    mesh = read(deck(tmp_path, *changes), **DECK_NAMES)
    assert mesh.cells.shape == (2, 9)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("*HEADING", "*NGEN\n1, 4, 1"), "*NGEN generates nodes or elements"),
        (("*HEADING", "*SYSTEM\n0, 0, 0"), "*SYSTEM transforms coordinates"),
        (("*HEADING", "*Instance, name=A\n1., 0., 0."), "*INSTANCE moves a part"),
        (("*Node, NSET=ALL", "*Node, NSET=ALL, SYSTEM=C"), "is not Cartesian"),
        (("12, 1., 0., 0.", "2, 1.5, 0., 0."), "node 2 is defined twice"),
        (("2, 11, 12, 13, 14, 15", "1, 11, 12, 13, 14, 15"), "element 1 is defined twice"),
        (("2, 2, 1", "2, 2, 0"), "a range with the step 0"),
    ],
)
def test_abaqus_cards_that_change_the_mesh(tmp_path, change, expected):
    """
    requirement: what would make or move nodes and elements is not passed over; numbers that several
    parts have each are refused.
    """
    assert expected in fault(deck(tmp_path, change), **DECK_NAMES)


NO_CELLS = "geometry.bodies.punch: the file has no cells named"
NO_SURFACE = "the file has no surface named"
SURFACES = "one of: ALL, BOTTOM, NOTHING, PLATE_FACE, PUNCH_FACE, TOP"
ELSEWHERE = "is not on the boundary of"


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ({"bodies": {"punch": "P", "plate": "PLATE"}}, f"{NO_CELLS} 'P'; one of: PLATE, PUNCH"),
        ({"bodies": {"punch": "TOP", "plate": "PLATE"}}, f"{NO_CELLS} 'TOP'"),
        (
            {"bodies": {"punch": "PUNCH", "plate": "PUNCH"}},
            "geometry.bodies: 1 cells are in both 'PUNCH' and 'PUNCH'",
        ),
        ({"contact": ["FACE", "PLATE_FACE"]}, f"geometry.contact: {NO_SURFACE} 'FACE'; {SURFACES}"),
        (
            {"contact": ["PLATE_FACE", "PUNCH_FACE"]},
            f"geometry.contact: 'PLATE_FACE' {ELSEWHERE} body 'punch'",
        ),
        (
            {"held": "BOTTOM", "fixed": "TOP"},
            f"geometry.held: 'BOTTOM' {ELSEWHERE} body 'punch'",
        ),
        ({"surfaces": {"cold": "BOTTM"}}, f"geometry.surfaces.cold: {NO_SURFACE} 'BOTTM'"),
        (
            {"symmetry": ["NOTHING"], "half": True},
            f"geometry.symmetry: 'NOTHING' {ELSEWHERE} a body",
        ),
    ],
)
def test_names_that_are_not_there(tmp_path, keys, expected):
    """
    requirement: one clear line with the key's path that lists the names of the file.
    """
    assert fault(deck(tmp_path), **(DECK_NAMES | keys)).startswith(expected)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5"), "does not have 8 nodes"),
        (("16, 17, 18", "16, 17, 99"), "99"),
        (("*Element, type=CPS8R, elset", "*Element, type=C3D8, elset"), "type C3D8"),
        (("2, 1., 0.", "2, 1., zero"), "zero"),
        (("2, 1., 0.", "2, 1., nan"), "the coordinates of some nodes of the bodies are not finite"),
        (("13, 1., -1., 0.", "13, 1., -1., 1."), "do not lie in a plane"),
    ],
)
def test_broken_abaqus_files(tmp_path, change, expected):
    """
    requirement: one clear line for whatever is wrong in a file.
    """
    text = fault(deck(tmp_path, change), **DECK_NAMES)
    assert text.startswith("geometry.path: ")
    assert expected in text


def test_cells_without_area(tmp_path):
    """
    requirement: degenerate cells are refused.
    """
    changes = [("13, 1., -1., 0.", "13, 1., 0., 0."), ("14, 0., -1.", "14, 0., 0.")]
    assert "1 of 1 cells of 'plate' are tangled or flat" in fault(
        deck(tmp_path, *changes), **DECK_NAMES
    )


def test_mixed_cells(tmp_path):
    """
    requirement: triangles among the quadrilaterals of a body are refused in one line.
    """
    with gmsh_model("mixed") as gmsh:
        bodies = [gmsh.model.occ.addRectangle(x, 0, 0, 1, 1) for x in (0, 1, 5)]
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, bodies[:2], name="upper")
        gmsh.model.addPhysicalGroup(2, bodies[2:], name="lower")
        gmsh.model.mesh.setRecombine(2, bodies[0])
        gmsh.model.mesh.generate(2)
        gmsh.write(str(tmp_path / "a.msh"))
    text = fault(tmp_path / "a.msh")
    assert text.startswith("geometry.bodies.upper: mixed cell types, triangles of 3 nodes")


def test_three_dimensional_cells(tmp_path):
    """
    requirement: a plane section is needed.
    """
    with gmsh_model("solid") as gmsh:
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(3)
        gmsh.write(str(tmp_path / "a.msh"))
    assert "three-dimensional cells" in fault(tmp_path / "a.msh")


@pytest.mark.parametrize("ending", ["msh", "inp", "vtu", "xdmf", "med"])
@pytest.mark.parametrize("content", ["", "nonsense\n1 2 3\n", "cut"])
def test_unreadable_files(tmp_path, ending, content):
    """
    requirement: empty, foreign and truncated files give one line.
    """
    path = tmp_path / f"mesh.{ending}"
    if content == "cut" and ending != "med":
        write_mesh(two_blocks(), path)
        content = path.read_text()[: path.stat().st_size // 2]
    path.write_text(content)
    assert fault(path).startswith("geometry.")


def test_files_that_are_not_there(tmp_path):
    """
    requirement: missing files and unknown endings give one line.
    """
    assert fault(tmp_path / "no.msh").endswith("cannot be read: No such file or directory")
    assert "unknown file ending; must be one of: .msh, .inp" in fault(tmp_path / "mesh.stl")
    (tmp_path / "folder.msh").mkdir()
    assert fault(tmp_path / "folder.msh").endswith("cannot be read: Is a directory")


def med_file(path):
    """Two squares with families, as Salome writes them."""
    import meshio

    x = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    points = np.concatenate([x, x - [0, 1]])
    lines = np.array([[0, 1], [2, 3], [7, 6], [4, 5]])
    mesh = meshio.Mesh(points, [("quad", np.array([[0, 1, 2, 3], [4, 5, 6, 7]])), ("line", lines)])
    mesh.cell_data["cell_tags"] = [np.array([-1, -2]), np.array([-3, -4, -5, -6])]
    names = ("upper", "lower", "upper_face", "upper_end", "lower_face", "lower_end")
    mesh.cell_tags = {-i: [name] for i, name in enumerate(names, start=1)}
    mesh.point_tags = {}
    meshio.write(path, mesh)


def test_families_of_med(tmp_path):
    """
    requirement: .med by the names of its groups.
    """
    med_file(tmp_path / "a.med")
    mesh = read(tmp_path / "a.med")
    assert areas(mesh, "upper").sum() == pytest.approx(1.0)
    assert np.all(edges(mesh, "upper_end")[..., 1] == 1.0)
    assert np.all(edges(mesh, "lower_end")[..., 1] == -1.0)


def file_tables(path, **changes):
    keys = {"type": "file", "path": str(path)} | GMSH_NAMES | changes
    case = tables(STEADY)
    case["geometry"] = keys
    case["heat"]["cooling"] = {"BOTTOM": "1 kW/(m^2 K)"}
    case["load"] = {"force": "1 kN"}
    return case


def test_a_case_with_a_file(tmp_path):
    """
    requirement: keys of the case file, names of bodies and surfaces in its other tables, and the
    case written out again.
    """
    path = gmsh_blocks(tmp_path / "a.msh")
    case = tw.load(file_tables(path, contact_area="200 mm^2"))
    geometry = case.geometry
    assert geometry.bodies == ("punch", "plate")
    assert geometry.contact == ("punch_face", "plate_face")
    assert (geometry.held, geometry.fixed) == ("TOP", "BOTTOM")
    assert geometry.surfaces == ("punch_face", "plate_face", "TOP", "BOTTOM")
    assert geometry.contact_area() == pytest.approx(2e-4)
    plain = tw.case.as_plain(case)
    assert plain["geometry"]["bodies"] == GMSH_NAMES["bodies"]
    assert tw.load(plain) == case
    mesh = case.tagged_mesh()
    assert mesh.surfaces == geometry.surfaces
    assert len(np.unique(mesh.facet_tags)) == 4


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"bodies": {"punch": "PUNCH"}}, "geometry.bodies: needs two"),
        ({"bodies": ["PUNCH", "PLATE"]}, "geometry.bodies: "),
        ({"contact": ["punch_face"]}, "geometry.contact"),
        ({"contact": ["FACE", "FACE"]}, "geometry.contact: 'FACE' is used twice"),
        ({"held": "BOTTOM"}, "geometry.fixed: 'BOTTOM' is used twice"),
        ({"held": 3}, "geometry.held: found 3; must be text"),
        ({"length_unit": "1 s"}, "geometry.length_unit: "),
        ({"length_unit": 0.001}, "geometry.length_unit: found 0.001; needs a quantity"),
        ({"contact_area": "1 mm"}, "geometry.contact_area: "),
        ({"surface": {}}, "geometry.surface: unknown key"),
    ],
)
def test_faulty_keys(changes, expected):
    """
    requirement: one line with the path of the key as it stands in the case file.
    """
    with pytest.raises(CaseError) as error:
        tw.load(file_tables("mesh.msh", **changes))
    assert error.value.faults[0].startswith(expected), error.value.faults


@pytest.mark.parametrize("key", ["path", "bodies", "contact", "held", "fixed"])
def test_missing_keys(key):
    """
    requirement: keys that every file needs.
    """
    case = file_tables("mesh.msh")
    del case["geometry"][key]
    with pytest.raises(CaseError) as error:
        tw.load(case)
    assert f"geometry.{key}: missing" in error.value.faults


@pytest.fixture
def two_folders(tmp_path, monkeypatch):
    """A case file in one folder, the current one is another."""
    case, here = tmp_path / "case", tmp_path / "here"
    case.mkdir()
    here.mkdir()
    tables = file_tables("mesh.msh")
    (case / "case.toml").write_text(tomli_w.dumps(tables), encoding="utf-8")
    monkeypatch.chdir(here)
    return case, here


def test_paths_are_meant_from_the_folder_of_the_case(two_folders):
    """
    requirement: wherever the program is called, and said where there is another file; the case as
    it is written out reads the same file.
    """
    case, here = two_folders
    gmsh_blocks(case / "mesh.msh")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        known = tw.load(case / "case.toml")
    assert known.geometry.path == str(case / "mesh.msh")
    assert tw.load(tw.case.as_plain(known)) == known
    assert len(known.tagged_mesh().cells) > 0
    (here / "mesh.msh").write_text("not this\n")
    with pytest.warns(CaseNote, match="the other file .* is not read"):
        assert tw.load(case / "case.toml") == known


def test_paths_from_the_current_folder_are_the_second_try(two_folders):
    """
    requirement: found there, and said.
    """
    case, here = two_folders
    gmsh_blocks(here / "mesh.msh")
    with pytest.warns(
        CaseNote, match="in the current folder; paths are relative to the folder of the case file"
    ):
        found = tw.load(case / "case.toml")
    assert found.geometry.path == str(here / "mesh.msh")


def test_validate_opens_the_file(two_folders, capsys):
    """
    requirement: what `run` would refuse, `validate` refuses: the file, its names, its bodies.
    """
    case, _ = two_folders
    words = ["validate", str(case / "case.toml")]
    assert main(words) == 1
    assert "geometry.path: " in capsys.readouterr().err
    gmsh_blocks(case / "mesh.msh")
    assert main([*words, "--set", "geometry.held=TUP"]) == 1
    assert "geometry.held: the file has no surface named 'TUP'" in capsys.readouterr().err
    assert main(words) == 0
    said = capsys.readouterr()
    assert "punch 40 mm by 20 mm with 44 cells, plate 40 mm by 30 mm" in said.out
    assert said.err == ""


def test_a_surface_of_the_file_that_is_not_listed(tmp_path):
    """
    requirement: a name in the file is said to be there, and where to list it; one that is listed
    by another name, a name that is nowhere, and all names in a file that is not there, are unknown.
    """
    path = gmsh_blocks(tmp_path / "a.msh")

    def line(name, path=path, **changes):
        case = file_tables(path, **changes)
        case["heat"]["flux"] = {name: "1 W/m^2"}
        with pytest.raises(CaseError) as error:
            tw.load(case)
        return next(fault for fault in error.value.faults if fault.startswith("heat.flux"))

    listed = {"surfaces": GMSH_NAMES["surfaces"] | {"foot": "BOTTOM"}, "fixed": "foot"}
    assert line("TOP", held="HELD") == (
        "heat.flux.TOP: in the file, but not listed: add it to geometry.surfaces: TOP = 'TOP'; "
        "listed are: punch_face, plate_face, HELD, BOTTOM"
    )
    assert "unknown name in this geometry; must be one of: punch_face" in line("BOTTOM", **listed)
    assert "unknown name" in line("elsewhere")
    assert "unknown name" in line("TOP", tmp_path / "none.msh", held="HELD")


def test_keys_without_effect_on_a_mesh_file(tmp_path):
    """
    requirement: numbers of elements and gradings, which a file has, are refused; default values,
    which resolved cases have, are not.
    """
    path = gmsh_blocks(tmp_path / "a.msh")
    case = file_tables(path)
    case["mesh"] = {"elements": 20, "grading": 0.5, "bodies": {"punch": {"elements": 12}}}
    with pytest.raises(CaseError) as error:
        tw.load(case)
    assert [line.split(";")[0] for line in error.value.faults] == [
        f"mesh.{key}: has no effect on geometry.type = 'file'"
        for key in ("elements", "grading", "bodies.punch.elements")
    ]
    case["mesh"] = {"elements": 12, "grading": 0.3, "degree": 3}
    assert tw.load(case).mesh.degree == 3


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("PhysicalNames\n5", "PhysicalNames\n6", "announces 6 names and has 5"),
        ('2 2 "PLATE"', '2 1 "PLATE"', "the group 1 of dimension 2 has two names"),
        ("{edge}", "1 99 1 ", "elements lie on the entity (1, 99), which $Entities does not list"),
    ],
)
def test_groups_of_gmsh_that_are_lost(tmp_path, old, new, expected):
    """
    requirement: names and entities that the file does not have are errors, not smaller surfaces.
    """
    path = gmsh_blocks(tmp_path / "a.msh")
    text = path.read_text()
    elements = text.index("$Elements")
    edge = next(line for line in text[elements:].splitlines() if line.startswith("1 "))
    old, at = (edge, elements) if old == "{edge}" else (old, 0)
    new = new + edge.rpartition(" ")[2] if at else new
    assert old in text[at:]
    path.write_text(text[:at] + text[at:].replace(old, new, 1))
    assert expected in fault(path, **GMSH_NAMES)


@pytest.mark.parametrize("ending", ["vtu", "xdmf"])
def test_several_integer_data(tmp_path, ending):
    """
    requirement: a number is the cells with this value of one of the data of the file; where two
    data differ on it, it is taken with the name of its data only.
    """
    import meshio

    meshio_file(blocks(), tmp_path / f"a.{ending}")
    mesh = meshio.read(tmp_path / f"a.{ending}")
    mesh.cell_data["Ids"] = [3 + np.arange(len(block)) for block in mesh.cells]
    mesh.write(tmp_path / f"b.{ending}")
    surfaces = {name: f"tag={tag}" for name, tag in NUMBERED["surfaces"].items()}
    expected = read(tmp_path / f"a.{ending}", **NUMBERED)
    found = read(tmp_path / f"b.{ending}", **NUMBERED | {"surfaces": surfaces})
    np.testing.assert_array_equal(found.facets, expected.facets)
    text = fault(tmp_path / f"b.{ending}", **NUMBERED)
    assert "no surface named '3'" in text
    assert "tag=3, tag=4" in text


HOOK = ((0, 0), (20, 0), (20, 4), (12, 4), (12, 2), (18, 2), (18, 1), (2, 1), (2, 6), (20, 6))
"""Lower outline of a body whose bottom goes round a lip: two levels of it face down."""


def hooked(path):
    """Blocks as of `gmsh_blocks`, the upper one with a face that folds back."""
    with gmsh_model("hook") as gmsh:
        model, geo = gmsh.model, gmsh.model.geo
        for name, corners in {
            "PUNCH": (*HOOK, (20, 10), (0, 10)),
            "PLATE": ((-5, -9), (25, -9), (25, 0), (-5, 0)),
        }.items():
            points = [geo.addPoint(x, y, 0) for x, y in corners]
            nexts = points[1:] + points[:1]
            lines = [geo.addLine(*ends) for ends in zip(points, nexts, strict=True)]
            body = geo.addPlaneSurface([geo.addCurveLoop(lines)])
            geo.synchronize()
            model.addPhysicalGroup(2, [body], name=name)
            below, above = (lines[:1], lines[2:3]) if name == "PLATE" else (lines[:9], lines[10:11])
            model.addPhysicalGroup(1, below, name=f"{name}_BELOW")
            model.addPhysicalGroup(1, above, name=f"{name}_ABOVE")
        gmsh.option.setNumber("Mesh.MeshSizeMax", 1)
        model.mesh.generate(2)
        gmsh.write(str(path))
    return path


SPREAD = {"advection": "spread", "cooling": {"held": "9 W/(m^2 K)"}, "ambient": "20 degC"}
AT_ODDS = {
    "folds back": (hooked, {}, "it is not clear which points of punch_face and plate_face meet"),
    "no rows": (
        lambda path: gmsh_blocks(path, triangles=True),
        {"geometry.track": "1 m", "heat": SPREAD},
        "'spread' needs rows of cells along the motion of 'plate'",
    ),
    "too far": (
        gmsh_blocks,
        {
            "motion": {"amplitude": "9 mm", "frequency": "1 Hz"},
            "analysis": {"type": "reciprocating", "cycles": 1},
        },
        "motion.amplitude: ",
    ),
}
"""Meshes, changes of a case, and the line that both refuse it with."""


@pytest.mark.parametrize("kind", AT_ODDS)
def test_validate_refuses_what_no_run_can_begin_with(tmp_path, capsys, kind):
    """requirement: what needs no solution to tell, `validate` tells in the words of `run`."""
    write, changes, expected = AT_ODDS[kind]
    path = write(tmp_path / "a.msh")
    if kind == "folds back":
        ends = {"punch_face": "PUNCH_BELOW", "plate_face": "PLATE_ABOVE"}
        ends |= {"held": "PUNCH_ABOVE", "fixed": "PLATE_BELOW"}
    else:
        ends = {"punch_face": "FACE", "plate_face": "FACE", "held": "TOP", "fixed": "BOTTOM"}
    steel = {"young_modulus": "200 GPa", "poisson_ratio": 0.3}
    steel |= {"conductivity": "40 W/(m K)", "expansion": "1e-5 1/K"}
    case = changed(
        {
            "model": "plane-strain",
            "geometry": {"type": "file", "path": str(path)}
            | GMSH_NAMES
            | {"surfaces": ends, "held": "held", "fixed": "fixed", "thickness": "1 mm"},
            "bodies": {"punch": steel, "plate": dict(steel)},
            "load": {"force": "100 N"},
            "contact": {"friction": 0.2},
            "motion": {"velocity": "1 m/s"},
            "wear": {"punch": {"coefficient": "1e-8 1/MPa", "per": "pressure"}},
            "analysis": {"type": "initial"},
        },
        changes,
    )
    (tmp_path / "case.toml").write_text(tomli_w.dumps(case))
    assert main(["validate", str(tmp_path / "case.toml")]) == 1
    said = capsys.readouterr().err
    with pytest.raises(CaseError) as refused:
        tw.run(tw.load(case))
    assert expected in str(refused.value)
    assert said == f"error: {refused.value}\n"
