"""Comparison of one number of the program with a reference."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass

import numpy as np

from ..errors import CaseError, ComputationError


@dataclass(frozen=True)
class Check:
    """Row of ``thermowear verify``.

    Attributes
    ----------
    id : str
        Id of the verification case.
    quantity : str
        Compared quantity, with its unit.
    computed, reference : float
    error, allowed : float
        Relative error and its tolerance, to the reference or to the scale named by the quantity.
    source : str
        Source of the reference.
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
        return bool(self.error <= self.allowed)  # fails for NaN

    def as_row(self) -> dict:
        """Dictionary for ``--json``; None for numbers that are not finite."""
        row = asdict(self) | {"passed": self.passed}
        numbers = (key for key, value in row.items() if isinstance(value, float))
        return row | {key: None for key in numbers if not math.isfinite(row[key])}


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


def all_checks(id: str, checks: Checks) -> list[Check]:
    """All checks of a case; after an error, the previous ones and one that fails."""
    found: list[Check] = []
    try:
        found.extend(checks())
    except Exception as error:
        expected = isinstance(error, CaseError | ComputationError)
        reason = " ".join(f"{'' if expected else f'{type(error).__name__}: '}{error}".split())
        nothing = math.nan
        found.append(
            Check(
                id, f"not computed: {reason}", nothing, nothing, nothing, 0.0, "the program itself"
            )
        )
    return found


def along(interface, radii, values) -> np.ndarray:
    """Values at the contact points, interpolated to radii by a cubic spline."""
    from scipy.interpolate import CubicSpline

    return CubicSpline(interface.x, values)(np.asarray(radii, dtype=float))
