"""What the demo cases show, in figures: against closed forms, on coarse meshes."""

from math import cos, pi, radians, sin

import numpy as np
import pytest

from ..case.starter import GONE, solved

COARSE = ("mesh.degree=3", "mesh.elements=8")


def conical() -> float:
    """Peak of ``p = (F/I) / r`` with ``I = 2π (ro - ri) (sin α + mu_d cos α)/sin α`` [Pa]."""
    inner, outer, α = 0.02, 0.12, radians(60)
    carried = 2 * pi * (outer - inner) * (sin(α) + 0.1 * cos(α)) / sin(α)
    return 50e6 * pi * (outer**2 - inner**2) / carried / inner


def drum() -> float:
    """Peak of the long-shoe law, leading [Pa]."""
    moment, friction, radius, pivot, thickness = 100.0, 0.35, 0.1, 0.075, 0.04
    α = np.linspace(*np.radians([35, 145]), 20001)
    arm, drag = pivot * np.sin(α), friction * (radius + pivot * np.cos(α))
    return moment / np.trapezoid(np.sin(α) * (arm - drag) * radius * thickness, α)


def arc(start: float, end: float, friction: float) -> float:
    """Peak of ``p = (F/I) cos α``, in Pa, ``I = ∫ cos α (cos α + mu sin α) R t dα``."""
    α = np.linspace(start, end, 20001)
    carried = np.cos(α) * (np.cos(α) + friction * np.sin(α))
    return 1e3 / (np.trapezoid(carried, α) * 0.02 * 0.01)


PEAKS = {
    "annular-punch": 175e6,
    "annular-punch-conical": conical(),
    "block-on-disk": arc(-0.5, 0.5, 0.3),
    "disk-brake": 500.0 / (radians(60) * 0.08 * 0.05),
    "drum-brake": drum(),
    "pivoted-block": 2.493075e6,
    "punch-on-strip": 10e6,
    "punch-on-strip-tilting": 6.25e6,
    "ring-segment-on-disk": arc(-0.2, 0.7, -0.3),
}


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow if n == "disk-brake" else ()) for n in PEAKS]
)
def test_the_steady_peak(name):
    """requirement: the steady pressure of each special case is its closed form."""
    result = solved(name, None, *COARSE)
    assert result.summary["analysis"] == "steady"
    assert result.summary["max_pressure_Pa"] == pytest.approx(PEAKS[name], rel=2e-4)
    assert result.summary["equilibrium_relative_error"] < 1e-9


@pytest.mark.parametrize("name", ["block-on-disk", "punch-on-strip", "disk-brake"])
def test_heat_changes_the_shape_alone(name):
    """requirement: the steady pressure knows nothing of heat, the worn shape does."""
    hot, cold = solved(name, None, *COARSE), solved(name, {"heat": GONE}, *COARSE)
    assert hot.interface.pressure == pytest.approx(cold.interface.pressure, rel=1e-12)
    assert hot.summary["heat_balance_relative_error"] < 1e-9
    change = np.abs(hot.interface.shape - cold.interface.shape).max()
    assert change > 0.1 * cold.summary["shape_range_m"]


def test_friction_changes_the_shape_alone():
    """requirement: on a symmetric arc the pressure does not know friction, the worn shape does."""
    low, high = (
        solved("block-on-disk", None, COARSE[1], f"contact.friction={mu}") for mu in (0.1, 0.4)
    )
    assert low.interface.pressure == pytest.approx(high.interface.pressure, rel=1e-10)
    change = np.abs(low.interface.shape - high.interface.shape).max()
    assert change > 0.2 * low.summary["shape_range_m"]
    # along the press the steady shape sinks without changing: its rate is the same everywhere
    rate = high.profile.wear_rate_along_press
    assert rate == pytest.approx(high.summary["rigid_wear_velocity_m_per_s"], rel=1e-6, abs=0.0)


def test_the_sense_of_rotation_mirrors_a_symmetric_case():
    """requirement: clockwise is the mirror image of anticlockwise."""
    left, right = (
        solved("block-on-disk", None, *COARSE, f"motion.angular_velocity={w} rad/s")
        for w in (0.3, -0.3)
    )
    mirrored = right.interface.shape[::-1]
    assert left.interface.shape == pytest.approx(mirrored, abs=1e-6 * np.ptp(mirrored))
    assert left.summary["guide_force_N"] == pytest.approx(-right.summary["guide_force_N"])
