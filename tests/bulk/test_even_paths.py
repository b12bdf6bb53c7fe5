"""Bodies so fast that heat is spread along their way."""

import numpy as np
import pytest

from thermowear.bulk.heat.advection import Passage

from .passing import COMM, INNER, OUTER, STEEL, conducting, largest, ring, strip, total, turning

K, C = STEEL.conductivity, STEEL.capacity
FAST = turning(1.0, spread=True)


def places(conduction):
    return conduction.spaces.nodes().T


def spot(conduction, angle=1.0):
    """Heat on a small part of the rim, 1 W in all."""
    x, y = places(conduction)
    far = np.hypot(x - OUTER * np.sin(angle), y - OUTER * np.cos(angle))
    heat = np.where(np.hypot(x, y) > OUTER * (1 - 1e-6), np.exp(-((far / 3e-3) ** 2)), 0.0)
    return heat / total(heat)


def radial(r, h):
    """Rise of a ring that 1 W enters at the rim and leaves by cooling at the bore."""
    return (1 / (h * INNER) + np.log(r / INNER) / K) / (2 * np.pi)


@pytest.mark.parametrize(("degree", "rows", "allowed"), [(1, 16, 2e-3), (2, 6, 1e-4), (6, 3, 2e-6)])
def test_a_ring_heated_in_one_place(degree, rows, allowed):
    """requirement: radial solution for any degree, uniform along paths to rounding."""
    h = 2e3
    even = conducting(ring(rows=rows), degree, FAST, cooling={"ring_bore": h})
    rise, (x, y) = even.respond(spot(even)), places(even)
    exact = radial(np.hypot(x, y), h)
    assert largest(rise - exact) < allowed * largest(exact)
    rim = np.hypot(x, y) > OUTER * (1 - 1e-6)
    rims = np.concatenate(COMM.allgather(rise[rim]))
    assert np.ptp(rims) == 0.0
    losses = even.losses(rise, spot(even))
    assert losses[0] == pytest.approx(1.0, rel=1e-10)
    assert losses[1:] == (0.0, 0.0)


def test_given_temperatures_hold_all_along_a_path():
    """requirement: prescribed temperature of a bore, with heat balance."""
    even = conducting(ring(), 6, FAST, {"ring_bore": 7.0})
    rise, (x, y) = even.solve(spot(even)), places(even)
    exact = 7.0 + np.log(np.hypot(x, y) / INNER) / K / (2 * np.pi)
    assert largest(rise - exact) < 1e-5
    assert even.losses(rise, spot(even))[1] == pytest.approx(1.0, rel=1e-9)


def test_a_strip_that_runs_fast():
    """requirement: uniform along x, one-dimensional conduction across."""
    passage = Passage(("strip",), None, -5.0, spread=True)
    even = conducting(strip(), 3, passage, cooling={"strip_bottom": 1e3})
    x, y = places(even)
    top = y > 0.01 - 1e-9
    heat = np.where(top & (x < 0.005), 1.0, 0.0)
    heat = heat / total(heat)
    rise = even.respond(heat)
    np.testing.assert_allclose(rise, 1 / 0.02 * (1 / 1e3 + y / K), rtol=1e-11)
    # given on a part of the way: it holds all along it
    even = conducting(strip(), 3, passage, {"strip_left": 3.0})
    np.testing.assert_allclose(even.solve(0 * heat), 3.0, rtol=1e-12)


def test_what_is_sensed_and_stored():
    """requirement: adjoint solution; heat of a time step equals storage plus cooling."""
    even = conducting(ring(), 4, FAST, {}, {"ring_bore": 1e3}).implicit_euler(0.2)
    rng = np.random.default_rng(3)
    heat, weights = rng.normal(size=(2, even.spaces.owned, 3))
    forward = COMM.allreduce(weights.T @ even.respond(heat))
    np.testing.assert_allclose(
        COMM.allreduce(even.adjoint_response(weights).T @ heat), forward, rtol=1e-9
    )
    one = spot(even)
    rise = even.respond(one)
    kept = total(even.stored_heat(rise)) / 0.2
    x, y = places(even)
    cooled = 1 - kept
    bore = rise[np.hypot(x, y) < INNER * (1 + 1e-6)]
    assert cooled == pytest.approx(1e3 * 2 * np.pi * INNER * bore.mean(), rel=1e-5)
    assert np.ptp(bore) == 0.0
