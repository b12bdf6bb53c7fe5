"""Heat exchange condensed to the nodes of the faces, against one dense system of both bodies."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest

from thermowear.bulk.bodies import distribute
from thermowear.bulk.heat.heat_equation import ThermalMaterial, conduction
from thermowear.bulk.kinematics import Axisymmetric, Spatial
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.face import gather_face
from thermowear.contact.operators.condensation import bath_matrix, condense_heat, value_trace
from thermowear.contact.operators.heat_exchange import (
    FaceHeat,
    ReferenceExchange,
    baseline_response,
)
from thermowear.contact.operators.pressure import dense, pressure_basis
from thermowear.contact.operators.thermal_opening import ThermalDistortion
from thermowear.contact.search.pairing import pair

from ..conftest import two_blocks
from .solids import COMM, two_solids

MATERIALS = {"upper": ThermalMaterial(50.0, 3e6), "lower": ThermalMaterial(15.0, 2e6)}
COOLING = {"upper_end": 300.0, "lower_end": 2000.0}
SHIFTS, STEP = (1000.0, 300.0), 7.0
CASES = ["section", "tetrahedron", "hexahedron"]
CONDUCTANCES = {
    "apart": lambda x: np.zeros(len(x)),
    "finite": lambda x: 2e3 + 1e3 * np.sin(100 * x[:, 0]),
    "large": lambda x: np.full(len(x), 1e7),
    "perfect": lambda x: np.full(len(x), inf),
    "partly": lambda x: np.where(x[:, 0] < np.median(x[:, 0]), inf, 0.0),
    "mixed": lambda x: np.where(x[:, 0] < np.median(x[:, 0]), inf, 500.0),
}


@pytest.fixture(scope="module", params=CASES)
def faces(request):
    """Pairing, conduction and face of nonmatching blocks; a partition that varies."""
    if request.param == "section":
        kinematics, degree, tagged = Axisymmetric(), 3, two_blocks(columns=(3, 4))
    else:
        kinematics, degree = Spatial(), 2
        tagged = two_solids(((2, 2, 1), (3, 1, 1)), cell_type=request.param)
    bodies = distribute(tagged, COMM)
    sides = (gather_face(bodies, f"{name}_face") for name in ("upper", "lower"))
    pairing = pair(*sides, kinematics, degree + 2)
    spaces = lagrange_spaces(bodies, degree)
    traces = tuple(value_trace(spaces, side) for side in pairing.sides)
    shifts = tuple(np.full(len(pairing.weights), shift) for shift in SHIFTS)
    bath = bath_matrix(spaces, traces, pairing.weights, shifts)
    conducting = conduction(bodies, kinematics, spaces, MATERIALS, COOLING, {}, bath)
    basis = pressure_basis(pairing, degree - 1)
    partition = np.linspace(0.2, 0.7, len(pairing.weights))
    layers = tuple(shift * basis.shape[1] for shift in shifts)
    return pairing, conducting, (pairing.weights, basis, traces, shifts, layers, partition)


def array(matrix):
    """Dense copy of a PETSc matrix on one rank."""
    starts, columns, values = matrix.getValuesCSR()
    result = np.zeros(matrix.getSize())
    np.add.at(result, (np.repeat(np.arange(len(starts) - 1), np.diff(starts)), columns), values)
    return result


def friction_heat(pairing):
    return 1e5 * (1.5 + np.cos(70 * pairing.points[:, 0]))


def of_both_bodies(face, matrix, conductance, heat, friction):
    """Nodal rises and crossing heat of both bodies, without bath and without condensation."""
    w, f = face.weights, face.partition
    E1, E2 = (trace.T.toarray() for trace in face.traces)
    direct, passing_fraction, resistance = face.divided(conductance)
    basis = dense(face.basis)
    crossing = passing_fraction[:, None] * basis
    used = crossing.any(axis=0)
    basis, crossing = basis[:, used], crossing[:, used]
    apart = E1 - E2
    coupled = matrix + apart.T @ ((w * direct)[:, None] * apart)
    load = apart.T @ (w[:, None] * crossing)
    resisted = basis.T @ ((w * resistance)[:, None] * basis)
    whole = np.block([[coupled, -load], [-load.T, -resisted]])
    given = heat + E1.T @ (w * f * friction) + E2.T @ (w * (1 - f) * friction)
    nodal = 1 / np.sqrt(np.diag(coupled))
    scale = np.concatenate([nodal, 1 / np.linalg.norm(nodal[:, None] * load, axis=0)])
    right = np.concatenate([given, np.zeros(load.shape[1])])
    found = scale * np.linalg.solve(whole * np.outer(scale, scale), scale * right)
    rise, z = np.split(found, [len(matrix)])
    return rise, (E1 @ rise, E2 @ rise), direct * ((E2 - E1) @ rise) + crossing @ z


@pytest.mark.parametrize("step", [None, STEP])
@pytest.mark.parametrize("kind", CONDUCTANCES)
def test_nodes_equal_both_bodies(faces, kind, step):
    """
    requirement: temperatures, fluxes and the opening by heat as in one system of both bodies, in
    steady state and in a time step, from no to perfect conductance, to 1e-8.
    """
    pairing, conducting, at_points = faces
    if step is not None:
        conducting = conducting.implicit_euler(step)
    face = condense_heat(conducting, FaceHeat(*at_points))
    random = np.random.default_rng(1)
    heat, functional = random.random((2, len(conducting.fixed)))
    made, h = friction_heat(pairing), CONDUCTANCES[kind](pairing.points)
    matrix = array(conducting.conductivity)  # the bath is not part of it
    rise, at_faces, crossing = of_both_bodies(face, matrix, h, heat, made)

    baseline = baseline_response(conducting.respond(heat), face.traces, COMM)
    exchange = face.exchange(h)
    state = exchange.state(made, baseline)
    f = face.partition
    fluxes = f * made + crossing, (1 - f) * made - crossing
    for found, known in zip((*state.rise, *state.flux), (*at_faces, *fluxes), strict=True):
        np.testing.assert_allclose(found, known, rtol=0, atol=1e-8 * np.abs(known).max())

    adjoint = conducting.adjoint_response(functional[:, None])
    per_heat = tuple(adjoint[nodes.rows].T for nodes in face.nodes)
    opening = np.atleast_1d(functional @ conducting.respond(heat))
    distortion = ThermalDistortion(per_heat).coupled(exchange)
    opened = distortion.by_friction(made) + distortion.baseline_gap(
        replace(baseline, opening=opening)
    )
    np.testing.assert_allclose(opened, functional @ rise, rtol=1e-8)


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize(
    ("before", "after"),
    [("finite", "fewer"), ("large", "fewer"), ("perfect", "fewer"), ("partly", "more")],
)
def test_changed_exchange_equals_a_new_one(faces, monkeypatch, before, after, symmetric):
    """
    requirement: after a change of the conductance at some points temperatures and openings are
    those of an exchange made anew, to 1e-9; with one-sided responses as well.
    """
    monkeypatch.setattr("thermowear.contact.operators.heat_exchange._CHANGED", 1.0)
    pairing, conducting, at_points = faces
    face = condense_heat(replace(conducting, symmetric=symmetric), FaceHeat(*at_points))
    x, made = pairing.points[:, 0], friction_heat(pairing)
    closed = CONDUCTANCES[before](pairing.points)
    limit = np.quantile(x, 0.4)
    other = np.where(x > limit, closed, 0.0) if after == "fewer" else np.minimum(closed, 5e3)
    random = np.random.default_rng(2)
    distortion = ThermalDistortion(tuple(random.random((5, n.count)) for n in face.nodes))
    reference = ReferenceExchange(face, closed)
    known = distortion.coupled(reference)
    changed, anew = reference.changed(other), face.exchange(other)
    rises = tuple(random.random((2, len(x))) * 100)
    still = baseline_response(np.zeros(len(conducting.fixed)), face.traces, COMM)
    baseline = replace(still, rise=rises, opening=np.zeros(5))
    one, two = (exchange.state(made, baseline) for exchange in (changed, anew))
    for found, expected in zip((*one.rise, *one.flux), (*two.rise, *two.flux), strict=True):
        scale = np.abs(expected).max()
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * scale)
    updated, renewed = distortion.coupled(changed, known), distortion.coupled(anew)
    for quantity in ("by_friction", "baseline_gap"):
        given = made if quantity == "by_friction" else baseline
        found, expected = (getattr(each, quantity)(given) for each in (updated, renewed))
        np.testing.assert_allclose(found, expected, rtol=1e-8)


def test_heat_in_perfect_contact_of_more_points_is_no_change(faces):
    """requirement: where functions of crossing heat are missing, the exchange is made anew."""
    pairing, conducting, at_points = faces
    face = condense_heat(conducting, FaceHeat(*at_points))
    partly = CONDUCTANCES["partly"](pairing.points)
    assert ReferenceExchange(face, partly).changed(np.full(len(partly), inf)) is None
