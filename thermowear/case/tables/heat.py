"""Table ``heat``: sources, boundary conditions, interface properties."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import PlainSerializer, PlainValidator, TypeAdapter, ValidationInfo

from ..values import units
from ..values.section import Section, Switch, number_or
from .history import TemperatureHistory, TimeHistory
from .laws import Conductance

_PARTITION = number_or(
    "effusivity",
    where=lambda share: 0 <= share <= 1,
    allowed='at least 0 and at most 1, or "effusivity"',
)
_CONSTANT = TypeAdapter(units.Temperature)


def _parse_temperature(data: Any, info: ValidationInfo) -> Any:
    """Convert a quantity to a constant, a table or the name of a CSV file to a history."""
    in_a_file = isinstance(data, str) and data.strip().lower().endswith(".csv")
    if in_a_file or isinstance(data, dict | TemperatureHistory):
        return TemperatureHistory.model_validate(data, context=info.context)
    return _CONSTANT.validate_python(data)


def _serialise_temperature(value: Any) -> Any:
    return value.model_dump() if isinstance(value, Section) else _CONSTANT.dump_python(value)


GivenTemperature = Annotated[
    float | TemperatureHistory,
    PlainValidator(_parse_temperature),
    PlainSerializer(_serialise_temperature),
]
"""Constant [K], or history of a temperature."""


class HeatTable(Section):
    """Heat sources, thermal boundary conditions and thermal properties of the interface.

    Friction heats the faces while the bodies slide; bodies in contact conduct also at rest. Keys
    are those of `model.heat.Heat`; `conductance`, `gap_conductance` and `partition` are those of
    `model.interface.Interface`.
    """

    conductance: Conductance | None = None
    gap_conductance: units.HeatTransfer | None = None
    partition: Annotated[float | Literal["effusivity"], _PARTITION] = 0.5
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
    def histories(self) -> Mapping[str, TimeHistory]:
        """Time histories by key."""
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
        """True if the bodies are heated or cooled by anything besides friction."""
        given = [*self.temperature.values(), self.ambient if self.initial is None else self.initial]
        return bool(self.flux or self.power or self.ambient_history) or any(
            value != self.ambient for value in given
        )
