"""Heat: by friction, from the surroundings, and where it goes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, PlainSerializer, PlainValidator, TypeAdapter, ValidationInfo

from ...errors import quoted
from ..values import units
from ..values.section import Section, Switch
from .conductance import Conductance
from .history import Course, TemperatureHistory


def _share(value: Any) -> Any:
    """A number as a float; one message for all that is neither a part nor the word."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if number and math.isfinite(value) and 0 <= value <= 1:
        return float(value)
    if value == "effusivity":
        return value
    raise ValueError(f'found {quoted(value)}; must be at least 0 and at most 1, or "effusivity"')


Partition = Annotated[float | Literal["effusivity"], BeforeValidator(_share)]


_CONSTANT = TypeAdapter(units.Temperature)


def _temperature(data: Any, info: ValidationInfo) -> Any:
    """A constant where it is a quantity, else a history, or the name of a file with one."""
    in_a_file = isinstance(data, str) and data.strip().lower().endswith(".csv")
    if in_a_file or isinstance(data, dict | TemperatureHistory):
        return TemperatureHistory.model_validate(data, context=info.context)
    return _CONSTANT.validate_python(data)


def _written(value: Any) -> Any:
    return value.model_dump() if isinstance(value, Section) else _CONSTANT.dump_python(value)


GivenTemperature = Annotated[
    float | TemperatureHistory, PlainValidator(_temperature), PlainSerializer(_written)
]
"""A constant [K], or a history."""


class Heat(Section):
    """Temperatures of the bodies, what heats them, and where the heat goes.

    Friction heats where the bodies slide; pressed together at rest they conduct.

    Attributes
    ----------
    conductance : float, PressureConductance, TabulatedConductance or None
        Contact conductance [W/(m² K)], or how it depends on the pressure; None: perfect contact.
    gap_conductance : float or None
        Of faces that are apart [W/(m² K)]; None: they exchange no heat.
    partition : float or str
        Part of the friction heat that is set free on body 1; ``"effusivity"``: ``e1/(e1 + e2)``.
    advection : str
        What a body 2 that passes under body 1 does with heat: ``"none"``, it conducts as if it
        stood still; ``"resolved"``, it carries heat along; ``"spread"``, it passes so fast that
        heat is spread evenly along its way.
    transient : bool
        Temperatures in time, instead of those that the present friction heat would lead to.
    initial : float or None
        Temperature of both bodies at the start, by default the ambient one [K].
    ambient : float
        Temperature of the surroundings, and of the stress-free state [K].
    ambient_history : TemperatureHistory or None
        Of the surroundings, where their temperature changes in time; the stress-free state keeps
        `ambient`.
    cooling : dict of str to float
        Heat transfer coefficients of named surfaces [W/(m² K)].
    temperature : dict of str to float or TemperatureHistory
        Given temperatures of named surfaces [K].
    flux : dict of str to float
        Heat into the body through named surfaces, per area; negative: out of it [W/m²].
    power : dict of str to float
        Likewise of whole surfaces, spread evenly: of the whole ring, or of the thickness [W].
    """

    conductance: Conductance | None = None
    gap_conductance: units.HeatTransfer | None = None
    partition: Partition = 0.5
    advection: Literal["none", "resolved", "spread"] = "none"
    transient: Switch = False
    initial: units.Temperature | None = None
    ambient: units.Temperature = 293.15
    ambient_history: TemperatureHistory | None = None
    cooling: dict[str, units.HeatTransfer] = {}
    temperature: dict[str, GivenTemperature] = {}
    flux: dict[str, units.HeatFlux] = {}
    power: dict[str, units.Power] = {}

    @property
    def histories(self) -> Mapping[str, Course]:
        """What changes in time, by its key."""
        found = {
            f"temperature.{surface}": value
            for surface, value in self.temperature.items()
            if isinstance(value, TemperatureHistory)
        }
        if self.ambient_history is not None:
            found["ambient_history"] = self.ambient_history
        return found

    @property
    def driven(self) -> bool:
        """Whether anything but friction makes the bodies warmer or colder than the ambient."""
        given = [*self.temperature.values(), self.ambient if self.initial is None else self.initial]
        return bool(self.flux or self.power or self.ambient_history) or any(
            value != self.ambient for value in given
        )
