"""Face seals: coning by heat, and the side that opens after another speed."""

import numpy as np
import pytest

from thermowear.case import load
from thermowear.reference import heat as reference
from thermowear.verification.cases.assembly.face_seal import (
    AFTER,
    FORCE,
    HEIGHT,
    INNER,
    OUTER,
    coning,
    opening,
    tables,
)
from thermowear.verification.check import computed


def test_a_free_ring_is_free_of_stress():
    """requirement: the closed form has the strains alpha G z and no shear; its mean slope."""
    z, r, step, expansion, gradient = 0.013, 0.028, 1e-6, 5e-6, -1e3

    def u(r, z):
        return expansion * gradient * np.array([r * z, (z**2 - r**2) / 2])

    by_r = (u(r + step, z) - u(r - step, z)) / (2 * step)
    by_z = (u(r, z + step) - u(r, z - step)) / (2 * step)
    strain = expansion * gradient * z
    assert [by_r[0], u(r, z)[0] / r, by_z[1]] == pytest.approx([strain] * 3, rel=1e-6)
    assert by_r[1] + by_z[0] == pytest.approx(0.0, abs=1e-9 * abs(strain))
    ends = reference.face_deflection(np.array([INNER, OUTER]), expansion, gradient)
    slope = np.diff(ends)[0] / (OUTER - INNER)
    turned = reference.rotation(INNER, OUTER, expansion, gradient)
    assert slope == pytest.approx(turned, rel=1e-12)


def test_coning():
    """requirement: uniform heat, and the rotation of free rings within 1 %."""
    checks = list(coning(elements=4))
    assert len(checks) == 6
    assert not [check for check in checks if not check.passed]


@pytest.mark.parametrize("side", AFTER)
def test_a_change_of_speed_opens_the_seal(side):
    """requirement: parallel faces after the running-in; faster opens outside, slower inside."""
    checks = list(opening(side, elements=6))
    assert len(checks) == 4
    assert not [check for check in checks if not check.passed]


def test_fluid_around_the_ring():
    """
    requirement: pressure on the outside leaves the force alone; the ring shrinks as Lamé's tube,
    and, free of bending, does not turn.
    """
    given, pressure = tables(elements=4), 1e6
    still = computed(load(given))
    wet = computed(load(given | {"load": {"pressure": {"ring_outside": f"{pressure} Pa"}}}))
    forces = [r.summary["contacts"]["ring-seat"]["normal_force_N"] for r in (wet, still)]
    assert forces == pytest.approx([FORCE] * 2, rel=1e-9)
    np.testing.assert_allclose(wet.interface.pressure, still.interface.pressure, rtol=1e-9)
    turned = np.ptp(wet.interface.shape - still.interface.shape)
    assert turned < 1e-3 * np.ptp(still.interface.shape)
    points, moved = still.fields.points, wet.fields.displacement - still.fields.displacement
    rim = np.isclose(points[..., 0], OUTER) & (np.abs(points[..., 1] / HEIGHT - 0.5) < 0.1)
    assert rim.sum() > 5
    squares = OUTER**2, INNER**2
    factor = (squares[0] + squares[1]) / (squares[0] - squares[1]) - 0.2
    lame = -pressure * OUTER / 20e9 * factor
    assert moved[rim][:, 0] == pytest.approx(lame, rel=4e-2)  # both ends still add e^-3
