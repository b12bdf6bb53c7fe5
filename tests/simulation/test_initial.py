"""Contact of the unworn faces."""

import numpy as np
import pytest

import thermowear as tw

from ..conftest import HOT, at, cold_tables


def test_flat_ring():
    """requirement: 8T at t = 0, within 0.2 % away from the edges, singular there."""
    case = tw.load(cold_tables(), ("analysis.type=initial",))
    i = tw.run(case).interface
    radii = np.array([25, 40, 70, 100, 115]) * 1e-3
    pressure = at(i, radii, i.pressure) / 1e6
    assert pressure == pytest.approx([54.84, 48.89, 48.07, 47.60, 52.49], rel=2e-3)
    assert i.pressure[0] > 2 * i.pressure[50] < i.pressure[-1]
    assert np.all(i.wear_1 == 0)


def test_separated_edge_under_heat():
    """requirement: friction heat lifts part of the face off; no pressure where open."""
    result = tw.run(tw.load(HOT, ("analysis.type=initial", "mesh.degree=5")))
    i, summary = result.interface, result.summary
    open_points = i.pressure == 0
    assert 0.05 < open_points.mean() < 0.95
    assert i.gap[open_points].max() > 1e-6
    assert i.gap.min() > -1e-2 * i.gap.max()  # weak contact: the mean is what does not penetrate
    assert i.pressure.min() >= 0
    area = i.weight[i.pressure > 0].sum()
    assert area < 0.9 * i.weight.sum()
    assert summary["contact_area_m2"] == pytest.approx(area, rel=1e-12)
    assert summary["mean_pressure_Pa"] == pytest.approx(summary["normal_force_N"] / area, rel=1e-12)
    assert i.weight @ i.pressure == pytest.approx(50e6 * np.pi * (0.12**2 - 0.02**2), rel=1e-9)


@pytest.mark.parametrize("steps", [(2, 3)])
def test_symmetry_of_load(steps):
    """requirement: contact of held elastic faces in full contact is linear in the load."""
    low, high = (
        tw.run(
            tw.load(
                cold_tables(),
                ("analysis.type=initial", "mesh.degree=3", f'load.mean_pressure="{10 * s} MPa"'),
            )
        )
        for s in steps
    )
    np.testing.assert_allclose(
        high.interface.pressure / 3,
        low.interface.pressure / 2,
        rtol=1e-9,
        atol=1e-9 * low.interface.pressure.max(),
    )
