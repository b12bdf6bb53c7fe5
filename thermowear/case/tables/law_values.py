"""Laws in a case file: a number, an expression, or a registered law with its keys."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Annotated, Any

from pydantic import Field, PlainSerializer, PlainValidator, TypeAdapter, ValidationError

from ...errors import quoted
from ...laws.by_name import registered_laws
from ...laws.coefficients.constant import Constant
from ...laws.expressions import Expression
from ...laws.formulas import FormulaLaw, FormulaWear
from ...laws.interfaces import INTERFACE_VARIABLES, WEAR_VARIABLES, Law
from ...laws.plausible import require_interface_law, require_wear_rate
from ...laws.registry import Role
from ..values.expressions import expression
from ..values.section import KeyFault, Number
from ..values.units import quantity

_COEFFICIENT: TypeAdapter[float] = TypeAdapter(Annotated[Number, Field(ge=0.0)])


@dataclass(frozen=True)
class NamedLaw:
    """A registered law.

    Attributes
    ----------
    type : str
        Its name.
    law : object
        The law, with the values of its keys.
    """

    type: str
    law: Any


def named_law(role: Role, table: Mapping[str, Any]) -> NamedLaw:
    """Read the table of a registered law.

    Raises
    ------
    KeyFault
        If the type or a key is missing, unknown, or out of bounds.
    """
    laws = registered_laws(role)
    allowed = ", ".join(repr(name) for name in laws)
    if "type" not in table:
        raise KeyFault("type", f"missing; one of: {allowed}")
    name = table["type"]
    if not isinstance(name, str) or name not in laws:
        raise KeyFault("type", f"found {quoted(name)}; must be one of: {allowed}")
    parameters = {field.name: field for field in fields(laws[name])}
    for key in table:
        if key not in parameters and key != "type":
            raise KeyFault(key, f"unknown key; known: {', '.join(parameters)}")
    values = {
        key: _value(key, field.metadata, table[key])
        for key, field in parameters.items()
        if key in table
    }
    try:
        return NamedLaw(name, laws[name](**values))
    except TypeError:
        missing = next(key for key in parameters if key not in values)
        raise KeyFault(missing, f"missing; a law of type {name!r} needs it") from None


def _value(key: str, metadata: Mapping[str, Any], given: Any) -> float:
    unit, example, bounds = (metadata[name] for name in ("unit", "example", "bounds"))
    kind = quantity(unit, example, **bounds) if unit else Annotated[Number, Field(**bounds)]
    try:
        return TypeAdapter(kind).validate_python(given)
    except ValidationError as error:
        fault = error.errors(include_url=False)[0]
        said = fault.get("ctx", {}).get("error")
        text = f"found {quoted(given)}; {fault['msg'].replace('Input should be', 'must be')}"
        raise KeyFault(key, str(said) if said else text) from None


def written(value: Any) -> Any:
    """A law as the case file has it."""
    if isinstance(value, Expression):
        return value.text
    if isinstance(value, NamedLaw):
        keys = {
            field.name: _quantity(getattr(value.law, field.name), field.metadata["unit"])
            for field in fields(value.law)
        }
        return {"type": value.type, **keys}
    return value


def _quantity(value: float, unit: str) -> float | str:
    return f"{value!r} {unit}" if unit else value


def law_of(value: float | Expression | NamedLaw, name: str, least: float) -> Law:
    """The law of a value of a key.

    Parameters
    ----------
    value : float, Expression or NamedLaw
    name : str
        For messages of the law.
    least : float
        Smallest value that the law may have.
    """
    if isinstance(value, Expression):
        return FormulaLaw(value, name, least)
    return value.law if isinstance(value, NamedLaw) else Constant(value)


def wear_rate_of(value: Expression | NamedLaw, name: str) -> Law:
    """The wear rate of a value of a key; `name` is for its messages."""
    return value.law if isinstance(value, NamedLaw) else FormulaWear(value, name)


def checked(value: Expression | NamedLaw, name: str, least: float) -> Expression | NamedLaw:
    """Check the law of a value, and return the value."""
    require_interface_law(law_of(value, name, least))
    return value


def _friction(given: Any) -> Any:
    if isinstance(given, Expression | NamedLaw):
        return given
    if isinstance(given, str):
        found = expression(given, "", INTERFACE_VARIABLES)
        if found.constant is not None:
            raise ValueError(
                f"found {quoted(given)}; must be a number without quotation marks, or an "
                f"expression in {', '.join(INTERFACE_VARIABLES)}"
            )
        return checked(found, "friction", -math.inf)
    if isinstance(given, dict):
        return checked(named_law("friction", given), "friction", -math.inf)
    return _COEFFICIENT.validate_python(given)


def _wear(given: Any) -> Any:
    if isinstance(given, Expression | NamedLaw):
        return given
    if not isinstance(given, str | dict):
        raise ValueError(
            f"found {quoted(given)}; must be an expression in "
            f"{', '.join(WEAR_VARIABLES)}, or a table with a type"
        )
    law = (
        expression(given, "m/s", WEAR_VARIABLES)
        if isinstance(given, str)
        else named_law("wear", given)
    )
    require_wear_rate(wear_rate_of(law, "wear rate"))
    return law


Friction = Annotated[
    float | Expression | NamedLaw, PlainValidator(_friction), PlainSerializer(written)
]
"""Coefficient of friction: a number, an expression in p, v and T, or a registered law."""
RateOfWear = Annotated[Expression | NamedLaw, PlainValidator(_wear), PlainSerializer(written)]
"""Wear rate: an expression in p, v, T, depth and mu [m/s], or a registered law."""
