"""Laws in a case file: a number, an expression, or the table of a registered law."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, fields
from functools import lru_cache
from typing import Annotated, Any, ClassVar

from pydantic import Field, PlainSerializer, PlainValidator, TypeAdapter, create_model

from ...errors import quoted
from ...laws.coefficients.constant import Constant
from ...laws.expressions import Expression
from ...laws.formulas import FormulaLaw, FormulaWear
from ...laws.interfaces import INTERFACE_VARIABLES, WEAR_VARIABLES, Law
from ...laws.plausible import require_interface_law, require_wear_rate
from ...laws.registry import Role, registered_laws
from ..values.expressions import expression
from ..values.section import KeyFault, Number, Section
from ..values.units import quantity

_COEFFICIENT: TypeAdapter[float] = TypeAdapter(Annotated[Number, Field(ge=0.0)])


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


def written(value: Any) -> Any:
    """Law as in a case file."""
    if isinstance(value, Section):
        return value.model_dump()
    return value.text if isinstance(value, Expression) else value


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


def checked(value: Any, name: str, least: float) -> Any:
    """Value of a key, after a check of its law."""
    require_interface_law(law_of(value, name, least))
    return value


def _friction(given: Any) -> Any:
    if isinstance(given, Expression | LawTable):
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
        return checked(typed_table("friction", given), "friction", -math.inf)
    return _COEFFICIENT.validate_python(given)


def _wear(given: Any) -> Any:
    if isinstance(given, Expression | LawTable):
        return given
    law: Any
    if isinstance(given, str):
        law = expression(given, "m/s", WEAR_VARIABLES)
    elif isinstance(given, dict):
        law = typed_table("wear", given)
    else:
        raise ValueError(
            f"found {quoted(given)}; must be an expression in "
            f"{', '.join(WEAR_VARIABLES)}, or a table with a type"
        )
    require_wear_rate(wear_rate_of(law))
    return law


Friction = Annotated[
    float | Expression | LawTable, PlainValidator(_friction), PlainSerializer(written)
]
"""Coefficient of friction: a number, an expression in p, v and T, or a registered law."""
RateOfWear = Annotated[Expression | LawTable, PlainValidator(_wear), PlainSerializer(written)]
"""Wear rate: an expression in p, v, T, depth and mu [m/s], or a registered law."""
