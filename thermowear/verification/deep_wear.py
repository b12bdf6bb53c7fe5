"""An annular punch of which a fifth of the height is worn off, hot and cooled on its top.

Meshes are moved to the worn face on the way. The run must end like a punch that is meshed as low as
the worn one, and what it finds must not depend on how often the meshes are moved.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import log, pi

from ..simulation import Result
from .check import Check, along, compare
from .starter import run_starter

ID = "deep-wear"
STARTER = "annular-punch"
RADII = (0.022, 0.025, 0.04, 0.07, 0.1, 0.115, 0.118)
AREA = pi * (0.12**2 - 0.02**2)
HEIGHT, PART = 0.05, 0.2
FINE = ("mesh.degree=8", "mesh.elements=12")
COARSE = ("mesh.degree=6", "mesh.elements=4")
SIZES = (0.04, 0.02)
AMBIENT = 293.15
LOW = "a punch meshed as low as the worn mesh, by the principle"
STOKES = "the volume that the meshes have lost"
SMALL = "the same with updates at each 0.5 % of the height"


def checks() -> Iterator[Check]:
    """Volumes, shapes and temperatures at the end; the order of the updates."""
    worn = deep(*FINE, "wear.update=0.007")
    summary = worn.summary
    yield compare(
        ID, "worst update: volume lost by the mesh [1]", 1 + summary["geometry_volume_error"], 1.0,
        1e-6, "the wear integrated over the face",
    )  # fmt: skip
    slanted = 1.0 / summary["geometry_smallest_scaled_jacobian"]
    yield Check(ID, "1 / smallest scaled Jacobian [1]", slanted, 1.0, slanted, 10.0, "a rectangle")
    lost = summary["geometry_volume_1_m3"]
    kept = summary["wear_volume_1_m3"] - lost
    volume = float(worn.interface.weight @ worn.interface.wear_1)
    yield compare(ID, "volume worn off [m³]", volume, lost + kept, 1e-6, STOKES)
    yield compare(
        ID, "height worn off [m]", volume / AREA, PART * HEIGHT, 1e-3, "the steady wear rate"
    )
    yield from _like_low(worn, HEIGHT - lost / AREA)
    yield from _order()


def deep(*overrides: str) -> Result:
    """Until a fifth of the height is worn off, at the wear rate of the steady state."""
    rate = run_starter(STARTER, *COARSE).summary["rigid_wear_velocity_m_per_s"]
    end = PART * HEIGHT / rate
    transient = f'analysis={{type="transient", end_time="{end!r} s", tolerance=1e-3}}'
    return run_starter(STARTER, transient, *overrides)


def _like_low(worn: Result, height: float) -> Iterator[Check]:
    """Shape and temperatures against the steady state of a punch of a height [m]."""
    low = run_starter(STARTER, *FINE, f"geometry.punch_height={height!r} m")
    profiles = []
    for result in (worn, low):
        face = result.interface
        mean = float(face.weight @ face.shape / face.weight.sum())
        profiles.append(along(face, RADII, face.shape - mean))
    scale = low.summary["shape_range_m"]
    for r, found, known in zip(RADII, *profiles, strict=True):
        name = f"shape at r = {1e3 * r:g} mm from its mean [m], of its range"
        yield compare(ID, name, found, known, 1e-3, LOW, scale)
    for body in (1, 2):
        found, known = (
            along(result.interface, RADII, getattr(result.interface, f"temperature_{body}"))
            for result in (worn, low)
        )
        for r, T, exact in zip(RADII, found, known, strict=True):
            name = f"temperature of body {body} at r = {1e3 * r:g} mm [K], of its rise"
            yield compare(ID, name, T, exact, 1e-3, LOW, exact - AMBIENT)


def _order() -> Iterator[Check]:
    """What is kept in the gap at the end against what that changes; updates as they are chosen."""
    kept, late = [], []
    for size in SIZES:
        worn = deep(*COARSE, f"wear.update={size}").summary
        height = HEIGHT - worn["wear_volume_1_m3"] / AREA
        low = run_starter(STARTER, *COARSE, f"geometry.punch_height={height!r} m").summary
        kept.append(worn["wear_volume_1_m3"] - worn["geometry_volume_1_m3"])
        late.append(worn["max_temperature_K"] - low["max_temperature_K"])
    order = log(late[0] / late[1]) / log(kept[0] / kept[1])
    name = "order in the wear kept, of the temperature [1]"
    yield Check(ID, name, order, 1.0, 1.0 - order, 0.1, "its definition")
    automatic, fine = (deep(*COARSE, *keys).summary for keys in ((), ("wear.update=0.005",)))
    for key, name in (
        ("max_temperature_K", "hottest point [K], of its rise"),
        ("max_pressure_Pa", "largest pressure [Pa]"),
        ("wear_volume_1_m3", "volume worn off [m³]"),
        ("shape_range_m", "range of the shape [m]"),
    ):
        scale = fine[key] - AMBIENT if key == "max_temperature_K" else None
        label = f"{name}, updates as they are chosen"
        yield compare(ID, label, automatic[key], fine[key], 5e-3, SMALL, scale)
