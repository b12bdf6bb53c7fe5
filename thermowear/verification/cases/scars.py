"""Block worn by a rotating ring, and pin worn by a disc, with geometry updates of the worn body."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...reference.growing_contact import growing_line
from ...results import Result
from ..check import Check, compare
from ..starter import run_starter
from .growing import ARCHARD, ELASTIC, PUBLISHED, RIGID, SPEED, SPHERE, worn_half_width
from .hertz import MODULUS

PRESS, RADIUS, COEFFICIENT = 10_833.0, 20e-3, 2e-15
DISTANCES = (400.0, 800.0, 1600.0, 2400.0, 3600.0)
CIRCLE = "circle with the radius of the ring"
FACE = "integral of the wear over the face"
PIN_RADIUS = 50e-3
CAP = f"{RIGID}: cap that a flat cuts off a sphere"


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
    `reference.growing_contact`: by 2.1 % after 320 mm and 1.2 % after 640 mm (converged finite
    elements: 2.17 % and 1.20 %). Depths at the centre are therefore compared with those, and the
    later one with both.
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
