"""Pin with a spherical end on a disc, with geometry updates of the pin.

The published depths are those of the cap that a flat cuts off the sphere, a²/(2 R) of the
published radii. For elastic bodies the depth at the centre is smaller, see
`reference.growing_contact`: by 2.1 % after 320 mm and 1.2 % after 640 mm (converged finite
elements: 2.17 % and 1.20 %). Depths at the centre are therefore compared with those, and the later
one with both.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...reference.growing_contact import growing_point
from ..check import Check, compare
from ..starter import run_starter
from .growing import ARCHARD, ELASTIC, RIGID, SPEED, worn_half_width
from .hertz import MODULUS

FORCE, RADIUS, COEFFICIENT = 10.385, 50e-3, 1.33e-13
FIRST, LAST = 0.32, 0.64
PUBLISHED = {FIRST: (2.7426, 1.6924e-6), LAST: (3.2543, 2.3829e-6)}
"""Contact radius over Hertz's, and depth [m], by sliding distance [m]."""
CAP = f"{RIGID}: cap that a flat cuts off a sphere"
KEYS = ("mesh.elements=60", "wear.update=0.0005")


def checks() -> Iterator[Check]:
    """Radius and depth against the published ones, volumes against Archard's law."""
    law = growing_point(FORCE, RADIUS, MODULUS, COEFFICIENT)
    times = f'analysis.end_time="{LAST / SPEED} s"', f'analysis.output_times=["{FIRST / SPEED} s"]'
    result = run_starter("sphere-on-block-growing", *KEYS, *times)
    states = {FIRST: result.outputs[FIRST / SPEED], LAST: result.interface}
    for distance, (ratio, depth) in PUBLISHED.items():
        state, place = states[distance], f"after {1e3 * distance:g} mm"
        radius, worn = worn_half_width(state, 3), float(state.wear_1[0])
        found, elastic = radius / law.start, float(law.elastic_half_width(distance)) / law.start
        yield compare(f"radius over a0 {place} [1]", found, ratio, 2e-2, RIGID)
        yield compare(f"radius over a0 {place}, elastic [1]", found, elastic, 1e-2, ELASTIC)
        cap = radius**2 / (2 * RADIUS)
        yield compare(f"depth {place}, by the radius of the scar [m]", cap, depth, 2e-2, CAP)
        name, dented = f"depth {place}, in the middle", float(law.elastic_depth(distance))
        if distance == LAST:
            yield compare(f"{name} [m]", worn, depth, 2e-2, RIGID)
        yield compare(f"{name}, elastic [m]", worn, dented, 1e-2, ELASTIC)
    summary, volume = result.summary, COEFFICIENT * FORCE * LAST
    lost = summary["geometry_volume_1_m3"]
    yield compare("volume lost by the mesh [m³]", lost, volume, 1e-4, ARCHARD)
    error = summary["geometry_volume_error"]
    known = "integral of the wear over the face"
    yield compare("worst update: volume lost by the mesh [1]", 1 + error, 1.0, 1e-6, known)
