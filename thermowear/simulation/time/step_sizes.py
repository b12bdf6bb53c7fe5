"""How large a step of time may be, besides what its error allows."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import reduce
from typing import Protocol

_HIT = 1e-9
"""Of what is left: a step that ends so near to a time ends there."""
_FEW = 5
"""Powers of two that a way may be made up of: at most so many steps are smaller than need be."""


class StepSizes(Protocol):
    """Chooses sizes of steps on the way from one time that is hit exactly to the next.

    Attributes
    ----------
    rounding : float
        Ratio of a wanted size to the one chosen, at most.
    """

    @property
    def rounding(self) -> float: ...

    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        """A step from a time, between a begin and an end, that is not larger than this one [s]."""


class AnySize:
    """Steps as large as they may be, but none that leaves a tiny one over.

    Parameters
    ----------
    longest : float, optional
        Step that there may be [s].
    """

    rounding = 1.0

    def __init__(self, longest: float = math.inf):
        self._longest = longest

    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        left, wanted = end - time, min(wanted, self._longest)
        return left if ends(wanted, left) else min(wanted, max(left / 2, 0.1 * wanted))


class FewSizes:
    """Halves, quarters, ... and doubles of one size, so that few operators serve all steps.

    Times are multiples of the step that leaves them, as the marks of a ruler are: what is left to
    the next one to be hit is always made up by few steps of such sizes.

    Parameters
    ----------
    times : iterable of float
        All that will be hit exactly [s].
    """

    rounding = 2.0

    def __init__(self, times: Iterable[float]):
        self._measure = reduce(_common_measure, (t for t in times if t < math.inf), 0.0)

    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        unit, passed = self._unit(end - begin), time - begin
        size = unit * 2.0 ** math.floor(math.log2(min(wanted, end - time) / unit) + _HIT)
        while abs(math.remainder(passed, size)) > 1e-3 * size:
            size /= 2
        return size

    def _unit(self, way: float) -> float:
        """What divides the way between two times, and as many others as can be [s]."""
        measure = self._measure or 1.0
        if way == math.inf or round(way / measure).bit_count() <= _FEW:
            return measure
        return way


class Limited:
    """Sizes that others choose, up to a limit that may change from step to step.

    Parameters
    ----------
    sizes : StepSizes

    Attributes
    ----------
    largest : float
        [s]
    """

    def __init__(self, sizes: StepSizes):
        self.largest = math.inf
        self._sizes = sizes

    @property
    def rounding(self) -> float:
        return self._sizes.rounding

    def at_most(self, wanted: float, time: float, begin: float, end: float) -> float:
        return self._sizes.at_most(min(wanted, self.largest), time, begin, end)


def ends(step: float, left: float) -> bool:
    """Whether a step goes as far as a time that is so far away [s]."""
    return step >= left * (1 - _HIT)


def _common_measure(a: float, b: float) -> float:
    """The largest number that both are multiples of, by Euclid's algorithm."""
    rounding = _HIT * max(a, b)
    while b > rounding:
        a, b = b, abs(math.remainder(a, b))
    return a
