"""Sobol indices of functions whose indices are known."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

from ....inference.distributions import Uniform
from ....inference.sampling import saltelli
from ....inference.sensitivity import sobol_indices
from ....reference.sensitivity_functions import Ishigami, SobolProduct
from ...check import Check, compare_each

POINTS = 4096
_ALLOWED = 2e-2
_SOURCE = "closed form (Saltelli et al., Global Sensitivity Analysis, 2008)"


def sobol() -> Iterator[Check]:
    """First-order and total indices of Ishigami's function and of the g-function."""
    ishigami, product = Ishigami(), SobolProduct()
    yield from _indices("Ishigami's function", ishigami, [Uniform(-pi, pi)] * 3)
    yield from _indices("g-function", product, [Uniform(0.0, 1.0)] * len(product.a))


def _indices(
    name: str, function: Ishigami | SobolProduct, inputs: list[Uniform]
) -> Iterator[Check]:
    """Indices of all inputs of a function, to the variance of its value."""
    design = saltelli(inputs, POINTS)
    found = sobol_indices(*design.split(function(design.points)))
    both = ("first-order", found.first, function.first), ("total", found.total, function.total)
    for kind, indices, known in both:
        quantity, places = f"{kind} index of x{{}}, {name} [1]", range(1, len(inputs) + 1)
        yield from compare_each(quantity, places, indices[:, 0], known, _ALLOWED, _SOURCE, 1.0)
