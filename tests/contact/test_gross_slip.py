"""Gross slip under forces in two directions and a torque."""

import dataclasses

import numpy as np
import pytest

from thermowear.contact.friction.coulomb import CoulombProblem
from thermowear.contact.friction.gross_slip import FullSliding, check_gross_slip
from thermowear.contact.operators.rigid_motion import HeldMotion
from thermowear.laws.motions import rotation, translation

M, MU, PRESS = 400, 0.3, 1000.0
PRESSES = np.array([True, False, False, False])
SLIDES = np.array([1, 2, 3])


def ring(force, slides=SLIDES):
    """A stiff ring of the radius 2 under a uniform pressure; forces (x, y, torque)."""
    angle = np.linspace(0, 2 * np.pi, M, endpoint=False)
    x, y = 2 * np.cos(angle), 2 * np.sin(angle)
    modes = np.zeros((3 * M, 4))
    modes[:M, 0] = 1.0
    modes[M : 2 * M, 1], modes[2 * M :, 2] = -1.0, -1.0
    modes[M : 2 * M, 3], modes[2 * M :, 3] = y, -x  # a turn about z
    compliance, every = 1e-12 * np.eye(3 * M), np.array([0, *slides])
    problem = CoulombProblem(
        compliance, np.zeros(3 * M), modes[:, every], np.array([PRESS, *force]), np.full(M, MU)
    )
    return problem, PRESSES[every], np.arange(1, len(every))


def held(own):
    """Motions for the messages."""
    moved = translation((1, 0, 0)), translation((0, 1, 0)), rotation((0, 0, 1), (0, 0, 0))
    return [HeldMotion(moved[k - 1], holder="it") for k in own]


def carried(force, slides=SLIDES):
    """Part of forces beyond the limit that friction carries, as the message says."""
    problem, presses, own = ring([1e3 * f for f in force], slides)
    with pytest.raises(FullSliding) as refused:
        check_gross_slip(problem, presses, own, held(own))
    return 1e3 * float(str(refused.value).partition("carries ")[2].split()[0])


@pytest.mark.parametrize("angle", [0.0, 0.6, 2.5])
def test_friction_opposes_the_force_in_any_direction(angle):
    """requirement: the limit is mu P whatever the direction, not mu P along each axis."""
    force = MU * PRESS * np.array([np.cos(angle), np.sin(angle), 0.0])
    assert carried(force) == pytest.approx(1.0, rel=1e-5)
    assert carried(force[:2], SLIDES[:2]) == pytest.approx(1.0, rel=1e-5)
    problem, presses, own = ring(0.999 * force)
    check_gross_slip(problem, presses, own, held(own))


def test_torque():
    """requirement: a torque alone up to mu P r."""
    assert carried((0.0, 0.0, MU * PRESS * 2.0)) == pytest.approx(1.0, rel=1e-5)


def test_force_and_torque_share_the_friction():
    """requirement: together they are carried up to a limit surface: less than each alone, and more
    than their sum (the limit surface is convex and smooth).
    """
    both = MU * PRESS * np.array([1.0, 0.0, 0.8])
    assert 1 / (1 + 0.8 / 2) < carried(both) < 0.95
    # the ring turns about a pole at a distance d: minimum over d of ∫|r - d| mu p / (F·v)
    angle, d = np.linspace(0, 2 * np.pi, 4001), np.linspace(0.01, 40, 4000)
    power = np.array([np.hypot(2 * np.cos(angle), 2 * np.sin(angle) - s).mean() for s in d])
    assert carried(both) == pytest.approx((power / (0.8 + d)).min(), rel=1e-3)


def test_nothing_asked_is_carried():
    """requirement: no force, no sliding."""
    problem, presses, own = ring((0.0, 0.0, 0.0))
    check_gross_slip(problem, presses, own, held(own))


def test_without_friction_nothing_is_carried():
    """requirement: refused with the load and its unit, also before the load grows."""
    for slides, text in (
        (SLIDES[:1], "carries 0 N, and the tangential force is 0 N"),
        (SLIDES, "carries 0 times the tangential forces and torques"),
    ):
        problem, presses, own = ring((0.0, 0.0, 0.0)[: len(slides)], slides)
        problem = dataclasses.replace(problem, friction=np.zeros(M))
        with pytest.raises(FullSliding, match=text):
            check_gross_slip(problem, presses, own, held(own))


def test_a_torque_has_its_own_unit():
    """requirement: N m, and a twist as the remedy."""
    problem, presses, own = ring((0.0, 0.0, 1e4))
    with pytest.raises(FullSliding, match=r"carries 600 N m, and the torque is 10000 N m\. Give a"):
        check_gross_slip(problem, presses, own[2:], held(own)[2:])
