"""Cases in space, coarse, to be changed by tests."""

from __future__ import annotations

from typing import Any

PUNCH: dict[str, Any] = {
    "title": "rectangular punch",
    "model": "3d",
    "geometry": {
        "type": "rectangular-punch",
        "size_x": "60 mm",
        "size_y": "80 mm",
        "height": "50 mm",
        "block_x": "120 mm",
        "block_y": "140 mm",
        "block_height": "60 mm",
    },
    "mesh": {"degree": 2, "elements": 4, "grading": 0.3},
    "bodies": {
        "punch": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
        "block": {"like": "punch"},
    },
    "holder": {"free": ["z", "rotation-x", "rotation-y"]},
    "load": {"force": "10 kN", "point": ["-5 mm", "0 mm"]},
    "motion": {"velocity": "5 mm/s"},
    "contact": {"friction": 0.25},
    "wear": {"punch": {"coefficient": "2e-7 1/MPa"}},
    "analysis": {"type": "steady"},
}
"""Special case 2 of Páczelt and Mróz: pressed 5 mm off the middle."""

BRAKE: dict[str, Any] = {
    "title": "pad on a disk",
    "model": "3d",
    "geometry": {
        "type": "disk-sector",
        "pad_inner_radius": "80 mm",
        "pad_outer_radius": "120 mm",
        "pad_thickness": "15 mm",
        "pad_angle": "60 deg",
        "disk_inner_radius": "60 mm",
        "disk_outer_radius": "130 mm",
        "disk_thickness": "20 mm",
    },
    "mesh": {"degree": 2, "elements": 6, "grading": 0.4},
    "bodies": {
        "pad": {"young_modulus": "2 GPa", "poisson_ratio": 0.25},
        "disk": {"young_modulus": "110 GPa", "poisson_ratio": 0.28},
    },
    "load": {"force": "10 kN"},
    "motion": {"angular_velocity": "50 rad/s"},
    "contact": {"friction": 0.35},
    "wear": {"pad": {"coefficient": "2e-7 1/MPa"}},
    "analysis": {"type": "steady"},
}
