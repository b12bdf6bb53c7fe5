"""Loads that no wear carries, and why."""

import numpy as np
import pytest

from thermowear import ComputationError
from thermowear.laws import NotCarried, PowerWear, SelfLocking, contact_patch, rotation, translation

from .random_problems import curved_face

Z, LENGTH = 0.1 + 0.05 * np.polynomial.legendre.leggauss(30)[0], 0.1
AREA = 0.05 * np.polynomial.legendre.leggauss(30)[1] * 0.01


def block(friction, sense, motions=None, offset=0.04):
    """A block against a strip, on a lever about the origin."""
    motions = motions or [rotation((0, 1, 0), (0, 0, 0))]
    return contact_patch(
        np.column_stack([np.full(30, offset), 0 * Z, Z]), AREA, (1, 0, 0), motions, 1.0,
        friction, (0, 0, -sense),
    )  # fmt: skip


def locking_friction(b):
    """Friction coefficient mu for which ``∫ (z - mu l) z^(1/b) dz`` vanishes."""
    return AREA @ Z ** (1 + 1 / b) / (0.04 * (AREA @ Z ** (1 / b)))


@pytest.mark.parametrize("b", [0.3, 0.5, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("beyond", [1e-6, 0.01, 0.3, 3.0])
def test_lever_locks_in_one_sense(b, beyond):
    """requirement: I <= 0 is reported as self-locking; the other sense never locks."""
    friction = locking_friction(b)
    law = [PowerWear(1e-13 * 1e6 ** (1 - b), b)]
    with pytest.raises(SelfLocking, match="self-locking: friction carries any load"):
        block(friction * (1 + beyond), -1).steady([200.0], law)
    steady = block(friction * (1 + beyond), 1).steady([200.0], law)
    assert steady.velocity[0] > 0


@pytest.mark.parametrize("b", [0.3, 0.5, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("before", [1e-6, 1e-3, 0.1])
def test_just_before_it_locks_there_is_a_pressure(b, before):
    """requirement: up to the limit the closed form is found, however large the pressure."""
    friction = locking_friction(b) * (1 - before)
    steady = block(friction, -1).steady([200.0], [PowerWear(1e-13 * 1e6 ** (1 - b), b)])
    integral = AREA @ ((Z - friction * 0.04) * Z ** (1 / b))
    np.testing.assert_allclose(
        steady.pressure, 200.0 / integral * Z ** (1 / b), rtol=1e-13 / before + 1e-11
    )


def test_one_line():
    """requirement: a clear message of one line, and a computation error (exit code 2)."""
    with pytest.raises(ComputationError) as caught:
        block(5.0, -1).steady([200.0], [PowerWear(1e-13)])
    assert "\n" not in str(caught.value)
    assert "lower the friction" in str(caught.value)


def test_pulled_off_is_not_self_locking():
    """requirement: a load that opens the contact is told from one that friction carries."""
    for friction in (0.0, 0.3, 5.0):
        for sense in (1, -1):
            with pytest.raises(NotCarried, match="no contact pressure is in equilibrium"):
                block(friction, sense).steady([-200.0], [PowerWear(1e-13)])


TILTING = [translation((1, 0, 0)), rotation((0, 1, 0), (0, 0, 0.1))]


def test_outside_the_face_is_not_self_locking():
    """requirement: a moment beyond the edge of the face tips the block, with or without friction.

    The lever arm of the load from the middle is at most half the length; friction adds ``mu h``.
    """
    for sense in (1, -1):
        for friction in (0.0, 0.5):
            patch = block(friction, sense, TILTING)
            shift = sense * friction * 0.04
            half = Z.max() - 0.1  # of the outermost points
            for arm in (half * 0.95, -half * 0.95):
                patch.steady([1e3, 1e3 * (arm + shift)], [PowerWear(1e-13)])
            for arm in (half * 1.01, -half * 1.01):
                with pytest.raises(NotCarried):
                    patch.steady([1e3, 1e3 * (arm + shift)], [PowerWear(1e-13)])


def winding(patch, law):
    """Winding number of the load over one revolution of the wear velocity of two motions."""
    φ = np.linspace(-np.pi, np.pi, 1001)
    R, T = patch.normal_modes, patch.force_modes
    scale = np.abs(R).max(axis=0)
    rate = (R / scale) @ np.array([np.cos(φ), np.sin(φ)])
    pressure = (np.maximum(rate, 0.0) / law.factor(patch.speed)[:, None]) ** (
        1 / law.pressure_exponent
    )
    loads = (T / scale).T @ (patch.weights[:, None] * pressure)
    angle = np.unwrap(np.arctan2(loads[1], loads[0]))
    return round((angle[-1] - angle[0]) / (2 * np.pi))


def test_locks_where_the_topology_says():
    """requirement: self-locking is recognised in general.

    With two motions that turn a face round, any load is carried by some direction of wear as long
    as loads turn once while directions do; where friction has taken that turn away, some are not.
    """
    rng = np.random.default_rng(12)
    turned, lost = 0, 0
    for _ in range(14):
        patch, _, laws = curved_face(rng, friction=1.5, eccentric=0.0, motions=3)
        pivot = (*rng.uniform(-0.3, 0.3, 2), rng.uniform(0.0, 1.5))
        motions = [rotation((1, 0, 0), pivot), rotation((0, 1, 0), pivot)]
        patch = contact_patch(
            patch.points, patch.weights, patch.normals, motions, patch.speed, 1.0,
            patch.traction - patch.normals,
        )  # fmt: skip
        turns = winding(patch, laws[0])
        outcomes = set()
        for φ in np.linspace(0, 2 * np.pi, 8, endpoint=False):
            scale = np.abs(patch.normal_modes).max(axis=0)
            load = scale * np.array([np.cos(φ), np.sin(φ)])
            try:
                patch.steady(load, laws[:1])
                outcomes.add("worn")
            except SelfLocking:
                outcomes.add("locked")
        if turns == 1:
            assert outcomes == {"worn"}
            turned += 1
        else:
            assert "locked" in outcomes
            lost += 1
    assert turned > 5
    assert lost > 1
