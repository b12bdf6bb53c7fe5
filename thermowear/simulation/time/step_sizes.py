"""Constraints on the time step size beside error control."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable
from functools import reduce

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
