"""Sobol indices of functions, and of a run, whose indices are known."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import pi

import numpy as np

from .... import load
from ....case import as_plain
from ....case.studies.scalars import Scalar
from ....inference.distributions import Uniform
from ....inference.sensitivity import saltelli, sobol_indices
from ....reference.sensitivity_functions import Ishigami, SobolProduct, UniformProduct
from ....simulation.analyses.run import Series
from ....simulation.from_case import analysis_of, model_of
from ...check import Check, compare_each, starter

POINTS = 4096
RUNS = 256
"""Number of base samples of functions, and of runs."""
INPUTS = {
    ("load.mean_pressure", "MPa"): (20.0, 80.0),
    ("motion.angular_velocity", "rad/s"): (0.05, 0.15),
    ("contact.friction", ""): (0.1, 0.4),
}
"""Ends of the uniform inputs of the runs by key and unit."""
_ALLOWED = 2e-2
_SOURCE = "closed form (Saltelli et al., Global Sensitivity Analysis, 2008)"


def sobol() -> Iterator[Check]:
    """First-order and total indices of Ishigami's function, the g-function, and a steady state."""
    ishigami, product = Ishigami(), SobolProduct()
    yield from _indices("Ishigami's function", ishigami, [Uniform(-pi, pi)] * 3)
    yield from _indices("g-function", product, [Uniform(0.0, 1.0)] * len(product.a))
    ends = tuple(INPUTS.values())
    inputs = [Uniform(low, high) for low, high in ends]
    known = UniformProduct(ends)
    yield from _indices("friction power of a ring", known, inputs, RUNS, _friction_powers)


def _friction_powers(points: np.ndarray) -> np.ndarray:
    """Friction power of a cold ring, proportional to the product of its inputs [W]."""
    small = "mesh.degree=2", "mesh.elements=3"
    tables = as_plain(starter("annular-punch", *small, without=("heat",)))
    series, powers = Series(), []
    for point in points:
        values = (
            Scalar(float(value), unit) for (_, unit), value in zip(INPUTS, point, strict=True)
        )
        changes = (value.override(key) for (key, _), value in zip(INPUTS, values, strict=True))
        case = load(tables, tuple(changes))
        result = series.run(model_of(case), analysis_of(case))
        powers.append(result.summary["friction_power_W"])
    return np.array(powers)


def _indices(
    name: str,
    function: Ishigami | SobolProduct | UniformProduct,
    inputs: list[Uniform],
    points: int = POINTS,
    computed: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Iterator[Check]:
    """Indices of all inputs of a function, or of what is computed instead, to its variance."""
    design = saltelli(inputs, points)
    found = sobol_indices(*design.split((computed or function)(design.points)))
    both = ("first-order", found.first, function.first), ("total", found.total, function.total)
    for kind, indices, known in both:
        quantity, places = f"{kind} index of x{{}}, {name} [1]", range(1, len(inputs) + 1)
        yield from compare_each(quantity, places, indices[:, 0], known, _ALLOWED, _SOURCE, 1.0)
