"""Completed runs of (starter) cases, and comparison of their numbers with references."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import wraps
from typing import Any

import numpy as np

from .. import geometry  # noqa: F401  (makes the geometries known)
from ..case import AnyCase, load
from ..case.starters import starter_text
from ..errors import CaseError, ComputationError
from ..results import Result
from ..simulation import run


@dataclass(frozen=True)
class Check:
    """Row of ``thermowear verify``.

    Attributes
    ----------
    quantity : str
        Compared quantity, with its unit.
    computed, reference : float
    error, allowed : float
        Relative error and its tolerance, to the reference or to the scale named by the quantity.
    source : str
        Source of the reference.
    id : str
        Id of the verification case, see `identified`.
    """

    quantity: str
    computed: float
    reference: float
    error: float
    allowed: float
    source: str
    id: str = ""

    @property
    def passed(self) -> bool:
        return bool(self.error <= self.allowed)  # fails for NaN

    def as_row(self) -> dict:
        """Dictionary for ``--json``; None for numbers that are not finite."""
        row = {"id": self.id} | asdict(self) | {"passed": self.passed}
        numbers = (key for key, value in row.items() if isinstance(value, float))
        return row | {key: None for key in numbers if not math.isfinite(row[key])}


Checks = Callable[[], Iterator[Check]]


def compare(
    quantity: str,
    computed: float,
    reference: float,
    allowed: float,
    source: str,
    scale: float | None = None,
) -> Check:
    """Compare two numbers, relative to the reference or to a scale."""
    error = abs(float(computed) - float(reference)) / abs(float(scale or reference))
    return Check(quantity, float(computed), float(reference), error, allowed, source)


def compare_worst(
    quantity: str, computed, exact, allowed: float, source: str, scale: float | None = None
) -> Check:
    """Compare values at points at the point of largest deviation, relative to the largest value."""
    computed, exact = np.broadcast_arrays(computed, exact)
    at = int(np.abs(computed - exact).argmax())
    scale = scale or float(np.abs(exact).max())
    return compare(quantity, computed[at], exact[at], allowed, source, scale)


def compare_each(
    quantity: str,
    places: Iterable,
    computed: Iterable[float],
    exact: Iterable[float],
    allowed: float,
    source: str,
    scale: float | None = None,
) -> Iterator[Check]:
    """Compare values at several places, which the quantity names in a replacement field."""
    for place, found, known in zip(places, computed, exact, strict=True):
        yield compare(quantity.format(place), found, known, allowed, source, scale)


def printed(quantity: str, computed: float, text: str) -> Check:
    """Compare a number with a tabulated one, to half a unit of its last digit."""
    mantissa, _, power = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    half_unit = 0.5 * 10.0 ** (int(power or 0) - decimals)
    known = float(text)  # ties in rounding are allowed
    return compare(
        quantity, computed, known, half_unit / abs(known) * (1 + 1e-9), "closed form, tabulated"
    )


def identified(id: str, *parts: Checks) -> Checks:
    """Checks of all parts of a case with its id, described as the first of them."""

    @wraps(parts[0])
    def every() -> Iterator[Check]:
        return (replace(check, id=id) for checks in parts for check in checks())

    return every


def all_checks(id: str, checks: Checks) -> list[Check]:
    """All checks of a case; after an error, the previous ones and one that fails."""
    found: list[Check] = []
    try:
        found.extend(checks())
    except Exception as error:
        expected = isinstance(error, CaseError | ComputationError)
        reason = " ".join(f"{'' if expected else f'{type(error).__name__}: '}{error}".split())
        nothing = (math.nan,) * 3
        found.append(Check(f"not computed: {reason}", *nothing, 0.0, "the program itself", id))
    return found


def along(interface, radii, values) -> np.ndarray:
    """Values at the contact points, interpolated to radii by a cubic spline."""
    from scipy.interpolate import CubicSpline

    return CubicSpline(interface.x, values)(np.asarray(radii, dtype=float))


def computed(case: AnyCase) -> Result:
    """Compute a case to its end.

    Raises
    ------
    ComputationError
        If it stopped early, or its balances do not hold.
    KeyboardInterrupt
        If a stop was requested during the run.
    """
    result = run(case)
    if result.stopped is not None:
        raise result.stopped
    return result


def starter(name: str, *overrides: str, without: tuple[str, ...] = ()) -> Any:
    """Starter case with changes.

    Parameters
    ----------
    name : str
    *overrides : str
        ``KEY=VALUE`` each.
    without : tuple of str
        Paths of tables and keys to leave out.
    """
    tables = tomllib.loads(starter_text(name))
    for path in without:
        *above, key = path.split(".")
        table = tables
        for part in above:
            table = table[part]
        del table[key]
    return load(tables, overrides)


def run_starter(name: str, *overrides: str, without: tuple[str, ...] = ()) -> Result:
    """Compute a starter case; parameters as in `starter`."""
    return computed(starter(name, *overrides, without=without))
