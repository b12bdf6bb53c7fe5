"""Materials, heat and laws of a model from arguments with units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..case.values import units
from ..case.values.units import in_python
from ..errors import CaseError
from ..laws import power_wear
from ..laws.time_course import TimeFunction
from ..model import body, heat, interface
from .body import BodySurface, require_surface
from .conversion import number, quantities

_OF_MATERIALS = {
    "young_modulus": units.Pressure,
    "expansion": units.Expansion,
    "conductivity": units.Conductivity,
    "density": units.Density,
    "specific_heat": units.SpecificHeat,
    "hardness": units.Pressure,
}
_OF_HEAT = {"ambient": units.Temperature, "initial": units.Temperature}
_OF_SURFACES = {
    "cooling": units.HeatTransfer,
    "temperature": units.Temperature,
    "flux": units.HeatFlux,
    "power": units.Power,
}


def Material(
    young_modulus: Any, poisson_ratio: float, *, name: str = "Material", **properties: Any
) -> body.Material:
    """Material of a body.

    Parameters
    ----------
    young_modulus : float or quantity
    poisson_ratio : float
    name : str
        Name in messages.
    **properties : float or quantity
        ``expansion``, ``conductivity``, ``density``, ``specific_heat``, ``hardness`` and other
        attributes of `model.body.Material`.
    """
    poisson = number(poisson_ratio, f"{name}.poisson_ratio", -1.0, 0.5)
    if poisson in (-1.0, 0.5):
        raise CaseError(f"{name}.poisson_ratio: found {poisson}; must be within -1 and 0.5")
    given = quantities(name, _OF_MATERIALS, {"young_modulus": young_modulus, **properties})
    return body.Material(poisson_ratio=poisson, label=name, **given)


def Heat(**settings: Any) -> heat.Heat:
    """Heat sources and thermal boundary conditions.

    Parameters
    ----------
    **settings
        Attributes of `model.heat.Heat`: ``ambient``, ``initial``, ``transient``, ``advection``;
        ``cooling``, ``temperature``, ``flux`` and ``power`` by `BodySurface`.
    """
    of_surfaces = {
        key: by_surface(kind, settings.get(key), f"Heat.{key}")
        for key, kind in _OF_SURFACES.items()
    }
    return heat.Heat(**quantities("Heat", _OF_HEAT, settings) | of_surfaces)


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
