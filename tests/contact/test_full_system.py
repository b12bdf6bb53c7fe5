"""Penalty and Nitsche's method on the full system."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace

from mpi4py import MPI

import numpy as np
import pytest

from thermowear import ComputationError
from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import kinematics_of
from thermowear.bulk.spaces import lagrange_spaces
from thermowear.contact.faces.face import gather_face
from thermowear.contact.full.edge_deflection import edge_deflection, wave_compliance
from thermowear.contact.full.full_system import FullContact, Loading, step_length
from thermowear.contact.full.nitsche import (
    default_penalty,
    nitsche_stiffness,
    normal_traction,
    thermal_traction,
)
from thermowear.contact.operators.condensation import gap_trace, value_trace, vector_trace
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.contact.solvers.signorini import solve_contact
from thermowear.parallel import sum_over_ranks

from ..conftest import two_blocks

COMM = MPI.COMM_WORLD
SIDES = tuple(f"{b}_{s}" for b in ("upper", "lower") for s in ("inside", "outside"))
METHODS = ["penalty", 1, 0, -1]
"""The penalty method, and θ of Nitsche's."""


def build(
    degree,
    columns,
    rows=(2, 2),
    name="plane-strain",
    poisson_ratio=0.3,
    rollers=(),
    growth=(1.0, 1.0),
):
    """Two blocks and everything that the methods need."""
    tagged = two_blocks(columns=columns, rows=rows, growth=growth) if COMM.rank == 0 else None
    bodies = distribute(tagged, COMM)
    model = kinematics_of(name, 0.01)
    materials = {
        "upper": ElasticMaterial(2e11, poisson_ratio, 1.2e-5),
        "lower": ElasticMaterial(7e10, poisson_ratio, 2e-5),
    }
    ends = ["upper_end", "lower_end"]
    elastic = elasticity(bodies, model, degree, materials, ends, rollers)
    faces = gather_face(bodies, "upper_face"), gather_face(bodies, "lower_face")
    pairing = pair(*faces, model, degree + 2)
    return SimpleNamespace(
        elastic=elastic,
        pairing=pairing,
        trace=gap_trace(elastic.spaces, Contacts((pairing,))),
        stress=normal_traction(elastic, pairing),
        modes=(pairing.normals @ [0.0, -1.0])[:, None],
        bump=(pairing.points[:, 0] - 0.07) ** 2 / 4.0,
        weights=pairing.weights,
    )


def method(case, kind, factor=1.0, friction=0.0, modes=None):
    """One of the methods with its default stiffness, times a factor."""
    elastic, pairing = case.elastic, case.pairing
    modes = case.modes if modes is None else modes
    traction, force_modes = case.trace, modes
    if friction:
        traction_direction = pairing.normals + friction * np.array([1.0, 0.0])
        traction = vector_trace(elastic.spaces, Contacts((pairing,)), traction_direction)
    operators = elastic, pairing, case.trace, traction, modes, force_modes
    if kind == "penalty":
        return FullContact(*operators, factor * default_penalty(elastic, pairing))
    stiffness = factor * nitsche_stiffness(elastic, pairing)
    return FullContact(*operators, stiffness, case.stress, kind)


def condensed(case, degree, gap, load, friction_trace=None):
    """Pressure and motion of the condensed bodies, with the pressure space of `degree`."""
    basis = pressure_basis(case.pairing, degree)
    weighted = case.weights[:, None] * basis
    traction = case.trace if friction_trace is None else friction_trace
    response = case.elastic.solve(traction @ weighted)
    compliance = weighted.T @ sum_over_ranks(COMM, case.trace.T @ response)
    solution = solve_contact(compliance, weighted.T @ gap, weighted.T @ case.modes, load)
    return basis @ solution.coefficients, solution.motion[0]


@pytest.mark.parametrize("kind", METHODS)
@pytest.mark.parametrize("columns", [(3, 3), (3, 4)])
@pytest.mark.parametrize("degree", [1, 2, 5])
@pytest.mark.parametrize(("name", "rollers"), [("axisymmetric", ()), ("plane-strain", SIDES)])
def test_uniform_pressure(name, rollers, degree, columns, kind):
    """requirement: contact patch test. A uniform pressure is found exactly by Nitsche's method,
    whether faces match or not, and by a uniform penalty with the approach it adds.
    """
    ν = 0.3 if rollers else 0.0
    case = build(degree, columns, name=name, poisson_ratio=ν, rollers=rollers)
    contact = method(case, kind)
    solution = contact.solve(case.pairing.gap, np.array([1e8 * case.weights.sum()]))
    np.testing.assert_allclose(solution.pressure, 1e8, rtol=1e-10)
    modulus = (1 - ν) / ((1 + ν) * (1 - 2 * ν))
    approach = 1e8 * (0.02 / 2e11 + 0.03 / 7e10) / modulus
    if kind == "penalty":
        approach += 1e8 / contact.stiffness[0]
    assert solution.motion[0] == pytest.approx(approach, rel=1e-9, abs=0.0)


@pytest.fixture(scope="module")
def hertz():
    """A cylinder on a block, finely meshed where it touches."""
    return build(4, (26, 26), (4, 4))


@pytest.mark.parametrize("kind", METHODS)
def test_cylinder_against_the_condensed_solution(hertz, kind):
    """requirement: the methods agree with the condensed solution to 1e-3 of the peak away
    from the edges, from a cold start in at most 10 iterations.
    """
    case, load = hertz, np.array([3e4])
    expected, motion = condensed(case, 3, case.bump, load)
    solution = method(case, kind).solve(case.bump, load)
    assert solution.iterations <= 10
    assert case.weights @ solution.pressure == pytest.approx(3e4, rel=1e-9)
    basis = pressure_basis(case.pairing, 3)
    error = (case.weights * (solution.pressure - expected)) @ basis / (case.weights @ basis)
    distance = np.abs(case.pairing.points[:, 0] - 0.07)
    inside = distance @ (case.weights[:, None] * basis) / (case.weights @ basis) < 0.006
    assert distance[expected > 0].max() > 0.01
    assert np.abs(error[inside]).max() < 1e-3 * expected.max()
    assert solution.motion[0] == pytest.approx(motion, rel=1e-3)
    np.testing.assert_array_equal(solution.active, solution.pressure > 0)


def test_penetration_falls_as_the_penalty_grows(hertz):
    """requirement: the penalty method's error is proportional to 1/γ, and p = γ penetration."""
    case, load = hertz, np.array([3e4])
    limit = method(case, "penalty", 1e3).solve(case.bump, load).motion[0]
    factors = np.array([1.0, 4.0, 16.0])
    excess = []
    for factor in factors:
        contact = method(case, "penalty", factor)
        solution = contact.solve(case.bump, load)
        excess.append(solution.motion[0] - limit)
        shut = sum_over_ranks(COMM, case.trace.T @ solution.displacement)
        penetration = case.modes @ solution.motion - case.bump - shut
        np.testing.assert_allclose(
            solution.pressure, contact.stiffness * np.maximum(penetration, 0), atol=1e2
        )
    assert np.polyfit(np.log(factors), np.log(excess), 1)[0] == pytest.approx(-1.0, abs=0.1)


@pytest.mark.parametrize("kind", METHODS)
@pytest.mark.parametrize("degree", [1, 2, 4, pytest.param(7, marks=pytest.mark.slow)])
def test_few_iterations_whatever_the_gap(degree, kind):
    """requirement: a cold start from any distance; rough faces that do not match; small loads."""
    case = build(degree, (36 // degree, 30 // degree), name="axisymmetric")
    contact = method(case, kind)
    r = case.pairing.points[:, 0]
    rough = 1e-5 * np.sin(600 * r) + 2e-6 * np.sin(1777 * r)
    for gap in (case.bump, rough, case.bump + 0.5):
        for load in (1e2, 1e4, 1e6):
            solution = contact.solve(gap, np.array([load]))
            assert solution.iterations <= 10
            assert case.weights @ solution.pressure == pytest.approx(load, rel=1e-9)


@pytest.mark.parametrize("kind", METHODS)
def test_given_approach(kind):
    """requirement: without a free motion, a closed gap gives the pressure of the same approach."""
    case = build(3, (12, 10))
    loaded = method(case, kind).solve(case.bump, np.array([1e4]))
    contact = method(case, kind, modes=np.zeros((len(case.bump), 0)))
    gap = case.bump - case.modes @ loaded.motion
    solution = contact.solve(gap, np.zeros(0))
    np.testing.assert_allclose(solution.pressure, loaded.pressure, atol=1e-8 * 1e8)
    assert solution.iterations <= 8
    apart = contact.solve(case.bump + 1e-3, np.zeros(0))
    assert not apart.active.any()
    assert np.abs(apart.displacement).max() == 0.0


@pytest.mark.parametrize("kind", METHODS)
def test_friction_in_the_section(kind):
    """requirement: a sliding contact is the condensed one, unsymmetric; friction shifts it."""
    case = build(3, (14, 14), (3, 3))
    traction_direction = case.pairing.normals + 0.4 * np.array([1.0, 0.0])
    trace = vector_trace(case.elastic.spaces, Contacts((case.pairing,)), traction_direction)
    closed = np.zeros(len(case.bump))
    expected, motion = condensed(case, 2, closed, np.array([1e5]), trace)
    solution = method(case, kind, 10.0, friction=0.4).solve(closed, np.array([1e5]))
    x = case.pairing.points[:, 0]
    inside = np.abs(x - 0.07) < 0.012
    np.testing.assert_allclose(solution.pressure[inside], expected[inside], rtol=2e-2)
    assert solution.motion[0] == pytest.approx(motion, rel=1e-3)
    moment = case.weights @ (solution.pressure * (x - 0.07)) / 1e5
    assert moment == pytest.approx(case.weights @ (expected * (x - 0.07)) / 1e5, rel=1e-2)
    assert abs(moment) > 1e-4


@pytest.mark.parametrize("kind", METHODS)
def test_holder_that_tilts(kind):
    """requirement: several free motions; a moment is carried up to the edges and not beyond."""
    case = build(2, (15, 18), (4, 4))
    arm = case.pairing.points[:, 0] - 0.07
    modes = case.modes * np.column_stack([np.ones(len(arm)), arm])
    contact = method(case, kind, modes=modes)
    for lever in (0.0, 0.01, 0.019):
        solution = contact.solve(case.bump + 0.1, np.array([3e4, 3e4 * lever]))
        assert solution.iterations <= 10
        assert case.weights @ solution.pressure == pytest.approx(3e4, rel=1e-9)
        moment = case.weights @ (solution.pressure * arm)
        assert moment == pytest.approx(3e4 * lever, abs=1e-9 * 3e4)
    with pytest.raises(ComputationError, match="cannot be carried"):
        contact.solve(case.bump, np.array([3e4, 3e4 * 0.021]))


@pytest.mark.parametrize("kind", METHODS)
def test_wear_on_the_spot_is_a_compliance(kind):
    """requirement: c p opens the gap; with it, the gap left is that of a worn face."""
    case = build(2, (12, 12), (3, 3))
    contact, load = method(case, kind), np.array([3e4])
    soft = np.full(len(case.bump), 2e-15)
    worn = contact.solve(case.bump, load, compliance=soft)
    again = contact.solve(case.bump + soft * worn.pressure, load, start=worn)
    np.testing.assert_allclose(again.pressure, worn.pressure, atol=1e-8 * worn.pressure.max())
    assert again.iterations <= 1
    assert worn.pressure.max() < contact.solve(case.bump, load).pressure.max()


@pytest.mark.parametrize("kind", METHODS)
def test_a_small_residual_alone_does_not_end_the_iteration(kind):
    """requirement: a start whose residual is accepted, but whose pressures are off by more."""
    case = build(2, (12, 12), (3, 3))
    contact, load = method(case, kind), np.array([3e4])
    exact = contact.solve(case.bump, load)
    loading = Loading(
        case.bump, load, 0 * case.bump, 0 * exact.displacement, thermal_traction=0 * case.bump
    )
    noise = np.random.default_rng(1).standard_normal(len(exact.displacement))
    noise *= 1e-12 * np.abs(exact.displacement).max()
    noise[case.elastic.fixed] = 0.0
    off = contact.residual(loading, exact.displacement + noise, exact.motion).relative
    near = replace(exact, displacement=exact.displacement + 5e-11 / off * noise)
    start = contact.residual(loading, near.displacement, exact.motion)
    assert start.relative < 1e-10
    peak = exact.pressure.max()
    assert np.abs(np.maximum(start.pressure, 0.0) - exact.pressure).max() > 1e-11 * peak
    found = contact.solve(case.bump, load, start=near)
    np.testing.assert_allclose(found.pressure, exact.pressure, rtol=0, atol=2e-12 * peak)
    assert found.iterations <= 1


@pytest.mark.parametrize("kind", METHODS)
def test_hot_bodies(kind):
    """requirement: thermal stress belongs to the traction. Clamped all round and heated uniformly,
    the faces of rods that just touch press with E α ΔT/(1 - 2ν).
    """
    case = build(2, (3, 4), rollers=SIDES)
    spaces = lagrange_spaces(case.elastic.bodies, 2)
    rise = np.full(spaces.owned, 50.0)
    forces = case.elastic.thermal_load(spaces).multiply(rise)
    at_face = value_trace(spaces, case.pairing.sides[0]).T @ rise
    heat = thermal_traction(case.elastic, case.pairing) * sum_over_ranks(COMM, at_face)
    contact = method(case, kind, modes=np.zeros((len(heat), 0)))
    solution = contact.solve(0 * heat, np.zeros(0), nodal_loads=-forces, thermal_traction=-heat)
    assert not solution.active.any()  # cooled, they part
    solution = contact.solve(0 * heat, np.zeros(0), nodal_loads=forces, thermal_traction=-heat)
    modulus = 0.7 / (1.3 * 0.4)
    free = 50 * (1.3 / 0.7) * (1.2e-5 * 0.02 + 2e-5 * 0.03)
    softness = (0.02 / 2e11 + 0.03 / 7e10) / modulus
    if kind == "penalty":
        softness += 1 / contact.stiffness[0]
    np.testing.assert_allclose(solution.pressure, free / softness, rtol=1e-9)


@pytest.mark.parametrize("kind", METHODS)
@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("yields", [False, True])
def test_newton_step(kind, friction, yields):
    """requirement: the residual is linear between changes of contact; Newton steps reduce it so."""
    case = build(2, (5, 4))
    contact = method(case, kind, friction=friction)
    loading, u, d, *_ = states(case, contact, yields)
    at = contact.residual(loading, u, d)
    assert 0 < at.active.sum() < len(at.active)
    δu, δd = contact.newton_step(loading, at, at.active)
    near = contact.residual(loading, u + 1e-3 * δu, d + 1e-3 * δd)
    np.testing.assert_array_equal(near.active, at.active)
    scale = np.abs(at.forces).max()
    np.testing.assert_allclose((at.forces - near.forces) / 1e-3, at.forces, atol=1e-8 * scale)
    np.testing.assert_allclose((at.balance - near.balance) / 1e-3, at.balance, rtol=1e-7)


@pytest.mark.parametrize("kind", ["penalty", 1])
@pytest.mark.parametrize("yields", [False, True])
def test_residual_is_the_gradient_of_the_energy(kind, yields):
    """requirement: Taylor's remainder of the energy has slope 2, across changes of contact too."""
    case = build(2, (5, 4))
    contact = method(case, kind)
    loading, u, d, δu, δd = states(case, contact, yields)

    def energy(u, d):
        at = contact.residual(loading, u, d)
        pressure = np.maximum(at.pressure, 0.0)
        traction = sum_over_ranks(COMM, case.stress.T @ u) + loading.thermal_traction
        share = case.weights / contact.stiffness
        soft = 1 + contact.stiffness * loading.compliance
        elastic = 0.5 * COMM.allreduce(u @ contact.elastic_forces(u)) - d[0] * loading.load[0]
        if yields:
            elastic += 0.5 * d[1:] @ loading.deflection.stiffness @ d[1:]
        if kind == 1:
            elastic -= 0.5 * share @ traction**2
        return (
            elastic - COMM.allreduce(u @ loading.nodal_loads) + 0.5 * (share * soft) @ pressure**2
        )

    at = contact.residual(loading, u, d)
    work = COMM.allreduce(at.forces @ δu) + at.balance @ δd
    steps = 0.5 ** np.arange(6)
    remainder = [abs(energy(u + a * δu, d + a * δd) - energy(u, d) - a * work) for a in steps]
    assert np.polyfit(np.log(steps), np.log(remainder), 1)[0] > 1.9
    *line, pressure, change = contact.along(loading, at, δu, δd)
    for a in steps:
        there = contact.residual(loading, u + a * δu, d + a * δd)
        expected = COMM.allreduce(there.forces @ δu) + there.balance @ δd
        constant, slope, factors = line
        found = constant + slope * a + factors @ np.maximum(pressure + a * change, 0.0)
        assert found == pytest.approx(expected, rel=1e-9)


def states(case, contact, yields=False):
    """A loading, a state that is partly closed, and a direction."""
    n = len(case.bump)
    rng = np.random.default_rng(COMM.rank)
    free = ~case.elastic.fixed
    loads = 10.0 * rng.normal(size=len(free)) * free
    loading = Loading(
        case.bump, np.array([1e4]), np.full(n, 1e-15), loads, np.full(n, -1e6 * contact.nitsche)
    )
    u, δu = (1e-8 * rng.normal(size=len(free)) * free for _ in range(2))
    d, δd = np.array([4e-5]), np.array([3e-7])
    if yields:
        loading = replace(loading, deflection=edge_of(case, np.abs(case.bump) < 1e-4))
        own = np.random.default_rng(5).normal(size=(2, loading.deflection.modes.shape[1]))
        unit = 1e-8 / np.abs(loading.deflection.modes).max()
        d, δd = np.append(d, unit * own[0]), np.append(δd, unit * own[1])
    return loading, u, d, δu, δd


def edge_of(case, points):
    """Own deflection of some points, with pressures of degree 1."""
    compliance = wave_compliance(case.elastic, case.pairing, 1)
    return edge_deflection(pressure_basis(case.pairing, 1), case.weights, points, compliance)


@pytest.mark.parametrize("kind", METHODS)
def test_points_at_the_edge_of_wear_yield_to_what_is_rough(kind):
    """requirement: they open by ε (p - Π p), which has no part in the pressure space; F carried."""
    case = build(2, (5, 4))
    points = case.pairing.points[:, 0] > 0.07
    own, n = edge_of(case, points), len(points)
    nothing, load = np.zeros(len(case.elastic.fixed)), np.array([1e4])
    solution = method(case, kind).solve(case.bump, load, deflection=own)
    p, basis = solution.pressure, pressure_basis(case.pairing, 1)
    weighted = (case.weights * points)[:, None] * basis
    smooth = basis @ np.linalg.lstsq(weighted.T @ basis, weighted.T @ p, rcond=None)[0]
    rough = np.where(points, wave_compliance(case.elastic, case.pairing, 1) * (p - smooth), 0.0)
    assert (
        np.abs(rough).max() > 1e-2 * wave_compliance(case.elastic, case.pairing, 1).max() * p.max()
    )
    # the same contact with gaps that are open by so much
    known = method(case, kind).solve(case.bump + rough, load, np.zeros(n), nothing)
    np.testing.assert_allclose(p, known.pressure, atol=1e-6 * p.max())
    assert case.weights @ p == pytest.approx(1e4, rel=1e-9)


def test_half_spaces_yield_to_short_waves_by_their_length():
    """requirement: 2 h/(π E* q), Johnson section 13.2, with both bodies and the facets of one.

    Between two facets h is the mean of both.
    """
    softness = (1 - 0.3**2) * (1 / 2e11 + 1 / 7e10)
    for degree, growth in ((1, 1.0), (3, 1.0), (1, 1.5)):
        case = build(2, (5, 4), growth=(growth, 1.0))
        found = wave_compliance(case.elastic, case.pairing, degree)
        lengths = found * np.pi * degree / (2 * softness)
        side = case.pairing.sides[0]
        inside = (side.t > 1e-9) & (side.t < 1 - 1e-9)
        sizes = side.face.sizes
        np.testing.assert_allclose(lengths[inside], sizes[side.facet[inside]], rtol=1e-12)
        between, pairs = lengths[~inside][1:-1], np.sort([sizes[:-1], sizes[1:]], axis=0)
        assert np.all((between > pairs[0] * (1 - 1e-12)) & (between < pairs[1] * (1 + 1e-12)))
        if growth > 1.0:
            assert np.all((between > 1.05 * pairs[0]) & (between < 0.95 * pairs[1]))


def test_step_length_finds_the_minimum():
    """requirement: the zero of an increasing, piecewise linear function; whole steps kept."""
    rng, shortened = np.random.default_rng(3), 0
    for _ in range(200):
        pressure, change = rng.normal(size=(2, 20))
        slope = rng.uniform(0, 5)

        def work(a, line=(slope, pressure, change)):
            return line[0] * a + line[2] @ np.maximum(line[1] + a * line[2], 0.0)

        constant = -work(rng.uniform(0, 1))
        length = step_length(constant, slope, change, pressure, change)
        assert 0 < length <= 1
        start, whole, there = (constant + work(a) for a in (0.0, 1.0, length))
        if start < 0 and whole > 0.9 * abs(start):
            shortened += 1
            assert length < 1
            assert abs(there) < 1e-9 * abs(start)
        else:
            assert length == 1.0
    assert shortened > 20


@pytest.mark.parametrize("kind", METHODS)
def test_what_has_no_solution_is_reported(kind):
    """requirement: pulled apart, or without numbers, there is an error and no wrong pressure."""
    case = build(1, (4, 4))
    contact = method(case, kind)
    with pytest.raises(ComputationError, match="cannot be carried"):
        contact.solve(case.bump, np.array([-1e4]))
    for gap, load in ((case.bump * np.nan, 1e4), (case.bump, np.inf)):
        with pytest.raises(ComputationError, match="not finite"):
            contact.solve(gap, np.array([load]))
    assert contact.solve(case.bump, np.array([1e4])).active.any()


def test_penalty_beyond_rounding_is_reported():
    """requirement: what rounding spoils is no solution; the error says what to change."""
    case = build(1, (4, 4))
    with pytest.raises(ComputationError, match=r"contact\.penalty smaller"):
        method(case, "penalty", 1e14).solve(case.bump, np.array([1e4]))


def test_unstable_stabilisation_is_reported():
    """requirement: γ0 below its limit: advice for θ = 1, a solution for θ = -1."""
    case = build(2, (8, 8))
    with pytest.raises(ComputationError, match=r"contact\.gamma"):
        method(case, 1, 0.02).solve(case.bump, np.array([1e4]))
    solution = method(case, -1, 0.02).solve(case.bump, np.array([1e4]))
    assert case.weights @ solution.pressure == pytest.approx(1e4, rel=1e-9)


def numbers():
    """Pressures, approaches [pm] and iterations of all methods, with and without friction."""
    case = build(3, (9, 7), name="axisymmetric")
    found = []
    for kind in METHODS:
        for friction in (0.0, 0.2):
            solution = method(case, kind, friction=friction).solve(case.bump, np.array([1e4]))
            found.append([*solution.pressure, *(1e12 * solution.motion), solution.iterations])
    return np.array(found)


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
@pytest.mark.slow
def test_two_ranks_give_the_serial_pressure():
    """requirement: the same numbers on any number of ranks."""
    script = (
        "import json; from tests.contact.test_full_system import COMM, numbers; found = numbers()\n"
        "if COMM.rank == 0: print(json.dumps(found.tolist()))"
    )
    command = ["mpirun", "--oversubscribe", "-n", "2", sys.executable, "-c", script]
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PMIX", "PRTE_"))}
    environment |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, env=environment, timeout=120
    )
    assert done.returncode == 0, done.stderr
    serial = numbers()
    np.testing.assert_allclose(
        json.loads(done.stdout), serial, atol=1e-8 * np.abs(serial).max(axis=1).min()
    )


def test_a_part_of_an_approach():
    """requirement: at share 0 the faces only just touch, at share 1 all is there."""
    gap, none = np.array([-2e-6, 1e-6]), np.zeros(2)
    loading = Loading(gap, np.zeros(0), none, none, none)
    assert loading.part(0.0).gap.min() == pytest.approx(0.0, abs=1e-18)
    assert loading.part(1.0).gap == pytest.approx(gap)
