"""Meshes of bodies in space that cannot be computed, or not as meant."""

import warnings
from dataclasses import replace

import meshio
import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import CaseError, CaseNote
from thermowear.geometry.mesh.nodes import boundary, numbered
from thermowear.geometry.mesh.tagged import compact
from thermowear.geometry.reading.export import write_mesh

from ..conftest import NAMES
from ..contact.solids import HEIGHTS, SIZE, two_solids
from .test_solid_files import file_tables


def blocks(order=1, divisions=((4, 3, 2), (4, 3, 2)), cell_type="tetrahedron"):
    """A block of 40 x 30 x 20 mm on one of 40 x 30 x 30 mm."""
    return two_solids(divisions, order, cell_type=cell_type)


def check(tmp_path, mesh, **keys):
    """Load and check a mesh as `validate` does; one line, if it is refused."""
    write_mesh(mesh, tmp_path / "mesh.msh")
    tables = file_tables(tmp_path / "mesh.msh", **(NAMES | keys))
    return tw.load(tables).tagged_mesh()


def refused(tmp_path, mesh, **keys):
    with pytest.raises(CaseError) as error:
        check(tmp_path, mesh, **keys)
    (line,) = error.value.faults
    assert "\n" not in line
    return line


def moved(mesh, where, step):
    """Mesh with the points at a place (or all of a mask) moved."""
    points = mesh.points.copy()
    chosen = where if isinstance(where, np.ndarray) and where.dtype == bool else at(mesh, where)
    points[chosen] += step
    return replace(mesh, points=points)


def at(mesh, place):
    return np.linalg.norm(mesh.points - place, axis=1) < 1e-9


def of_body(mesh, number):
    mask = np.zeros(len(mesh.points), dtype=bool)
    mask[mesh.cells[mesh.cell_tags == number]] = True
    return mask


def only(mesh, keep):
    """Mesh with some of its cells, and their named facets."""
    cells = mesh.cells[keep]
    outer = [boundary(mesh.cell_type, mesh.order, cells[mesh.cell_tags[keep] == t]) for t in (1, 2)]
    known = np.concatenate([mesh.facets, *outer])
    number, _ = numbered(known)
    left = np.isin(number[: len(mesh.facets)], number[len(mesh.facets) :])
    return compact(
        replace(
            mesh,
            cells=cells,
            cell_tags=mesh.cell_tags[keep],
            facets=mesh.facets[left],
            facet_tags=mesh.facet_tags[left],
        )
    )


INSIDE = (SIZE[0] / 2, SIZE[1] / 3, HEIGHTS[0] / 2)


@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
@pytest.mark.parametrize("order", [1, 2])
def test_good_blocks_pass(tmp_path, cell_type, order):
    """requirement: no note and no error for a good mesh."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check(tmp_path, blocks(order, cell_type=cell_type))


@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
def test_inverted_cells(tmp_path, cell_type):
    """requirement: a node pushed through the opposite facet: cells overlap; with their position."""
    line = refused(tmp_path, moved(blocks(cell_type=cell_type), INSIDE, [0.012, 0.0, 0.0]))
    assert line.startswith("geometry.path: ")
    assert "cells of 'upper' are tangled or flat (det J <= 0), one at x = 0.0" in line
    assert "z = 0.0" in line


def test_mirrored_cells_are_turned(tmp_path):
    """requirement: cells listed in the other orientation are no fault."""
    mesh = blocks()
    cells = mesh.cells.copy()
    cells[::3] = cells[::3][:, [0, 2, 1, 3]]
    found = check(tmp_path, replace(mesh, cells=cells))
    edges = found.points[found.cells[:, 1:]] - found.points[found.cells[:, :1]]
    assert np.linalg.det(edges).min() > 0


def test_flat_cells(tmp_path):
    """requirement: degenerate cells are refused."""
    line = refused(tmp_path, moved(blocks(), INSIDE, [-SIZE[0] / 4, 0.0, 0.0]))
    assert "tangled or flat" in line


def test_curved_cells_with_a_wrong_node(tmp_path):
    """requirement: det J <= 0 inside a curved cell is found although its corners are fine."""
    mesh = blocks(2, ((2, 2, 2), (2, 2, 2)))
    middle = np.array([SIZE[0] / 4, SIZE[1] / 2, HEIGHTS[0] / 2])
    assert at(mesh, middle).sum() == 1
    assert "tangled or flat" in refused(tmp_path, moved(mesh, middle, [0.009, 0.0, 0.0]))


@pytest.mark.parametrize("share", [0.5, 1.0])
def test_duplicate_nodes(tmp_path, share):
    """requirement: a crack within a body, and one that cuts it in two."""
    mesh = blocks()
    centres = mesh.points[mesh.cells].mean(axis=1)
    beyond = (mesh.cell_tags == 1) & (centres[:, 0] > SIZE[0] / 2)
    plane = np.abs(mesh.points[:, 0] - SIZE[0] / 2) < 1e-9
    cut = plane & (mesh.points[:, 1] < share * SIZE[1] + 1e-9) & of_body(mesh, 1)
    number = np.arange(len(mesh.points))
    number[cut] = len(mesh.points) + np.arange(cut.sum())
    cells = mesh.cells.copy()
    cells[beyond] = number[cells[beyond]]
    points = np.concatenate([mesh.points, mesh.points[cut]])
    held = mesh.points[mesh.facets].mean(axis=1)[:, 0] > SIZE[0] / 2
    own = np.isin(mesh.facets, mesh.cells[beyond]).all(axis=1) & held
    facets = mesh.facets.copy()
    facets[own] = number[facets[own]]
    line = refused(tmp_path, replace(mesh, points=points, cells=cells, facets=facets))
    assert line.startswith("geometry.path: cells of 'upper' are not joined along ")
    assert "facets with duplicate nodes, one at x = 0.02 m" in line


def test_cells_joined_at_an_edge_only(tmp_path):
    """requirement: a hinge is refused."""
    mesh = blocks(1, ((2, 2, 1), (2, 2, 1)), "hexahedron")
    x, y, _ = mesh.points[mesh.cells].mean(axis=1).T
    diagonal = (x > SIZE[0] / 2) == (y > SIZE[1] / 2)
    line = refused(tmp_path, only(mesh, (mesh.cell_tags == 2) | diagonal))
    assert "cells of 'upper' are joined by an edge only at x = 0.02 m, y = 0.015 m" in line


def test_a_body_in_two_pieces(tmp_path):
    """requirement: a piece that is not held is refused, with its position; held ones are noted."""
    mesh = blocks(1, ((4, 1, 3), (1, 1, 1)), "hexahedron")
    x, _, z = mesh.points[mesh.cells].mean(axis=1).T
    layer = (mesh.cell_tags == 1) & (np.abs(z - HEIGHTS[0] / 2) < 1e-6)
    line = refused(tmp_path, only(mesh, ~layer))
    assert line.startswith("geometry.path: 4 of 8 cells of 'upper' are not joined to those held at")
    assert "one at x = " in line
    column = (mesh.cell_tags == 1) & (x > SIZE[0] / 4) & (x < SIZE[0] / 2)
    with pytest.warns(CaseNote, match="'upper' has 2 pieces, all held by 'upper_end'"):
        check(tmp_path, only(mesh, ~column))


def test_linear_and_quadratic_mixed(tmp_path):
    """requirement: two cell types within a body, in one line."""
    one, two = blocks(1), blocks(2)
    names = {name: np.array([i + 1, 3]) for i, name in enumerate(one.bodies)}
    linear, quadratic = one.cells[one.cell_tags == 1], two.cells[two.cell_tags == 1]
    cells = [("tetra", linear), ("tetra10", quadratic[len(linear) // 2 :] + len(one.points))]
    cells += [("tetra10", two.cells[two.cell_tags == 2] + len(one.points))]
    tags = [np.full(len(c), t) for (_, c), t in zip(cells, (1, 1, 2), strict=True)]
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    points = np.concatenate([one.points, two.points])
    mesh = meshio.Mesh(points, cells, cell_data=data, field_data=names)
    meshio.write(tmp_path / "mesh.msh", mesh, file_format="gmsh22", binary=False)
    with pytest.raises(CaseError) as error:
        tw.load(file_tables(tmp_path / "mesh.msh", **NAMES)).tagged_mesh()
    (line,) = error.value.faults
    assert line.startswith("geometry.bodies.upper: mixed cell types")
    assert "tetrahedra of 4 nodes and tetrahedra of 10 nodes; only one type" in line


def test_prisms(tmp_path):
    """requirement: cells that are not supported are named."""
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]
    meshio.write(tmp_path / "a.msh", meshio.Mesh(points, [("wedge", [range(6)])]), "gmsh22")
    with pytest.raises(CaseError, match=r"prisms \(gmsh's type 6\) are not supported"):
        tw.load(file_tables(tmp_path / "a.msh", **NAMES)).tagged_mesh()


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        ((0.0, 0.0, 0.025), "geometry.path: the bodies lie 25 mm apart at x = "),
        ((0.0, 0.0, -0.005), "geometry.path: the bodies overlap by 5 mm at x = "),
        (
            (0.05, 0.0, 0.0),
            "geometry: the contact faces do not lie opposite each other; they range",
        ),
        (
            (0.0, -0.04, 0.0),
            "geometry: the contact faces do not lie opposite each other; they range",
        ),
    ],
)
@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
def test_faces_that_do_not_meet(tmp_path, step, expected, cell_type):
    """requirement: bodies apart, overlapping, or side by side."""
    mesh = blocks(2, ((2, 2, 1), (3, 2, 1)), cell_type)
    assert refused(tmp_path, moved(mesh, of_body(mesh, 1), step)).startswith(expected)


def test_bodies_on_the_wrong_side(tmp_path):
    """requirement: body 1 lies above body 2."""
    keys = {
        "bodies": {"lower": "lower", "upper": "upper"},
        "contact": ["lower_face", "upper_face"],
        "held": "lower_end",
        "fixed": "upper_end",
    }
    line = refused(tmp_path, blocks(), **keys)
    assert line.startswith("geometry.contact: 'lower_face' does not face down; body 'lower' is ")
    assert "loaded along -z" in line


def test_wrong_length_unit(tmp_path):
    """requirement: a pressure far above a modulus points to the unit."""
    line = refused(tmp_path, blocks(), length_unit="1 um")
    assert line.startswith("load: a mean pressure of ")
    assert "for contact on the whole 1.2e-09 mm² of the faces" in line
    assert line.endswith("(check geometry.length_unit)")
    assert "(check geometry.length_unit" in refused(tmp_path, blocks(), length_unit="1e-7 m")


@pytest.mark.parametrize("cell_type", ["tetrahedron", "hexahedron"])
def test_a_hole_in_the_contact_face(tmp_path, cell_type):
    """requirement: facets that are missing in the set of a face are noted with their position."""
    mesh = blocks(1, ((5, 5, 1), (3, 3, 1)), cell_type)
    x, y, _ = mesh.points[mesh.facets].mean(axis=1).T
    middle = (np.abs(x - SIZE[0] / 2) < 0.004) & (np.abs(y - SIZE[1] / 2) < 0.003)
    hole = middle & (mesh.facet_tags == mesh.surfaces.index("upper_face") + 1)
    facets, tags = mesh.facets[~hole], mesh.facet_tags[~hole]
    with pytest.warns(CaseNote, match="'upper_face' has a hole of 8 mm by 6 mm at x = 0.02 m"):
        check(tmp_path, replace(mesh, facets=facets, facet_tags=tags))


def test_a_pocket_in_the_face_is_no_hole(tmp_path):
    """requirement: what is cut out of a body is meant."""
    mesh = blocks(1, ((5, 5, 2), (3, 3, 1)), "hexahedron")
    x, y, z = mesh.points[mesh.cells].mean(axis=1).T
    pocket = (np.abs(x - SIZE[0] / 2) < 0.004) & (np.abs(y - SIZE[1] / 2) < 0.003) & (z > 0)
    pocket &= z < HEIGHTS[0] / 2
    facets = mesh.points[mesh.facets].mean(axis=1)
    under = (np.abs(facets - [SIZE[0] / 2, SIZE[1] / 2, 0]) < 0.003).all(axis=1)
    under &= mesh.facet_tags == mesh.surfaces.index("upper_face") + 1
    mesh = replace(mesh, facets=mesh.facets[~under], facet_tags=mesh.facet_tags[~under])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check(tmp_path, only(mesh, ~pocket))


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        (
            {"symmetry": ["upper_low_y", "lower_low_y"]},
            "geometry.symmetry: 'upper_low_y' does not lie in a plane x = const",
        ),
        ({"rollers": ["upper_low_y"]}, "geometry.rollers: no surface of 'lower' is listed"),
        ({"surfaces": {"cold": "upper_end"}}, "geometry.surfaces: 'upper_end' and 'cold' share"),
        ({"held": "no"}, "geometry.held: the file has no surface named 'no'; one of: lower_end"),
        ({"held": "lower_end", "fixed": "upper_end"}, "geometry.held: 'lower_end' is not on the"),
        (
            {"bodies": {"upper": "upper", "lower": "upper"}},
            "geometry.bodies: 144 cells are in both",
        ),
    ],
)
def test_faulty_names(tmp_path, keys, expected):
    """requirement: one line at the key."""
    assert refused(tmp_path, blocks(), **keys).startswith(expected)


def test_planes_of_symmetry(tmp_path):
    """requirement: any number of planes, with the bodies between them; one side of each."""
    names = [f"{body}_{end}" for body in ("upper", "lower") for end in ("low_x", "high_x")]
    check(tmp_path, blocks(), symmetry=names, rollers=["upper_low_y", "lower_low_y"])
    mesh = blocks()
    both = moved(mesh, of_body(mesh, 1), [0.01, 0.0, 0.0])
    line = refused(tmp_path, both, symmetry=["upper_low_x", "lower_low_x"])
    assert "geometry.symmetry: the bodies lie on both sides of the plane of 'upper_low_x'" in line
