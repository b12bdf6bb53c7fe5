"""Two blocks between planes of symmetry that slide across the section."""

import numpy as np
import pytest

from thermowear.reference.heat import contact_temperatures

from ..case.starter import GONE, solved

BLOCKS = "stacked-blocks"
COLD = 293.15
PRESSURE, HEAT = 5e6, 0.2 * 5e6 * 0.1


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"model": "plane-stress"},
        {"mesh.bodies": {"lower": {"elements": 4}}},
        {"motion.velocity": "-0.1 m/s"},
    ],
)
def test_heat_flows_straight(changes):
    """requirement: pressure and temperature are even, as between slabs; friction drags nothing."""
    result = solved(BLOCKS, changes)
    interface, summary = result.interface, result.summary
    np.testing.assert_allclose(interface.pressure, PRESSURE, rtol=1e-8)
    expected, fluxes = contact_temperatures(
        (0.01, 0.02), (50.0, 15.0), (COLD, COLD), HEAT, 0.5, 1e4
    )
    temperatures = interface.temperature_1, interface.temperature_2
    for found, known in zip(temperatures, expected, strict=True):
        np.testing.assert_allclose(found, known, rtol=0, atol=1e-8)
    for found, known in zip((interface.heat_flux_1, interface.heat_flux_2), fluxes, strict=True):
        np.testing.assert_allclose(found, known, rtol=1e-8)
    assert summary["friction_force_N"] == pytest.approx(0.2 * summary["normal_force_N"])
    assert summary["normal_force_N"] == pytest.approx(PRESSURE * 1e-4)
    assert summary["guide_force_N"] == summary["guide_moment_Nm"] == 0.0
    assert summary["shape_range_m"] < 1e-15


def test_blocks_are_held_sideways():
    """requirement: planes of symmetry let nothing spread; they shorten by less than columns."""
    result = solved(BLOCKS, {"analysis": {"type": "initial"}, "heat": GONE})
    modulus = [E * (1 - ν) / ((1 + ν) * (1 - 2 * ν)) for E, ν in ((210e9, 0.3), (200e9, 0.3))]
    shortened = PRESSURE * (0.01 / modulus[0] + 0.02 / modulus[1])
    assert result.summary["approach_m"] == pytest.approx(shortened, rel=1e-6)
