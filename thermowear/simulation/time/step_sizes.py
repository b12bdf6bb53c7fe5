"""Sizes of time steps: choice between times that must be hit exactly, and error control."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable
from functools import reduce

import numpy as np

_HIT = 1e-9
"""Distance to a target time, relative to the time left, at which a step is taken to end there."""
_FEW = 5
"""Largest number of powers of two that make up an interval; bounds the number of small steps."""


class StepSizes(ABC):
    """Choice of step sizes between two consecutive times that must be hit exactly.

    Parameters
    ----------
    largest : float, optional
        Upper bound, which may change from step to step [s].

    Attributes
    ----------
    rounding : float
        Largest ratio of a wanted step size to the one chosen.
    """

    rounding = 1.0

    def __init__(self, largest: float = math.inf):
        self.largest = largest

    @abstractmethod
    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        """Step from a time between begin and end, not larger than the wanted one [s]."""

    def nominal(self, step: float, begin: float, end: float) -> float:
        """Size of an earlier step between begin and end, without the rounding of its times [s]."""
        return step


class AnySize(StepSizes):
    """Largest admissible steps that do not leave a tiny last one."""

    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        left, wanted = end - time, min(wanted, self.largest)
        return left if ends(wanted, left) else min(wanted, max(left / 2, 0.1 * wanted))


class FewSizes(StepSizes):
    """Power-of-two multiples of one step size, so that few operators serve all steps.

    Each step begins at a multiple of its size (dyadic grid): the time left to the next target is
    always a sum of few such steps.

    Parameters
    ----------
    times : iterable of float
        All times that must be hit exactly [s].
    """

    rounding = 2.0

    def __init__(self, times: Iterable[float]):
        super().__init__()
        self._measure = reduce(_common_measure, (t for t in times if t < math.inf), 0.0)

    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        unit, passed = self._unit(end - begin), time - begin
        wanted = min(wanted, self.largest, end - time)
        size = unit * 2.0 ** math.floor(math.log2(wanted / unit) + _HIT)
        while abs(math.remainder(passed, size)) > 1e-3 * size:
            size /= 2
        return size

    def nominal(self, step: float, begin: float, end: float) -> float:
        unit = self._unit(end - begin)
        size = unit * 2.0 ** round(math.log2(step / unit))
        return size if abs(size - step) <= _HIT * step else step

    def _unit(self, interval: float) -> float:
        """Unit of the step sizes: common measure of all times, or the interval if too fine [s]."""
        measure = self._measure or 1.0
        if interval == math.inf or round(interval / measure).bit_count() <= _FEW:
            return measure
        return interval


def ends(step: float, left: float) -> bool:
    """Test whether a step covers the time left, up to rounding [s]."""
    return step >= left * (1 - _HIT)


def _common_measure(a: float, b: float) -> float:
    """Greatest common divisor of two real numbers by Euclid's algorithm, up to rounding."""
    rounding = _HIT * max(a, b)
    while b > rounding:
        a, b = b, abs(math.remainder(a, b))
    return a


def next_step(
    step: float, error: float, tolerance: float, former: tuple[float, float] | None = None
) -> float:
    """Step size expected to meet the tolerance; the error is of third order in the step.

    Slower growth of the error from the former step to this one is extrapolated to the next
    (predictive control, Gustafsson, ACM Trans. Math. Softw. 20 (1994) 496).

    Parameters
    ----------
    step, error, tolerance : float
    former : tuple of float, optional
        Size and error of the preceding step; no prediction without them.
    """
    if error == 0.0:
        return 5.0 * step
    factor = 0.9 * (tolerance / error) ** (1 / 3)
    if former is not None and factor > 1.0:
        factor *= max(1.0, step / former[0] * (former[1] / error) ** (1 / 3))
    return step * float(np.clip(factor, 0.2, 5.0))
