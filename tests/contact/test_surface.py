"""Faces in space: facets, contact points, pressure space and trace operators."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from thermowear import CaseError
from thermowear.bulk.kinematics import Spatial
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.projection import project
from thermowear.contact.operators.condensation import gap_trace, value_trace
from thermowear.contact.operators.pressure import contact_zones, pressure_basis
from thermowear.contact.search.clipping import parts_opposite
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.lagrange import lattice
from thermowear.parallel import sum_over_ranks

from ..bulk.fields import interpolated
from .solids import COMM, SIZE, bent, gathered, skewed, straight, turned
from .solids import two_solids as solids

OTHER = ((3, 2, 2), (4, 3, 2))
CELLS = ["hexahedron", "tetrahedron"]


def raised(p):
    """A face that is no longer level."""
    x, y, z = np.moveaxis(p, -1, 0)
    return np.stack([x, y, z + 3e-3 * np.cos(60 * x) * np.cos(40 * y)], axis=-1)


def faces(divisions=OTHER, order=1, maps=(straight, straight), cell_type="hexahedron"):
    return gathered(solids(divisions, order, maps, cell_type))[1]


def moved(face, by):
    """The face of a body that has been shifted."""
    return replace(face, nodes=face.nodes + np.array(by))


@pytest.mark.parametrize("cell_type", CELLS)
@pytest.mark.parametrize(("place", "order"), [(straight, 1), (bent, 2), (bent, 3), (turned, 3)])
def test_facets(place, order, cell_type):
    """requirement: outward normals, areas, shared corners, the order of the mesh file."""
    upper, lower = faces(OTHER, order, (place, place), cell_type)
    per_cell = 1 if cell_type == "hexahedron" else 2
    area = SIZE[0] * SIZE[1] if place is not turned else np.pi / 4 * (0.09**2 - 0.05**2)
    for face, count, normal in ((upper, (3, 2), -1.0), (lower, (4, 3), 1.0)):
        every = np.arange(len(face.nodes))
        assert len(every) == per_cell * count[0] * count[1]
        t = np.random.default_rng(0).uniform(size=(len(every), 2)) / per_cell
        np.testing.assert_allclose(face.normals(every, t), [[0, 0, normal]] * len(every), atol=1e-9)
        assert face.sizes.sum() == pytest.approx(area, rel=2e-4 if place is turned else 1e-12)
        places = face.corner_points.reshape(-1, 3)
        numbers = face.corners.reshape(-1)
        assert len(np.unique(numbers)) == (count[0] + 1) * (count[1] + 1)
        for number in numbers:
            assert np.ptp(places[numbers == number], axis=0).max() < 1e-12


@pytest.mark.parametrize("cell_type", CELLS)
def test_tangents_and_turning_are_derivatives(cell_type):
    """requirement: of points and of the continuous normals, along both parameters."""
    upper, _ = faces(OTHER, 2, (raised, raised), cell_type)
    rng = np.random.default_rng(1)
    facet, t = np.arange(6), rng.uniform(0.1, 0.4, (6, 2))
    for k in (0, 1):
        step = 1e-6 * np.eye(2)[k]
        slope = (upper.points(facet, t + step) - upper.points(facet, t - step)) / 2e-6
        np.testing.assert_allclose(upper.tangents(facet, t)[:, k], slope, atol=1e-9)
        after, before = (upper.smooth_normals(facet, at)[0] for at in (t + step, t - step))
        turning = upper.smooth_normals(facet, t)[1][:, k]
        np.testing.assert_allclose(turning, (after - before) / 2e-6, atol=1e-8)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_normals_of_triangles_meet_at_corners_and_along_plane_edges(order):
    """requirement: facets have the same normal at their common corners, plane ones along edges."""
    upper, _ = faces(OTHER, order, (raised, raised), "tetrahedron")
    part = np.linspace(0.0, 1.0, 9)
    jumps = _jumps(
        upper, lambda *at: upper.smooth_normals(*at)[0], part if order == 1 else part[::8]
    )
    assert np.abs(_jumps(upper, upper.normals, part)).max() > 1e-3
    assert np.abs(jumps).max() < 1e-12


def _jumps(face, normals, part):
    """Differences of normals of two facets along their common edges."""
    places = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]])  # of the corners, as of a lattice
    found = {}
    for facet, numbers in enumerate(face.corners):
        for a, b in ((0, 1), (1, 2), (0, 2)):
            a, b = (a, b) if numbers[a] < numbers[b] else (b, a)
            t = places[a] + part[:, None] * (places[b] - places[a])
            along = normals(np.full(len(t), facet), t)
            found.setdefault((numbers[a], numbers[b]), []).append(along)
    return np.array([first - pair[0] for pair in found.values() for first in pair[1:]])


@pytest.mark.parametrize(
    ("divisions", "maps"),
    [
        (((3, 2, 2), (3, 2, 2)), (straight, straight)),
        (OTHER, (straight, straight)),
        (((4, 3, 2), (2, 5, 2)), (skewed, skewed)),
        (((3, 3, 2), (3, 3, 2)), (bent, bent)),
        (OTHER, (straight, bent)),
        (((5, 4, 2), (2, 2, 2)), (bent, straight)),
    ],
)
@pytest.mark.parametrize("cell_type", CELLS)
def test_weights_integrate_over_the_face(divisions, maps, cell_type):
    """requirement: areas; polynomials in space, across the facets of both sides."""
    pairing = pair(*faces(divisions, 1, maps, cell_type), Spatial(), 6)
    (x, y, _), w = pairing.points.T, pairing.weights
    a, b = SIZE
    if maps[0] is skewed:
        assert w.sum() == pytest.approx(0.94 * a * b, rel=1e-12)
    else:
        assert w.sum() == pytest.approx(a * b, rel=1e-12)
        assert w @ (x**2 * y**3) == pytest.approx(a**3 / 3 * b**4 / 4, rel=1e-11)
    assert w.min() > 0
    assert pairing.unpaired < 1e-12
    np.testing.assert_allclose(pairing.gap, 0.0, atol=1e-15)
    for side in pairing.sides:
        np.testing.assert_allclose(side.face.points(side.facet, side.t), pairing.points, atol=1e-12)
        assert side.t.min() >= 0
        assert side.t.max() <= 1


@pytest.mark.parametrize("cell_type", CELLS)
@pytest.mark.parametrize("order", [2, 3])
def test_curved_facets_cover_the_face_once(order, cell_type):
    """requirement: facets with curved edges in a plane that do not match; small at their corners
    are the parts that edges of four segments miss.
    """
    pairing = pair(*faces(OTHER, order, (bent, bent), cell_type), Spatial(), 6)
    assert pairing.weights.sum() == pytest.approx(SIZE[0] * SIZE[1], rel=1e-5)
    assert pairing.unpaired < 1e-5


def test_matching_faces_have_the_nodes_of_one_rule():
    """requirement: points that facets share are one; the rim has points."""
    pairing = pair(*faces(((3, 2, 2), (3, 2, 2))), Spatial(), 4)
    assert len(pairing.weights) == (3 * 3 + 1) * (3 * 2 + 1)
    assert pairing.points[:, :2].min() == 0.0
    assert pairing.points[:, 0].max() == SIZE[0]


@pytest.mark.parametrize("axes", [(0, 1, 2), (1, 0, 2)])
def test_parts_are_where_both_facets_are(axes):
    """requirement: a turned square opposite to one leaves a regular octagon, whichever way each
    facet runs.
    """
    upper, lower = faces(((1, 1, 1), (1, 1, 1)))
    square = np.array([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]], dtype=float)
    upper = replace(upper, nodes=square.reshape(1, 4, 3))
    middle, angle = np.array([0.5, 0.5, 0.0]), np.pi / 4
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    lower = replace(
        lower, nodes=((square.transpose(axes) - middle) @ turn.T + middle).reshape(1, 4, 3)
    )
    if upper.middle_normals[0] @ lower.middle_normals[0] > 0:
        lower = replace(lower, outward=-lower.outward)
    facet, corners = parts_opposite(upper, lower)
    assert set(facet) == {0}
    side = np.sqrt(2) - 1
    following = np.roll(corners, -1, axis=1)
    areas = (corners[..., 0] * following[..., 1] - corners[..., 1] * following[..., 0]).sum(1) / 2
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(2 * (1 + np.sqrt(2)) * side**2, rel=1e-12)
    pairing = pair(upper, lower, Spatial(), 4)
    assert pairing.weights.sum() == pytest.approx(areas.sum(), rel=1e-12)
    assert pairing.unpaired == pytest.approx(1 - areas.sum(), rel=1e-12)


@pytest.mark.parametrize("distance", [1e-4, -2e-5])
def test_initial_gap_is_open_where_positive(distance):
    """requirement: the sign of the gap, g0 = (x2 - x1)·n."""
    upper, lower = faces()
    pairing = pair(upper, moved(lower, [0.0, 0.0, -distance]), Spatial(), 4)
    np.testing.assert_allclose(pairing.gap, distance, rtol=1e-9)


def wavy(p):
    """A face that is level but for a few micrometres."""
    return p + 1e-3 * (raised(p) - p)


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("cell_type", CELLS)
def test_gaps_far_from_the_origin(order, cell_type):
    """requirement: rounded as the coordinates are, a few times the last digit of 1 m."""
    known = faces(OTHER, order, (wavy, wavy), cell_type)
    away = (1.0, 0.7, -0.9)
    one, other = (pair(*each, Spatial(), 4) for each in (known, [moved(f, away) for f in known]))
    np.testing.assert_allclose(other.gap, one.gap, rtol=0.0, atol=7e-16)
    np.testing.assert_allclose(other.points - away, one.points, rtol=0.0, atol=7e-16)


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("cell_type", CELLS)
def test_no_place_of_a_curved_face_is_closer(order, cell_type):
    """requirement: than the projection, of many sampled on all facets."""
    upper, _ = faces(OTHER, order, (raised, raised), cell_type)
    low, high = upper.nodes.reshape(-1, 3).min(axis=0), upper.nodes.reshape(-1, 3).max(axis=0)
    points = np.random.default_rng(8).uniform(low - 4e-3, high + 4e-3, (500, 3))
    steps = lattice(40, upper.kind).reshape(-1, 2)
    sampled = cKDTree(upper.points(*upper.on_each(steps))).query(points)[0]
    distance = np.linalg.norm(project(upper, points)[2], axis=1)
    assert np.all(distance <= sampled + 1e-12)


def dome(p):
    """Curved facets on a sphere that touches the other face at its pole, of uneven sizes."""
    x, y, z = np.moveaxis(p, -1, 0)
    x, y = x + 2e-4 * np.sin(900 * x + 500 * y), y + 2e-4 * np.sin(700 * y - 650 * x + 1)
    radius = 0.032
    square = (x - SIZE[0] / 2) ** 2 + (y - SIZE[1] / 2) ** 2
    return np.stack([x, y, z + radius - np.sqrt(radius**2 - square)], axis=-1)


def test_facets_far_from_the_other_face_are_covered_at_most_once():
    """requirement: near the rim of a cap of a ball, the gap to a flat face is longer than facets,
    and which points meet is not unique there: their area counts once, and the cap is not refused;
    near the pole facets are covered exactly once.
    """
    upper, lower = faces(((24, 18, 1), (6, 5, 1)), 2, (dome, straight), "tetrahedron")
    pairing = pair(upper, lower, Spatial(), 4)
    pieces = pairing.pieces
    covered = np.bincount(pieces.facet, pieces.weight, len(upper.sizes)) / upper.measure
    assert covered.max() < 1 + 1e-3
    middle = upper.points(*upper.on_each(np.full((1, 2), 1 / 3)))
    near = np.linalg.norm(middle[:, :2] - np.array(SIZE) / 2, axis=1) < 4e-3
    np.testing.assert_allclose(covered[near], 1.0, rtol=1e-3)


def test_points_without_a_partner_are_outside_the_contact():
    """requirement: where body 2 ends, contact ends, exactly there."""
    upper, lower = faces()
    pairing = pair(upper, moved(lower, [0.013, 0.004, 0.0]), Spatial(), 5)
    left = (SIZE[0] - 0.013) * (SIZE[1] - 0.004)
    np.testing.assert_allclose(pairing.points[:, :2].min(axis=0), [0.013, 0.004], atol=1e-12)
    assert pairing.weights.sum() == pytest.approx(left, rel=1e-9)
    assert pairing.unpaired == pytest.approx(1 - left / (SIZE[0] * SIZE[1]), rel=1e-9)


@pytest.mark.parametrize("refine", [True, False])
def test_faces_that_do_not_meet_are_reported(refine):
    upper, lower = faces()
    with pytest.raises(CaseError, match="opposite"):
        pair(upper, moved(lower, [1.0, 0.0, 0.0]), Spatial(), 4, refine)


def test_faces_that_look_away_do_not_meet():
    upper, lower = faces()
    with pytest.raises(CaseError, match="opposite"):
        pair(upper, replace(lower, outward=-lower.outward), Spatial(), 4)


def test_points_of_whole_facets():
    """requirement: point by point, at the nodes of one rule on each facet of body 1."""
    pairing = pair(*faces(), Spatial(), 3, refine=False)
    assert len(pairing.weights) == 7 * 5
    assert pairing.weights.sum() == pytest.approx(SIZE[0] * SIZE[1])


@pytest.mark.parametrize("cell_type", CELLS)
def test_projection_on_a_curved_face(cell_type):
    """requirement: closest points; the offset is along the normal, beyond the rim it is not."""
    _, lower = faces(((3, 2, 2), (5, 4, 2)), 3, (raised, raised), cell_type)
    rng = np.random.default_rng(2)
    facet, t = rng.integers(20, size=60), rng.uniform(0.05, 0.95, (60, 2))
    if cell_type == "tetrahedron":
        t = np.where(t.sum(axis=1, keepdims=True) < 1, t, 1 - t)
    on = lower.points(facet, t)
    points = on + 2e-3 * lower.normals(facet, t)
    found, at, offset = project(lower, points)
    np.testing.assert_allclose(lower.points(found, at), on, atol=1e-10)
    np.testing.assert_allclose(offset, on - points, atol=1e-10)
    beyond = np.array([[-1e-3, 0.01, 0.003], [0.05, 0.04, 0.0]])
    found, at, offset = project(lower, beyond)
    rim = lower.points(found, at)
    np.testing.assert_allclose(rim[0, 0], 0.0, atol=1e-12)
    np.testing.assert_allclose(rim[1, :2], SIZE, atol=1e-12)


@pytest.mark.parametrize("cell_type", CELLS)
@pytest.mark.parametrize(("place", "order"), [(skewed, 1), (bent, 2)])
def test_the_closest_point_of_a_rim(place, order, cell_type):
    """requirement: beside the face it lies on the rim, nearer than any other point of it."""
    _, lower = faces(((3, 2, 2), (3, 2, 2)), order, (place, place), cell_type)
    middle = lower.nodes.mean(axis=(0, 1))
    angles = np.linspace(0, 2 * np.pi, 40)
    points = middle + 0.05 * np.column_stack([np.cos(angles), np.sin(angles), 0.1 + 0 * angles])
    _, _, offset = project(lower, points)
    steps = np.linspace(0, 1, 201)
    s, t = (v.ravel() for v in np.meshgrid(steps, steps))
    if cell_type == "tetrahedron":
        s, t = s[s + t <= 1], t[s + t <= 1]
    facet = np.repeat(np.arange(len(lower.nodes)), len(s))
    every = lower.points(facet, np.tile(np.column_stack([s, t]), (len(lower.nodes), 1)))
    distance = np.array([np.linalg.norm(every - p, axis=1).min() for p in points])
    found = np.linalg.norm(offset, axis=1)
    assert np.all(found <= distance * (1 + 1e-12))
    np.testing.assert_allclose(found, distance, rtol=1e-4)


@pytest.mark.parametrize("degree", [1, 2, 4])
@pytest.mark.parametrize(
    ("divisions", "maps"), [(OTHER, (straight, straight)), (((3, 2, 2),) * 2, (bent, bent))]
)
@pytest.mark.parametrize("cell_type", CELLS)
def test_pressure_basis(divisions, maps, degree, cell_type):
    """requirement: Ψ >= 0, sums to one, continuous, complete to its degree."""
    pairing = pair(*faces(divisions, 1, maps, cell_type), Spatial(), degree + 2)
    basis = pressure_basis(pairing, degree).toarray()
    assert basis.min() >= 0.0
    np.testing.assert_allclose(basis.sum(axis=1), 1.0, rtol=1e-13)
    assert basis.shape[1] == (3 * degree + 1) * (2 * degree + 1)
    x, y, _ = pairing.points.T / SIZE[0]
    field = (x - 2 * y) ** degree
    if maps[0] is straight and cell_type == "hexahedron":
        field = field + (x * y) ** degree
    best = np.linalg.lstsq(basis, field, rcond=None)[0]
    np.testing.assert_allclose(basis @ best, field, atol=1e-11)


def test_pressure_is_continuous_whichever_way_facets_run():
    """requirement: edges are shared with their orientation."""
    upper, lower = faces(((3, 2, 2), (3, 2, 2)))
    flipped = upper.nodes.copy(), upper.corners.copy()
    for facet, turns in ((1, 1), (2, 2), (4, 3)):
        for values in flipped:
            grid = values[facet].reshape(2, 2, *values.shape[2:])
            values[facet] = np.rot90(grid, turns).reshape(values[facet].shape)
    mixed = replace(upper, nodes=flipped[0], corners=flipped[1])
    plain, turned_ = (pair(f, lower, Spatial(), 6) for f in (upper, mixed))
    order = [np.lexsort(np.round(p.points[:, :2], 9).T) for p in (plain, turned_)]
    spaces = [
        pressure_basis(p, 4)[k].toarray() for p, k in zip((plain, turned_), order, strict=True)
    ]
    both = np.hstack(spaces)
    assert np.linalg.matrix_rank(both, tol=1e-9) == spaces[0].shape[1]


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
@pytest.mark.parametrize(
    ("divisions", "order", "maps"),
    [
        (OTHER, 1, (straight, straight)),
        (OTHER, 1, (straight, bent)),
        (((3, 2, 2),) * 2, 2, (bent, bent)),
    ],
)
@pytest.mark.parametrize("cell_type", CELLS)
def test_traces(divisions, order, maps, degree, cell_type):
    """requirement: E evaluates fields at the points; B = (u2 - u1)·n, open positive."""
    degree = max(degree, order)
    bodies, (upper, lower) = gathered(solids(divisions, order, maps, cell_type))
    pairing = pair(upper, lower, Spatial(), degree + 2)
    scalar, vector = lagrange_spaces(bodies, degree), lagrange_spaces(bodies, degree, 3)
    power = degree // order  # in the cells' own parameters the degree is higher

    def field(x):
        return (30 * x[0] - 50 * x[1] + 20 * x[2]) ** power

    values = interpolated(scalar, field)
    u = interpolated(vector, lambda x: np.stack([7 + 0 * x[0], x[1], field(x)]))
    expected = field(pairing.points.T)
    for side in pairing.sides:
        found = value_trace(scalar, side).T @ values
        np.testing.assert_allclose(sum_over_ranks(COMM, found), expected, atol=1e-11)
    trace = gap_trace(vector, Contacts((pairing,))).T
    assert np.abs(sum_over_ranks(COMM, trace @ u)).max() < 1e-10
    lifted = elevated(bodies, vector)
    np.testing.assert_allclose(sum_over_ranks(COMM, trace @ lifted), 1e-3, rtol=1e-11)


def elevated(bodies, spaces):
    """Body 1 lifted by 1 mm: the gap opens by 1 mm."""
    return np.outer(spaces.nodes_of(bodies, "upper"), (0.0, 0.0, 1e-3)).ravel()


def test_a_surface_has_no_zones():
    pairing = pair(*faces(), Spatial(), 4)
    assert contact_zones(pairing, np.ones(len(pairing.weights))) == []
    assert np.isnan(pairing.position).all()
    assert pairing.extent == pytest.approx(SIZE[0])


@pytest.mark.parametrize("moved_by", [0.14, 0.18])
def test_distorted_facets_do_not_fold_back(moved_by):
    """requirement: edges of second order whose middles lie anywhere in a plane cover the face
    once, though the facets, extended by their own curves, fold over next to it."""
    upper, lower = faces(OTHER, 2, (straight, straight), "tetrahedron")
    numbers, nodes = upper.numbers(2), upper.nodes.reshape(-1, 3)
    _, first, uses = np.unique(numbers, return_index=True, return_counts=True)
    x, y = nodes[first, :2].T / np.array(SIZE)[:, None]
    inside = (uses == 2) & (x > 0.01) & (x < 0.99) & (y > 0.01) & (y < 0.99)
    way = np.random.default_rng(3).uniform(-1, 1, (numbers.max() + 1, 3)) * [1.0, 1.0, 0.0]
    way[numbers.ravel()[first][~inside]] = 0.0
    upper = replace(upper, nodes=upper.nodes + moved_by * upper.lengths.mean() * way[numbers])
    pairing = pair(upper, lower, Spatial(), 4)
    assert pairing.weights.sum() == pytest.approx(SIZE[0] * SIZE[1], rel=1e-2)
    assert pairing.unpaired < 1e-2
