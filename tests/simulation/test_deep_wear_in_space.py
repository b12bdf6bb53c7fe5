"""Pin with a spherical end, of tetrahedra, worn by several elements."""

import math

import numpy as np
import pytest

import thermowear as tw
from thermowear.verification.spherical_pin import NAMES, SphericalPin

SPHERE, RADIUS, SPEED, WEAR, FORCE = 10e-3, 6e-3, 0.5, 1e-12, 100.0


def cap(depth):
    """Volume that a flat cuts off the end of the whole pin [m³]."""
    return math.pi * depth**2 * (SPHERE - depth / 3)


def case(path, depth, size, order=2, **changes):
    """Quarter of a pin that loses the cap of a depth, on a rigid block."""
    SphericalPin(SPHERE, RADIUS, 10e-3, (9e-3, 6e-3), size, order).write(path)
    end = cap(depth) / (WEAR * FORCE * SPEED)
    tables = {
        "title": "worn pin",
        "model": "3d",
        "geometry": {"type": "file", "path": str(path)} | NAMES,
        "mesh": {"degree": 2},
        "bodies": {
            "pin": {"young_modulus": "2 GPa", "poisson_ratio": 0.4},
            "block": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
        },
        "load": {"force": f"{FORCE / 4} N"},
        "motion": {"velocity": f"{SPEED} m/s"},
        "wear": {"update": 0.02, "pin": {"coefficient": f"{WEAR} 1/Pa", "per": "pressure"}},
        "analysis": {"type": "transient", "end_time": f"{end} s", "tolerance": 3e-2},
    }
    return tw.load(tables | changes)


@pytest.mark.parametrize(("order", "size"), [(1, 2e-3), (2, 2e-3)])
def test_tetrahedra_follow_the_worn_face(tmp_path, order, size):
    """requirement: the mesh loses the worn volume, k F s, in each update; the scar is a flat."""
    depth = 0.4e-3
    result = tw.run(case(tmp_path / "pin.msh", depth, size, order))
    summary, i = result.summary, result.interface
    assert summary["geometry_updates"] >= 3
    assert summary["geometry_volume_error"] < 1e-9
    assert summary["geometry_smallest_scaled_jacobian"] > 0.1
    assert summary["wear_volume_1_m3"] == pytest.approx(cap(depth) / 4, rel=1e-9, abs=0.0)
    lost = summary["geometry_volume_1_m3"]
    assert lost == pytest.approx(cap(depth) / 4, rel=1e-6, abs=0.0)
    # a flat but for the faceted sphere of linear cells, and the elastic deflection
    known = np.maximum(depth - SPHERE + np.sqrt(SPHERE**2 - i.x**2 - i.y**2), 0.0)
    off = np.sqrt(i.weight @ (i.wear_1 - known) ** 2 / (i.weight @ known**2))
    assert off < (0.1 if order == 1 else 0.05)
