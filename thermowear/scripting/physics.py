"""Materials, heat and laws of a model from arguments with units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..laws import power_wear
from ..laws.coefficients import Table1D
from ..laws.time_course import TimeFunction
from ..model import body, heat, interface
from .body import BodySurface, require_surface
from .conversion import number


def Material(
    young_modulus: Any,
    poisson_ratio: float,
    *,
    expansion: Any = 0.0,
    conductivity: Any = None,
    density: Any = None,
    specific_heat: Any = None,
    hardness: Any = None,
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
        conductivity=optional(units.Conductivity, conductivity, f"{name}.conductivity"),
        density=optional(units.Density, density, f"{name}.density"),
        specific_heat=optional(units.SpecificHeat, specific_heat, f"{name}.specific_heat"),
        hardness=optional(units.Pressure, hardness, f"{name}.hardness"),
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
) -> heat.Heat:
    """Heat sources and thermal boundary conditions by surface, see `model.conditions.Heat`."""
    return heat.Heat(
        ambient=in_python(units.Temperature, ambient, "Heat.ambient"),
        ambient_history=ambient_history,
        initial=optional(units.Temperature, initial, "Heat.initial"),
        transient=transient,
        advection=advection,
        cooling=by_surface(units.HeatTransfer, cooling, "Heat.cooling"),
        temperature=by_surface(units.Temperature, temperature, "Heat.temperature"),
        flux=by_surface(units.HeatFlux, flux, "Heat.flux"),
        power=by_surface(units.Power, power, "Heat.power"),
    )


def optional(kind: Any, value: Any, name: str) -> float | None:
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


def PowerWear(coefficient: Any, b: float = 1.0, a: float = 1.0) -> power_wear.PowerWear:
    """Wear rate ``coefficient p^b v^a``, see `laws.power_wear.PowerWear`."""
    name = "PowerWear"
    b, a = number(b, f"{name}.b", 0.1, 10.0), number(a, f"{name}.a", 0.0, 10.0)
    unit = ("" if a == 1 else f"(m/s)^{1 - a:.12g} ") + f"1/Pa^{b:.12g}"
    kind = units.quantity(unit, f"1e-13 {unit}", gt=0)
    return power_wear.PowerWear(in_python(kind, coefficient, f"{name}.coefficient"), b, a)


def PressureConductance(coefficient: Any) -> interface.HardnessConductance:
    """Conductance ``coefficient k p / H``, see `model.interface.HardnessConductance`."""
    name = "PressureConductance.coefficient"
    return interface.HardnessConductance(in_python(units.PerLength, coefficient, name))
