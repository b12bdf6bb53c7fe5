"""Pin on disk in space: worn volumes of both bodies, and the scar of a ball."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

import numpy as np

from ....results import Result
from ...check import Check, compare, run_starter

ARCHARD = "Archard's law, V = k F s for any shape of the faces"
AXISYMMETRIC = "axisymmetric run of a ball that slides across its axis"
PIN, DISK = 2e-14, 6e-15
"""Wear coefficients k of the starter [1/Pa]."""
COARSE = "mesh={degree = 2, elements = 4, grading = 1.0}"
BALL, FORCE, SPEED, TIME = 3e-3, 10.0, 0.5, 2.4
"""Radius [m], load [N], sliding speed [m/s] and time [s] of the ball."""
BALL_WEAR = 1.33e-13
"""Wear coefficient of the ball [1/Pa]: the scar grows to five times the radius of the contact."""
_RUNNING_IN = "pin-on-disk-running-in"
_ELEMENTS = 4


def pin_on_disk_3d() -> Iterator[Check]:
    """Worn volumes of pin and disk, whose wear is spread over its track; scar of a ball."""
    yield from volumes_on_a_wide_track()
    yield from volumes_by_time()
    yield from scar_of_a_ball(_ELEMENTS)


def volumes_on_a_wide_track() -> Iterator[Check]:
    """On a track of 2000 pin radii the sliding distance is the same all over the face."""
    force, distance = 15.0, 250.0
    result = run_starter(
        _RUNNING_IN,
        COARSE,
        "geometry.pin_radius=1 mm",
        "geometry.pin_height=3 mm",
        "geometry.track_radius=2 m",
        "geometry.disk_inner_radius=1.8 m",
        "geometry.disk_outer_radius=2.2 m",
        "geometry.disk_thickness=60 mm",
        f"motion.angular_velocity={distance / 500 / 2.0} rad/s",
        f"load.force={force} N",
        "analysis.end_time=500 s",
        without=("analysis.output_times",),
    )
    yield from _volumes(result, "wide track", PIN * force * distance, DISK * force * distance)


def volumes_by_time() -> Iterator[Check]:
    """Wear that does not depend on the speed removes κ F t at any radius of the track."""
    rates, force, time = (2e-14, 6e-15), 250.0, 1000.0
    tables = [
        {"coefficient": f"{rate} m/(s Pa)", "velocity_exponent": 0.0, "per": "pressure"}
        for rate in rates
    ]
    tables[1]["spread"] = "track"
    laws = [
        f"wear.{body}={_inline(table)}" for body, table in zip(("pin", "disk"), tables, strict=True)
    ]
    result = run_starter(_RUNNING_IN, COARSE, *laws)
    yield from _volumes(result, "wear by time", *(rate * force * time for rate in rates))


def _volumes(result: Result, note: str, pin: float, disk: float) -> Iterator[Check]:
    for body, number, known in (("pin", 1, pin), ("disk", 2, disk)):
        quantity = f"worn volume of the {body}, {note} [m³]"
        found = result.summary[f"wear_volume_{number}_m3"]
        yield compare(quantity, found, known, 1e-6, ARCHARD)


def scar_of_a_ball(elements: int) -> Iterator[Check]:
    """Scar that has grown to five times the radius of the first contact.

    Parameters
    ----------
    elements : int
        Number of elements across the contact zone, in space.
    """
    law = {"coefficient": f"{BALL_WEAR} 1/Pa", "per": "pressure"}
    analysis = {"type": "transient", "end_time": f"{TIME} s", "tolerance": 1e-2}
    common = ("geometry.zone=0.35 mm", f"analysis={_inline(analysis)}")
    flat = run_starter(
        "sphere-on-block-growing",
        *common,
        f"geometry.radius={BALL} m",
        "geometry.block_radius=8 mm",
        "geometry.block_height=6 mm",
        f"load.force={FORCE} N",
        f"motion.velocity={SPEED} m/s",
        f"wear={_inline({'sphere': law})}",
    )
    found = run_starter(
        "pin-on-disk-ball",
        *common,
        f"mesh={_inline({'degree': 2, 'elements': elements, 'grading': 1.0})}",
        f"motion={_inline({'angular_velocity': f'{SPEED / 0.02} rad/s'})}",
        f"wear={_inline({'pin': law})}",
    )
    worn = BALL_WEAR * FORCE * SPEED * TIME
    radius = _scar_radius(flat, 0.0)
    for name, result, center in (("axisymmetric", flat, 0.0), ("in space", found, 0.02)):
        if center:
            quantity = f"radius of the scar of a ball, {elements} elements [m]"
            yield compare(quantity, _scar_radius(result, center), radius, 1e-2, AXISYMMETRIC)
        volume = result.summary["wear_volume_1_m3"]
        yield compare(f"worn volume of a ball, {name} [m³]", volume, worn, 1e-4, ARCHARD)


def _inline(table: dict) -> str:
    """Inline table of TOML."""
    values = (_inline(v) if isinstance(v, dict) else json.dumps(v) for v in table.values())
    return "{" + ", ".join(f"{k} = {v}" for k, v in zip(table, values, strict=True)) + "}"


def _scar_radius(result: Result, center: float) -> float:
    """Radius where a parabola through the wear depths within 80 % of it ends [m]."""
    i = result.interface
    r = np.hypot(i.x - center, i.y) if center else i.x
    inside = r < 0.8 * math.sqrt(2 * BALL * i.wear_1.max())
    slope, depth = np.polyfit(r[inside] ** 2, i.wear_1[inside], 1, w=np.sqrt(i.weight[inside]))
    return math.sqrt(-depth / slope)
