"""Contact point by point at Lobatto nodes: another pressure space, the same contact."""

import numpy as np
import pytest

from thermowear.verification.check import run_starter

LOBATTO = "contact.pressure_degree=lobatto"


@pytest.mark.slow
def test_running_in_is_that_of_the_weak_gap(running_in):
    """requirement: 8T by a second pressure space, at every output time to 1e-3."""
    pointwise = run_starter("annular-punch-running-in", LOBATTO)
    radii = np.array([0.025, 0.04, 0.07, 0.1, 0.115])
    for time, expected in running_in.outputs.items():
        found = pointwise.outputs[time]
        pressures = [np.interp(radii, run.x, run.pressure) for run in (found, expected)]
        np.testing.assert_allclose(*pressures, rtol=1e-3)
        assert found.weight @ found.wear_1 == pytest.approx(
            expected.weight @ expected.wear_1, rel=1e-5
        )


def test_gap_is_closed_at_every_pressing_point():
    """requirement: no point penetrates or pulls, not only in the mean."""
    result = run_starter("cylinder-on-block", LOBATTO)
    interface = result.interface
    touching = interface.pressure > 0
    scale = interface.gap.max()
    assert interface.pressure.min() >= 0
    assert np.abs(interface.gap[touching]).max() < 1e-9 * scale
    assert interface.gap.min() > -1e-9 * scale
    weak = run_starter("cylinder-on-block")
    assert result.summary["max_pressure_Pa"] == pytest.approx(
        weak.summary["max_pressure_Pa"], rel=1e-3
    )


def test_hot_steady_state():
    """requirement: heat too crosses the interface point by point; the worn shape stays to 1e-3."""
    result = run_starter("annular-punch", LOBATTO, "mesh.degree=5")
    weak = run_starter("annular-punch", "mesh.degree=5")
    assert result.summary["shape_range_m"] == pytest.approx(weak.summary["shape_range_m"], rel=1e-3)
    assert result.summary["heat_balance_relative_error"] < 1e-9
