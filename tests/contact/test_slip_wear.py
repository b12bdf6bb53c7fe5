"""Wear by local slip, on half-planes without finite elements."""

import dataclasses
import itertools

import numpy as np
import pytest

from thermowear.contact.friction.frictional_contact import unloaded
from thermowear.contact.friction.slip_wear import SlipWear, WornProfile, WornProfiles
from thermowear.contact.friction.stick_slip import follow
from thermowear.contact.friction.stick_slip_state import Status
from thermowear.laws import PowerWear
from thermowear.reference.elastic_contact.growing_contact import growing_line
from thermowear.reference.elastic_contact.hertz import MindlinLine

from .half_plane import half_plane, loaded

LINE = MindlinLine(force=1e5, radius=0.05, modulus=1e11, friction=0.4)
A = LINE.normal.half_width
LAWS = (PowerWear(2e-13), PowerWear(1e-13))


def close(value, rel=1e-6):
    """Equal numbers, however small: pytest's own allowance of 1e-12 would hide volumes."""
    return pytest.approx(value, rel=rel, abs=0.0)


def wear(x, laws=LAWS, bodies=(0, 1), duration=1.0, repeats=1):
    areas = np.full(len(x), x[1] - x[0])
    profiles = tuple(WornProfiles((WornProfile(x, areas, body == 0),)) for body in bodies)
    return SlipWear(laws, profiles, 0.3, duration, repeats)


def pushed(*forces):
    return [loaded(normal_force=LINE.force, tangential_force=q) for q in forces]


def moved(*places):
    return [loaded(normal_force=LINE.force, tangential_displacement=d) for d in places]


def volumes(x, state):
    return state.worn.sum(axis=1) * (x[1] - x[0])


@pytest.fixture(scope="module")
def partial():
    """Pressed, then three times to and fro within the limit of friction, every cycle for 1000."""
    x, contact = half_plane(LINE, 120)
    *_, pressed = follow(contact, LINE.friction, pushed(0.0), 1, unloaded(contact, 2))
    q = 0.6 * LINE.limit
    corners = pushed(q, *[-q, q] * 3)
    law = wear(x, repeats=1000)
    states = list(follow(contact, LINE.friction, corners, 6, pressed, law))
    return x, contact, [pressed, *states]


def test_volume_is_that_of_the_energy(partial):
    """requirement: V = k/mu E exactly, for each body, in partial slip, whatever the jump."""
    x, contact, states = partial
    lost = contact.weighted.sum(axis=1) @ states[-1].dissipated
    for law, volume in zip(LAWS, volumes(x, states[-1]), strict=True):
        assert volume == close(law.coefficient / LINE.friction * lost, rel=1e-9)
    assert np.all(np.diff([state.worn.sum() for state in states]) >= 0)


def test_what_sticks_does_not_wear(partial):
    """requirement: wear is exactly zero where it has never slipped, and positive where it has."""
    _, _, states = partial
    status = np.array([state.status for state in states[1:]])
    stuck, slips = (status == Status.STICK).all(axis=0), (status == Status.SLIP).any(axis=0)
    depth = states[-1].worn.sum(axis=0)
    assert stuck.sum() > 10
    assert np.all(depth[stuck][1:-1] == 0.0)
    assert np.all(depth[stuck] < 1e-2 * depth.max())
    assert np.all(depth[slips] > 0.0)


def test_without_jumps_it_is_mindlins_energy():
    """requirement: the volume of a cycle is that of the closed form of its energy."""
    x, contact = half_plane(LINE, 240)
    q = 0.6 * LINE.limit
    *_, turned = follow(contact, LINE.friction, pushed(0.0, q), 2, unloaded(contact, 2))
    *_, end = follow(contact, LINE.friction, pushed(-q, q), 10, turned, wear(x))
    expected = LAWS[0].coefficient / LINE.friction * LINE.loss_per_cycle(q)
    assert volumes(x, end)[0] == close(expected, rel=2e-3)


@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (1.0, 2.0), (0.5, 1.0), (2.0, 0.7)])
def test_the_law(a, b):
    """requirement: depth = κ p^b |s|^a t^(1-a), n times; slip without friction is that given."""
    x, contact = half_plane(LINE, 60)
    law = PowerWear(1e-9 / (2.5e8**b * 1e-4**a), b, a)
    start, slid, time = unloaded(contact, 1), 1e-4, 3.0
    *_, pressed = follow(contact, 0.0, moved(0.0), 1, start)
    settings = wear(x, (law,), (1,), time, 2)
    (end,) = follow(contact, 0.0, moved(-slid), 1, pressed, settings)
    expected = 2 * law.coefficient * end.pressure**b * slid**a * time ** (1 - a)
    np.testing.assert_allclose(end.worn[0], expected, rtol=1e-5, atol=1e-7 * expected.max())
    assert 1e-10 < expected.max() < 1e-8


def test_given_displacement_wears_at_the_bound():
    """requirement: full sliding, V = k F 4 d a cycle but for what is elastic."""
    x, contact = half_plane(LINE, 100)
    elastic = 2e-6  # the deflection under mu F is about so much
    d = 500 * elastic
    *_, turned = follow(contact, LINE.friction, moved(0.0, d), 1, unloaded(contact, 1))
    law = wear(x, LAWS[:1], (1,))
    *_, end = follow(contact, LINE.friction, moved(-d, d), 4, turned, law)
    bound = LAWS[0].coefficient * LINE.force * 4 * d
    assert bound * (1 - 4 * elastic / d) < volumes(x, end)[0] < bound


def test_jumps_of_any_size_are_stable():
    """requirement: implicit wear; explicit steps diverge beyond 1.5 h/(k E*) of sliding."""
    x, contact = half_plane(LINE, 100, extent=3.0)
    h, k = x[1] - x[0], 1e-13
    slid = 2e-5
    limit = 1.5 * h / (k * LINE.modulus) / slid  # increments
    *_, pressed = follow(contact, 0.0, moved(0.0), 1, unloaded(contact, 1))
    ends = []
    for jump in (int(0.5 * limit), int(20 * limit)):
        state = pressed
        law = wear(x, (PowerWear(k),), (1,), repeats=jump)
        for _ in range(int(100 * limit) // jump):
            (state,) = follow(contact, 0.0, moved(state.motion[1] + slid), 1, state, law)
            pressing = state.pressure[state.pressure > 0]
            assert np.abs(np.diff(pressing[4:-4], 2)).max() < 0.02 * pressing.max()
        ends.append(state)
    fine, coarse = ends
    assert fine.worn.max() > 3 * A**2 / (2 * LINE.radius)
    assert coarse.worn.max() == close(fine.worn.max(), rel=3e-2)


def rolling(contact, x):
    """The contact of a round body 1: pushed along, its lowest point moves with it."""
    rigid = contact.rigid.copy()
    rigid[0, :, 1] = x / LINE.radius
    modes = contact.modes.copy()
    modes[: len(x), 1] = contact.weighted.T @ rigid[0, :, 1]
    return dataclasses.replace(contact, rigid=rigid, modes=modes)


@pytest.mark.slow
@pytest.mark.parametrize("body", [0, 1])
def test_a_cylinder_that_slides_to_and_fro(body):
    """requirement: rubbing as far as the contact is wide. A cylinder that wears has its scar where
    it touches, and grows as on an endless way; the trough it digs in the other is longer and flat.
    """
    x, contact = half_plane(LINE, 160, extent=6.0)
    contact, k, d, cycles = rolling(contact, x), 1e-15, A, 10
    law = growing_line(LINE.force, LINE.radius, LINE.modulus, k)
    a = 3 * A
    jump = int(law.distance(a) / (cycles * 4 * d))
    settings = wear(x, (PowerWear(k),), (body,), repeats=jump)
    (state,) = follow(contact, 0.0, moved(0.0), 1, unloaded(contact, 1))
    for _ in range(cycles):
        *_, state = follow(contact, 0.0, moved(d, -d, 0.0), 12, state, settings)
    slid = volumes(x, state)[0] / (k * LINE.force)
    assert slid == close(cycles * jump * 4 * d, rel=1e-2)
    depth = state.worn[0]
    width = np.ptp(x[depth > 1e-2 * depth.max()]) / 2
    if body == 0:
        assert depth.max() == close(float(law.elastic_depth(slid)), rel=1e-2)
        assert width == close(a, rel=0.1)
    else:
        assert depth.max() < 0.95 * float(law.elastic_depth(slid))
        assert width > d + A


def test_the_worn_profile_slides_along_at_once():
    """requirement: at the end of an increment the profile lies where the holder has moved it."""
    x, contact = half_plane(LINE, 60)
    bump, d = 2e-8 * np.exp(-((x / (0.3 * A)) ** 2)), 0.25 * A
    state = dataclasses.replace(unloaded(contact, 1), worn=bump[None])
    settings = wear(x, LAWS[:1], (0,), duration=0.0)
    (found,) = follow(contact, 0.0, moved(d), 1, state, settings)
    there = dataclasses.replace(contact, gap=contact.gap + np.interp(x - d, x, bump))
    (known,) = follow(there, 0.0, moved(d), 1, unloaded(contact))
    np.testing.assert_allclose(found.pressure, known.pressure, atol=1e-6 * known.pressure.max())
    assert np.abs(found.pressure - found.pressure[::-1]).max() > 0.05 * found.pressure.max()


def test_wear_with_the_square_of_the_pressure():
    """requirement: b = 2, a long way in a few implicit increments, against quasi-steady growth."""
    x, contact = half_plane(LINE, 120, extent=4.0)
    k, d = 1e-22, 1e-3
    law = growing_line(LINE.force, LINE.radius, LINE.modulus, k, 2.0)
    jump = int(law.distance(3 * A) / (40 * d))
    settings = wear(x, (PowerWear(k, 2.0),), (1,), repeats=jump)
    (state,) = follow(contact, 0.0, moved(0.0), 1, unloaded(contact, 1))
    *_, state = follow(contact, 0.0, moved(40 * d), 40, state, settings)
    expected = float(law.elastic_depth(40 * d * jump))
    assert state.worn.max() == close(expected, rel=3e-2)


@pytest.mark.parametrize("b", [0.5, 2.0])
def test_at_the_end_of_an_increment_the_worn_faces_touch(b):
    """requirement: the pressure is that of the contact of what is left, however much is worn."""
    x, contact = half_plane(LINE, 60, extent=2.5)
    (start,) = follow(contact, 0.0, moved(0.0), 1, unloaded(contact, 1))
    settings = wear(x, (PowerWear(5e-6 / 1e8**b, b),), (1,))
    (end,) = follow(contact, 0.0, moved(1.0), 1, start, settings)
    left = dataclasses.replace(contact, gap=contact.gap + end.worn[0])
    (known,) = follow(left, 0.0, moved(1.0), 1, unloaded(contact))
    assert end.worn.max() > A**2 / LINE.radius
    np.testing.assert_allclose(end.pressure, known.pressure, atol=1e-3 * known.pressure.max())


def test_profiles_slide_along_and_lose_no_volume():
    """requirement: W1(x - s), by linear interpolation, and its adjoint with areas."""
    places, areas = np.array([0.0, 1.0, 1.5, 3.0]), np.array([0.5, 0.75, 1.0, 0.75])
    own = WornProfile(places, areas, True)
    np.testing.assert_allclose(own.interpolation(0.5) @ (2 * places + 1), [1.0, 2.0, 3.0, 6.0])
    for slip in (0.0, 0.3, -0.7, 10.0):
        seen, lost = own.interpolation(slip), own.wear_transfer(slip)
        np.testing.assert_allclose(seen.sum(axis=1), 1.0)
        assert np.all(seen >= 0)
        np.testing.assert_allclose(areas @ lost, areas)
    still = WornProfile(places, areas, False)
    np.testing.assert_array_equal(still.interpolation(0.5), np.eye(4))


def test_nothing_wears_in_no_time():
    """requirement: the bodies are put together at the first instant without wear."""
    x, contact = half_plane(LINE, 40)
    law = wear(x, duration=0.0)
    for state in follow(contact, LINE.friction, moved(0.0, 1e-5), 2, unloaded(contact, 2), law):
        assert not state.worn.any()
    assert state.dissipated.max() > 0


def test_halved_increments_wear_as_much():
    """requirement: where an increment is halved, each half has half the time."""
    x, _ = half_plane(LINE, 20)
    law = wear(x, (PowerWear(1e-13, 1.0, 0.5),), (1,), 2.0, 3)
    pressure = np.full(20, 1e7)
    whole = law.depths(pressure, np.full(20, 1e-5))
    halves = 2 * law.halved().depths(pressure, np.full(20, 0.5e-5))
    np.testing.assert_allclose(whole, halves)


def test_corners_may_be_followed_one_by_one(partial):
    """requirement: a state remembers all it needs."""
    x, contact, states = partial
    q = 0.6 * LINE.limit
    law = wear(x, repeats=1000)
    state = states[0]
    for corner in pushed(q, -q):
        *_, state = follow(contact, LINE.friction, [corner], 6, state, law)
    np.testing.assert_allclose(state.worn, states[12].worn, rtol=1e-9, atol=1e-20)
    later = [s.worn.sum() for s in states[1::6]]
    assert all(b > a for a, b in itertools.pairwise(later))


def test_a_law_of_ones_own_is_asked():
    """requirement: a wear law that somebody derives is used, in fretting, too."""

    class Doubled(PowerWear):
        def value(self, at):
            return 2 * super().value(at)

        def slope(self, at):
            return 2 * super().slope(at)

    x, p, slip = np.linspace(0, 1, 5), np.full(5, 1e6), np.full(5, 1e-6)
    plain, doubled = (wear(x, (law(2e-13),), (0,)) for law in (PowerWear, Doubled))
    assert doubled.depths(p, slip) == close(2 * plain.depths(p, slip), rel=1e-14)
    assert doubled.slopes(p, slip) == close(2 * plain.slopes(p, slip), rel=1e-14)
