"""Wear coefficient, friction and exponent from worn depths: the part that measurements determine.

The depth that uniform pressure wears over a distance s is ``k (mu p)^b s``, for wear in proportion
to a power b of the shear stress. Tests at one pressure determine neither k and mu nor k and b, but
a combination of them; tests at two pressures determine k and b.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import exp, log, sqrt

import numpy as np

from ....inference.fit import Fit, fit
from ....inference.identifiability import identify
from ....inference.parameters import Observations, Parameter, ParameterSpace
from ...check import Check, compare, compare_each

COEFFICIENT, FRICTION, EXPONENT = 2e-3, 0.3, 1.4
"""Wear coefficient for pressures in MPa and depths in µm per m, friction, and exponent b."""
LOADS = 1.0, 4.0
"""Pressures [MPa]."""
SCATTER = 0.05
_NAMES = {"k": (1e-3, 1e-5, 1e-1, True), "mu": (0.2, 0.01, 1.0, True), "b": (1.0, 0.5, 3.0, False)}
_TRUE = {"k": COEFFICIENT, "mu": FRICTION, "b": EXPONENT}
_EXACT = "closed form, linear in the logarithms"


def identifiability() -> Iterator[Check]:
    """Combinations that are determined, and standard errors of those fits that are unique."""
    yield from _friction()
    yield from _exponent()


def _friction() -> Iterator[Check]:
    """Fit of k and mu at one pressure: only ``k mu^b`` is determined."""
    found = _fitted(("k", "mu"), LOADS[1:])
    result = identify(found.space, found.jacobian)
    yield compare("undetermined directions, k and mu [1]", result.null.shape[1], 1, 0.0, _EXACT)
    (combination,) = result.combinations
    quantity = "exponent of mu in the combination [1]"
    yield compare(quantity, combination.coefficients[1], EXPONENT, 1e-6, _EXACT)
    quantity = "relative standard deviation of the combination [1]"
    yield compare(quantity, combination.deviation, SCATTER, 1e-6, _EXACT)
    exact = COEFFICIENT * FRICTION**EXPONENT
    yield compare("k mu^b [1]", float(combination.value(found.values)), exact, 1e-6, _EXACT)


def _exponent() -> Iterator[Check]:
    """Fit of k and b: one pressure determines ``k (mu p)^b``, two determine both."""
    found = _fitted(("k", "b"), LOADS[1:])
    result = identify(found.space, found.jacobian)
    yield compare("undetermined directions, k and b [1]", result.null.shape[1], 1, 0.0, _EXACT)
    (combination,) = result.combinations
    base = exp(combination.coefficients[1])
    yield compare("base of b in the combination [1]", base, FRICTION * LOADS[1], 1e-5, _EXACT)
    found = _fitted(("k", "b"), LOADS)
    result = identify(found.space, found.jacobian)
    yield compare("undetermined directions, two loads [1]", result.null.shape[1], 0, 0.0, _EXACT, 1)
    quantity = "fitted {} [1]"
    yield from compare_each(quantity, "kb", found.values, (COEFFICIENT, EXPONENT), 1e-6, _EXACT)
    ratio = log(LOADS[1] / LOADS[0])
    shear = [log(FRICTION * load) for load in LOADS]
    exact = SCATTER * sqrt(sum(x**2 for x in shear)) / ratio, SCATTER * sqrt(2) / ratio
    quantity, places = "standard error of {} from two loads [1]", ("ln k", "b")
    yield from compare_each(quantity, places, found.standard_errors, exact, 1e-5, _EXACT)


def _fitted(unknown: Sequence[str], loads: Sequence[float]) -> Fit:
    """Fit of some parameters to exact depths; the others are known."""
    space = ParameterSpace(tuple(Parameter(name, *_NAMES[name]) for name in unknown))
    model = _Depths(tuple(unknown), np.array(loads))
    depths = model.predict(np.array([_TRUE[name] for name in unknown]))
    return fit(space, Observations(depths, SCATTER * depths, ("depth",) * len(depths)), model)


@dataclass(frozen=True)
class _Depths:
    """Worn depths per distance at several pressures, ``k mu^b p^b``."""

    unknown: tuple[str, ...]
    loads: np.ndarray
    step: float = 1e-4

    def predict(self, values: np.ndarray) -> np.ndarray:
        of = _TRUE | dict(zip(self.unknown, values, strict=True))
        return of["k"] * (of["mu"] * self.loads) ** of["b"]

    def neighbours(self, values: np.ndarray, others: Sequence[np.ndarray]) -> list[np.ndarray]:
        return [self.predict(other) for other in others]
