"""Faces that begin where the other body, or the arm of the pivot, ends: closed forms."""

import math

import numpy as np
import pytest

import thermowear as tw
from thermowear.reference.rigid_faces import DrumBrakeShoe

from ..case.starter import changed
from .space import BRAKE

FORCE = 1e4
RADII = {"disk_inner_radius": "80 mm", "disk_outer_radius": "0.12 m"}
WIDE = changed(BRAKE, {f"geometry.{key}": value for key, value in RADII.items()})
RING = changed(
    WIDE,
    {
        "model": "axisymmetric",
        "geometry.type": "disk-brake",
        "mesh.degree": 4,
        "wear.disk": {"coefficient": "2e-8 1/MPa", "spread": "track"},
    },
)
SHOE = {
    "model": "plane-strain",
    "geometry": {
        "type": "drum-brake",
        "drum_radius": "100 mm",
        "drum_thickness": "8 mm",
        "lining_thickness": "5 mm",
        "shoe_thickness": "8 mm",
        "arc_start": "-45 deg",
        "arc_end": "60 deg",
        "pivot": ["-70 mm", "70 mm"],
        "thickness": "40 mm",
    },
    "mesh": {"degree": 3, "elements": 24},
    "bodies": {
        "shoe": {"young_modulus": "70 GPa", "poisson_ratio": 0.33},
        "drum": {"like": "shoe"},
    },
    "holder": {"free": ["rotation"]},
    "load": {"moment": "200 N m"},
    "motion": {"angular_velocity": "-5 rad/s"},
    "contact": {"friction": 0.35},
    "analysis": {"type": "steady"},
}


def even_wear(r):
    """Steady pressure of a pad under a force: p r = const."""
    return FORCE / (math.pi / 3 * 0.04) / r


@pytest.mark.parametrize(("case", "allowed"), [(WIDE, 2e-5), (RING, 1e-12)])
def test_a_pad_as_wide_as_its_disk(case, allowed):
    """
    requirement: p ~ 1/r from edge to edge, in space and as a ring.
    """
    result = tw.run(tw.load(case))
    i = result.interface
    r = np.hypot(i.x, i.y) if case["model"] == "3d" else i.x
    np.testing.assert_allclose(i.pressure, even_wear(r), rtol=allowed)
    assert result.summary["equilibrium_relative_error"] < 1e-9
    assert result.summary["contact_area_m2"] == pytest.approx(
        math.pi / 6 * (0.12**2 - 0.08**2), rel=1e-4
    )


def test_running_in_of_a_pad_as_wide_as_its_disk():
    """
    requirement: in time it comes to the same, with nothing that gives way at the shared edges.
    """
    case = changed(RING, {"analysis": {"type": "transient", "end_time": "2000 s"}})
    result = tw.run(tw.load(case))
    np.testing.assert_allclose(result.interface.pressure, even_wear(result.interface.x), rtol=1e-3)


@pytest.mark.parametrize("b", [1.0, 2.0])
def test_a_shoe_that_begins_on_the_line_of_its_pivot(b):
    """
    requirement: p ~ sin^(1/b) of the angle from that line, zero there (leading shoe, case 7).
    """
    law = {"coefficient": f"1e-7 1/MPa^{b}", "pressure_exponent": b}
    case = tw.load(changed(SHOE, {"wear": {"shoe": law}}))
    i = tw.run(case).interface
    angle = np.arctan2(i.x, i.y) + np.radians(45)
    exact = DrumBrakeShoe(0.1, math.hypot(0.07, 0.07), 0.04, 0.0, math.radians(105), 0.35, b)
    expected = exact.pressure(angle, 200.0)
    np.testing.assert_allclose(i.pressure, expected, atol=1e-4 * expected.max(), rtol=0)
    assert angle.min() == pytest.approx(0.0, abs=1e-12)
