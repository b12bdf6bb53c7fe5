"""Bodies of tetrahedra remeshed inside of their surfaces."""

from dataclasses import replace

import numpy as np
import pytest

from tests.contact.solids import two_solids
from thermowear.bulk.mesh_motion import serial_extension
from thermowear.errors import ComputationError
from thermowear.geometry.mesh.nodes import boundary
from thermowear.geometry.mesh.tagged import quality
from thermowear.geometry.moving.moved import cells_of
from thermowear.geometry.moving.remeshed_solid import meshed_inside
from thermowear.verification.spherical_pin import SphericalPin

from .measure import volumes


def squeezed(tmp_path, order):
    """Pin whose inner nodes lie where they make bad cells."""
    mesh = SphericalPin(10e-3, 6e-3, 10e-3, (9e-3, 6e-3), 2e-3, order).write(tmp_path / "pin.msh")
    surface = np.unique(boundary("tetrahedron", order, cells_of(mesh, ("pin",))))
    inside = np.setdiff1d(cells_of(mesh, ("pin",)), surface)
    points = mesh.points.copy()
    points[inside, 2] = 10e-3 - 0.3 * (10e-3 - points[inside, 2])
    return replace(mesh, points=points), surface


@pytest.mark.parametrize("order", [1, 2, 3])
def test_the_surface_is_kept(tmp_path, order):
    """To the last bit, with its names; the other body, too."""
    mesh, surface = squeezed(tmp_path, order)
    before = quality(mesh, ("pin",))
    found = meshed_inside(mesh, ("pin",), serial_extension)
    assert quality(found, ("pin",)) > max(0.1, 2 * before)
    assert found.order == order
    assert volumes(found, "pin").min() > 0.0
    assert volumes(found, "pin").sum() == pytest.approx(volumes(mesh, "pin").sum(), rel=1e-9)
    for name in mesh.surfaces:
        one, other = (each.points[each.facets_of(name)] for each in (mesh, found))
        assert np.array_equal(
            np.sort(one.mean(axis=1), axis=0), np.sort(other.mean(axis=1), axis=0)
        )
    new = np.unique(boundary("tetrahedron", order, cells_of(found, ("pin",))))
    assert {tuple(p) for p in found.points[new]} == {tuple(p) for p in mesh.points[surface]}
    blocks = [each.points[cells_of(each, ("block",))] for each in (mesh, found)]
    assert np.array_equal(*blocks)


def divided(order, inside):
    """Upper of two boxes, some of whose cells, by their middles, belong to a zone."""
    mesh = two_solids(((4, 4, 4), (2, 2, 2)), order, cell_type="tetrahedron")
    middles = mesh.points[mesh.cells[:, :4]].mean(axis=1)
    size = np.ptp(mesh.points[mesh.cells[mesh.cell_tags == 1]], axis=(0, 1))
    low = mesh.points[mesh.cells[mesh.cell_tags == 1]].min(axis=(0, 1))
    zone = (mesh.cell_tags == 1) & inside((middles - low) / size)
    tags = np.where(zone, len(mesh.bodies) + 1, mesh.cell_tags).astype(np.int32)
    return replace(mesh, cell_tags=tags, bodies=(*mesh.bodies, "zone"))


@pytest.mark.parametrize("order", [1, 2])
def test_parts_keep_their_border(order):
    """A zone on one side, and one enclosed by the body, whose material has an inner surface."""
    for inside in (
        lambda p: p[:, 0] < 0.5,
        lambda p: np.all((p > 0.25) & (p < 0.75), axis=1),
    ):
        mesh = divided(order, inside)
        found = meshed_inside(mesh, ("upper", "zone"), serial_extension)
        for part in ("upper", "zone", "lower"):
            one, other = (volumes(each, part) for each in (mesh, found))
            assert other.min() > 0.0
            assert other.sum() == pytest.approx(one.sum(), rel=1e-9)


def test_a_hollow_body_stays_hollow():
    mesh = divided(1, lambda p: np.all((p > 0.25) & (p < 0.75), axis=1))
    hollow = mesh.cell_tags != 3
    mesh = replace(mesh, cells=mesh.cells[hollow], cell_tags=mesh.cell_tags[hollow])
    found = meshed_inside(mesh, ("upper",), serial_extension)
    assert volumes(found, "upper").sum() == pytest.approx(volumes(mesh, "upper").sum(), rel=1e-9)


def test_a_surface_that_intersects_itself(tmp_path):
    """requirement: one line; gmsh runs in a process of its own."""
    mesh, _ = squeezed(tmp_path, 1)
    face = np.unique(mesh.facets_of("pin_face"))
    points = mesh.points.copy()
    points[face, 2] += 12e-3
    with pytest.raises(ComputationError, match="remeshing: gmsh could not mesh the worn body: "):
        meshed_inside(replace(mesh, points=points), ("pin",), serial_extension)
