"""Laws in a case file: a number, an expression, or the table of a registered law."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import MISSING, fields
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Literal

from pydantic import (
    Field,
    PlainSerializer,
    PlainValidator,
    TypeAdapter,
    create_model,
    model_validator,
)

from ...errors import quoted
from ...laws.expressions import Expression
from ...laws.formulas import (
    PLACE,
    FormulaLaw,
    FormulaWear,
    PlaceFunction,
    require_interface_law,
    require_wear_rate,
)
from ...laws.interfaces import (
    INTERFACE_VARIABLES,
    WEAR_VARIABLES,
    Constant,
    Law,
    Role,
    Table1D,
    registered_laws,
)
from ..values import units
from ..values.json_schema import AnyOf, WrittenAs, text_such_as
from ..values.section import KeyFault, Number, Section
from ..values.units import expression, quantity
from .tabulated import must_increase, must_match

_COEFFICIENT: TypeAdapter[float] = TypeAdapter(Annotated[Number, Field(ge=0.0)])
_PRESSURE: TypeAdapter[float] = TypeAdapter(units.LeastPressure)
_CONDUCTANCE: TypeAdapter[float] = TypeAdapter(units.HeatTransfer)
_VARIABLE = re.compile(rf"(?<![\w.])({'|'.join(INTERFACE_VARIABLES)})(?!\w)", re.ASCII)


class LawTable(Section):
    """Table of a registered law: its type, and a key for each parameter of the law."""

    LAW: ClassVar[type]

    type: str

    @property
    def law(self) -> Law:
        """Law with the values of the keys."""
        keys = type(self).model_fields.keys() - {"type"}
        return self.LAW(**{key: getattr(self, key) for key in keys})

    def __reduce__(self):
        """Pickle the law with its keys, as the class of its table is made when needed."""
        return _restored, (self.LAW, dict(self))


def _restored(law: type, keys: dict[str, Any]) -> LawTable:
    return _table_of(law).model_construct(**keys)


@lru_cache
def _table_of(law: type) -> type[LawTable]:
    """Table of a registered law, with the units and bounds of its parameters."""
    keys: dict[str, Any] = {}
    for field in fields(law):
        unit, example, bounds = (field.metadata[name] for name in ("unit", "example", "bounds"))
        kind = quantity(unit, example, **bounds) if unit else Annotated[Number, Field(**bounds)]
        keys[field.name] = (kind, ... if field.default is MISSING else field.default)
    table = create_model(law.__name__, __base__=LawTable, **keys)
    table.LAW = law
    return table


def typed_table(
    role: Role, data: Mapping[str, Any], others: Mapping[str, type[Section]] | None = None
) -> Section:
    """Read the table of a registered law, or of one of other types.

    Raises
    ------
    KeyFault, ValidationError
        If the type or a key is missing, unknown, or out of bounds.
    """
    laws, others = registered_laws(role), others or {}
    allowed = ", ".join(repr(name) for name in (*others, *laws))
    if "type" not in data:
        raise KeyFault("type", f"missing; must be one of: {allowed}")
    name = data["type"]
    if not isinstance(name, str) or name not in (*others, *laws):
        raise KeyFault("type", f"found {quoted(name)}; must be one of: {allowed}")
    if name in others:
        return others[name].model_validate(data)
    table = _table_of(laws[name])
    for key in data:
        if key not in table.model_fields:
            known = [key for key in table.model_fields if key != "type"]
            raise KeyFault(key, f"unknown key; known: {', '.join(known)}")
    return table.model_validate(data)


def law_of(value: float | Expression | LawTable, name: str, least: float) -> Law:
    """Friction or conductance law of a value of a key.

    Parameters
    ----------
    value : float, Expression or LawTable
    name : str
        Name of the law, for its messages.
    least : float
        Smallest valid value of the law.
    """
    if isinstance(value, Expression):
        return FormulaLaw(value, name, least)
    return value.law if isinstance(value, LawTable) else Constant(value)


def wear_rate_of(value: Expression | LawTable) -> Law:
    """Wear rate of a value of a key."""
    return value.law if isinstance(value, LawTable) else FormulaWear(value)


class PressureConductanceTable(Section):
    """Conductance proportional to the pressure, see `laws.interfaces`.

    Attributes
    ----------
    coefficient : float
        Conductance over the product of pressure over hardness and mean conductivity, see
        `laws.interfaces` [1/m].
    """

    type: Literal["pressure"]
    coefficient: units.PerLength


class TabulatedConductanceTable(Section):
    """Conductance tabulated over the pressure: piecewise linear, constant beyond the ends.

    Attributes
    ----------
    pressure : tuple of float
        Pressures, increasing [Pa].
    conductance : tuple of float
        Conductances at these pressures [W/(m² K)].
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


_CONDUCTANCES = {"pressure": PressureConductanceTable, "table": TabulatedConductanceTable}


def _law(given: Any, role: Role, unit: str, variables: tuple[str, ...], **others: Any) -> Any:
    """Expression, or table of a law or of one of other types; None for any other value."""
    if isinstance(given, Expression | Section):
        return given
    if isinstance(given, str):
        return expression(given, unit, variables)
    return typed_table(role, given, others) if isinstance(given, dict) else None


def _friction(given: Any) -> Any:
    found = _law(given, "friction", "", INTERFACE_VARIABLES)
    if found is None:
        return _COEFFICIENT.validate_python(given)
    if isinstance(found, Expression) and found.constant is not None:
        raise ValueError(
            f"found {quoted(given)}; must be a number without quotation marks, or an "
            f"expression in {', '.join(INTERFACE_VARIABLES)}"
        )
    require_interface_law(law_of(found, "friction", -math.inf))
    return found


def _conductance(given: Any) -> Any:
    if isinstance(given, str) and not _VARIABLE.search(given):
        return _CONDUCTANCE.validate_python(given)
    found = _law(given, "conductance", "W/(m^2 K)", INTERFACE_VARIABLES, **_CONDUCTANCES)
    if found is None:
        return _CONDUCTANCE.validate_python(given)
    if isinstance(found, Expression | LawTable):
        require_interface_law(law_of(found, "heat.conductance", 0.0))
    return found


def _wear(given: Any) -> Any:
    found = _law(given, "wear", "m/s", WEAR_VARIABLES)
    if found is None:
        raise ValueError(
            f"found {quoted(given)}; must be an expression in "
            f"{', '.join(WEAR_VARIABLES)}, or a table with a type"
        )
    require_wear_rate(wear_rate_of(found))
    return found


def _fluid(given: Any) -> Any:
    if isinstance(given, PlaceFunction):
        return given
    if isinstance(given, str):
        return PlaceFunction(expression(given, "Pa", tuple(PLACE)))
    return _PRESSURE.validate_python(given)  # names the missing unit


def _written(value: Any) -> Any:
    if isinstance(value, Section):
        return value.model_dump()
    return value.text if isinstance(value, Expression) else value


def _written_conductance(value: Any) -> Any:
    return _CONDUCTANCE.dump_python(value) if isinstance(value, float) else _written(value)


def _registered(role: Role, **others: type[Section]) -> dict[str, type[Section]]:
    """Tables of the registered laws of a role, and others, by their type."""
    return others | {name: _table_of(law) for name, law in registered_laws(role).items()}


Friction = Annotated[
    float | Expression | LawTable,
    PlainValidator(_friction),
    PlainSerializer(_written),
    AnyOf(
        {"type": "number", "minimum": 0.0},
        {"type": "string", "examples": ["0.2 + 0.1 * exp(-v / (1 m/s))"]},
        typed=lambda: _registered("friction"),
    ),
]
"""Coefficient of friction: a number, an expression in p, v and T, or a registered law."""
FluidPressure = Annotated[
    PlaceFunction,
    PlainValidator(_fluid),
    PlainSerializer(lambda value: value.formula.text),
    WrittenAs(text_such_as("0.5 MPa", "1 MPa * (1 - r / (50 mm))")),
]
"""Pressure, or expression in x, y, z and r [Pa]."""
RateOfWear = Annotated[
    Expression | LawTable,
    PlainValidator(_wear),
    PlainSerializer(_written),
    AnyOf(
        {"type": "string", "examples": ["1e-8 1/MPa * mu * p * v"]},
        typed=lambda: _registered("wear"),
    ),
]
"""Wear rate: an expression in p, v, T, depth and mu [m/s], or a registered law."""
Conductance = Annotated[
    float | PressureConductanceTable | TabulatedConductanceTable | Expression | LawTable,
    PlainValidator(_conductance),
    PlainSerializer(_written_conductance),
    AnyOf(
        {"type": "string", "examples": ["2000 W/(m^2 K)", "500 W/(m^2 K) * p / (1 MPa)"]},
        typed=lambda: _registered("conductance", **_CONDUCTANCES),
    ),
]
"""Constant [W/(m² K)], table, expression in p, v and T, or registered law."""
