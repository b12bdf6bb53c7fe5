"""The mesh of a rectangular punch on a block."""

import numpy as np
import pytest

from thermowear.case.tables.mesh import MeshTable
from thermowear.geometry.geometries.rectangular_punch import RectangularPunch

from ..simulation.space import PUNCH
from .measure import edges
from .sound import fault


def punch(**changes):
    return RectangularPunch(**PUNCH["geometry"] | changes)


def boxes(mesh, body):
    """Lower and upper corners of the cells of a body."""
    corners = mesh.points[mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]]
    return corners.min(axis=1), corners.max(axis=1)


def areas(mesh, surface):
    corners = edges(mesh, surface)
    along, across = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
    return np.linalg.norm(np.cross(along, across), axis=1)


@pytest.mark.parametrize(("elements", "grading"), [(8, 0.3), (5, 1.0), (1, 0.3), (12, 0.6)])
def test_bodies_and_surfaces(elements, grading):
    """requirement: boxes that fill both bodies; every facet of the boundary has one name."""
    mesh = punch().build(MeshTable(elements=elements, grading=grading))
    volumes = {"punch": 0.06 * 0.08 * 0.05, "block": 0.12 * 0.14 * 0.06}
    for body, volume in volumes.items():
        low, high = boxes(mesh, body)
        assert (high - low).min() > 0
        assert np.prod(high - low, axis=1).sum() == pytest.approx(volume, rel=1e-12, abs=0.0)
    face, block = 0.06 * 0.08, 0.12 * 0.14
    expected = {
        "punch_face": face,
        "punch_top": face,
        "punch_sides": 2 * 0.05 * (0.06 + 0.08),
        "block_face": face,
        "block_top": block - face,
        "block_bottom": block,
        "block_sides": 2 * 0.06 * (0.12 + 0.14),
    }
    assert tuple(expected) == mesh.surfaces
    for surface, area in expected.items():
        assert areas(mesh, surface).sum() == pytest.approx(area, rel=1e-12), surface
    for surface, z in {
        "punch_face": 0,
        "punch_top": 0.05,
        "block_face": 0,
        "block_bottom": -0.06,
    }.items():
        np.testing.assert_allclose(edges(mesh, surface)[..., 2], z, atol=1e-15)
    assert np.abs(edges(mesh, "block_face")[..., :2]).max(axis=(0, 1)) == pytest.approx(
        [0.03, 0.04]
    )


def test_faces_agree_where_their_meshes_do():
    """requirement: the same facets on both sides; more on one where the case says so."""
    alike = punch().build(MeshTable(elements=8, grading=0.3))
    upper, lower = (edges(alike, f"{body}_face").mean(axis=1) for body in ("punch", "block"))
    assert len(upper) == 8 * 6
    nearest = np.linalg.norm(upper[:, None] - lower, axis=2).min(axis=1)
    assert nearest.max() < 1e-12
    other = MeshTable(elements=8, grading=0.3, bodies={"block": {"elements": 4}})
    assert len(edges(punch().build(other), "block_face")) == 4 * 3


def test_elements_follow_the_sides():
    """requirement: `elements` on the longer side, fewer on the shorter, thin at the edges."""
    mesh = punch(size_x="20 mm").build(MeshTable(elements=12, grading=0.5))
    face = edges(mesh, "punch_face")
    x, y = (np.unique(np.round(face[..., axis], 12)) for axis in (0, 1))
    assert (len(x), len(y)) == (4, 13)
    np.testing.assert_allclose(np.diff(y)[1] / np.diff(y)[0], 2.0, rtol=1e-6)
    low, high = boxes(mesh, "punch")
    assert (high - low)[:, 2].min() <= 1.001 * min(np.diff(x).min(), np.diff(y).min())


def test_the_geometry_says_how_it_is_pressed():
    geometry = punch()
    assert geometry.press_direction == (0.0, 0.0, -1.0)
    assert geometry.contact_area() == pytest.approx(0.0048)
    assert geometry.rotation_center is None
    assert not geometry.follows_contact


@pytest.mark.parametrize(
    ("changes", "key"),
    [({"block_x": "60 mm"}, "block_x"), ({"block_y": "50 mm"}, "block_y")],
)
def test_a_block_that_is_too_small_is_refused(changes, key):
    found, text = fault(punch, **changes)
    assert found == key
    assert "must be greater than 10/9" in text
