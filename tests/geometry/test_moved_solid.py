"""Meshes in space that follow a moved face."""

from dataclasses import replace

import numpy as np
import pytest

from tests.contact.solids import HEIGHTS, SIZE, bent, skewed, straight, turned, two_solids
from thermowear.bulk.mesh_motion import serial_extension
from thermowear.geometry.mesh.tagged import scaled_jacobians
from thermowear.geometry.moving.moved_solid import MovableSolid

from .measure import followed, volumes

HEIGHT = HEIGHTS[0]
MAPS = {"straight": straight, "skewed": skewed, "turned": turned, "bent": bent}


CELLS = ["hexahedron", "tetrahedron"]


def upper(order=1, place=straight, divisions=(3, 3, 2), cell_type="hexahedron"):
    """The upper of two boxes, the nodes of its face, and the mesh."""
    mesh = two_solids((divisions, (2, 2, 2)), order, (place, straight), cell_type)
    facets = mesh.facets[mesh.facet_tags == mesh.surfaces.index("upper_face") + 1]
    face = mesh.points[np.unique(facets)]
    return MovableSolid(mesh, ("upper",), face, serial_extension), face, mesh


@pytest.mark.parametrize("place", [straight, skewed, turned])
@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("cell_type", CELLS)
def test_a_level_face_squeezes_the_body_evenly(order, place, cell_type):
    """Sides, edges and inner nodes alike; the other body stays."""
    body, face, mesh = upper(order, place, cell_type=cell_type)
    points = followed(mesh, body.outlined(np.tile((0.0, 0.0, 5e-3), (len(face), 1))))
    above = np.unique(mesh.cells[mesh.cell_tags == 1])
    expected = mesh.points[above] + np.outer(5e-3 * (1 - mesh.points[above, 2] / HEIGHT), (0, 0, 1))
    assert points[above] == pytest.approx(expected, abs=1e-12)
    below = np.unique(mesh.cells[mesh.cell_tags == 2])
    assert np.array_equal(points[below], mesh.points[below])


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("name", MAPS)
@pytest.mark.parametrize("cell_type", CELLS)
def test_the_volume_lost_is_that_of_the_mesh(order, name, cell_type):
    """Sign and size, of a bulge into the body."""
    body, face, mesh = upper(order, MAPS[name], cell_type=cell_type)
    x, y, _ = face.T
    bulge = np.outer(2e-3 * np.sin(60 * x) * np.cos(40 * y) + 3e-3, (0, 0, 1))
    outlined = body.outlined(bulge)
    after = replace(mesh, points=followed(mesh, outlined))
    lost = volumes(mesh, "upper").sum() - volumes(after, "upper").sum()
    assert body.lost(outlined, lambda p: np.ones(len(p))) == pytest.approx(lost, rel=1e-10)
    assert lost > 0.0
    assert scaled_jacobians(after).min() > 0.5 * scaled_jacobians(mesh).min() > 0.0


@pytest.mark.parametrize("cell_type", CELLS)
def test_the_rim_goes_along_the_sides(cell_type):
    """requirement: the rim moves along slanted sides and the edges between them; paths inside
    of the face turn towards it, as they must not cross.
    """

    def slanted(p):
        x, y, z = np.moveaxis(p, -1, 0)
        return np.stack([x + 0.5 * z, y - 0.25 * z, z], axis=-1)

    body, face, mesh = upper(2, slanted, cell_type=cell_type)
    normals = np.tile((0.0, 0.0, -1.0), (len(face), 1))
    directions, held = body.motion_paths(normals)
    assert not held.any()
    along = -np.array((0.5, -0.25, 1.0)) / np.linalg.norm((0.5, -0.25, 1.0))
    assert directions == pytest.approx(np.tile(along, (len(face), 1)), abs=1e-12)
    points = followed(mesh, body.outlined(-4e-3 * directions))
    side = mesh.facets[mesh.facet_tags == mesh.surfaces.index("upper_low_x") + 1]
    assert points[side][..., 0] == pytest.approx(0.5 * points[side][..., 2], abs=1e-12)


@pytest.mark.parametrize("cell_type", CELLS)
def test_paths_turn_gradually(cell_type):
    """Between slanted and upright sides, from one side of the face to the other, linearly."""

    def wedge(p):
        x, y, z = np.moveaxis(p, -1, 0)
        return np.stack([x + 0.5 * z * (1 - x / SIZE[0]), y, z], axis=-1)

    body, face, _ = upper(1, wedge, cell_type=cell_type)
    directions, _ = body.motion_paths(np.tile((0.0, 0.0, -1.0), (len(face), 1)))
    slope = -np.array((0.5, 0.0, 1.0)) / np.linalg.norm((0.5, 1.0))
    part = (1 - face[:, 0] / SIZE[0])[:, None]
    expected = (1 - part) * (0.0, 0.0, -1.0) + part * slope
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    inner = (face[:, 1] > 1e-9) & (face[:, 1] < SIZE[1] - 1e-9)
    at_sides = np.isclose(face[:, 0], 0.0) | np.isclose(face[:, 0], SIZE[0])
    assert directions[at_sides] == pytest.approx(expected[at_sides], abs=1e-12)
    off = np.abs(directions - expected).max(axis=1)
    assert off[inner].max() < 0.03
    assert np.all(np.diff(np.unique(np.round(directions[inner, 0], 3))) > 0.0)


@pytest.mark.parametrize("cell_type", CELLS)
def test_a_face_within_a_level_boundary_keeps_its_rim(cell_type):
    """As that of a block, larger than the punch on it: its nodes where it goes on stay."""
    mesh = two_solids(cell_type=cell_type)
    face = np.unique(mesh.facets[mesh.facet_tags == mesh.surfaces.index("lower_face") + 1])
    part = mesh.points[face][mesh.points[face, 0] < 0.7 * SIZE[0]]
    body = MovableSolid(mesh, ("lower",), part, serial_extension)
    _, held = body.motion_paths(np.tile((0.0, 0.0, 1.0), (len(part), 1)))
    assert np.array_equal(held, part[:, 0] > 0.6 * SIZE[0])
    points = followed(mesh, body.outlined(np.where(held[:, None], 0.0, (0.0, 0.0, -1e-3))))
    beyond = mesh.points[:, 0] > 0.6 * SIZE[0]
    level = np.abs(mesh.points[:, 2]) < 1e-9
    assert np.array_equal(points[beyond & level], mesh.points[beyond & level])


def test_shapes_of_cells():
    """A parallelepiped's is the triple product of its unit edges; one inside out is negative."""
    _, _, mesh = upper(2, skewed)
    units = np.array([(1.0, 0.2, 0.0), (0.3, 1.0, 0.0), (0.0, 0.0, 1.0)])
    units /= np.linalg.norm(units, axis=1, keepdims=True)
    shapes = scaled_jacobians(mesh)[mesh.cell_tags == 1]
    assert shapes == pytest.approx(np.linalg.det(units), rel=1e-12)
    mirrored = replace(mesh, points=mesh.points * (1, 1, -1))
    assert scaled_jacobians(mirrored)[mesh.cell_tags == 1] == pytest.approx(-shapes, rel=1e-12)
