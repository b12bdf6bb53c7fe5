"""One number of the program held against a reference."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass

import numpy as np


@dataclass(frozen=True)
class Check:
    """A row of ``thermowear verify``.

    Attributes
    ----------
    id : str
        Of the verification case.
    quantity : str
        What is compared, with its unit.
    computed, reference : float
    error, allowed : float
        Relative, to the reference or to the scale that the quantity names.
    source : str
        Where the reference comes from.
    """

    id: str
    quantity: str
    computed: float
    reference: float
    error: float
    allowed: float
    source: str

    @property
    def passed(self) -> bool:
        return bool(self.error <= self.allowed)  # a NaN fails

    def as_row(self) -> dict:
        """For ``--json``."""
        return asdict(self) | {"passed": self.passed}


Checks = Callable[[], Iterator[Check]]


def compare(
    id: str,
    quantity: str,
    computed: float,
    reference: float,
    allowed: float,
    source: str,
    scale: float | None = None,
) -> Check:
    """Compare two numbers, relative to the reference or to a scale."""
    error = abs(float(computed) - float(reference)) / abs(float(scale or reference))
    return Check(id, quantity, float(computed), float(reference), error, allowed, source)


def along(interface, radii, values) -> np.ndarray:
    """Values at the contact points, interpolated to radii by a cubic spline."""
    from scipy.interpolate import CubicSpline

    return CubicSpline(interface.x, values)(np.asarray(radii, dtype=float))
