"""Grid of the worn profile over what a face in space passes on its stroke."""

from __future__ import annotations

from types import SimpleNamespace

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.contact.wear.worn_profile import swept_surface
from thermowear.errors import CaseError
from thermowear.simulation.system.building import build
from thermowear.timer import Phases

from ..simulation.extruded import Blocks
from ..simulation.test_reciprocating_in_space import BLOCKS, HALF, ball, length, model, pin

REACH = 3e-3


def swept(meshes, spacing=1e-3):
    """Contact points of two bodies in space, and the grid."""
    system = build(model(meshes, "3d"), MPI.COMM_WORLD, Phases())
    pairing = system.contacts.only
    return pairing, swept_surface(pairing, REACH, (spacing, spacing))


def shaped(height):
    """Blocks whose faces have a height over the coordinate across the stroke."""

    def place(p):
        along, up = np.moveaxis(p, -1, 0)
        return np.stack([along, up + height(along)], axis=-1)

    return Blocks(BLOCKS.upper, BLOCKS.lower, place)


def test_rows_reach_from_end_to_end():
    """requirement: rows follow arched ends; planes are seen exactly, in the mean over a segment,
    too; weights are positive and sum to one.
    """
    pairing, grid = swept(pin(8, 21))
    rows = grid.outline.rows
    assert rows[[0, -1]] == pytest.approx([0.0, HALF])
    np.testing.assert_allclose(grid.outline.ends - grid.outline.starts, length(rows), rtol=1e-2)
    ends = grid.nodes[grid.columns - 1 :: grid.columns, 0]
    np.testing.assert_allclose(ends, grid.outline.ends + REACH)
    points = pairing.on_body_2
    for part in (0.0, 1e-3):
        hats = grid.hats(pairing, part)
        assert hats.data.min() >= 0.0
        np.testing.assert_allclose(hats.sum(axis=1), 1.0)
        seen = hats @ grid.nodes
        np.testing.assert_allclose(seen[:, 0], points[:, 0], atol=2e-5)
        np.testing.assert_allclose(seen[:, 1:], points[:, 1:], atol=1e-12)


@pytest.mark.parametrize("height", [np.asarray, np.abs], ids=["slope", "groove"])
def test_areas_of_slopes_across_the_stroke(height):
    """requirement: areas are those of the face, not of its projection."""
    breadth = 1e-2
    meshes = shaped(lambda y: 0.5 * height(y)).extruded(np.linspace(0.0, breadth, 3), axis=0)
    _, grid = swept(meshes)
    known = (breadth + 2 * REACH) * 1e-2 * np.hypot(1.0, 0.5)
    near = 1e-9 if height is np.asarray else 1e-3  # the normals at the kink are of one side
    assert grid.areas.sum() == pytest.approx(known, rel=near)
    if height is np.asarray:
        np.testing.assert_allclose(grid.nodes[:, 2], 0.5 * grid.nodes[:, 1], atol=1e-12)


def test_areas_under_a_ball():
    """requirement: areas are those of the flat block, however steep the ball."""
    pairing, grid = swept(ball(8, 10, 3e-3, 1.5e-3))
    assert np.abs(pairing.sides[0].face.middle_normals[:, 2]).min() < 0.9
    known = (3e-3 + 2 * REACH) * 1.5e-3
    assert grid.areas.sum() == pytest.approx(known, rel=5e-3)


def test_points_away_from_the_ends():
    """requirement: the inner part of the face, wherever it has moved to, and of the track."""
    pairing, grid = swept(pin(8, 21))
    x, y = pairing.on_body_1[:, :2].T
    away = grid.inner(pairing, 0.0, 0.5)
    known = (np.abs(x) < 0.5 * length(y) / 2) & (np.abs(y / HALF - 0.5) < 0.25)
    assert (away == known).mean() > 0.97
    moved = SimpleNamespace(
        carrying=SimpleNamespace(points=pairing.on_body_1 + [REACH, 0, 0]),
        opposite=SimpleNamespace(points=pairing.on_body_2 + [REACH, 0, 0]),
    )
    assert grid.inner(moved, REACH, 0.9).sum() < grid.inner(pairing, 0.0, 0.9).sum()


def test_a_stroke_normal_to_the_face():
    """requirement: one line: faces cannot slide along their normal."""
    pairing, _ = swept(BLOCKS.extruded(np.array([0.0, 5e-3]), axis=1))
    side = pairing.sides[1]

    def normals(facet, t):
        return np.tile([1.0, 0.0, 0.0], (len(facet), 1))

    face = SimpleNamespace(normals=normals, name="wall")
    wall = SimpleNamespace(
        weights=pairing.weights,
        carrying=SimpleNamespace(face=face),
        opposite=SimpleNamespace(face=face, facet=side.facet, t=side.t),
    )
    with pytest.raises(CaseError, match="along x is normal to the contact face wall"):
        swept_surface(wall, REACH, (1e-3, 1e-3))
