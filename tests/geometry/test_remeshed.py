"""Bodies that are meshed anew within their worn outline."""

from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import two_blocks
from thermowear.bulk.mesh_motion import serial_extension
from thermowear.errors import ComputationError
from thermowear.geometry.mesh.nodes import boundary
from thermowear.geometry.mesh.tagged import quality
from thermowear.geometry.moving.moved import MovableBody
from thermowear.geometry.moving.remeshed import meshed_anew
from thermowear.geometry.moving.skeleton import skeleton
from thermowear.verification.check import starter

from .measure import areas, edges, followed, volume
from .measure import scaled_jacobians as measured

LEFT, RIGHT, HEIGHT = 0.05, 0.09, 0.02


def flat(points):
    """Areas, not volumes."""
    return np.ones(len(points))


def round_the_axis(points):
    return 2 * np.pi * points[:, 0]


def grooved(depth, order=1, triangles=False, columns=12, factor=flat):
    """The upper block with a round groove in its face: its mesh moved, and the same meshed anew."""
    mesh = two_blocks(order=order, triangles=triangles, columns=(columns, 5), rows=(6, 2))
    nodes = np.unique(mesh.facets[mesh.facet_tags == mesh.surfaces.index("upper_face") + 1])
    face = mesh.points[nodes[np.argsort(mesh.points[nodes, 0])]]
    body = MovableBody(mesh, ("upper",), face)
    radius = 0.012
    across = np.clip((face[:, 0] - 0.07) / radius, -1, 1)
    up = np.maximum(radius * np.sqrt(1 - across**2) - radius + depth, 0.0)
    outlined = body.outlined(np.column_stack([0 * up, up]))
    moved = replace(mesh, points=followed(mesh, outlined))
    sizes = np.linalg.norm(np.diff(face[::order], axis=0), axis=1)
    anew, divided = meshed_anew(moved, ("upper",), body.face, sizes, factor, serial_extension)
    return mesh, moved, anew, divided, body.lost(outlined, factor)


@pytest.mark.parametrize(
    ("order", "triangles"), [(1, False), (2, False), (3, False), (1, True), (2, True)]
)
def test_a_deep_groove_breaks_moved_cells_and_not_those_meshed_anew(order, triangles):
    """requirement: scaled Jacobian above 0.1; cells of the kind and order that they were."""
    mesh, moved, anew, _, _ = grooved(0.0115, order, triangles, columns=48 if order == 1 else 12)
    assert quality(moved, ("upper",)) < (0.4 if order == 1 else 0.15)
    assert quality(anew, ("upper",)) > 0.25
    assert measured(anew).min() == pytest.approx(quality(anew, ("upper", "lower")), abs=1e-11)
    assert (anew.cell_type, anew.order) == (mesh.cell_type, order)
    assert (anew.bodies, anew.surfaces) == (mesh.bodies, mesh.surfaces)


@pytest.mark.parametrize("factor", [flat, round_the_axis])
@pytest.mark.parametrize("order", [1, 3])
def test_the_volume_stays(order, factor):
    """requirement: to 1e-6 of what is worn off; here by quadrature over all cells."""
    mesh, _, anew, _, lost = grooved(0.008, order, factor=factor)
    before, after = (volume(m, "upper", factor) for m in (mesh, anew))
    assert before - after == pytest.approx(lost, rel=1e-10)
    assert lost > 0.02 * before
    if factor is flat:
        assert areas(anew, "upper").sum() == pytest.approx(before - lost, rel=1e-12)


def test_sides_and_names_stay():
    mesh, moved, anew, _, _ = grooved(0.008, 2)
    for name in ("upper_end", "upper_inside", "upper_outside"):
        (length, corners), (before, corners_before) = (_extent(m, name) for m in (anew, moved))
        assert length == pytest.approx(before, rel=1e-12)
        assert corners == pytest.approx(corners_before, abs=1e-15)
    for name in ("lower_face", "lower_end"):
        assert np.array_equal(edges(anew, name), edges(mesh, name))
    outline = boundary(anew.cell_type, anew.order, anew.cells)
    assert len(outline) == len(anew.facets)  # every edge has its name
    assert areas(anew, "lower") == pytest.approx(areas(mesh, "lower"), rel=1e-14)


def _extent(mesh, name):
    """Length of a straight surface, and its corners."""
    nodes = edges(mesh, name)
    corners = nodes.reshape(-1, 2)
    length = np.linalg.norm(nodes[:, 1] - nodes[:, 0], axis=1).sum()
    return length, np.array([corners.min(axis=0), corners.max(axis=0)])


def test_the_face_is_on_the_groove():
    """New nodes lie on the circle, and the walls of the groove have edges as long as the others."""
    _, _, _, divided, _ = grooved(0.008, 2, columns=24)
    nodes = divided.edges[:, :-1].reshape(-1, 2)
    inside = nodes[np.abs(nodes[:, 0] - 0.07) < 0.9 * np.sqrt(0.012**2 - 0.004**2)]
    assert len(inside) > 20
    from_centre = np.hypot(inside[:, 0] - 0.07, inside[:, 1] + 0.004)
    assert from_centre == pytest.approx(0.012, abs=5e-6)
    assert divided.sizes.max() < 1.4 * (RIGHT - LEFT) / 24
    assert len(divided.edges) > 24


def test_places_are_found_again():
    """requirement: a position on the former face is at the same position of the new one."""
    _, _, _, divided, _ = grooved(0.008, 2, columns=24)
    former = np.linspace(0.0, len(divided.former), 101)
    number = divided.at(former)
    assert np.all(np.diff(number) > 0.0)
    facet = np.minimum(former.astype(int), len(divided.former) - 1)
    x = _at(divided.former, facet, former - facet)
    curve = divided.on_curve(number)
    assert curve == pytest.approx(x, abs=2e-4)
    nodes = np.concatenate([divided.former[:, :-1].reshape(-1, 2), divided.former[-1:, -1]])
    carried = divided.carried(nodes)
    new = np.concatenate([divided.edges[:, :-1].reshape(-1, 2), divided.edges[-1:, -1]])
    assert carried == pytest.approx(new, abs=2e-4)


def _at(edge_nodes, facet, t):
    """Points of quadratic edges."""
    a, m, b = np.moveaxis(edge_nodes[facet], 1, 0)
    t = t[:, None]
    return a * (1 - t) * (1 - 2 * t) + 4 * m * t * (1 - t) + b * t * (2 * t - 1)


def test_a_body_with_zones_keeps_them():
    """The lining of a brake shoe is meshed anew with the shoe, their border stays."""
    case = starter("drum-brake")
    mesh = case.tagged_mesh()
    parts = case.geometry.parts_of("shoe")
    assert len(parts) == 2
    face = mesh.facets[mesh.facet_tags == mesh.surfaces.index(case.geometry.contact[0]) + 1]
    angle = np.arctan2(*mesh.points[face].mean(axis=1).T)
    listed = face[np.argsort(angle)]
    listed = np.column_stack([listed[:, 0], listed[:, 2:], listed[:, 1]])
    turned = np.arctan2(*mesh.points[listed[:, 0]].T) > np.arctan2(*mesh.points[listed[:, -1]].T)
    listed[turned] = listed[turned, ::-1]
    chain = np.append(listed[:, :-1].ravel(), listed[-1, -1])
    sizes = np.linalg.norm(mesh.points[listed[:, -1]] - mesh.points[listed[:, 0]], axis=1)
    anew, _ = meshed_anew(mesh, parts, chain, sizes, flat, serial_extension)
    for part in case.geometry.parts:
        assert areas(anew, part).sum() == pytest.approx(areas(mesh, part).sum(), rel=1e-6)
    assert quality(anew, parts) > 0.3
    inner = [line for line in skeleton(anew, parts, chain[:0]) if len(line.parts) == 2]
    assert inner
    assert not any(line.surface for line in inner)


def test_a_face_worn_through_its_body_is_refused():
    with pytest.raises(ComputationError, match="intersects other sides"):
        grooved(0.0295)
