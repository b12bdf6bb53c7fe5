"""A beam over a gap: nothing presses in the end."""

import numpy as np
import pytest

from ..case.starter import solved

COARSE = {
    "mesh.degree": 2,
    "mesh.elements": 20,
    "analysis.output_times": [],
    "wear.update": "never",  # what is worn off thins no beam here: its stiffness would change
}


def beam(*overrides, **changes):
    return solved("beam-on-foundation", COARSE | changes, *overrides)


def depth(result):
    i = result.interface
    return float(np.interp(0.1755, i.x, i.wear_1))


def test_a_run_goes_on_when_nothing_presses_any_more():
    """requirement: rounding is not taken for an error of the steps; pressure and wear rest."""
    minute = beam()
    long = beam("analysis.end_time=1 h")
    assert long.stopped is None
    assert len(long.history) < len(minute.history) + 100
    assert long.history[-1].time == 3600.0
    assert minute.summary["max_pressure_Pa"] < 1.0
    assert long.summary["max_pressure_Pa"] < 1e-12 * minute.history[0].max_pressure
    np.testing.assert_allclose(long.interface.wear_1, minute.interface.wear_1, atol=1e-11)


def test_a_beam_that_never_touches():
    """requirement: no wear, no pressure, and no step too many."""
    result = beam("geometry.gap=5 mm")
    assert result.stopped is None
    assert len(result.history) < 5
    assert result.summary["max_pressure_Pa"] == 0.0
    assert result.summary["contact_zones_m"] == []
    assert np.all(result.interface.wear_1 == 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["penalty", "nitsche"])
def test_methods_agree(method):
    """requirement: the same shape in the end by the other methods."""
    known = beam("mesh.elements=10")
    found = beam("mesh.elements=10", f"contact.method={method}")
    difference = np.abs(found.interface.wear_1 - known.interface.wear_1)
    # one measures the gap point by point, the other its mean
    assert np.average(difference, weights=known.interface.weight) < 1e-2 * depth(known)
    assert depth(found) == pytest.approx(depth(known), rel=1e-2)


@pytest.mark.slow
def test_friction_bends_the_beam_on_its_way_only():
    """requirement: drag at the face presses right of the load harder if the beam moves there; the
    shape in the end does not know of it."""
    early = {"analysis.end_time": "0.8 s"}
    right = beam(**early)
    left = beam("motion.velocity=-50 mm/s", **early)
    smooth = {
        "contact.friction": 0.0,
        "wear.beam": {"coefficient": "7.5e-4 1/MPa", "per": "pressure"},
    }
    none = beam(**early | smooth)
    assert depth(left) < (1 - 3e-3) * depth(none) < depth(none) < (1 - 3e-3) * depth(right)
    ends = [depth(beam(f"motion.velocity={v} mm/s")) for v in (50, -50)]
    assert ends[0] == pytest.approx(ends[1], rel=1e-6)
