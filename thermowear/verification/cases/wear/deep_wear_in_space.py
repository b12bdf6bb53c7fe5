"""Pin with a spherical end in space, worn by several elements, against the axisymmetric run.

A quarter of the pin, of quadratic tetrahedra, is worn until its end is almost flat, and on until
70 % of it are lost. Wear is by time, not by distance, so that a rotation about the axis of the pin
wears it like a translation.
"""

from __future__ import annotations

import math
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ....case import load
from ....errors import CaseNote
from ....results import InterfaceFields
from ...check import Check, compare, computed
from ...spherical_pin import NAMES, SphericalPin
from .geometry_updates import volume_error
from .growing import ARCHARD

AXISYMMETRIC = "axisymmetric run of the same pin"
PIN = SphericalPin(10e-3, 6e-3, 10e-3, (9e-3, 6e-3), 1e-3)
FORCE, WEAR = 100.0, 5e-13
"""Load [N], and wear rate per pressure [m/(s Pa)]."""
CAP, DEEP = 1.5e-3, 7e-3
"""Heights worn off, of the spherical end and in all [m]."""
_FINER = 5
"""Size of the elements in space over those of the section."""


def deep_wear_3d() -> Iterator[Check]:
    """Volumes, quality of the cells, and shape of the worn pin."""
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "pin.msh"
        PIN.write(path)
        found = computed(_case(path, 0.25, symmetry=NAMES["symmetry"], rollers=NAMES["rollers"]))
        PIN.finer(_FINER).write_section(path)
        known = computed(_case(path, 1.0))
    yield volume_error(found)
    summary, last = found.summary, max(found.history, key=lambda row: row.time).time
    worn = WEAR * FORCE / 4 * last
    volume = summary["geometry_volume_1_m3"]
    yield compare("volume lost by the mesh [m³]", volume, worn, 1e-6, ARCHARD)
    slanted = 1.0 / summary["geometry_smallest_scaled_jacobian"]
    quantity = "1 / smallest scaled Jacobian [1]"
    yield Check(quantity, slanted, 1.0, slanted, 10.0, "regular tetrahedra")
    (time,) = found.outputs
    yield from _profiles("spherical end", found.outputs[time], known.outputs[time], CAP)
    yield from _profiles("in the end", found.interface, known.interface, DEEP)


def end_time(depth: float) -> float:
    """Time until a height is worn off the pin [s]."""
    whole = min(depth, float(PIN.rise(np.array(PIN.radius))))
    cap = math.pi * whole**2 * (PIN.sphere - whole / 3)
    return (cap + math.pi * PIN.radius**2 * (depth - whole)) / (WEAR * FORCE)


def tables(path: Path, share: float, **planes: Any) -> dict[str, Any]:
    """Tables of a case for a part of the pin in space, or of its section."""
    geometry = {name: NAMES[name] for name in ("bodies", "contact", "held", "fixed")} | planes
    if share < 1.0:
        geometry["rotation_center"] = ["0 mm", "0 mm"]
    law = {"coefficient": f"{WEAR} m/(s Pa)", "velocity_exponent": 0.0, "per": "pressure"}
    return {
        "title": "Pin with a spherical end, worn off",
        "model": "3d" if share < 1.0 else "axisymmetric",
        "geometry": {"type": "file", "path": str(path)} | geometry,
        "mesh": {"degree": 2},
        "bodies": {
            "pin": {"young_modulus": "2 GPa", "poisson_ratio": 0.4},
            "block": {"young_modulus": "200 GPa", "poisson_ratio": 0.3},
        },
        "load": {"force": f"{share * FORCE!r} N"},
        "motion": {"angular_velocity": "1 rad/s"},
        "wear": {"pin": law},
        "analysis": {
            "type": "transient",
            "end_time": f"{end_time(DEEP)!r} s",
            "output_times": [f"{end_time(CAP)!r} s"],
            "tolerance": 3e-2,
        },
    }


def _case(path: Path, share: float, **planes: Any):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseNote)  # a sector lacks the twist by friction
        return load(tables(path, share, **planes))


def _profiles(
    name: str, found: InterfaceFields, known: InterfaceFields, depth: float
) -> Iterator[Check]:
    """Worn depth and shape at all points, the latter from the middle of the pin."""
    r, at = np.hypot(found.x, found.y), np.argsort(known.x)
    for quantity, field in (("worn depth", "wear_1"), ("shape", "shape")):
        ours, theirs = getattr(found, field), np.interp(r, known.x[at], getattr(known, field)[at])
        if field == "shape":
            ours, theirs = ours - ours[r.argmin()], theirs - theirs[r.argmin()]
        worst = int(np.abs(ours - theirs).argmax())
        label = f"{quantity}, {name}, at r = {1e3 * r[worst]:.2g} mm [m], of the height worn off"
        yield compare(label, ours[worst], theirs[worst], 1e-2, AXISYMMETRIC, depth)
