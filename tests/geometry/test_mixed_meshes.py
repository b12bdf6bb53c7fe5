"""Meshes of bodies whose cells differ in type or order: files, export, parts by cell set."""

from dataclasses import replace

import meshio
import numpy as np
import pytest

import thermowear as tw
from thermowear.geometry.mesh.mixed import MixedMesh, block_of, block_with, count_cells, joined
from thermowear.geometry.reading.export import write_mesh
from thermowear.verification.cases.contact.contact_methods import HEIGHTS
from thermowear.verification.cases.contact.patch_in_space import SIZE, PatchInSpace

from ..conftest import NAMES
from ..solid_meshes import write_blocks
from .test_bad_solids import file_tables
from .test_solid_files import outward, read, volume

SIDES = {"upper": (0.0, HEIGHTS[0]), "lower": (-HEIGHTS[1], 0.0)}


def solids(tetrahedra=(True, False), orders=(1, 2)):
    return PatchInSpace(columns=(2, 3), orders=orders, tetrahedra=tetrahedra).build(None)


def names_in(path, made):
    """Keys of a file written by `write_mesh`."""
    if path.suffix not in (".vtu", ".xdmf"):
        return NAMES
    numbers = {n: str(i) for i, n in enumerate((*made.bodies, *made.surfaces), start=1)}
    used = [*NAMES["contact"], NAMES["held"], NAMES["fixed"]]
    return NAMES | {
        "bodies": {name: numbers[name] for name in made.bodies},
        "surfaces": {name: numbers[name] for name in used},
    }


@pytest.mark.parametrize("ending", ["msh", "inp", "vtu", "xdmf"])
@pytest.mark.parametrize("tetrahedra", [(True, False), (False, True), (True, True), (False, False)])
def test_exports_are_read_back(tmp_path, ending, tetrahedra):
    """requirement: linear cells on quadratic ones, of either type, in every format."""
    made, path = solids(tetrahedra), tmp_path / f"mesh.{ending}"
    assert isinstance(made, MixedMesh)
    write_mesh(made, path)
    mesh = read(path, **names_in(path, made))
    assert isinstance(mesh, MixedMesh)
    kinds = ["tetrahedron" if of_body else "hexahedron" for of_body in tetrahedra]
    assert [(block.cell_type, block.order) for block in mesh.blocks] == [
        (kinds[0], 1),
        (kinds[1], 2),
    ]
    assert count_cells(mesh) == count_cells(made)
    assert len(mesh.points) == len(made.points)
    for body, (low, high) in SIDES.items():
        block = block_of(mesh, body)
        assert volume(block, body) == pytest.approx(np.prod(SIZE) * (high - low), rel=1e-10)
        for surface, up in ((f"{body}_face", body == "lower"), (f"{body}_end", body == "upper")):
            area = np.prod(SIZE) * (1 if up else -1)
            found = outward(block_with(mesh, surface), surface)
            assert found == pytest.approx([0, 0, area], abs=1e-12)


@pytest.mark.parametrize("hexahedra", [(False, True), (True, False)])
def test_a_file_for_each_body(tmp_path, hexahedra):
    """requirement: two meshes of gmsh, one of tetrahedra and one of hexahedra of another order."""
    files = {}
    for body, of_body, order in zip(("pad", "disk"), hexahedra, (2, 1), strict=True):
        files[body] = str(write_blocks(tmp_path / f"{body}.msh", order, of_body, size=12.0))
    tables = file_tables("", **NAMES)
    tables["geometry"] = {
        "type": "file",
        "length_unit": "1 mm",
        "paths": files,
        "bodies": {"pad": "PAD", "disk": "DISK"},
        "contact": ["PAD_FACE", "DISK_FACE"],
        "held": "PAD_BACK",
        "fixed": "DISK_BOTTOM",
    }
    tables["bodies"] = {"pad": tables["bodies"]["upper"], "disk": {"like": "pad"}}
    mesh = tw.load(tables).tagged_mesh()
    assert [block.order for block in mesh.blocks] == [2, 1]
    kinds = ["hexahedron" if of_body else "tetrahedron" for of_body in hexahedra]
    assert [block.cell_type for block in mesh.blocks] == kinds


def test_parts_by_cell_set(tmp_path):
    """requirement: a set of cells of the second body is a part of it, with its own material."""
    made = solids()
    middle = made.blocks[1].points[made.blocks[1].cells].mean(axis=1)
    tags = made.blocks[1].cell_tags.copy()
    tags[middle[:, 0] < SIZE[0] / 3] = 3
    bodies = (*made.bodies, "soft")
    upper, lower = (replace(block, bodies=bodies) for block in made.blocks)
    split = MixedMesh((upper, replace(lower, cell_tags=tags)))
    path = tmp_path / "mesh.msh"
    write_mesh(split, path)
    tables = file_tables(path, **NAMES)
    tables["geometry"]["bodies"] = {"upper": "upper", "lower": ["lower", "soft"]}
    soft = {"young_modulus": "1 GPa", "poisson_ratio": 0.3}
    tables["bodies"]["lower"] = tables["bodies"]["upper"] | {"materials": {"soft": soft}}
    mesh = tw.load(tables).tagged_mesh()
    assert mesh.bodies == ("upper", "lower", "lower.soft")
    x = mesh.blocks[1].points[mesh.blocks[1].cells].mean(axis=1)[:, 0]
    np.testing.assert_array_equal(mesh.blocks[1].cell_tags == 3, x < SIZE[0] / 3)
    assert set(mesh.blocks[0].cell_tags) == {1}


def test_facets_off_all_boundaries(tmp_path):
    """requirement: a stray quadrilateral in a surface is counted and located, as without mixing."""
    made, path = solids(orders=(1, 1)), tmp_path / "mesh.msh"
    write_mesh(made, path)
    mesh = meshio.read(path)
    kinds = [block.type for block in mesh.cells]
    quads, hexes = kinds.index("quad"), kinds.index("hexahedron")
    upper = len(made.blocks[0].points)
    bottom = mesh.cells[hexes].data[0][[4, 5, 6, 7]]  # inside of the body
    assert (bottom >= upper).all()
    mesh.cells[quads].data[0] = bottom
    mesh.cell_data["gmsh:geometrical"] = mesh.cell_data["gmsh:physical"]
    meshio.write(path, mesh, file_format="gmsh22", binary=False)
    with pytest.raises(tw.errors.CaseError, match=r"1 facets of '\w+' are not on the .*one at x ="):
        read(path, **NAMES)


def test_meshes_of_one_type_are_joined_to_one():
    """requirement: bodies meshed one by one have one block if their cells are alike."""
    alike = solids((False, False), (1, 1))
    assert alike.blocks == (alike,)
    assert alike.bodies == ("upper", "lower")
    assert volume(alike, "lower") == pytest.approx(np.prod(SIZE) * HEIGHTS[1])
    again = joined([replace(alike, bodies=("a", "b"), surfaces=("s", "t", "u", "v"))])
    np.testing.assert_array_equal(again.cells, alike.cells)
