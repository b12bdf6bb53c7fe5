"""The mesh of the annular punch on a plate."""

import numpy as np
import pytest

import thermowear as tw

from ..conftest import HOT


def mesh_of(*overrides):
    case = tw.load(HOT, overrides)
    return case, case.tagged_mesh()


def area(mesh, body):
    corners = mesh.points[mesh.cells[mesh.cell_tags == mesh.bodies.index(body) + 1]]
    x, y = corners[..., 0], corners[..., 1]
    return 0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum(axis=1)


def edges(mesh, surface):
    return mesh.points[mesh.facets[mesh.facet_tags == mesh.surfaces.index(surface) + 1]]


@pytest.mark.parametrize(
    "overrides",
    [
        (),
        ("mesh.elements=5", "mesh.grading=1.0"),
        ("mesh.bodies.plate.elements=17",),
        ("mesh.elements=1",),
    ],
)
def test_bodies_are_filled(overrides):
    """requirement: quadrilaterals without inversion that fill both sections."""
    _, mesh = mesh_of(*overrides)
    punch, plate = area(mesh, "punch"), area(mesh, "plate")
    assert np.all(np.abs(np.sign(punch).sum()) == len(punch))
    assert np.abs(punch.sum()) == pytest.approx(0.1 * 0.05, rel=1e-12)
    assert np.abs(plate.sum()) == pytest.approx(0.14 * 0.1, rel=1e-12)


def test_surfaces_are_where_their_names_say():
    """requirement: tags by name, every boundary named, axis left free."""
    _, mesh = mesh_of()
    expected = {
        "punch_face": (1, 0.0),
        "punch_top": (1, 0.05),
        "punch_inside": (0, 0.02),
        "punch_outside": (0, 0.12),
        "plate_face": (1, 0.0),
        "plate_bottom": (1, -0.1),
        "plate_side": (0, 0.14),
    }
    assert set(expected) == set(mesh.surfaces)
    for surface, (axis, value) in expected.items():
        assert np.allclose(edges(mesh, surface)[..., axis], value, atol=1e-12), surface
    for face in ("punch_face", "plate_face"):
        r = edges(mesh, face)[..., 0]
        assert (r.min(), r.max()) == pytest.approx((0.02, 0.12), abs=1e-12)


def test_elements_and_grading_along_the_contact():
    """requirement: `mesh.elements` and `mesh.grading` mean what the case file says."""
    _, mesh = mesh_of("mesh.elements=12", "mesh.grading=0.3")
    h = np.sort(np.abs(np.diff(edges(mesh, "punch_face")[..., 0], axis=1)).ravel())
    assert len(h) == 12
    assert h[-1] / h[0] == pytest.approx(0.3**-3, rel=1e-6)


def test_bodies_may_be_divided_differently():
    """requirement: the contact sides of the two bodies need not match."""
    _, mesh = mesh_of("mesh.bodies.plate.elements=17", "mesh.bodies.plate.grading=0.5")
    assert len(edges(mesh, "punch_face")) == 12
    assert len(edges(mesh, "plate_face")) == 17
