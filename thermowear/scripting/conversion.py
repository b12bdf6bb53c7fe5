"""Conversion of Python arguments: quantities, laws, and histories of time."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

from ..case.values import units
from ..case.values.units import expression, in_python
from ..errors import CaseError
from ..laws import time_course
from ..laws.coefficients import Constant
from ..laws.formulas import FormulaLaw, FormulaWear, interface_law, wear_rate
from ..laws.interfaces import INTERFACE_VARIABLES, WEAR_VARIABLES, Law
from ..laws.plausible import require_interface_law
from ..laws.time_course import TimeFunction

_LOADS = {
    "force": units.LeastForce,
    "approach": units.Displacement,
    "tangential_force": units.SignedForce,
    "tangential_displacement": units.Displacement,
}


def quantities(name: str, kinds: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of a function with its quantities in SI; see `case.values.units.in_python`.

    Parameters
    ----------
    name : str
        Name of the function, for messages.
    kinds : mapping of str to Annotated
        Type of each quantity.
    given : mapping of str to object
        Arguments; None and those without a type are kept.
    """
    return {
        key: in_python(kinds[key], value, f"{name}.{key}")
        if key in kinds and value is not None
        else value
        for key, value in given.items()
    }


def each_quantity(kind: Any, values: Iterable[Any], name: str) -> tuple[float, ...]:
    """Quantities of a sequence, in SI."""
    return tuple(in_python(kind, value, name) for value in values)


def number(value: Any, name: str, least: float = -math.inf, most: float = math.inf) -> float:
    """Read a number without a unit."""
    if isinstance(value, bool | str) or not least <= value <= most:
        raise CaseError(f"{name}: found {value!r}; must be a number from {least:g} to {most:g}")
    return float(value)


def coefficient_law(given: Any, name: str, unit: str, least: float) -> Law:
    """Friction or conductance.

    Parameters
    ----------
    given : float, str, Law or callable
        Number in SI, expression in p, v and T with units, law, or function of some of p, v and T.
    name : str
        Name of the argument, for messages.
    unit : str
        SI unit of the value; empty for a number without one.
    least : float
        Smallest value that an expression may have.
    """
    with _faults_of(name):
        if isinstance(given, str):
            found = expression(given, unit, INTERFACE_VARIABLES)
            constant = found.constant
            law: Law = FormulaLaw(found, name, least) if constant is None else Constant(constant)
        else:
            law = interface_law(given)
        if not isinstance(law, Constant):
            require_interface_law(law)
    if isinstance(law, Constant):
        number(law.number, name, least=0.0)
    return law


def rate_law(given: Any, name: str) -> Law:
    """Wear rate from an expression with units, a law, or a function of p, v, T, depth and mu."""
    with _faults_of(name):
        if isinstance(given, str):
            given = FormulaWear(expression(given, "m/s", WEAR_VARIABLES), name)
        return wear_rate(given)


@contextmanager
def _faults_of(name: str) -> Iterator[None]:
    """Name of the argument in messages."""
    try:
        yield
    except (ValueError, CaseError) as error:
        raise CaseError(f"{name}: {error}") from None


def TimeHistory(time: Sequence[Any], values: Sequence[Any], repeat: bool = False) -> TimeFunction:
    """Piecewise linear function of time, constant beyond its ends or periodic.

    Parameters
    ----------
    time : sequence
        Increasing instants [s].
    values : sequence
        Factors without unit, or temperatures [K].
    repeat : bool
        Repeat the course from the last instant on.
    """
    name = "TimeHistory"
    read = [
        in_python(units.Temperature, value, f"{name}.values")
        if isinstance(value, str)
        else number(value, f"{name}.values")
        for value in values
    ]
    if len(read) != len(time):
        raise CaseError(f"{name}: has {len(time)} instants and {len(read)} values")
    return TimeFunction(_instants(time, name), repeat, tuple(read))


def LoadHistory(
    time: Sequence[Any],
    *,
    force: Sequence[Any] | None = None,
    approach: Sequence[Any] | None = None,
    tangential_force: Sequence[Any] | None = None,
    tangential_displacement: Sequence[Any] | None = None,
    repeat: bool = False,
    cycle_start: Any = None,
) -> time_course.LoadHistory:
    """Loads of a holder at instants, see `laws.time_course.LoadHistory`."""
    loads = force, approach, tangential_force, tangential_displacement
    instants, read = _instants(time, "LoadHistory"), {}
    for (key, kind), values in zip(_LOADS.items(), loads, strict=True):
        if values is not None:
            name = f"LoadHistory.{key}"
            if len(values) != len(time):
                raise CaseError(f"{name}: has {len(values)} values for {len(time)} instants")
            read[key] = each_quantity(kind, values, name)
    if cycle_start is not None:
        cycle_start = in_python(units.Instant, cycle_start, "LoadHistory.cycle_start")
    return time_course.LoadHistory(instants, repeat, **read, cycle_start=cycle_start)


def _instants(time: Sequence[Any], name: str) -> tuple[float, ...]:
    instants = each_quantity(units.Instant, time, f"{name}.time")
    if len(instants) < 2 or any(b <= a for a, b in pairwise(instants)):
        raise CaseError(f"{name}.time: needs two or more increasing instants")
    return instants
