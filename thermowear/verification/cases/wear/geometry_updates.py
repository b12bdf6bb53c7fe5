"""Wear with geometry updates, which move the mesh to the worn face.

A block worn by a rotating ring, a pin worn by a disc, and an annular punch worn by a fifth of its
height with friction heat and cooling at its top, which must end in the state of a punch meshed with
the worn height; its results must not depend on the interval of the updates.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import log2, pi

import numpy as np

from ....reference.elastic_contact.growing_contact import growing_line
from ....results import Result
from ...check import Check, along, compare, compare_each, run_starter
from ..contact.hertz import MODULUS
from .growing import ARCHARD, ELASTIC, PUBLISHED, RIGID, SPEED, SPHERE, worn_half_width

PRESS, RADIUS, COEFFICIENT = 10_833.0, 20e-3, 2e-15
DISTANCES = (400.0, 800.0, 1600.0, 2400.0, 3600.0)
CIRCLE = "circle with the radius of the ring"
FACE = "integral of the wear over the face"
PIN_RADIUS = 50e-3
CAP = f"{RIGID}: cap that a flat cuts off a sphere"
DEEP = "annular-punch"
PLACES = np.array([0.022, 0.025, 0.04, 0.07, 0.1, 0.115, 0.118])
AREA = pi * (0.12**2 - 0.02**2)
HEIGHT, WORN, LAST = 0.05, 0.01, 0.001
FINE = ("mesh.degree=8", "mesh.elements=12")
COARSE = ("mesh.degree=6", "mesh.elements=4")
INTERVALS = (0.04, 0.02, 0.01, 0.005)
AMBIENT = 293.15
LOW = "steady principle for a punch of the worn height"
LATE = "punch of the same final height, worn by its last millimetre only"
SMALL = "same case with updates at each 0.25 % of the height"
ORDER = "four runs, with the update interval halved each time"
_SCATTER = 1e-2
"""Tolerance of the mean order of four runs: the last interval of a run is shorter than the others,
so that the order from three runs scatters by 0.05."""


def block_on_ring() -> Iterator[Check]:
    """From line contact to a worn circle: half-width and depth, the worn face against the ring."""
    law = growing_line(PRESS, RADIUS, MODULUS, COEFFICIENT)
    result = run_starter("block-on-ring")
    states = result.outputs | {DISTANCES[-1] / SPEED: result.interface}
    for distance in DISTANCES:
        state, place = states[distance / SPEED], f"after {distance:g} m"
        depth, known = float(state.wear_2[0]), float(law.half_width(distance))
        yield compare(f"half-width {place} [m]", worn_half_width(state, 5), known, 1e-2, RIGID)
        yield compare(f"depth {place} [m]", depth, float(law.depth(distance)), 1e-2, RIGID)
        inside = state.x < 0.95 * known
        ring = depth - RADIUS + np.sqrt(RADIUS**2 - state.x**2)
        off = float(np.abs(state.wear_2 - ring)[inside].max())
        quantity = f"worn face {place} [m], relative to its depth"
        yield compare(quantity, off, 0.0, 1e-2, CIRCLE, depth)
    volume = COEFFICIENT * PRESS * 1e-3 * DISTANCES[-1]
    found = result.summary["geometry_volume_2_m3"]
    yield compare("volume lost by the mesh [m³]", found, volume, 1e-3, ARCHARD)
    yield volume_error(result)


def pin_on_disc() -> Iterator[Check]:
    """Pin with a spherical end: radius and depth against the published ones, volumes.

    The published depths are those of the cap that a flat cuts off the sphere, a²/(2 R) of the
    published radii. For elastic bodies the depth at the centre is smaller, see
    `reference.elastic_contact.growing_contact`: by 2.1 % after 320 mm and 1.2 % after 640 mm
    (converged finite elements: 2.17 % and 1.20 %). Depths at the centre are therefore compared with
    those, and the later one with both.
    """
    law, (first, last) = SPHERE.law(SPHERE.coefficient), PUBLISHED
    times = f'analysis.end_time="{last / SPEED} s"', f'analysis.output_times=["{first / SPEED} s"]'
    result = run_starter(SPHERE.starter, "mesh.elements=60", "wear.update=0.0005", *times)
    states = {first: result.outputs[first / SPEED], last: result.interface}
    for distance, (ratio, depth) in PUBLISHED.items():
        state, place = states[distance], f"after {1e3 * distance:g} mm"
        radius, worn = worn_half_width(state, 3), float(state.wear_1[0])
        found, elastic = radius / law.start, float(law.elastic_half_width(distance)) / law.start
        yield compare(f"radius over a0 {place} [1]", found, ratio, 2e-2, RIGID)
        yield compare(f"radius over a0 {place}, elastic [1]", found, elastic, 1e-2, ELASTIC)
        cap = radius**2 / (2 * PIN_RADIUS)
        yield compare(f"depth {place}, by the radius of the scar [m]", cap, depth, 2e-2, CAP)
        name, dented = f"depth {place}, in the middle", float(law.elastic_depth(distance))
        if distance == last:
            yield compare(f"{name} [m]", worn, depth, 2e-2, RIGID)
        yield compare(f"{name}, elastic [m]", worn, dented, 1e-2, ELASTIC)
    volume = SPHERE.coefficient * SPHERE.force * last
    lost = result.summary["geometry_volume_1_m3"]
    yield compare("volume lost by the mesh [m³]", lost, volume, 1e-4, ARCHARD)
    yield volume_error(result)


def volume_error(result: Result) -> Check:
    """Volume removed by the worst geometry update, relative to its wear."""
    error = 1 + result.summary["geometry_volume_error"]
    return compare("worst update: volume lost by the mesh [1]", error, 1.0, 1e-6, FACE)


def deep_wear() -> Iterator[Check]:
    """Final volumes, shapes and temperatures; influence of the update interval."""
    worn = deep("wear.update=0.007", *FINE)
    summary = worn.summary
    yield volume_error(worn)
    slanted = 1.0 / summary["geometry_smallest_scaled_jacobian"]
    yield Check("1 / smallest scaled Jacobian [1]", slanted, 1.0, slanted, 10.0, "a rectangle")
    lost = summary["geometry_volume_1_m3"]
    volume = float(worn.interface.weight @ worn.interface.wear_1)
    whole = summary["wear_volume_1_m3"]
    yield compare("volume lost by the mesh and kept in the gap [m³]", whole, volume, 1e-6, FACE)
    # the last step is repeated on the moved mesh: the difference of both remains in the gap
    yield compare(
        "volume lost by the mesh in the end, but for the last step [m³]", lost, whole, 1e-5, FACE
    )
    yield compare("height worn off [m]", lost / AREA, WORN, 1e-3, "the steady wear rate")
    height = HEIGHT - lost / AREA
    yield from _against_low_punch(worn, height)
    late = deep("wear.update=0.0035", *FINE, height=height + LAST, worn=LAST)
    yield from _shapes(worn, late, LATE, "its lowest point")
    yield from _updates()


def deep(*overrides: str, height: float = HEIGHT, worn: float = WORN) -> Result:
    """Transient until a depth is worn off, at the steady wear rate [m]."""
    end = worn / run_starter(DEEP, *COARSE).summary["rigid_wear_velocity_m_per_s"]
    transient = f'analysis={{type="transient", end_time="{end!r} s", tolerance=1e-3}}'
    return run_starter(DEEP, transient, f"geometry.punch_height={height!r} m", *overrides)


def _against_low_punch(worn: Result, height: float) -> Iterator[Check]:
    """Shape and temperatures against the steady state of a punch of a height [m].

    That punch has a flat face. Thermal displacement along the inclined worn face closes its gap by
    the slope times the relative displacement, 0.8e-3 of the range.
    """
    low = run_starter(DEEP, *FINE, f"geometry.punch_height={height!r} m")
    yield from _shapes(worn, low, LOW, "its mean")
    for body in (1, 2):
        found, known = (
            along(i, PLACES, getattr(i, f"temperature_{body}"))
            for i in (worn.interface, low.interface)
        )
        for r, T, exact in zip(PLACES, found, known, strict=True):
            name = f"temperature of body {body} at r = {1e3 * r:g} mm [K], of its rise"
            yield compare(name, T, exact, 1e-3, LOW, exact - AMBIENT)


def _shapes(worn: Result, known: Result, source: str, origin: str) -> Iterator[Check]:
    """Heights of the face, relative to its mean or to its lowest point."""
    profiles = []
    for face in (worn.interface, known.interface):
        mean = float(face.weight @ face.shape / face.weight.sum()) if origin == "its mean" else 0.0
        profiles.append(along(face, PLACES, face.shape - mean))
    name, size = f"shape at r = {{:g}} mm from {origin} [m], of its range", "shape_range_m"
    (found, exact), scale = profiles, known.summary[size]
    yield from compare_each(name, 1e3 * PLACES, found, exact, 1e-3, source, scale)


def _updates() -> Iterator[Check]:
    """Order of the geometry-update loop, and automatic updates against frequent ones.

    Between updates the conduction path is too long by the gap wear, on average over the run. At the
    end the gap wear is zero.
    """
    hottest = [_mean_of_hottest(deep(f"wear.update={size}", *COARSE)) for size in INTERVALS]
    changes = np.diff(hottest)
    order = log2(changes[0] / changes[-1]) / (len(changes) - 1)
    sizes = ", ".join(f"{100 * size:g} %" for size in INTERVALS)
    name = f"order, updates at {sizes}: hottest point in the mean over the run [1]"
    yield Check(name, order, 1.0, max(1.0 - order, 0.0), _SCATTER, ORDER)
    chosen, fine = deep(*COARSE), deep("wear.update=0.0025", *COARSE)
    for name, value in (
        ("hottest point in the mean over the run [K], of its rise", _mean_of_hottest),
        ("hottest point [K], of its rise", lambda result: result.summary["max_temperature_K"]),
        ("largest pressure [Pa]", lambda result: result.summary["max_pressure_Pa"]),
        ("volume worn off [m³]", lambda result: result.summary["wear_volume_1_m3"]),
        ("range of the shape [m]", lambda result: result.summary["shape_range_m"]),
    ):
        found, known = value(chosen), value(fine)
        scale = known - AMBIENT if "rise" in name else None
        yield compare(f"{name}, updates as they are chosen", found, known, 5e-3, SMALL, scale)


def _mean_of_hottest(result: Result) -> float:
    """Time average of the highest face temperature [K]."""
    steps = result.history[1:]
    return sum(row.max_temperature * row.step for row in steps) / steps[-1].time
