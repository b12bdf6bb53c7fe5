"""Stick and slip by increments: half-planes against Mindlin, and blocks of finite elements."""

import dataclasses
import itertools
import re

from mpi4py import MPI

import numpy as np
import pytest
import ufl

from thermowear import ComputationError
from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Axisymmetric, PlaneStrain
from thermowear.contact.faces.face import gather_face
from thermowear.contact.friction import stick_slip
from thermowear.contact.friction.frictional_contact import condense_tangential, unloaded
from thermowear.contact.friction.slip_wear import SlipWear, WornProfile, WornProfiles
from thermowear.contact.friction.stick_slip import FullSliding, advance, follow
from thermowear.contact.friction.stick_slip_state import Status
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.contact.solvers.signorini import solve_contact
from thermowear.laws import PowerWear
from thermowear.parallel import sum_over_ranks
from thermowear.reference.elastic_contact.hertz import MindlinLine, contact_modulus

from ..conftest import two_blocks
from .half_plane import PRESS as PRESSED
from .half_plane import SLIDE, half_plane, loaded

COMM = MPI.COMM_WORLD
LINE = MindlinLine(force=1e5, radius=0.05, modulus=1e11, friction=0.4)
Q = 0.6 * LINE.limit
PRESS = 4e5  # N on the blocks


def pushed(*tangential, normal=LINE.force):
    return [loaded(normal_force=normal, tangential_force=q) for q in tangential]


@pytest.fixture(scope="module")
def mindlin():
    """Pressed, then pushed to Q and three times round; 8 increments from corner to corner."""
    x, contact = half_plane(LINE, 200)
    corners = pushed(0.0, Q, -Q, Q, -Q)
    return x, contact, list(follow(contact, LINE.friction, corners, 8))


UNLIKE = {"upper": ElasticMaterial(2e11, 0.3), "lower": ElasticMaterial(7e10, 0.2)}
ALIKE = dict.fromkeys(UNLIKE, ElasticMaterial(2e11, 0.3))
BOTH_WAYS = PRESSED, SLIDE


def block_contact(model, degree=4, materials=UNLIKE, held=BOTH_WAYS, **mesh):
    """Elasticity, x of the points, and condensed contact of two blocks."""
    mesh.setdefault("columns", (3, 4))
    tagged = two_blocks(**mesh) if COMM.rank == 0 else None
    bodies = distribute(tagged, COMM)
    elastic = elasticity(bodies, model, degree, materials, ["upper_end", "lower_end"])
    faces = (gather_face(bodies, f"{body}_face") for body in ("upper", "lower"))
    pairing = pair(*faces, model, degree + 2)
    basis = pressure_basis(pairing, degree - 1)
    contact = condense_tangential(elastic, Contacts((pairing,)), basis, held)
    return elastic, pairing.points[:, 0], contact


@pytest.fixture(scope="module")
def blocks():
    elastic, _, contact = block_contact(PlaneStrain(0.01))
    return elastic, contact


def test_mindlin_on_loading(mindlin):
    """requirement: half-width, sticking zone and shear of Cattaneo and Mindlin."""
    x, _, states = mindlin
    a, c = LINE.normal.half_width, LINE.stick_half_width(Q)
    cell, state = x[1] - x[0], states[15]
    assert (state.pressure > 0).sum() * cell / 2 == pytest.approx(a, abs=0.5 * cell)
    assert (state.status == Status.STICK).sum() * cell / 2 == pytest.approx(c, abs=cell)
    error = np.abs(-state.shear[:, 0] - LINE.shear(x, Q))
    assert error.sum() < 2e-3 * LINE.shear(x, Q).sum()
    assert error.max() < 0.02 * LINE.friction * LINE.normal.peak
    slip = state.point_slip[:, 0] - state.point_slip[np.abs(x) < c, 0].mean()
    inside = np.abs(x) < a
    largest = LINE.slip(a, Q)
    np.testing.assert_allclose(slip[inside], LINE.slip(x, Q)[inside], atol=0.01 * largest)
    assert max(state.iterations for state in states) <= 10


def test_mindlin_on_unloading(mindlin):
    """requirement: shear of Mindlin's superposition on the way back."""
    x, _, states = mindlin
    for state in states[16:24]:
        expected = LINE.shear_after(x, Q, state.force[1])
        error = np.abs(-state.shear[:, 0] - expected).sum()
        assert error < 2e-3 * LINE.shear(x, Q).sum()


def test_mindlin_loss(mindlin):
    """requirement: energy lost on loading and per cycle, closed form; where it slips."""
    x, contact, states = mindlin
    area = contact.weighted.sum(axis=1)
    first = area @ states[15].dissipated
    cycle = area @ (states[39].dissipated - states[23].dissipated)
    assert first == pytest.approx(LINE.loss_on_loading(Q), rel=2e-3)
    assert cycle == pytest.approx(LINE.loss_per_cycle(Q), rel=2e-3)
    sticks = np.abs(x) < LINE.stick_half_width(Q) - 2 * (x[1] - x[0])
    assert np.abs(states[-1].dissipated[sticks]).max() < 1e-9 * states[-1].dissipated.max()


def test_mindlin_by_finite_elements():
    """requirement: the same from condensed bodies: one round on a cylinder pressed on a block. Only
    the blocks' finite size, 11 half-widths, keeps the loss 6 % from that of half-planes.
    """
    sizes = {"inner": -0.02, "outer": 0.02, "heights": (0.03, 0.03)}
    mesh = {"columns": (68, 68), "rows": (16, 16), **sizes}
    _, x, contact = block_contact(PlaneStrain(1.0), 3, ALIKE, **mesh)
    line = MindlinLine(5.3e6, 0.2, contact_modulus((2e11, 0.3), (2e11, 0.3)), 0.4)
    area = contact.weighted.sum(axis=1)
    contact = dataclasses.replace(contact, gap=x**2 / (2 * line.radius))
    force = 0.6 * line.limit
    states = list(
        follow(contact, line.friction, pushed(0.0, force, -force, force, normal=line.force), 4)
    )
    state = states[7]
    pressure, shear = contact.basis @ state.pressure, -contact.basis @ shears(state)
    assert pressure.max() == pytest.approx(line.normal.peak, rel=0.01)
    assert area @ np.abs(shear - line.shear(x, force)) < 0.06 * force
    lost = area @ (states[15].dissipated - state.dissipated)
    assert lost == pytest.approx(line.loss_per_cycle(force), rel=0.07)


def work(states):
    """Work of the holder's forces between successive states [J]."""
    pairs = itertools.pairwise(states)
    return sum((a.force + b.force) @ (b.motion - a.motion) / 2 for a, b in pairs)


def test_loss_is_the_work_of_a_cycle(mindlin):
    """requirement: over a closed cycle the work of the tangential force is the loss."""
    _, contact, states = mindlin
    closed = states[23:40]
    lost = contact.weighted.sum(axis=1) @ (closed[-1].dissipated - closed[0].dissipated)
    assert np.abs(closed[-1].shear - closed[0].shear).max() < 1e-9 * LINE.normal.peak
    fine = list(follow(contact, LINE.friction, pushed(Q, -Q), 40, closed[0]))
    fine_lost = contact.weighted.sum(axis=1) @ (fine[-1].dissipated - closed[0].dissipated)
    assert fine_lost == pytest.approx(lost, rel=1e-9)  # constant pressure: the steps do not matter
    assert work([closed[0], *fine]) == pytest.approx(lost, rel=3e-3)


def stored_energy(contact, state):
    """Elastic energy of both bodies."""
    x = contact.stack(state.pressure, state.shear)
    return float(x @ contact.compliance @ x) / 2


def shears(state):
    return state.shear[:, 0]


def balances(contact, states):
    """Work less stored and lost energy, both by the mean tractions of each increment [J]."""
    total = 0.0
    for a, b in itertools.pairwise(states):
        lost = -np.sum((a.shear + b.shear) / 2 * (b.slip - a.slip))
        gaps = [
            contact.split(
                contact.compliance @ contact.stack(s.pressure, s.shear) - contact.modes @ s.motion
            )[0]
            for s in (a, b)
        ]
        opened = -(a.pressure + b.pressure) @ (gaps[1] - gaps[0]) / 2
        stored = stored_energy(contact, b) - stored_energy(contact, a)
        total += abs(work([a, b]) - stored - lost - opened)
    return total


def test_condensed_response_is_the_bodies_own(blocks):
    """requirement: energies under pressure and shear, and both together (the sign of their
    coupling), against nodal loads of the same tractions assembled on the faces.
    """
    elastic, contact = blocks
    m, faces = contact.basis.shape[1], []
    for sign, body, name in zip((1, -1), elastic.bodies.each, ("upper", "lower"), strict=True):
        ds = ufl.Measure("ds", body.mesh, subdomain_data=body.facet_tags)
        faces.append((sign * 0.01, ds(body.surfaces.index(f"{name}_face") + 1)))
    for pressure, shear in ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -0.4)):
        on_1 = ufl.as_vector([shear, pressure])  # n is -y and e is +x
        works = [lambda v, f=size * on_1, d=ds: ufl.dot(f, v) * d for size, ds in faces]
        f = elastic.spaces.loads(works)
        energy = sum_over_ranks(COMM, f @ elastic.solve(f))
        x = np.repeat([pressure, shear], m)
        assert x @ contact.compliance @ x == pytest.approx(energy, rel=1e-10)
        assert contact.modes.T @ x == pytest.approx([pressure * 4e-4, -shear * 4e-4])


def test_blocks_pushed_back_and_forth():
    """requirement: all conditions hold, loss is never negative, energy balances."""
    *_, contact = block_contact(PlaneStrain(0.01), columns=(9, 7))
    parts = (0.0, 0.26, -0.26, 0.1)
    corners = pushed(*(part * PRESS for part in parts), normal=PRESS)
    states = [unloaded(contact), *follow(contact, 0.3, corners, 4)]
    for a, b in itertools.pairwise(states):
        nothing = 1e-12 * stored_energy(contact, b)
        assert np.all(-b.shear * (b.slip - a.slip) >= -nothing)
        pressure, shear = contact.basis @ b.pressure, contact.basis @ b.shear
        assert np.all(np.abs(shear[:, 0]) <= 0.3 * pressure * (1 + 1e-9))
        lost = contact.weighted.sum(axis=1) @ (b.dissipated - a.dissipated)
        in_the_mean = -np.sum(b.shear * (b.slip - a.slip))
        assert lost == pytest.approx(in_the_mean, rel=1e-9, abs=nothing)
        assert b.iterations <= 10
    for state, part in zip(states[4::4], parts, strict=True):
        assert state.force == pytest.approx([PRESS, part * PRESS], rel=1e-9, abs=1e-9 * PRESS)
    assert {Status.STICK, Status.SLIP} <= set(states[8].status)
    assert balances(contact, states) < 1e-10 * stored_energy(contact, states[8])


def test_sign_of_the_tangential_load():
    """requirement: the mirrored push gives the mirrored shear, pressure and slip."""
    *_, contact = block_contact(PlaneStrain(0.01), columns=(3, 3))
    ends = []
    for q in (0.1 * PRESS, -0.1 * PRESS):
        *_, end = follow(contact, 0.3, pushed(0.0, q, normal=PRESS), 3)
        ends.append(end)
    right, left = ends
    scale = right.pressure.max()
    np.testing.assert_allclose(shears(left)[::-1], -shears(right), atol=1e-8 * scale)
    np.testing.assert_allclose(left.pressure[::-1], right.pressure, atol=1e-8 * scale)
    assert shears(right).sum() < 0 < right.motion[1]  # friction holds body 1 back
    assert left.motion[1] == pytest.approx(-right.motion[1], rel=1e-8)


def test_rough_faces_stick_everywhere(blocks):
    """requirement: with much friction a tangential load causes no slip; all is linear."""
    _, contact = blocks
    *_, pressed = follow(contact, 50.0, pushed(0.0, normal=PRESS), 1)
    one, two = (advance(contact, 50.0, pressed, pushed(q, normal=PRESS)[0]) for q in (1e3, 2e3))
    assert np.all(one.status == Status.STICK)
    moved = np.abs(one.slip - pressed.slip).max()
    assert moved < 1e-9 * contact.weighted.sum() * one.motion[1]
    twice = 2 * (one.shear - pressed.shear)
    np.testing.assert_allclose(two.shear - pressed.shear, twice, atol=1e-8 * np.abs(twice).max())
    stiff = contact.compliance, contact.modes
    bonded = stiff[1].T @ np.linalg.solve(*stiff)
    slope = np.linalg.solve(bonded, [0.0, 1e3])
    np.testing.assert_allclose(one.motion - pressed.motion, slope, atol=1e-8 * slope[1])


def test_too_much_force_slides(blocks):
    """requirement: more than mu P is refused, and the message says how much friction carries."""
    _, contact = blocks
    *_, state = follow(contact, 0.3, pushed(0.29 * PRESS, normal=PRESS), 2)
    assert state.force[1] == pytest.approx(0.29 * PRESS)
    for q in (0.301 * PRESS, -0.31 * PRESS, 2 * PRESS):
        with pytest.raises(FullSliding, match=r"friction carries 120000 N"):
            advance(contact, 0.3, state, loaded(normal_force=PRESS, tangential_force=q))
    with pytest.raises(FullSliding):
        list(follow(contact, 0.3, pushed(0.31 * PRESS, normal=PRESS), 2, state))


def test_given_displacement_slides_with_friction(blocks):
    """requirement: under a large displacement the force is mu P, and the work goes into heat."""
    _, contact = blocks
    corners = [loaded(normal_force=PRESS, tangential_displacement=s) for s in (1e-3, 2e-3)]
    first, second = follow(contact, 0.3, corners, 1)
    assert np.all(second.status == Status.SLIP)
    assert second.force == pytest.approx([PRESS, 0.3 * PRESS], rel=1e-9)
    lost = contact.weighted.sum(axis=1) @ (second.dissipated - first.dissipated)
    assert lost == pytest.approx(0.3 * PRESS * 1e-3, rel=1e-9)


def test_given_approach_is_the_force_it_takes(blocks):
    """requirement: force and translation of the holder are two sides of one state."""
    _, contact = blocks
    *_, forced = follow(contact, 0.3, pushed(0.1 * PRESS, normal=PRESS), 1)
    loads = loaded(approach=forced.motion[0], tangential_displacement=forced.motion[1])
    moved = advance(contact, 0.3, unloaded(contact), loads)
    np.testing.assert_allclose(moved.force, forced.force, rtol=1e-8)
    np.testing.assert_allclose(moved.shear, forced.shear, atol=1e-8 * forced.pressure.max())
    lifted = advance(contact, 0.3, forced, loaded(approach=-1e-6, tangential_displacement=0.0))
    assert np.all(lifted.status == Status.OPEN)
    assert np.all(lifted.force == 0)
    with pytest.raises(ComputationError, match="do not touch"):
        advance(contact, 0.3, forced, loaded(approach=-1e-6, tangential_force=0.0))


def test_the_path_matters():
    """requirement: pressing and pushing in another order ends in another shear."""
    _, contact = half_plane(LINE, 80)
    *_, later = follow(contact, LINE.friction, pushed(0.0, Q), 6)
    *_, together = follow(contact, LINE.friction, pushed(Q), 6)
    assert np.abs(later.shear - together.shear).max() > 0.05 * LINE.normal.peak
    assert together.force == pytest.approx(later.force)
    # what grows together, and below mu P, does not slip (Mindlin and Deresiewicz 1953)
    assert np.all(np.abs(shears(together)) <= LINE.friction * together.pressure * (1 + 1e-9))


def test_without_friction_it_is_contact(blocks):
    """requirement: mu = 0 gives the pressure of `solve_contact`."""
    _, contact = blocks
    m = contact.basis.shape[1]
    state = advance(contact, 0.0, unloaded(contact), loaded(PRESS, tangential_displacement=1e-5))
    expected = solve_contact(
        contact.compliance[:m, :m],
        contact.weighted.T @ contact.gap,
        contact.modes[:m, :1],
        np.array([PRESS]),
    )
    scale = expected.coefficients.max()
    np.testing.assert_allclose(state.pressure, expected.coefficients, atol=1e-9 * scale)
    assert np.all(state.shear == 0)
    assert np.all(state.dissipated == 0)


def test_friction_by_coefficient_and_wear(blocks):
    """requirement: friction may vary; a worn layer brings the holder closer by its depth."""
    _, contact = blocks
    friction = np.linspace(0.05, 0.4, contact.basis.shape[1])
    loads = loaded(normal_force=PRESS, tangential_force=0.05 * PRESS)
    state = advance(contact, friction, unloaded(contact), loads)
    assert np.all(np.abs(shears(state)) <= friction * state.pressure)
    lower = dataclasses.replace(contact, gap=contact.gap + 1e-6)
    worn = advance(lower, friction, unloaded(contact), loads)
    assert worn.motion - state.motion == pytest.approx([1e-6, 0.0], rel=1e-6, abs=1e-14)
    np.testing.assert_allclose(worn.shear, state.shear, atol=1e-8 * state.pressure.max())


def test_a_stick_zone_that_changes_leaves_the_gap(blocks):
    """requirement: what has been worn opens one gap, wherever the stick zone ends later on."""
    _, contact = blocks
    m = contact.basis.shape[1]
    profile = WornProfile(np.arange(float(m)), contact.areas, 0.0)
    wear = SlipWear((PowerWear(1e-12),), (WornProfiles((profile,)),), 0.3, 1.0, 100)
    loads = loaded(normal_force=PRESS, tangential_force=0.28 * PRESS)
    pressed = advance(contact, 0.3, unloaded(contact, 1), loaded(PRESS, tangential_force=0.0))
    sticks = np.arange(m) // 2 % 3 > 0
    state = dataclasses.replace(pressed, part=sticks.astype(float))
    worn = advance(contact, 0.3, state, loads, wear)
    new = advance(contact, 0.3, state, loads)
    assert np.abs(worn.pressure - new.pressure).max() > 0.05 * new.pressure.max()
    assert worn.spared.any()
    for part in (np.zeros(m), np.ones(m), ~sticks + 0.0):
        again = advance(contact, 0.3, dataclasses.replace(worn, part=part), loads)
        np.testing.assert_allclose(again.pressure, worn.pressure, rtol=1e-5)


def test_worn_depths_open_the_gap_where_they_slip():
    """requirement: stick zones have the gap of their own depths, no volume is lost; outside, depths
    are shared as functions overlap where all slip alike, and lean to where more of it slips.
    """
    _, x, contact = block_contact(PlaneStrain(0.01), degree=2)
    places = contact.weighted.T @ x / contact.areas
    inside = places <= np.sort(places)[1]
    still, equal = unloaded(contact), contact.areas[:, None] * np.ones((len(places), 1))

    def opened(slip, part=inside + 0.0):
        state = dataclasses.replace(still, part=part)
        return contact.mass + contact.spared(state, dataclasses.replace(still, slip=slip))

    evenly, leaning = opened(equal), opened(equal * (places - x.min())[:, None])
    for found in (evenly, leaning):
        np.testing.assert_allclose(found.sum(axis=0), contact.areas, rtol=1e-12)
        assert not (found - np.diag(np.diag(found)))[inside].any()
    far = places > np.sort(places)[2]
    np.testing.assert_allclose(evenly[:, far], contact.mass[:, far], rtol=1e-9, atol=1e-15)
    np.testing.assert_array_equal(opened(equal, 0.0 * inside), contact.mass)
    moved = (places @ (leaning - evenly) / contact.areas)[~inside]
    assert moved.min() > -1e-9 * np.ptp(x)
    assert np.median(moved) > 1e-3 * np.ptp(x) / len(places)


def test_pressing_a_ring():
    """requirement: axisymmetric without torsion; unlike bodies slip radially at the edges, which
    friction resists; no tangential motion of the holder.
    """
    *_, contact = block_contact(Axisymmetric(), held=(PRESSED,))
    states = list(follow(contact, 0.03, [loaded(normal_force=1e6)], 3))
    assert set(states[-1].status) == {Status.STICK, Status.SLIP}
    assert states[-1].force == pytest.approx([1e6], rel=1e-9)
    losses = [contact.weighted.sum(axis=1) @ state.dissipated for state in states]
    assert np.all(np.diff([0.0, *losses]) > 0)
    lost = [
        np.sum(b.shear * (b.slip - a.slip))
        for a, b in itertools.pairwise([unloaded(contact), *states])
    ]
    assert -sum(lost) == pytest.approx(losses[-1], rel=1e-9)


def test_increments_are_halved_where_they_fail(blocks, monkeypatch):
    """requirement: the driver takes smaller increments by itself, and gives up at some time."""
    _, contact = blocks
    taken, limit = [], 0.3 * PRESS

    def cautious(contact, friction, state, loads, gap=None):
        if abs(loads.forces[0] - state.force[0]) > limit:
            raise ComputationError("too far")
        taken.append(loads.forces[0])
        return advance(contact, friction, state, loads, gap)

    monkeypatch.setattr(stick_slip, "advance", cautious)
    (state,) = follow(contact, 0.3, pushed(0.0, normal=PRESS), 1)
    assert taken == pytest.approx(np.array([0.25, 0.5, 0.75, 1.0]) * PRESS)
    assert state.force[0] == pytest.approx(PRESS)
    limit = 0.0
    with pytest.raises(ComputationError, match="too far"):
        list(follow(contact, 0.3, pushed(0.0, normal=PRESS), 1))


@pytest.mark.parametrize(
    "wrong",
    [
        {"normal_force": 1.0, "approach": 0.0},
        {"tangential_force": 1.0},
        {"approach": 0.0, "tangential_force": 1.0, "tangential_displacement": 1.0},
        {"normal_force": 1.0},
    ],
)
def test_loads_that_do_not_hold_the_body(blocks, wrong):
    """requirement: exactly one of force and translation along each motion."""
    with pytest.raises(ValueError, match="loads:"):
        advance(blocks[1], 0.3, unloaded(blocks[1]), loaded(**wrong))


def test_friction_carries_what_sliding_takes(blocks):
    """requirement: the refused force is held against what sliding under the approach takes."""
    _, contact = blocks
    friction = np.linspace(0.05, 0.4, contact.basis.shape[1])
    start = unloaded(contact)
    pressed = loaded(normal_force=PRESS, tangential_force=0.0)
    near = advance(contact, friction, start, pressed).motion[0]
    slid = advance(contact, friction, start, loaded(approach=near, tangential_displacement=1e-2))
    push = loaded(approach=near, tangential_force=1.01 * slid.force[1])
    with pytest.raises(FullSliding) as refused:
        advance(contact, friction, slid, push)
    carried = float(re.search(r"carries ([\d.e+]+) N", str(refused.value)).group(1))
    assert carried == pytest.approx(slid.force[1], rel=1e-5)
