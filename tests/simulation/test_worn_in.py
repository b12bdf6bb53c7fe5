"""Worn faces that fit at every point where they press."""

import numpy as np
import pytest

from thermowear.simulation.from_case import run
from thermowear.verification.check import run_starter, starter

RING = "annular-punch-running-in", "mesh.degree=6", "mesh.elements=4"
END = "analysis.end_time=4000 s", "analysis.output_times=[]", "analysis.tolerance=1e-3"
STEADY = 'analysis={type="steady"}'
AREA = np.pi * (0.12**2 - 0.02**2)


@pytest.fixture(scope="module")
def worn():
    return run_starter(*RING, *END, "wear.update=0.01")


def test_deep_wear_leaves_no_ripples_that_the_pressure_does_not_see(worn):
    """requirement: the shape worn deep is that of the principle, of a lower ring, at each point."""
    height = 0.05 - worn.summary["geometry_volume_1_m3"] / AREA
    low = run(starter(RING[0], *RING[1:], f"geometry.punch_height={height!r} m", STEADY))
    found, known = (
        r.interface.shape - np.average(r.interface.shape, weights=r.interface.weight)
        for r in (worn, low)
    )
    # without it: a twentieth
    assert np.abs(found - known).max() < 5e-3 * np.ptp(known)


def test_a_lower_body_stands_on_the_other_one(worn):
    """requirement: fields are shown on bodies that touch; their displacement is a small one."""
    fields = worn.fields
    height = fields.points[fields.body == 1][..., 1]
    depth = worn.summary["geometry_volume_1_m3"] / AREA
    assert depth > 5e-3
    assert height.min() == pytest.approx(0.0, abs=0.02 * depth)
    assert height.max() == pytest.approx(0.05 - depth, abs=0.02 * depth)
    # what is kept in the gap since the last update, and the elastic approach
    assert np.abs(fields.displacement).max() < 0.2 * depth
