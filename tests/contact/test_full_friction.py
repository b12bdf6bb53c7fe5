"""Stick and slip by penalty and Nitsche's method on the full system: blocks of finite elements."""

import dataclasses
import itertools

from mpi4py import MPI

import numpy as np
import pytest

from thermowear import ComputationError
from thermowear.bulk.bodies import distribute
from thermowear.bulk.elasticity.elasticity import ElasticMaterial, elasticity
from thermowear.bulk.kinematics import Axisymmetric, PlaneStrain
from thermowear.contact.faces.face import gather_face
from thermowear.contact.friction.frictional_contact import condense_tangential, unloaded
from thermowear.contact.friction.stick_slip import FullSliding, advance, follow
from thermowear.contact.friction.stick_slip_state import Status
from thermowear.contact.full.full_friction import full_friction, projected
from thermowear.contact.full.nitsche import default_penalty, nitsche_stiffness
from thermowear.contact.operators.pressure import pressure_basis
from thermowear.contact.operators.rigid_motion import tangential_frame
from thermowear.contact.search.pairing import Contacts, pair
from thermowear.parallel import sum_over_ranks

from ..conftest import two_blocks
from .half_plane import PRESS as PRESSED
from .half_plane import SLIDE, loaded

COMM = MPI.COMM_WORLD
PRESS = 4e5
METHODS = ["penalty", 1, 0, -1]
"""The penalty method, and θ of Nitsche's."""
MATERIALS = {"upper": ElasticMaterial(2e11, 0.3), "lower": ElasticMaterial(7e10, 0.2)}


CYLINDER = [loaded(normal_force=3e4, tangential_force=part * 0.3 * 3e4) for part in (0, 0.6, -0.6)]


def blocks(model, degree=2, held=(PRESSED, SLIDE), columns=(4, 5)):
    """Arguments of the contacts of two blocks: bodies, contact, pressure basis and motions."""
    tagged = two_blocks(columns=columns) if COMM.rank == 0 else None
    bodies = distribute(tagged, COMM)
    elastic = elasticity(bodies, model, degree, MATERIALS, ["upper_end", "lower_end"])
    faces = (gather_face(bodies, f"{body}_face") for body in ("upper", "lower"))
    pairing = pair(*faces, model, degree + 2)
    contacts = Contacts((pairing,))
    basis = pressure_basis(pairing, degree - 1)
    return elastic, contacts, basis, held, tangential_frame(contacts)


def contact_by(given, method, factor=1.0):
    """Contact by a method, its stiffness times a factor."""
    elastic, contacts, *_ = given
    if method == "condensed":
        return condense_tangential(*given)
    if method == "penalty":
        return full_friction(*given, factor * default_penalty(elastic, contacts.only))
    stiffness = factor * nitsche_stiffness(elastic, contacts.only)
    return full_friction(*given, stiffness, method)


@pytest.fixture(scope="module")
def plane():
    return blocks(PlaneStrain(0.01))


@pytest.fixture(scope="module", params=METHODS)
def contact(plane, request):
    return contact_by(plane, request.param)


def pushed(*tangential):
    return [loaded(normal_force=PRESS, tangential_force=q * PRESS) for q in tangential]


def lost(contact, state):
    return float(contact.areas @ state.dissipated[contact.contacts.weights > 0])


# ---- points ----


@pytest.mark.parametrize("t", [1, 2])
def test_slopes_of_the_projection(t):
    """requirement: derivatives by differences, and the conditions of Coulomb at each point."""
    rng = np.random.default_rng(7)
    trial, step = rng.normal(size=(1 + t, 200)), 1e-6
    friction, soft = rng.uniform(0.1, 0.8, 200), rng.uniform(0.3, 1.0, 200)
    found = projected(trial, friction, soft)
    for j in range(1 + t):
        ahead, behind = trial.copy(), trial.copy()
        ahead[j] += step
        behind[j] -= step
        both = (projected(each, friction, soft).values for each in (ahead, behind))
        change = np.subtract(*both) / (2 * step)
        np.testing.assert_allclose(found.slopes[:, j], change, atol=1e-7)
    pressure, size = found.values[0], np.linalg.norm(found.values[1:], axis=0)
    assert np.all(pressure >= 0)
    assert np.all(size <= friction * pressure + 1e-14)
    slips = (pressure > 0) & ~found.sticking
    assert slips.any()
    assert found.sticking.any()
    np.testing.assert_allclose(size[slips], (friction * pressure)[slips], rtol=1e-12)
    assert np.all(np.einsum("tn,tn->n", found.values[1:], trial[1:])[slips] >= 0)


# ---- increments ----


def test_conditions_and_balance(contact):
    """requirement: forces balance, shear within the cone of friction and against the slip."""
    states = [unloaded(contact), *follow(contact, 0.3, pushed(0.0, 0.26, -0.26, 0.1), 3)]
    for a, b in itertools.pairwise(states):
        assert np.all(np.abs(b.shear[:, 0]) <= 0.3 * b.pressure * (1 + 1e-12))
        gained = b.point_slip - a.point_slip
        sticks = contact.basis @ (b.status == Status.STICK) > 0
        assert np.all(gained[sticks] == 0.0)
        assert np.all((contact.basis @ b.shear * gained)[~sticks] <= 0.0)
        assert np.all(b.dissipated >= a.dissipated)
        np.testing.assert_allclose(contact.modes.T @ contact.stack(b.pressure, b.shear), b.force)
    assert {Status.STICK, Status.SLIP} <= set(states[6].status)
    for state, part in zip(states[3::3], (0.0, 0.26, -0.26, 0.1), strict=True):
        assert state.force == pytest.approx([PRESS, part * PRESS], rel=1e-8, abs=1e-8 * PRESS)


def rolled(given, method, factor=1.0):
    """Contact of a cylinder of 2 m radius, on the mesh of the blocks."""
    x = given[1].points[:, 0]
    gap = (x - x.mean()) ** 2 / 4.0
    return dataclasses.replace(contact_by(given, method, factor), gap=gap)


@pytest.fixture(scope="module")
def fine():
    return blocks(PlaneStrain(0.01), columns=(44, 44))


@pytest.fixture(scope="module")
def known(fine):
    """Pressed, pushed and pulled as far as to slip in part, by the condensed method."""
    contact = rolled(fine, "condensed")
    return contact, list(follow(contact, 0.3, CYLINDER, 2))


@pytest.mark.parametrize("method", METHODS)
def test_the_condensed_answer(fine, known, method):
    """requirement: compliance to 2e-3 and loss to 2 % of condensed bodies on the same mesh."""
    contact, (condensed, states) = rolled(fine, method), known
    found = list(follow(contact, 0.3, CYLINDER, 2))
    for a, b in zip(found, states, strict=True):
        np.testing.assert_allclose(a.motion, b.motion, rtol=2e-3, atol=2e-3 * b.motion[0])
    areas = condensed.weighted.sum(axis=1)
    for first, last in ((1, 3), (3, 5)):
        loss = areas @ (states[last].dissipated - states[first].dissipated)
        gained = lost(contact, found[last]) - lost(contact, found[first])
        assert gained == pytest.approx(loss, rel=2e-2)


def test_penalty_converges_as_one_over_the_penalty():
    """requirement: compliances along and across the face approach a limit as 1/γ."""
    given, ends = blocks(PlaneStrain(0.01), columns=(10, 10)), {}
    for factor in (1, 4, 16, 4096):
        contact = rolled(given, "penalty", factor)
        loads = [loaded(normal_force=3e4, tangential_force=q) for q in (0.0, 3e3)]
        *_, state = follow(contact, 50.0, loads, 1)
        assert np.all(state.status[state.pressure > 0] == Status.STICK)
        ends[factor] = state.motion
    excess = np.array([ends[factor] - ends[4096] for factor in (1, 4, 16)])
    assert np.all(excess > 0)
    np.testing.assert_allclose(excess[:-1] / excess[1:], 4.0, rtol=0.05)


def test_tractions_of_an_affine_displacement(plane):
    """requirement: pressure and shear on body 1, which lies above: p = -σ_yy, t = -σ_xy."""
    contact = contact_by(plane, 1)
    x, y = plane[0].nodes().T
    u = np.column_stack([2e-4 * x + 5e-4 * y, -3e-4 * y + 1e-4 * x]).ravel()
    pressure, shear = sum_over_ranks(COMM, contact.stress.T @ u).reshape(2, -1)
    E, ν = 2e11, 0.3
    μ, λ = E / (2 * (1 + ν)), E * ν / ((1 + ν) * (1 - 2 * ν))
    np.testing.assert_allclose(pressure, 1e-4 * λ + 6e-4 * μ, rtol=1e-9)
    np.testing.assert_allclose(shear, -6e-4 * μ, rtol=1e-9)


def test_stick_does_not_creep(contact):
    """requirement: many increments without a change of the loads change nothing, exactly."""
    *_, pressed = follow(contact, 50.0, pushed(0.1), 1)
    state = pressed
    for _ in range(5):
        state = advance(contact, 50.0, state, pushed(0.1)[0])
    assert np.all(state.point_slip[contact.basis @ state.pressure > 0] == 0.0)
    np.testing.assert_allclose(state.motion, pressed.motion, rtol=1e-9)
    np.testing.assert_allclose(state.shear, pressed.shear, atol=1e-7 * pressed.pressure.max())


def test_gross_slip(contact):
    """requirement: under a displacement the force is mu P, and the work is lost; a larger force
    is refused with what friction carries.
    """
    corners = [loaded(normal_force=PRESS, tangential_displacement=s) for s in (1e-3, 2e-3)]
    first, second = follow(contact, 0.3, corners, 1)
    assert np.all(second.status[second.pressure > 0] == Status.SLIP)
    assert second.force == pytest.approx([PRESS, 0.3 * PRESS], rel=1e-8)
    gained = lost(contact, second) - lost(contact, first)
    assert gained == pytest.approx(0.3 * PRESS * 1e-3, rel=1e-8)
    *_, state = follow(contact, 0.3, pushed(0.0), 1)
    with pytest.raises(FullSliding, match="friction carries 120000 N"):
        advance(contact, 0.3, state, pushed(0.31)[0])
    with pytest.raises(FullSliding, match="friction carries 0 N"):
        advance(contact, 0.0, state, pushed(0.01)[0])


def test_signs(contact):
    """requirement: the mirrored push gives the mirrored shear; friction holds body 1 back."""
    ends = [list(follow(contact, 0.3, pushed(0.0, q), 2))[-1] for q in (0.1, -0.1)]
    for end, sign in zip(ends, (1, -1), strict=True):
        assert sign * end.motion[1] > 0
        assert sign * (contact.areas @ end.shear[:, 0]) == pytest.approx(-0.1 * PRESS, rel=1e-8)
    assert ends[0].motion[1] == pytest.approx(-ends[1].motion[1], rel=1e-6)


def test_lifted_and_pressed_again(contact):
    """requirement: a lifted body carries nothing, and friction alone holds no force there."""
    *_, pressed = follow(contact, 0.3, pushed(0.1), 1)
    lifted = advance(contact, 0.3, pressed, loaded(approach=-1e-6, tangential_displacement=0.0))
    assert np.all(lifted.status == Status.OPEN)
    assert np.all(lifted.force == 0.0)
    with pytest.raises(ComputationError, match="do not touch"):
        advance(contact, 0.3, pressed, loaded(approach=-1e-6, tangential_force=0.0))
    again = advance(contact, 0.3, lifted, pushed(0.0)[0])
    assert again.force == pytest.approx([PRESS, 0.0], rel=1e-8, abs=1e-8 * PRESS)


def test_pressed_ring():
    """requirement: axisymmetric, with points on the axis; unlike bodies slip radially."""
    given = blocks(Axisymmetric(), held=(PRESSED,))
    for method in ("penalty", 1):
        contact = contact_by(given, method)
        *_, state = follow(contact, 0.03, [loaded(normal_force=1e6)], 3)
        assert {Status.STICK, Status.SLIP} <= set(state.status)
        assert state.force == pytest.approx([1e6], rel=1e-8)
        assert lost(contact, state) > 0


def test_worn_depth_and_its_slope(plane):
    """requirement: a worn layer brings the holder closer by its depth."""
    contact = contact_by(plane, 1)
    lower = dataclasses.replace(contact, gap=contact.gap + 1e-6)
    state, worn = (advance(each, 0.3, unloaded(each), pushed(0.1)[0]) for each in (contact, lower))
    assert worn.motion - state.motion == pytest.approx([1e-6, 0.0], rel=1e-6, abs=1e-14)
