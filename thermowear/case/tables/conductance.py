"""Contact conductance in the case file."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import PlainSerializer, PlainValidator, TypeAdapter, model_validator

from ...laws.coefficients import Table1D
from ...laws.expressions import Expression
from ...laws.interfaces import INTERFACE_VARIABLES
from ..values import units
from ..values.expressions import expression
from ..values.section import KeyFault, Section
from .law_values import LawTable, checked, typed_table, written
from .multipliers import must_increase, must_match


class PressureConductanceTable(Section):
    """Conductance proportional to the pressure, see `laws.coefficients`.

    Attributes
    ----------
    coefficient : float
        [1/m]
    """

    type: Literal["pressure"]
    coefficient: units.PerLength


class TabulatedConductanceTable(Section):
    """Conductance tabulated over the pressure: piecewise linear, constant beyond the ends.

    Attributes
    ----------
    pressure : tuple of float
        Increasing [Pa].
    conductance : tuple of float
        [W/(m² K)]
    """

    type: Literal["table"]
    pressure: tuple[units.LeastPressure, ...]
    conductance: tuple[units.LeastHeatTransfer, ...]

    @model_validator(mode="after")
    def _fits(self):
        must_increase("pressure", self.pressure)
        must_match("conductance", self.conductance, self.pressure, "pressures")
        if not any(self.conductance):
            raise KeyFault("conductance", "at least one value must be greater than 0")
        return self

    @property
    def table(self) -> Table1D:
        """Conductance as a piecewise linear function of the pressure."""
        return Table1D(self.pressure, self.conductance)


_KINDS: dict[str, type[Section]] = {
    "pressure": PressureConductanceTable,
    "table": TabulatedConductanceTable,
}
_CONSTANT = TypeAdapter(units.HeatTransfer)
_VARIABLE = re.compile(rf"(?<![\w.])({'|'.join(INTERFACE_VARIABLES)})(?!\w)", re.ASCII)


def _read(data: Any) -> Any:
    if isinstance(data, Section | Expression):
        return data
    if isinstance(data, str) and _VARIABLE.search(data):
        return checked(expression(data, "W/(m^2 K)", INTERFACE_VARIABLES), "heat.conductance", 0.0)
    if not isinstance(data, dict):
        return _CONSTANT.validate_python(data)
    table = typed_table("conductance", data, _KINDS)
    return checked(table, "heat.conductance", 0.0) if isinstance(table, LawTable) else table


def _written(value: Any) -> Any:
    return _CONSTANT.dump_python(value) if isinstance(value, float) else written(value)


Conductance = Annotated[
    float | PressureConductanceTable | TabulatedConductanceTable | Expression | LawTable,
    PlainValidator(_read),
    PlainSerializer(_written),
]
"""Constant [W/(m² K)], table, expression in p, v and T, or registered law."""
