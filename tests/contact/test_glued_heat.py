"""Heat through joints of glued bodies whose meshes do not match."""

from math import inf

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.optimize import brentq

from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.heat.advection import Passage
from thermowear.bulk.heat.heat_equation import ThermalMaterial, conduction, surface_heat
from thermowear.bulk.heat.varying import varying_conduction
from thermowear.bulk.kinematics import Axisymmetric, Spatial
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.face import gather_faces
from thermowear.contact.operators.condensation import (
    bath_matrix,
    condense_heat,
    face_traces,
    gap_trace,
    influence,
    pressure_loads,
    value_trace,
)
from thermowear.contact.operators.coupled_heat import CoupledHeat
from thermowear.contact.operators.exchange_matrix import BaselineResponse
from thermowear.contact.operators.heat_exchange import FaceHeat
from thermowear.contact.operators.pressure import joined_bases, pressure_basis
from thermowear.contact.operators.thermal_opening import ThermalOpening, condense_distortion
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.contact.ties import elastic_joints, thermal_joints, transferred
from thermowear.parallel import sum_over_ranks

from ..bulk.fields import empty_matrix, times
from .glued import COMM, PLANE, Box, boxes, glued_conduction, ties_of
from .test_glued import (
    HEIGHTS,
    IN_PLANE,
    IN_SPACE,
    WIDTH,
    largest,
    on_two_ranks,
    pytest_needs_ranks,
    stack,
)

HOT, CONDUCTIVITIES = 100.0, {"upper": (50.0, 3e6), "lower": (2.0, 1e6)}
CONDUCTANCES = [inf, 1e9, 2e3, 1.0]


@pytest.mark.parametrize("conductance", CONDUCTANCES)
@pytest.mark.parametrize("fine", [True, False])
@pytest.mark.parametrize(("cells", "degree"), IN_PLANE + IN_SPACE)
def test_heat_through_the_joint(cells, degree, fine, conductance):
    """requirement: two slabs in series, with or without the resistance of their interface, whose
    temperature jump is q/h, to 1e-10.
    """
    bodies, joined, up = stack(cells, fine, swap=fine)
    given = {f"upper_high_{up}": HOT, f"lower_low_{up}": 0.0}
    known = bodies, degree, joined, [conductance], CONDUCTIVITIES, given
    conducting, (tie,) = glued_conduction(*known)
    rise = conducting.solve(none := np.zeros(conducting.spaces.owned))
    (k1, _), (k2, _) = CONDUCTIVITIES.values()
    flux = HOT / (HEIGHTS[0] / k1 + HEIGHTS[1] / k2 + 1 / conductance)
    z = conducting.spaces.nodes()[:, -1]
    upper = conducting.spaces.nodes_of(bodies, "upper")
    exact = np.where(upper, HOT - flux / k1 * (HEIGHTS[0] - z), flux / k2 * (z + HEIGHTS[1]))
    assert largest(rise - exact) < 1e-10 * HOT
    found = transferred(tie, conducting.multipliers(rise, none), degree)[:, 0]
    sign = 1.0 if tie.sides[0].face.name.startswith("lower") else -1.0
    assert largest(found - sign * flux) < 1e-9 * flux
    first, second = (
        sum_over_ranks(COMM, value_trace(conducting.spaces, side).T @ rise) for side in tie.sides
    )
    assert largest(second - first - found / conductance) < 1e-10 * HOT
    area = WIDTH**2 if up == "z" else WIDTH * PLANE.thickness
    turnover = conducting.exchanged_heat(rise, none)
    assert turnover == pytest.approx(2 * flux * area, rel=1e-9)
    assert abs(sum(conducting.losses(rise, none))) < 1e-9 * turnover


@pytest.mark.parametrize("conductance", CONDUCTANCES)
@pytest.mark.parametrize("kinematics", [PLANE, Axisymmetric()])
def test_temperatures_given_at_the_edge_of_the_joint(kinematics, conductance):
    """requirement: where given temperatures end at the joint, heat through it enters them: all heat
    put in leaves, and both bodies are at the given temperature if all is insulated else.
    """
    upper = Box("upper", ((0.02, 0.06), (0.0, 0.02)), (5, 2))
    lower = Box("lower", ((0.02, 0.06), (-0.03, 0.0)), (2, 3))
    bodies, joined = boxes(upper, lower), [("lower_high_y", "upper_low_y")]
    for given in ({"upper_low_x": HOT, "lower_low_x": HOT}, {"upper_low_x": HOT}):
        known = bodies, 3, joined, [conductance], CONDUCTIVITIES, given
        conducting, _ = glued_conduction(*known, kinematics=kinematics)
        none = np.zeros(conducting.spaces.owned)
        assert largest(conducting.solve(none) - HOT) < 1e-9 * HOT
    given = {"upper_low_x": HOT, "lower_low_x": -HOT, "lower_high_x": 0.0}
    known = bodies, 3, joined, [conductance], CONDUCTIVITIES, given, {"upper_high_x": 500.0}
    conducting, _ = glued_conduction(*known, kinematics=kinematics)
    heat = surface_heat(bodies, kinematics, conducting.spaces, "upper_high_y", 3e4)
    rise = conducting.solve(heat)
    put_in = sum_over_ranks(COMM, heat.sum())
    turnover = conducting.exchanged_heat(rise, heat)
    assert abs(sum(conducting.losses(rise, heat)) - put_in) < 1e-10 * turnover


@pytest.mark.parametrize("conductance", CONDUCTANCES)
def test_heat_stored_in_time(conductance):
    """requirement: in insulated glued bodies the stored heat is the heat put in, in each step, and
    in the end both have the temperature of the whole.
    """
    bodies, joined, _ = stack("quadrilateral", True)
    known = bodies, 3, joined, [conductance], CONDUCTIVITIES, {}
    conducting, _ = glued_conduction(*known)
    spaces, step, power = conducting.spaces, 2.0, 40.0
    heat = surface_heat(bodies, PLANE, spaces, "upper_high_y", power / (WIDTH * PLANE.thickness))
    rise, stepping = np.zeros(spaces.owned), conducting.implicit_euler(step)
    for _ in range(3):
        before, rise = rise, stepping.solve(heat + stepping.stored_heat(rise) / step)
        gained = sum_over_ranks(COMM, conducting.stored_heat(rise - before).sum())
        assert gained == pytest.approx(power * step, rel=1e-10)
    assert largest(rise) > 1.1 * abs(float(rise.mean()))
    long = conducting.implicit_euler(1e9)
    rise = long.solve(long.stored_heat(rise) / 1e9)
    sizes = zip(CONDUCTIVITIES.values(), HEIGHTS, strict=True)
    capacity = sum(c * h for (_, c), h in sizes) * WIDTH * PLANE.thickness
    assert largest(rise - 3 * power * step / capacity) < 1e-4 * largest(rise)


def test_an_insulating_joint():
    """requirement: without conductance no heat passes; the bodies are still solved together."""
    bodies, joined, _ = stack("triangle", True)
    known = bodies, 2, joined, [0.0], CONDUCTIVITIES, {"upper_high_y": HOT, "lower_low_y": 0.0}
    conducting, (tie,) = glued_conduction(*known)
    rise = conducting.solve(none := np.zeros(conducting.spaces.owned))
    upper = conducting.spaces.nodes_of(bodies, "upper")
    assert largest(rise - HOT * upper) < 1e-10 * HOT
    assert not transferred(tie, conducting.multipliers(rise, none), 2).any()
    assert conducting.spaces.groups == ((0, 1),)


def strip_on_block(spread, layers=True):
    """Strip of two glued layers, or of one mesh, that moves along a block at rest."""
    each = [Box("block", ((0.0, 0.04), (-0.02, 0.0)), (4, 3))]
    each += [Box("high", ((0.0, 0.04), (0.01, 0.03)), (4, 4))] * layers
    each += [Box("low", ((0.0, 0.04), (0.0, 0.01 if layers else 0.03)), (4, 2 if layers else 6))]
    bodies, top = boxes(*each), "high" if layers else "low"
    joined = [("block_high_y", "low_low_y"), *[("low_high_y", "high_low_y")] * layers]
    passage = Passage(("low", "high")[: 1 + layers], None, 0.02, spread)
    ties, spaces = ties_of(bodies, 3, joined), lagrange_spaces(bodies, 3)
    joints = thermal_joints(spaces, ties, [3e3, inf][: 1 + layers])
    materials = dict.fromkeys(bodies.names, ThermalMaterial(40.0, 3e6))
    known = bodies, PLANE, spaces, materials, {f"{top}_high_y": 5e3}, {"block_low_y": 0.0}
    return bodies, conduction(*known, empty_matrix(spaces), passage, joints=joints)


@pytest.mark.parametrize("spread", [False, True])
def test_heat_carried_along(spread):
    """requirement: the heat balance of glued bodies that move past one at rest, and as much heat
    carried along and cooled as in one moving body.
    """
    bodies, conducting = strip_on_block(spread)
    spaces = conducting.spaces
    heat = surface_heat(bodies, PLANE, spaces, "block_high_x", 1e5)
    rise = conducting.solve(heat)
    lost = sum(conducting.losses(rise, heat))
    assert lost == pytest.approx(sum_over_ranks(COMM, heat.sum()), rel=1e-9)
    weights = np.random.default_rng(2).random(spaces.owned)
    adjoint = sum_over_ranks(COMM, conducting.adjoint_response(weights) @ heat)
    assert adjoint == pytest.approx(
        sum_over_ranks(COMM, weights @ conducting.respond(heat)), rel=1e-9
    )
    whole, one = strip_on_block(spread, layers=False)
    heat_of_one = surface_heat(whole, PLANE, one.spaces, "block_high_x", 1e5)
    expected = one.losses(one.solve(heat_of_one), heat_of_one)
    assert conducting.losses(rise, heat) == pytest.approx(expected, rel=2e-3)
    if spread:  # both layers share the paths of the joint
        nodes = spaces.nodes()
        at = np.abs(nodes[:, 1] - 0.01) < 1e-9
        assert np.ptp(rise[at]) < 1e-9 * largest(rise)


def pad_on_disk(cells="quadrilateral"):
    """Elasticity and conduction of a pad glued on its back, which touches a disk."""
    dim = 3 if cells == "tetrahedron" else 2
    depth = ((0.0, 0.02),) * (dim - 2)
    count = (1,) * (dim - 2)
    pad = Box("pad", ((0.01, 0.03), *depth, (0.0, 0.01)), (3, *count, 2))
    disk = Box("disk", ((0.0, 0.04), *depth, (-0.02, 0.0)), (4, *count, 2))
    back = Box("back", ((0.01, 0.03), *depth, (0.01, 0.015)), (2, *count, 1))
    bodies, up = boxes(pad, disk, back, cells=cells), "xyz"[dim - 1]
    kinematics, degree = PLANE if dim == 2 else Spatial(), 2
    ties = ties_of(bodies, degree, [(f"back_low_{up}", f"pad_high_{up}")])
    elastic = elasticity(
        bodies,
        kinematics,
        degree,
        dict.fromkeys(bodies.names, ElasticMaterial(2e11, 0.3, 1.2e-5)),
        [f"back_high_{up}", f"disk_low_{up}"],
        joints=lambda spaces: elastic_joints(spaces, ties),
    )
    faces = gather_faces(bodies, (f"pad_low_{up}", f"disk_high_{up}"))
    pairing = pair(*faces, kinematics, degree + 2)
    spaces = lagrange_spaces(bodies, degree)
    traces = tuple(value_trace(spaces, side) for side in pairing.sides)
    shifts = tuple(np.full(len(pairing.weights), shift) for shift in (1000.0, 300.0))
    conducting = conduction(
        bodies,
        kinematics,
        spaces,
        dict.fromkeys(bodies.names, ThermalMaterial(50.0, 3e6)),
        {f"back_high_{up}": 300.0, f"disk_low_{up}": 2000.0},
        {},
        bath_matrix(spaces, traces, pairing.weights, shifts),
        joints=thermal_joints(spaces, ties, [4e3]),
    )
    return elastic, pairing, conducting, (traces, shifts)


def layers_of(shifts, basis):
    """Conductances of layers as thick as the support of a function."""
    return tuple(shift * basis.shape[1] for shift in shifts)


@pytest.mark.parametrize("cells", ["quadrilateral", "tetrahedron"])
@pytest.mark.parametrize("stored", [True, False])
def test_condensed_heat(cells, stored):
    """requirement: temperatures of the faces, and the gap that heat opens, condensed from glued
    bodies, are those of the bodies themselves.
    """
    elastic, pairing, conducting, (traces, shifts) = pad_on_disk(cells)
    basis = pressure_basis(pairing, 1)
    face = FaceHeat(pairing.weights, basis, traces, shifts, layers_of(shifts, basis), 0.5)
    condensed = condense_heat(conducting, face)
    random = np.random.default_rng(3)
    loads = [random.random(Φ.shape[1]) for Φ in condensed.response]
    nodal = condensed.on_nodes(np.concatenate(loads))
    rise = conducting.respond(nodal)
    each = zip(condensed.response, loads, strict=True)
    risen = np.concatenate([Φ @ load for Φ, load in each])
    for trace, values in zip(traces, condensed.values, strict=True):
        at_points = sum_over_ranks(COMM, trace.T @ rise)
        np.testing.assert_allclose(values @ risen, at_points, rtol=1e-9)
    G, trace = (
        elastic.thermal_load(conducting.spaces),
        gap_trace(elastic.spaces, Contacts((pairing,))),
    )
    found = influence(elastic, pairing.weights, trace, basis, [G] if stored else ())
    opening = ThermalOpening(elastic, pressure_loads(trace, found.weighted), [G], found.per_rise)
    distortion = condense_distortion(conducting, opening, condensed.nodes)
    per_heat = sum(one @ load for one, load in zip(distortion.per_heat, loads, strict=True))
    direct = sp.csr_matrix(found.weighted).T @ sum_over_ranks(
        COMM, trace.T @ elastic.solve(G.multiply(rise))
    )
    np.testing.assert_allclose(per_heat, direct, rtol=1e-8, atol=1e-9 * np.abs(direct).max())
    np.testing.assert_allclose(opening.of([rise]), direct, rtol=1e-8)


@pytest.mark.parametrize("conductance", [0.0, 3e3, inf])
def test_exchange_without_condensation(conductance):
    """requirement: heat exchanged with a glued body is the same, condensed or not."""
    _, pairing, conducting, (traces, shifts) = pad_on_disk()
    basis = pressure_basis(pairing, 1)
    at_points = pairing.weights, basis, traces, shifts, layers_of(shifts, basis), 0.3
    condensed = condense_heat(conducting, FaceHeat(*at_points))
    friction = 1e5 * (1.5 + np.cos(70 * pairing.points[:, 0]))
    none, h = np.zeros(len(friction)), np.full(len(friction), conductance)
    rises = [
        face.exchange(h).state(friction, BaselineResponse((none, none))).rise
        for face in (condensed, CoupledHeat(*at_points, conducting))
    ]
    np.testing.assert_allclose(rises[0], rises[1], rtol=1e-7)


@pytest.mark.parametrize("conductance", [inf, 2e3])
def test_conductivity_that_varies(conductance):
    """requirement: slabs in series by Kirchhoff's integral, and the heat balance."""
    bodies, joined, _ = stack("quadrilateral", True)
    given = {"upper_high_y": HOT, "lower_low_y": 0.0}
    known = bodies, 3, joined, [conductance], CONDUCTIVITIES, given
    linear, _ = glued_conduction(*known)
    materials = {name: ThermalMaterial(*values) for name, values in CONDUCTIVITIES.items()}
    known = bodies, PLANE, materials, {"lower": Rising()}, 0.0
    conducting = varying_conduction(linear, *known)
    rise = none = np.zeros(conducting.spaces.owned)
    for _ in range(12):
        rise = conducting.tangent(rise).solve(conducting.linearisation_error(rise, rise))
    (k1, _), (k2, _) = CONDUCTIVITIES.values()

    def excess(flux):
        at_joint = HOT - flux * (HEIGHTS[0] / k1 + 1 / conductance)
        return k2 * Rising().integral(0.0, at_joint) / HEIGHTS[1] - flux

    flux = brentq(excess, 0.0, HOT / (HEIGHTS[0] / k1), xtol=1e-10)
    z = conducting.spaces.nodes()[:, 1]
    upper = conducting.spaces.nodes_of(bodies, "upper")
    exact = HOT - flux / k1 * (HEIGHTS[0] - z)
    assert largest((rise - exact)[upper]) < 1e-9 * HOT
    turnover = conducting.exchanged_heat(rise, none)
    assert turnover == pytest.approx(2 * flux * WIDTH * PLANE.thickness, rel=1e-8)
    assert abs(sum(conducting.losses(rise, none))) < 1e-8 * turnover


class Rising:
    """Property that grows linearly with temperature."""

    def value(self, x):
        return 1 + x / HOT

    def slope(self, x):
        return np.full_like(x, 1 / HOT)

    def integral(self, start, x):
        return x - start + (x**2 - start**2) / (2 * HOT)


@pytest.mark.parametrize("conductance", [inf, 2e3])
def test_heat_conducted_in_bodies_and_joints(conductance):
    """requirement: heat times temperature is conducted, by the bodies and through the joint."""
    bodies, joined, _ = stack("quadrilateral", True)
    cooling = {"lower_low_y": 400.0}
    known = bodies, 3, joined, [conductance], CONDUCTIVITIES, {}, cooling
    conducting, _ = glued_conduction(*known)
    spaces = conducting.spaces
    heat = surface_heat(bodies, PLANE, spaces, "upper_high_y", 1e4)
    rise = conducting.respond(heat)
    passed = conducting.joints.passed(spaces, rise[:, None])[0, 0]
    whole = sum_over_ranks(COMM, rise @ (times(conducting.conductivity, rise)))
    flux, area = 1e4, WIDTH * PLANE.thickness
    assert passed == pytest.approx(flux**2 * area / conductance, rel=1e-9)
    assert whole + passed == pytest.approx(sum_over_ranks(COMM, rise @ heat), rel=1e-10)


def numbers():
    """Temperatures at points and balances on any number of ranks."""
    bodies, conducting = strip_on_block(True)
    heat = surface_heat(bodies, PLANE, conducting.spaces, "block_high_x", 1e5)
    rise = conducting.solve(heat)
    bodies, joined, _ = stack("tetrahedron", True)
    given = {"upper_high_x": HOT, "lower_low_x": -HOT}
    glued, _ = glued_conduction(bodies, 2, joined, [inf], CONDUCTIVITIES, given)
    none = np.zeros(glued.spaces.owned)
    other = glued.solve(none)
    _, pairing, pad, (traces, _) = pad_on_disk()
    flow = pad.respond(traces[0] @ pairing.weights)
    at_points = sum_over_ranks(COMM, traces[0].T @ flow)
    return [
        *conducting.losses(rise, heat),
        sum_over_ranks(COMM, (rise**2).sum()),
        *glued.losses(other, none),
        *glued.multipliers(other, none),
        sum_over_ranks(COMM, (other**2).sum()),
        *at_points,
    ]


@pytest.mark.slow
@pytest_needs_ranks
def test_two_ranks_give_the_serial_numbers():
    """requirement: temperatures and balances on two ranks as on one, to 1e-8."""
    assert on_two_ranks("test_glued_heat") == pytest.approx(numbers(), rel=1e-8, abs=1e-7)


def test_faces_on_both_sides_of_glued_layers():
    """requirement: heat into one face of glued layers is felt at the other one, condensed too."""
    heights = {"low": (-0.02, 0.0), "one": (0.0, 0.01), "two": (0.01, 0.03), "high": (0.03, 0.05)}
    counts = {"low": 3, "one": 2, "two": 4, "high": 3}
    each = [Box(name, ((0.0, 0.04), span), (counts[name], 2)) for name, span in heights.items()]
    bodies = boxes(*each)
    (tie,) = ties_of(bodies, 2, [("one_high_y", "two_low_y")])
    faces = [("one_low_y", "low_high_y"), ("high_low_y", "two_high_y")]
    pairings = tuple(pair(*gather_faces(bodies, names), PLANE, 4) for names in faces)
    contacts, spaces = Contacts(pairings, ((1, 0), (3, 2))), lagrange_spaces(bodies, 2)
    traces, w = face_traces(spaces, contacts), contacts.weights
    shifts = (np.full(len(w), 1000.0), np.full(len(w), 300.0))
    conducting = conduction(
        bodies,
        PLANE,
        spaces,
        dict.fromkeys(bodies.names, ThermalMaterial(5.0, 3e6)),
        {"low_low_y": 200.0, "high_high_y": 300.0},
        {},
        bath_matrix(spaces, traces, w, shifts),
        joints=thermal_joints(spaces, [tie], [4e3]),
    )
    assert len(conducting.spaces.groups) == 3
    basis = joined_bases([pressure_basis(pairing, 1) for pairing in pairings])
    at_points = w, basis, traces, shifts, shifts, 0.5
    friction = 1e5 * (1.5 + np.cos(70 * contacts.points[:, 0]))
    none, h = np.zeros(len(w)), np.full(len(w), 500.0)
    condensed = condense_heat(conducting, FaceHeat(*at_points))
    assert len(condensed.response) == 3
    first, second = (
        face.exchange(h).state(friction, BaselineResponse((none, none))).rise
        for face in (condensed, CoupledHeat(*at_points, conducting))
    )
    np.testing.assert_allclose(first, second, rtol=1e-8)
