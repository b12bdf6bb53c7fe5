"""Meshes that follow a moved face."""

from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import two_blocks
from thermowear.geometry.mesh.tagged import scaled_jacobians
from thermowear.geometry.moving.moved import MovableBody

from .measure import areas, followed
from .measure import scaled_jacobians as measured


def upper(order=1, triangles=False):
    """The upper block, 40 mm by 20 mm, the nodes of its face, and the mesh."""
    mesh = two_blocks(order=order, triangles=triangles)
    facets = mesh.facets[mesh.facet_tags == mesh.surfaces.index("upper_face") + 1]
    nodes = np.unique(facets)
    nodes = nodes[np.argsort(mesh.points[nodes, 0])]
    return MovableBody(mesh, ("upper",), mesh.points[nodes]), mesh.points[nodes], mesh


@pytest.mark.parametrize(("order", "triangles"), [(1, False), (2, False), (3, False), (2, True)])
def test_a_level_face_squeezes_the_body_evenly(order, triangles):
    body, face, mesh = upper(order, triangles)
    points = followed(mesh, body.outlined(np.tile((0.0, 5e-3), (len(face), 1))))
    above = np.unique(mesh.cells[mesh.cell_tags == 1])
    x, y = mesh.points[above].T
    assert points[above] == pytest.approx(np.column_stack([x, 5e-3 + 0.75 * y]), abs=1e-12)
    below = np.unique(mesh.cells[mesh.cell_tags == 2])
    assert np.array_equal(points[below], mesh.points[below])


@pytest.mark.parametrize("order", [1, 2, 3])
def test_the_volume_lost_is_that_of_the_mesh(order):
    """Sign and size: of a bulge into the body, in a section and round an axis."""
    body, face, mesh = upper(order)
    bulge = np.column_stack([0 * face[:, 0], 2e-3 * np.sin(60 * face[:, 0]) + 3e-3])
    outlined = body.outlined(bulge)
    after = replace(mesh, points=followed(mesh, outlined))
    flat = areas(mesh, "upper").sum() - areas(after, "upper").sum()
    assert body.lost(outlined, lambda p: np.ones(len(p))) == pytest.approx(flat, rel=1e-10)
    assert flat > 0.0
    # Guldin: a level face that goes up by h loses a ring
    level = body.outlined(np.tile((0.0, 1e-3), (len(face), 1)))
    ring = np.pi * (0.09**2 - 0.05**2) * 1e-3
    assert body.lost(level, lambda p: 2 * np.pi * p[:, 0]) == pytest.approx(ring, rel=1e-12)


def test_sides_are_found():
    body, _, _ = upper(2)
    first, last = body.sides
    assert first.is_corner
    assert last.is_corner
    assert first.inward == pytest.approx([0.0, 1.0], abs=1e-12)
    assert len(first.nodes) == 5  # two elements of order 2, up to the top


def test_nodes_of_a_face_do_not_cross():
    """A round face between upright sides: its ends go up, as all of it does, by what it turns."""
    mesh = two_blocks(inner=-0.02, outer=0.02, columns=(40, 3), order=2)
    x, y = mesh.points.T
    above = np.isin(np.arange(len(y)), mesh.cells[mesh.cell_tags == 1])
    bent = np.column_stack([x, y + np.where(above, np.sqrt(0.04**2 - x**2) - 0.04, 0.0)])
    mesh = replace(mesh, points=bent)
    facets = mesh.facets[mesh.facet_tags == mesh.surfaces.index("upper_face") + 1]
    nodes = np.unique(facets)
    face = bent[nodes[np.argsort(bent[nodes, 0])]]
    body = MovableBody(mesh, ("upper",), face)
    normals = -np.column_stack([face[:, 0], face[:, 1] + 0.04]) / 0.04  # of the circle
    directions, held = body.motion_paths(normals)
    assert not held.any()
    assert directions == pytest.approx(np.tile((0.0, -1.0), (len(face), 1)), abs=1e-3)
    moved = replace(mesh, points=followed(mesh, body.outlined(-3e-3 * directions)))
    assert scaled_jacobians(moved).min() > 0.7


@pytest.mark.parametrize("triangles", [False, True])
def test_shapes_of_cells(triangles):
    """Against an independent formula, before and after a face has become slanted."""
    body, face, mesh = upper(2, triangles)
    slanted = np.column_stack([0 * face[:, 0], 0.3 * (face[:, 0] - face[0, 0])])
    moved = replace(mesh, points=followed(mesh, body.outlined(slanted)))
    for shape in (mesh, moved):
        assert scaled_jacobians(shape) == pytest.approx(measured(shape), abs=1e-12)
