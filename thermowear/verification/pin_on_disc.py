"""A pin with a spherical end on a disc, whose mesh follows its worn end."""

from __future__ import annotations

from collections.abc import Iterator

from ..reference.growing_contact import growing_point
from .check import Check, compare
from .growing import ARCHARD, ELASTIC, RIGID, SPEED, worn_half_width
from .hertz import MODULUS
from .starter import run_starter

ID = "pin-on-disc"
FORCE, RADIUS, COEFFICIENT = 10.385, 50e-3, 1.33e-13
FIRST, LAST = 0.32, 0.64
PUBLISHED = {FIRST: (2.7426, 1.6924e-6), LAST: (3.2543, 2.3829e-6)}
"""Radius over that of Hertz's contact, and depth [m], by sliding distance [m]."""
_SEEN = 2e-2
"""Depths of rigid bodies are asked for where elasticity counts for less than that."""
UPDATE = "wear.update=0.0003"


def checks() -> Iterator[Check]:
    """Radius and depth against the published ones, volumes against Archard's law."""
    law = growing_point(FORCE, RADIUS, MODULUS, COEFFICIENT)
    times = f'analysis.end_time="{LAST / SPEED} s"', f'analysis.output_times=["{FIRST / SPEED} s"]'
    result = run_starter("sphere-on-block-growing", "mesh.elements=60", UPDATE, *times)
    states = {FIRST: result.outputs[FIRST / SPEED], LAST: result.interface}
    for distance, (ratio, depth) in PUBLISHED.items():
        state = states[distance]
        found = worn_half_width(state, 3) / law.start
        place, worn = f"after {1e3 * distance:g} mm", float(state.wear_1[0])
        elastic = float(law.elastic_half_width(distance)) / law.start
        yield compare(ID, f"radius over a0 {place} [1]", found, ratio, 2e-2, RIGID)
        yield compare(ID, f"radius over a0 {place}, elastic [1]", found, elastic, 1e-2, ELASTIC)
        dented = float(law.elastic_depth(distance))
        circle = (found * law.start) ** 2 / (2 * RADIUS)
        yield compare(ID, f"depth {place}, by the radius [m]", circle, depth, 2e-2, RIGID)
        if abs(dented / depth - 1) < _SEEN:
            yield compare(ID, f"depth {place} [m]", worn, depth, 2e-2, RIGID)
        yield compare(ID, f"depth {place}, elastic [m]", worn, dented, 1e-2, ELASTIC)
    summary, volume = result.summary, COEFFICIENT * FORCE * LAST
    worn = summary["wear_volume_1_m3"]
    kept = worn - summary["geometry_volume_1_m3"]
    yield compare(ID, "volume lost by mesh and gap [m³]", worn, volume, 1e-4, ARCHARD)
    yield compare(ID, "of it kept in the gap [m³], of it all", kept, 0.0, 0.2, ARCHARD, volume)
    error = summary["geometry_volume_error"]
    known = "the wear integrated over the face"
    yield compare(ID, "worst update: volume lost by the mesh [1]", 1 + error, 1.0, 1e-6, known)
