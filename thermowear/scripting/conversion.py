"""Materials, heat, laws and histories of a model from Python arguments with units."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import Any, Literal

from ..case.values import units
from ..case.values.units import expression, in_python
from ..errors import CaseError
from ..laws import histories, wear
from ..laws.formulas import (
    PLACE,
    FormulaLaw,
    FormulaWear,
    PlaceFunction,
    interface_law,
    require_interface_law,
    wear_rate,
)
from ..laws.histories import TimeFunction
from ..laws.interfaces import INTERFACE_VARIABLES, WEAR_VARIABLES, Constant, Law, Table1D
from ..model import body, conditions, interface
from .body import BodySurface, require_surface

_LOADS = {
    "force": units.LeastForce,
    "approach": units.Displacement,
    "tangential_force": units.SignedForce,
    "tangential_displacement": units.Displacement,
    "moment": units.SignedMoment,
    "tangential_force_y": units.SignedForce,
    "tangential_displacement_y": units.Displacement,
    "torque": units.SignedMoment,
    "twist": units.Twist,
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
        key: _optional(kinds[key], value, f"{name}.{key}") if key in kinds else value
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


def place_function(given: Any, name: str) -> PlaceFunction | None:
    """Pressure from a number, an expression with units, or a function of x, y, z and r."""
    with _faults_of(name):
        if isinstance(given, str):
            return PlaceFunction(expression(given, "Pa", tuple(PLACE)))
        if given is None:
            return None
        return PlaceFunction.of(given if callable(given) else number(given, name, least=0.0))


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
    moment: Sequence[Any] | None = None,
    tangential_force_y: Sequence[Any] | None = None,
    tangential_displacement_y: Sequence[Any] | None = None,
    torque: Sequence[Any] | None = None,
    twist: Sequence[Any] | None = None,
) -> histories.LoadHistory:
    """Loads of a holder at instants, see `laws.histories.LoadHistory`."""
    loads = (
        *(force, approach, tangential_force, tangential_displacement, moment),
        *(tangential_force_y, tangential_displacement_y, torque, twist),
    )
    instants, read = _instants(time, "LoadHistory"), {}
    for (key, kind), values in zip(_LOADS.items(), loads, strict=True):
        if values is not None:
            name = f"LoadHistory.{key}"
            if len(values) != len(time):
                raise CaseError(f"{name}: has {len(values)} values for {len(time)} instants")
            read[key] = each_quantity(kind, values, name)
    if cycle_start is not None:
        cycle_start = in_python(units.Instant, cycle_start, "LoadHistory.cycle_start")
    return histories.LoadHistory(instants, repeat, **read, cycle_start=cycle_start)


def _instants(time: Sequence[Any], name: str) -> tuple[float, ...]:
    instants = each_quantity(units.Instant, time, f"{name}.time")
    if len(instants) < 2 or any(b <= a for a, b in pairwise(instants)):
        raise CaseError(f"{name}.time: needs two or more increasing instants")
    return instants


def Material(
    young_modulus: Any,
    poisson_ratio: float,
    *,
    expansion: Any = 0.0,
    conductivity: Any = None,
    density: Any = None,
    specific_heat: Any = None,
    hardness: Any = None,
    yield_strength: Any = None,
    expansion_factor: Table1D | None = None,
    conductivity_factor: Table1D | None = None,
    name: str = "Material",
) -> body.Material:
    """Material of a body, see `model.body.Material`; `name` is that in messages."""
    poisson = number(poisson_ratio, f"{name}.poisson_ratio", -1.0, 0.5)
    if poisson in (-1.0, 0.5):
        raise CaseError(f"{name}.poisson_ratio: found {poisson}; must be within -1 and 0.5")
    return body.Material(
        young_modulus=in_python(units.Pressure, young_modulus, f"{name}.young_modulus"),
        poisson_ratio=poisson,
        expansion=in_python(units.Expansion, expansion, f"{name}.expansion"),
        conductivity=_optional(units.Conductivity, conductivity, f"{name}.conductivity"),
        density=_optional(units.Density, density, f"{name}.density"),
        specific_heat=_optional(units.SpecificHeat, specific_heat, f"{name}.specific_heat"),
        hardness=_optional(units.Pressure, hardness, f"{name}.hardness"),
        yield_strength=_optional(units.Pressure, yield_strength, f"{name}.yield_strength"),
        expansion_factor=expansion_factor,
        conductivity_factor=conductivity_factor,
        label=name,
    )


def Heat(
    *,
    ambient: Any = 293.15,
    ambient_history: TimeFunction | None = None,
    initial: Any = None,
    transient: bool = False,
    advection: Literal["none", "resolved", "spread"] = "none",
    cooling: Mapping[BodySurface, Any] | None = None,
    temperature: Mapping[BodySurface, Any] | None = None,
    flux: Mapping[BodySurface, Any] | None = None,
    power: Mapping[BodySurface, Any] | None = None,
) -> conditions.Heat:
    """Heat sources and thermal boundary conditions by surface, see `model.conditions.Heat`."""
    return conditions.Heat(
        ambient=in_python(units.Temperature, ambient, "Heat.ambient"),
        ambient_history=ambient_history,
        initial=_optional(units.Temperature, initial, "Heat.initial"),
        transient=transient,
        advection=advection,
        cooling=by_surface(units.HeatTransfer, cooling, "Heat.cooling"),
        temperature=by_surface(units.Temperature, temperature, "Heat.temperature"),
        flux=by_surface(units.HeatFlux, flux, "Heat.flux"),
        power=by_surface(units.Power, power, "Heat.power"),
    )


def _optional(kind: Any, value: Any, name: str) -> float | None:
    """Read an argument that may be None; see `case.values.units.in_python`."""
    return None if value is None else in_python(kind, value, name)


def by_surface(kind: Any, given: Mapping[BodySurface, Any] | None, name: str) -> dict[str, Any]:
    """Quantities, or functions of time, by the name of their surface."""
    result = {}
    for surface, value in (given or {}).items():
        require_surface(surface, name)
        constant = not isinstance(value, TimeFunction)
        result[surface.name] = in_python(kind, value, name) if constant else value
    return result


def PowerWear(coefficient: Any, b: float = 1.0, a: float = 1.0) -> wear.PowerWear:
    """Wear rate ``coefficient p^b v^a``, see `laws.wear.PowerWear`."""
    name = "PowerWear"
    b, a = number(b, f"{name}.b", 0.1, 10.0), number(a, f"{name}.a", 0.0, 10.0)
    unit = ("" if a == 1 else f"(m/s)^{1 - a:.12g} ") + f"1/Pa^{b:.12g}"
    kind = units.quantity(unit, f"1e-13 {unit}", gt=0)
    return wear.PowerWear(in_python(kind, coefficient, f"{name}.coefficient"), b, a)


def LayeredWear(thickness: Sequence[Any], laws: Sequence[Any], substrate: Any) -> wear.LayeredWear:
    """Wear of a face with layers, see `laws.wear.LayeredWear`.

    Parameters
    ----------
    thickness : sequence
        Thickness of each layer, from the surface down [m].
    laws : sequence of (str, Law or callable)
        Wear rate of each layer.
    substrate : str, Law or callable
        Wear rate below all layers.

    Raises
    ------
    CaseError
        If there is no layer, a thickness is not greater than 0, or a law is invalid.
    """
    name = "LayeredWear"
    found = each_quantity(units.Length, thickness, f"{name}.thickness")
    if not found or len(found) != len(laws):
        raise CaseError(f"{name}: has {len(laws)} laws for {len(found)} layers")
    each = [rate_law(law, f"{name}.laws") for law in laws]
    if any(isinstance(law, wear.LayeredWear) for law in (*each, substrate)):
        raise CaseError(f"{name}: a layer cannot have layers; give all of them in one list")
    each.append(rate_law(substrate, f"{name}.substrate"))
    return wear.LayeredWear(found, tuple(each))


def PressureConductance(coefficient: Any) -> interface.HardnessConductance:
    """Conductance ``coefficient k p / H``, see `model.interface.HardnessConductance`."""
    name = "PressureConductance.coefficient"
    return interface.HardnessConductance(in_python(units.PerLength, coefficient, name))
