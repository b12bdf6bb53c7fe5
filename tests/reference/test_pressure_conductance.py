"""Two blocks whose contact conducts better under pressure, against a linear system."""

import numpy as np
import pytest

from thermowear.reference.heat import conductance, contact_temperatures, harmonic_mean

LENGTHS, CONDUCTIVITIES, HARDNESSES = (0.01, 0.02), (50.0, 15.0), (2e9, 3e9)
ENDS, COEFFICIENT, HEAT = (400.0, 300.0), 1.25e5, 1e5


def test_softer_and_worse_conducting_body_decides():
    """requirement: means of both materials, nearer to the smaller one; proportional to pressure."""
    assert harmonic_mean(3.0, 3.0) == pytest.approx(3.0)
    assert harmonic_mean(1.0, 1e9) == pytest.approx(2.0)
    h = conductance(COEFFICIENT, CONDUCTIVITIES, HARDNESSES, 10e6)
    assert h == pytest.approx(1.25e5 * (1500 / 65) * 10e6 / 2.4e9, rel=1e-12)
    assert conductance(COEFFICIENT, CONDUCTIVITIES, HARDNESSES, 20e6) == pytest.approx(2 * h)


@pytest.mark.parametrize("pressure", [1e3, 1e6, 1e8])
@pytest.mark.parametrize("partition", [0.0, 0.5, 0.9])
def test_temperatures(pressure, partition):
    """requirement: heat that flows through each block is what its face gets."""
    h = conductance(COEFFICIENT, CONDUCTIVITIES, HARDNESSES, pressure)
    (T1, T2), _ = contact_temperatures(LENGTHS, CONDUCTIVITIES, ENDS, HEAT, partition, h)
    a, b = (k / length for k, length in zip(CONDUCTIVITIES, LENGTHS, strict=True))
    heated = [a * ENDS[0] + partition * HEAT, b * ENDS[1] + (1 - partition) * HEAT]
    expected = np.linalg.solve([[a + h, -h], [-h, b + h]], heated)
    np.testing.assert_allclose((T1, T2), expected, rtol=1e-12)
