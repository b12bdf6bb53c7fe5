"""A half cylinder that is pressed on a block and pushed: thermowear beside boundary elements.

    scripts/env python3 -m tests.benchmarks.pushed_cylinders

Cattaneo's and Mindlin's shear is symmetric. That of a cylinder on a flat is not quite: its zone of
stick lies off the middle by a part of ``a²/R``. Two causes are possible: bodies that do not yield
alike to a force along the face, which is real, or the choice of normals and of points that meet.
Boundary elements on faces that are followed as they deform (`tests.simulation.boundary_elements`)
share nothing of that choice. For each size of the block and each half-width a are printed, by both:
the middle of contact and of stick in ``a²/R``, and the largest difference of the shear to Cattaneo
and Mindlin in parts of its limit, 5 % of a away from all edges; last that between both.
"""

from __future__ import annotations

import numpy as np

from tests.simulation.pushed import FRICTION, R, centres, known, law, on_flat, pushed

PART = 0.5
SIZES = ((4.0, 1.0), (4.0, 2.0), (4.0, 4.0))
RATIOS = (0.005, 0.02)


def main() -> None:
    """Print the table."""
    print("block [R]  a/R    contact         stick           error to C.-M.   both")
    for size in SIZES:
        for ratio in RATIOS:
            exact, a = law(ratio, R), ratio * R
            states = pushed(on_flat(size, 72), exact, PART, 20), known(ratio, 200, PART, size)
            offsets = np.array([centres(state) for state in states]) / (ratio * a)
            x, limit = states[1].x, FRICTION * exact.normal.peak
            away = np.abs(np.abs(x)[:, None] - a * np.array([np.sqrt(PART), 1.0])) > 0.05 * a
            x = x[away.all(axis=1)]
            shears = np.array([np.interp(x, state.x, -state.shear) for state in states]) / limit
            errors = np.abs(shears - exact.shear(x, PART * exact.limit) / limit).max(axis=1)
            columns = [*offsets.T.ravel(), *errors, np.abs(np.diff(shears, axis=0)).max()]
            words = "  ".join(f"{value:+.4f}" for value in columns)
            print(f"{size[0]:g} x {size[1]:g}     {ratio:5.3f}  {words}", flush=True)


if __name__ == "__main__":
    main()
