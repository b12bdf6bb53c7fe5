"""A slab heated on one side, insulated on the other."""

import numpy as np
import pytest
from scipy.special import erfc

from thermowear.reference.heat import HalfSpace

from .heated_slab import HeatedSlab

SLAB = HeatedSlab(0.03, 50.0, 7800 * 460.0)
DEEP = HalfSpace(50.0, 7800 * 460.0)
DEPTHS = np.linspace(0.0, 0.03, 4001)


def test_early_it_is_a_half_space():
    """requirement: before heat has come to the other side, that side makes no difference."""
    z, time = DEPTHS[1:500:50], 0.5
    reach = 2 * np.sqrt(DEEP.diffusivity * time)
    np.testing.assert_allclose(SLAB.flux(1e5, time, z), DEEP.rise(1e5, time, z), rtol=1e-4)
    np.testing.assert_allclose(SLAB.step(7.0, time, z), 7.0 * erfc(z / reach), rtol=1e-9)


@pytest.mark.parametrize("time", [0.5, 5.0, 60.0])
def test_heat_is_what_has_come_in(time):
    """requirement: the integral over the depth: q t of a flux, and the stated one of a ramp."""
    flux = np.trapezoid(SLAB.flux(1e5, time, DEPTHS), DEPTHS) * SLAB.capacity
    ramp = np.trapezoid(SLAB.ramp(2.0, time, DEPTHS), DEPTHS) * SLAB.capacity
    assert flux == pytest.approx(1e5 * time, rel=1e-4)
    assert ramp == pytest.approx(SLAB.ramp_heat(2.0, time), rel=1e-4)


def test_a_ramp_is_the_sum_of_its_steps():
    """requirement: Duhamel: the ramp's derivative in time is the response to a step."""
    z, time, δ = DEPTHS[::400], 7.0, 1e-4
    slope = (SLAB.ramp(2.0, time + δ, z) - SLAB.ramp(2.0, time - δ, z)) / (2 * δ)
    np.testing.assert_allclose(slope, SLAB.step(2.0, time, z), rtol=1e-6, atol=1e-9)
