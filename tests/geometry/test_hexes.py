"""Hexahedra on lattices, their nodes, and what other programs read of them."""

import numpy as np
import pytest

from thermowear.geometry.mesh.nodes import facet_nodes, reference_nodes, shape_functions
from thermowear.geometry.meshing.cells import mesh_lattice, tagged_bodies
from thermowear.geometry.meshing.divisions import graded_face
from thermowear.geometry.reading.export import write_mesh

GMSH = {1: 5, 2: 12, 3: 92}
ENDS = (np.array([1.0, 1.4, 2.0]), np.linspace(0.0, 2 * np.pi, 9), np.array([0.0, 0.3, 1.0]))


def turned(p):
    r, angle, z = np.moveaxis(p, -1, 0)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)


def ring(order):
    return mesh_lattice(ENDS, order, turned, closed=True)


def tagged_ring(order):
    """A ring with a box on it as a second body."""
    sides = (np.array([1.0, 2.0]), ENDS[2], ENDS[2])
    box = mesh_lattice(sides, order, lambda p: p + np.array([0.0, 0.0, 1.0]))
    claims = {
        "ring_inside": lambda p: np.all(np.hypot(p[..., 0], p[..., 1]) < 1 + 1e-9, axis=1),
        "ring_rest": lambda p: np.ones(len(p), dtype=bool),
        "box_all": lambda p: np.ones(len(p), dtype=bool),
    }
    return tagged_bodies({"ring": ring(order), "box": box}, claims)


@pytest.mark.parametrize("order", GMSH)
def test_nodes_are_numbered_as_gmsh_does(order):
    """requirement: the node order of gmsh's own hexahedra and quadrilaterals."""
    import gmsh

    gmsh.initialize(["-noenv"], interruptible=False)
    try:
        for kind, name, dim in (
            (GMSH[order], "hexahedron", 3),
            ({1: 3, 2: 10, 3: 36}[order], "quadrilateral", 2),
        ):
            places = gmsh.model.mesh.getElementProperties(kind)[4]
            expected = (np.array(places).reshape(-1, dim) + 1) / 2
            np.testing.assert_allclose(reference_nodes(name, order), expected, atol=1e-12)
    finally:
        gmsh.finalize()


@pytest.mark.parametrize("order", GMSH)
def test_facets_look_outward(order):
    """requirement: nodes of facets in gmsh's order, their normals outward."""
    nodes = reference_nodes("hexahedron", order)
    for facet in facet_nodes("hexahedron", order):
        corners = nodes[facet[:4]]
        normal = np.cross(corners[1] - corners[0], corners[3] - corners[0])
        assert normal @ (corners.mean(axis=0) - 0.5) > 0
        s, t = reference_nodes("quadrilateral", order).T[..., None]
        along, across = corners[1] - corners[0], corners[3] - corners[0]
        np.testing.assert_allclose(nodes[facet], corners[0] + s * along + t * across, atol=1e-12)


@pytest.mark.parametrize("order", GMSH)
def test_a_closed_lattice_has_no_seam(order):
    """requirement: nodes on the circles, each once, no boundary where the angle closes."""
    body = ring(order)
    assert len(body.cells) == 2 * 8 * 2
    assert len(body.points) == (2 * order + 1) * 8 * order * (2 * order + 1)
    assert len(np.unique(body.cells)) == len(body.points)
    assert len(body.facets) == 8 * 2 * 2 * 2
    radii = np.hypot(*body.points[:, :2].T)
    on_rim = np.isclose(radii, 2.0, rtol=1e-12).sum()
    assert on_rim == 8 * order * (2 * order + 1)
    assert radii.max() < 2 + 1e-12


@pytest.mark.parametrize("order", GMSH)
def test_cells_are_not_inverted(order):
    """requirement: positive volumes, measured by gmsh in the file that is written."""
    values = shape_functions("hexahedron", order, np.array([[0.5, 0.5, 0.5]]))
    np.testing.assert_allclose(values.sum(), 1.0)
    corners = ring(order).points[ring(order).cells[:, [0, 1, 3, 4]]]
    first, *others = np.moveaxis(corners, 1, 0)
    along, across, up = (other - first for other in others)
    assert np.einsum("ni,ni->n", np.cross(along, across), up).min() > 0


@pytest.mark.parametrize("order", GMSH)
@pytest.mark.parametrize("ending", ["msh", "vtu", "inp"])
def test_exports(order, ending, tmp_path):
    """requirement: cells and named surfaces; order 3 where the format knows it, else order 2."""
    import meshio

    mesh, path = tagged_ring(order), tmp_path / f"mesh.{ending}"
    write_mesh(mesh, path)
    found = meshio.read(path)
    count = {"msh": (order + 1) ** 3, "vtu": {1: 8}.get(order, 27), "inp": {1: 8}.get(order, 20)}
    cells = [block for block in found.cells if block.dim == 3]
    assert {block.data.shape[1] for block in cells} == {count[ending]}
    assert sum(len(block.data) for block in cells) == len(mesh.cells)
    corners = np.concatenate([found.points[block.data[:, :8]] for block in cells])
    np.testing.assert_allclose(corners, mesh.points[mesh.cells[:, :8]], atol=1e-10)
    used = np.unique(np.concatenate([block.data.ravel() for block in found.cells]))
    assert len(used) == len(found.points)


@pytest.mark.parametrize("order", GMSH)
def test_vtk_sees_the_same_cells(order, tmp_path):
    """requirement: nodes within edges, facets and cells are written in VTK's order."""
    from vtkmodules.vtkCommonCore import mutable
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    mesh, path = tagged_ring(order), tmp_path / "mesh.vtu"
    write_mesh(mesh, path)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid, place = reader.GetOutput(), [0.3, 0.45, 0.8]
    values = shape_functions("hexahedron", order, np.array([place]))[0]
    for number, cell in enumerate(mesh.cells):
        x, weights = [0.0] * 3, [0.0] * 64
        grid.GetCell(number).EvaluateLocation(mutable(0), place, x, weights)
        np.testing.assert_allclose(
            x, values @ mesh.points[cell], atol=2e-3 if order == 3 else 1e-12
        )


def test_ends_of_intervals():
    """requirement: consecutive intervals give one row of ends, the last one exactly."""
    ends = graded_face(-0.03, 0.05, 9, 0.4)
    assert len(ends) == 10
    assert (ends[0], ends[-1]) == (-0.03, 0.05)
    sizes = np.diff(ends)
    np.testing.assert_allclose(sizes[:3] / sizes[1:4], 0.4, rtol=1e-9)
    np.testing.assert_allclose(sizes, sizes[::-1], rtol=1e-9)
