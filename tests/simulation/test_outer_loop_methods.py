"""Running-in with moved meshes, contact solved on all nodes by penalty or Nitsche's method."""

import numpy as np
import pytest

from thermowear.verification.check import run_starter

SMALL = ("mesh.degree=4", "mesh.elements=4", "wear.update=0.01")
CASES = {
    "cold": (
        "annular-punch-running-in",
        *SMALL,
        'analysis={type="transient", end_time="2000 s", tolerance=1e-2}',
    ),
    "hot": (
        "annular-punch",
        *SMALL,
        'analysis={type="transient", end_time="4e4 s", tolerance=1e-2}',
    ),
}
AREA = np.pi * (0.12**2 - 0.02**2)
METHODS = ("penalty", "nitsche")
WITHIN = {"pressure": 1e-3, "wear_1": 3e-5, "shape": 1e-3, "temperature_1": 3e-4}
"""Mean differences, by the largest value, of shapes by their range."""


@pytest.fixture(scope="module", params=["cold", pytest.param("hot", marks=pytest.mark.slow)])
def worn(request):
    """Some hundredths of the height of the ring worn off, by each method."""
    case = CASES[request.param]
    methods = ("condensed", *METHODS)
    return {method: run_starter(*case, f"contact.method={method}") for method in methods}


@pytest.mark.parametrize("method", METHODS)
def test_all_methods_lose_the_same(worn, method):
    """requirement: the same loop for penalty and Nitsche; meshes lose what is worn off."""
    ours, theirs = worn[method].summary, worn["condensed"].summary
    assert worn[method].stopped is None
    assert ours["geometry_updates"] >= 2
    assert ours["geometry_volume_error"] < 1e-6
    assert ours["geometry_volume_1_m3"] > 0.01 * 0.05 * AREA
    assert ours["geometry_volume_1_m3"] == pytest.approx(ours["wear_volume_1_m3"], rel=1e-4)
    assert ours["wear_volume_1_m3"] == pytest.approx(theirs["wear_volume_1_m3"], rel=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_all_methods_end_alike(worn, method):
    """requirement: pressure, worn shape and temperatures of deep-worn bodies."""
    ours, theirs = worn[method].interface, worn["condensed"].interface
    assert ours.x == pytest.approx(theirs.x, abs=1e-6)
    for name, part in WITHIN.items():
        found, known = getattr(ours, name), getattr(theirs, name)
        assert np.array_equal(np.isnan(found), np.isnan(known))
        if np.isnan(known).all():
            continue
        off, scale = found - known, np.abs(known).max()
        if name == "shape":
            off, scale = off - np.average(off, weights=theirs.weight), np.ptp(known)
        assert np.average(np.abs(off), weights=theirs.weight) < part * scale, name
