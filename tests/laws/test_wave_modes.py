"""Critical speeds and growth of waves of small systems with known modes."""

import numpy as np
import pytest
import scipy.sparse as sp

from thermowear.laws.waves import (
    WaveEquations,
    WaveHeat,
    WornBody,
    at_speed,
    first_critical,
    growing,
    lowest,
    with_wear,
)


def equations(gains=(1.0,), turning=0.0, wear=0.0, frames=(0.0,), worn_turning=0.0):
    """Modes with ``1 + V w/s = V g/(1 + s + i V ω)``, one for each gain g."""
    n = len(gains)
    identity = np.eye(n)
    return WaveEquations(
        elastic=identity,
        heat=WaveHeat(
            opening=-identity,
            heated=np.diag(gains),
            conducted=sp.eye(n, format="csc"),
            stored=sp.eye(n, format="csc"),
            turning=np.full(n, turning),
        ),
        worn=(WornBody(wear * identity, worn_turning),) if wear else (),
        slowest=1.0,
        frames=frames,
    )


def test_critical_speed_and_growth():
    """requirement: s = V - 1 of a single mode."""
    one = equations()
    mode = first_critical(one, 0.3)
    assert mode.factor == pytest.approx(1.0, rel=1e-10)
    assert abs(mode.rate) < 1e-10
    for factor in (0.6, 2.0):
        assert at_speed(one, mode, factor).rate == pytest.approx(factor - 1.0, rel=1e-9)


def test_wave_that_is_carried_along():
    """requirement: s = V - 1 - i V ω where the hot body moves."""
    moving = equations(turning=3.0, frames=(0.0, 3.0))
    mode, complete = lowest(moving, first_critical(moving, 0.3), 0.01)
    assert complete
    assert mode.factor == pytest.approx(1.0, rel=1e-9)
    assert mode.rate == pytest.approx(-3j, rel=1e-9)
    assert [growing(moving, factor) for factor in (0.98, 1.02)] == [0, 1]


def test_negative_gains_do_not_grow():
    """requirement: the critical speed is that of the largest gain, not of its magnitude."""
    mode = first_critical(equations((1.0, -5.0)), 0.3)
    assert mode.factor == pytest.approx(1.0, rel=1e-10)


def test_temperatures_and_opening_of_heat():
    """
    requirement: (K + (s + i V ω) M) θ = V Q and B θ of full matrices, also where K and M have
    different patterns, with zeros among their entries.
    """
    random, n = np.random.default_rng(4), 12
    coupled = sp.random(n, n, 0.2, random_state=random)
    conducted = (coupled + coupled.T + 5 * sp.eye(n)).tocoo()
    rows, columns = random.integers(0, n, (2, 8))  # of zeros
    rows, columns = np.append(conducted.row, rows), np.append(conducted.col, columns)
    values, diagonal = np.append(conducted.data, np.zeros(8)), np.append(np.arange(n), 0)
    heat = WaveHeat(
        opening=random.random((2, n)),
        heated=random.random((n, 3)),
        conducted=sp.csc_matrix((values, (rows, columns)), (n, n)),
        stored=sp.csc_matrix((np.append(random.random(n), 0.0), (diagonal, diagonal)), (n, n)),
        turning=random.random(n),
    )
    factor, rate = 1.3, 0.3 + 0.7j
    moved = (rate + 1j * factor * heat.turning[:, None]) * heat.stored.toarray()
    expected = np.linalg.solve(heat.conducted.toarray() + moved, factor * heat.heated)
    np.testing.assert_allclose(heat.temperatures(factor, rate), expected, rtol=1e-11)
    np.testing.assert_allclose(heat.opened(factor, rate), heat.opening @ expected, rtol=1e-11)


def test_number_of_growing_waves():
    """requirement: each gain g adds a growing wave from V = 1/g."""
    three = equations((1.0, 2.0, 5.0))
    assert [growing(three, V) for V in (0.19, 0.21, 0.6, 1.1)] == [0, 1, 2, 3]


@pytest.mark.parametrize("start", [None, 1.0, 0.5])
def test_lowest_of_several(start):
    """requirement: found from a higher mode, or from none."""
    three = equations((1.0, 2.0, 5.0))
    candidate = None
    if start is not None:
        candidate = at_speed(three, first_critical(three), 0.2)
        candidate = type(candidate)(start, 0j, np.eye(3)[round(1 / start) - 1] + 0j)
    mode, complete = lowest(three, candidate, 0.01)
    assert complete
    assert mode.factor == pytest.approx(0.2, rel=1e-9)


def test_no_growth():
    """requirement: bodies that contract where they are hot have no critical speed."""
    cold = equations((-1.0,))
    assert first_critical(cold) is None
    assert lowest(cold, None) == (None, True)


@pytest.mark.parametrize("wear", [1e-3, 0.2])
def test_wear_makes_waves_swing(wear):
    """requirement: V = 1/(1 - w) and ω² = V w at the critical speed."""
    worn = equations(wear=wear)
    mode = with_wear(worn, first_critical(worn))
    assert mode.factor == pytest.approx(1 / (1 - wear), rel=1e-8)
    assert mode.rate.imag**2 == pytest.approx(wear / (1 - wear), rel=1e-7)
    assert with_wear(worn.without_wear, first_critical(worn)).factor == pytest.approx(1.0)


def test_a_body_that_carries_heat_and_wear_along():
    """requirement: waves at rest on the moving body, seen as s - i V ω from the reference body."""
    wear = 0.02
    rest = equations(wear=wear)
    plain = first_critical(rest.without_wear, 0.3)
    moving = equations(turning=3.0, wear=wear, frames=(0.0, 3.0), worn_turning=3.0)
    for factor in (1.2, 2.0):
        known = at_speed(rest, with_wear(rest, plain), factor)
        gain, _ = moving.gains(factor, known.rate - 3j * factor).like(known.shape)
        assert gain == pytest.approx(1.0, abs=1e-9)
