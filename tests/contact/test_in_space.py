"""Contact in space: the patch test, and the same bodies computed by the plane models."""

from dataclasses import replace

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.heat.heat_equation import ThermalMaterial, conduction
from thermowear.bulk.kinematics import Axisymmetric, PlaneStrain, Spatial
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.face import gather_face
from thermowear.contact.operators.condensation import (
    bath_matrix,
    condense,
    condense_heat,
    gap_trace,
    value_trace,
)
from thermowear.contact.operators.heat_exchange import FaceHeat, baseline_response
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.operators.rigid_motion import RigidMode, hold
from thermowear.contact.search.pairing import Contacts, pair, paired
from thermowear.contact.solvers.signorini import solve_contact
from thermowear.laws.motions import rotation, translation
from thermowear.reference import heat

from ..conftest import two_blocks
from .solids import (
    COMM,
    HEIGHTS,
    MODULI,
    SIZE,
    bent,
    condensed,
    gathered,
    skewed,
    straight,
    turned,
)
from .solids import two_solids as solids

SAME, OTHER, COARSER = ((3, 3, 2), (3, 3, 2)), ((3, 3, 2), (5, 4, 2)), ((4, 5, 2), (2, 3, 2))
CELLS = ["hexahedron", "tetrahedron"]
EXACT = [
    (SAME, 1, straight),
    (SAME, 1, bent),
    (SAME, 2, bent),
    (SAME, 2, turned),
    (OTHER, 1, straight),
    (COARSER, 1, straight),
    (OTHER, 1, skewed),
]


def solved(pairing, holder, contact, gap):
    """Pressure at the points and the motion of the holder."""
    weak = contact.weak(gap)
    solution = solve_contact(contact.compliance, weak, contact.modes, holder.load)
    return contact.basis @ solution.coefficients, solution.motion


def patch(divisions, order, maps, degree, cell_type="hexahedron"):
    """Largest relative error of the pressure, and of the approach."""
    pairing, holder, contact = condensed(solids(divisions, order, maps, cell_type), degree)
    p, d = solved(pairing, holder, contact, pairing.gap)
    mean = 1 / pairing.weights.sum()
    shortened = mean * sum(h / E for h, E in zip(HEIGHTS, MODULI.values(), strict=True))
    return np.abs(p / mean - 1).max(), abs(d[0] / shortened - 1)


@pytest.mark.parametrize("cell_type", CELLS)
@pytest.mark.parametrize("degree", [1, 2, 3])
@pytest.mark.parametrize(("divisions", "order", "place"), EXACT)
def test_uniform_pressure_is_exact(divisions, order, place, degree, cell_type):
    """requirement: in space. Two blocks carry a uniform pressure: matching faces of any shape
    exactly, others where the facets of body 1 are parallelograms or plane triangles.
    """
    errors = patch(divisions, order, (place, place), max(degree, order), cell_type)
    assert max(errors) < 1e-10


@pytest.mark.parametrize(
    ("divisions", "order", "maps", "degree", "allowed"),
    [
        (OTHER, 1, (straight, bent), 2, 1e-8),
        (OTHER, 1, (bent, bent), 2, 1e-4),
        (COARSER, 1, (bent, straight), 2, 1e-3),
        (OTHER, 1, (bent, straight), 3, 1e-3),
        (OTHER, 2, (bent, bent), 2, 1e-3),
        (OTHER, 2, (turned, turned), 2, 1e-2),  # elements of 30°: the arcs are not the same
        (OTHER, 3, (turned, turned), 3, 1e-2),
    ],
)
def test_uniform_pressure_through_distorted_faces_that_do_not_match(
    divisions, order, maps, degree, allowed
):
    pressure, approach = patch(divisions, order, maps, degree)
    assert pressure < allowed
    assert approach < allowed / 10


def plane_contact(model, inner, columns, degree, gap, rigid_modes):
    """x, pressure and motion of two blocks in a plane model."""
    tagged = two_blocks(
        inner=inner,
        outer=inner + SIZE[0],
        heights=HEIGHTS,
        columns=(columns, columns),
        rows=(3, 3),
    )
    bodies = distribute(tagged if COMM.rank == 0 else None, COMM)
    materials = {name: ElasticMaterial(E, 0.3) for name, E in MODULI.items()}
    elastic = elasticity(bodies, model, degree, materials, ["upper_end", "lower_end"])
    faces = (gather_face(bodies, f"{name}_face") for name in MODULI)
    pairing = pair(*faces, model, degree + 2)
    trace, basis = (
        gap_trace(elastic.spaces, Contacts((pairing,))),
        pressure_basis(pairing, degree - 1),
    )
    holder = hold(Contacts((pairing,)), pairing.normals, rigid_modes)
    contact = condense(elastic, pairing.weights, trace, trace, basis, holder)
    x = pairing.points[:, 0]
    return x, *solved(pairing, holder, contact, gap(x))


def test_a_slab_between_walls_is_in_plane_strain():
    """requirement: the pressure that the plane model finds, under a force off the middle."""

    def gap(x):
        return 4e-6 * ((x - 0.018) / 0.02) ** 2

    middle, force, moment = 0.02, 5e3, 5.0
    down = [RigidMode(translation((0.0, -1.0)), load=force)]
    # about y by the right-hand rule is clockwise in the plane of x and z
    down.append(RigidMode(rotation((0.0, 0.0, -1.0), (middle, 0.0)), load=moment))
    model = PlaneStrain(SIZE[1])
    x, expected, motion = plane_contact(model, 0.0, 6, 3, gap, down)
    rigid_modes = [RigidMode(translation((0.0, 0.0, -1.0)), load=force)]
    rigid_modes.append(RigidMode(rotation((0.0, 1.0, 0.0), (middle, 0.0, 0.0)), load=moment))
    walls = tuple(f"{name}_{end}_y" for name in MODULI for end in ("low", "high"))
    tagged = solids(((6, 1, 3), (6, 1, 3)))
    pairing, holder, contact = condensed(tagged, 3, 0.3, rigid_modes=rigid_modes, rollers=walls)
    found, moved = solved(pairing, holder, contact, gap(pairing.points[:, 0]))
    assert 0.2 < (expected > 0).mean() < 0.9
    nearest = np.abs(pairing.points[:, :1] - x).argmin(axis=1)
    np.testing.assert_allclose(found, expected[nearest], atol=1e-9 * expected.max())
    np.testing.assert_allclose(moved, motion, rtol=1e-9)


@pytest.mark.parametrize(("degree", "order"), [(2, 2), pytest.param(3, 3, marks=pytest.mark.slow)])
def test_a_quarter_of_a_ring_is_axisymmetric(degree, order):
    """requirement: curved cells, the pressure of the axisymmetric model within 2e-3 of its peak."""

    def gap(r):
        return 2e-6 * ((r - 0.07) / 0.02) ** 2

    force = 4e4
    down = [RigidMode(translation((0.0, -1.0)), load=force)]
    r, expected, motion = plane_contact(Axisymmetric(), 0.05, 6, degree, gap, down)
    tagged = solids(((6, 3, 3), (6, 3, 3)), order, (turned, turned))
    pairing, holder, contact = condensed(
        tagged,
        degree,
        0.3,
        force=force / 4,
        symmetric=("upper_high_y", "lower_high_y"),
        rollers=("upper_low_y", "lower_low_y"),
    )
    radius = np.hypot(*pairing.points[:, :2].T)
    found, moved = solved(pairing, holder, contact, gap(radius))
    assert 0.2 < (expected > 0).mean() < 0.9
    nearest = np.abs(radius[:, None] - r).argmin(axis=1)
    assert np.abs(found - expected[nearest]).max() < 2e-3 * expected.max()
    assert moved == pytest.approx(motion, rel=2e-4)


@pytest.mark.parametrize("cell_type", CELLS)
@pytest.mark.parametrize("h", [0.0, 1e3, np.inf])
@pytest.mark.parametrize(("divisions", "place"), [(SAME, bent), (OTHER, skewed)])
def test_two_slabs_with_friction_heat(h, divisions, place, cell_type):
    """requirement: temperatures and fluxes of heat that flows straight down, to 1e-9."""
    bodies, faces = gathered(solids(divisions, 1, (place, place), cell_type))
    pairing = pair(*faces, Spatial(), 4)
    spaces = lagrange_spaces(bodies, 2)
    traces = tuple(value_trace(spaces, side) for side in pairing.sides)
    shifts = tuple(np.full(len(pairing.weights), shift) for shift in (1000.0, 300.0))
    materials = {"upper": ThermalMaterial(50.0), "lower": ThermalMaterial(15.0)}
    bath = bath_matrix(spaces, traces, pairing.weights, shifts)
    cold = {"upper_end": 0.0, "lower_end": 0.0}
    conducting = conduction(bodies, Spatial(), spaces, materials, {}, cold, bath)
    basis = pressure_basis(pairing, 1)
    layers = tuple(shift * basis.shape[1] for shift in shifts)
    at_points = pairing.weights, basis, traces, shifts, layers, 0.3
    face = condense_heat(conducting, FaceHeat(*at_points))
    resting = baseline_response(np.zeros(len(conducting.fixed)), traces, bodies.comm)
    made = np.full(len(pairing.weights), 1e5)
    state = face.exchange(np.full(len(made), h)).state(made, resting)
    slab = HEIGHTS, (50.0, 15.0), (0.0, 0.0)
    rises, fluxes = heat.contact_temperatures(*slab, 1e5, 0.3, h)
    for found, exact in zip((*state.rise, *state.flux), (*rises, *fluxes), strict=True):
        np.testing.assert_allclose(found, exact, rtol=1e-9, atol=1e-6)


def test_merged_points_stay_merged():
    """Their number does not depend on the rounding of a face that has moved."""
    _, (first, second) = gathered(solids())
    before = pair(first, second, Spatial(), 3)
    nodes = first.nodes.copy()
    nodes[0] += (1e-9 * first.extent, 0.0, 0.0)
    moved = replace(first, nodes=nodes)
    after = paired(moved, second, Spatial(), before.pieces)
    assert len(after.weights) == len(before.weights)
    apart = paired(moved, second, Spatial(), replace(before.pieces, point=None))
    assert len(apart.weights) > len(before.weights)
    assert after.weights.sum() == pytest.approx(before.weights.sum(), rel=1e-6)
