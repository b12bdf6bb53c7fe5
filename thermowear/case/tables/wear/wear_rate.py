"""Wear law of a body, of a part of it or of a layer.

``rate = coefficient · s^b · v^a`` (s: friction stress or pressure), or any law of the rate.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PlainSerializer, model_serializer, model_validator

from ....laws.interfaces import Law
from ...values.json_schema import WrittenAs, text_such_as
from ...values.section import KeyFault, Number, Section
from ...values.units import parse, registry
from ..laws import RateOfWear, wear_rate_of
from ..tabulated import MultiplierTables

_EXAMPLE = "2e-7 1/MPa"
OF_POWER = ("coefficient", "per", "pressure_exponent", "velocity_exponent")
"""Keys of a power law."""


def _coefficient(text: Any):
    value = parse(text, _EXAMPLE)
    if not value.magnitude > 0:
        raise ValueError(f'found "{text}"; must be greater than 0')
    return value


def _text(value) -> str:
    """Text that is read back to the same quantity exactly."""
    unit = f"{value.units:~C}"
    if registry().parse_units(unit) != value.units:  # pint rounds the exponents it writes
        unit = " * ".join(f"{name}**{power!r}" for name, power in value.unit_items())
    return f"{value.magnitude!r} {unit}"


Coefficient = Annotated[
    Any,
    BeforeValidator(_coefficient),
    PlainSerializer(_text, return_type=str),
    WrittenAs(text_such_as(_EXAMPLE)),
]


Stress = Literal["friction-stress", "pressure"]
PressureExponent = Annotated[Number, Field(ge=0.1, le=10.0)]
VelocityExponent = Annotated[Number, Field(ge=0.0, le=10.0)]


class RateTable(Section):
    """Wear law: a coefficient with exponents, or a rate.

    Attributes
    ----------
    coefficient : pint.Quantity or None
        Wear coefficient, in a unit that fits both exponents.
    rate : Expression, LawTable or None
        Wear rate as an expression in p, v, T, depth and mu, or a registered law, in place of the
        coefficient, its exponents and `per`.
    per : str
        ``"friction-stress"``: the coefficient multiplies ``(mu p)^b v^a``; ``"pressure"``:
        ``p^b v^a``.
    pressure_exponent : float
        Exponent b of the stress.
    velocity_exponent : float
        Exponent a of the sliding speed.
    factor : MultiplierTables
        Factors of the rate: tables of the temperature of the body's own face, pressure and speed.
    """

    coefficient: Coefficient | None = None
    rate: RateOfWear | None = None
    per: Stress = "friction-stress"
    pressure_exponent: PressureExponent = 1.0
    velocity_exponent: VelocityExponent = 1.0
    factor: MultiplierTables = MultiplierTables()

    @property
    def has_law(self) -> bool:
        """True if it has a law, or a key of one."""
        return True

    @model_validator(mode="after")
    def _one_law(self):
        if not self.has_law:
            return self
        if self.rate is not None:
            for key in OF_POWER:
                if key in self.model_fields_set:
                    raise KeyFault(key, "not allowed together with rate")
            return self
        if self.coefficient is None:
            raise KeyFault("coefficient", "missing")
        self.require_coefficient()
        return self

    def require_coefficient(self) -> None:
        """Reject a coefficient whose unit does not fit the exponents, or out of range in SI.

        Raises
        ------
        KeyFault
        """
        try:
            number = self.coefficient_si()
        except (OverflowError, ZeroDivisionError):
            number = math.inf
        if not 0 < number < math.inf:
            raise KeyFault("coefficient", f'found "{_text(self.coefficient)}"; out of range in SI')

    @model_serializer(mode="wrap")
    def _without_other_keys(self, handler):
        """Leave out the keys of the other type of law or of both, and tables that are empty."""
        written, left_out = handler(self).items(), {"rate"} if self.rate is None else {*OF_POWER}
        if self.coefficient is None and self.rate is None:
            left_out = {*RateTable.model_fields}
        empty = {"materials", "layers", "where"}
        return {k: v for k, v in written if k not in left_out and (k not in empty or v)}

    @property
    def law(self) -> Law | None:
        """Law given by `rate`; None for a coefficient."""
        return None if self.rate is None else wear_rate_of(self.rate)

    @property
    def variables(self) -> frozenset[str]:
        """Variables of the law (p, v, T, depth, mu), without those of the tables of factors."""
        if self.law is not None:
            return self.law.variables
        return frozenset({"p", "v", "mu"} if self.per == "friction-stress" else {"p", "v"})

    @property
    def follows_state(self) -> bool:
        """True if the rate depends on the temperature or on the wear depth."""
        return bool(self.variables & {"T", "depth"})

    def coefficient_si(self) -> float:
        """Coefficient in ``(m/s)^(1-a) Pa^(-b)``.

        Raises
        ------
        ValueError
            If its unit does not fit the exponents.
        """
        assert self.coefficient is not None
        a, b = self.velocity_exponent, self.pressure_exponent
        needed = {"[length]": 1 - a + b, "[time]": a - 1 + 2 * b, "[mass]": -b}
        found = dict(self.coefficient.dimensionality)
        if any(
            abs(needed.get(k, 0) - found.get(k, 0)) > 1e-9 for k in needed.keys() | found.keys()
        ):
            rate = "" if a == 1 else f"(m/s)^{1 - a:.12g} "
            raise KeyFault(
                "coefficient",
                f'the unit of "{_text(self.coefficient)}" does not fit the exponents'
                f" a = {a:g} and b = {b:g}; needs {rate}1/MPa^{b:.12g} or the like",
            )
        return float(self.coefficient.to_base_units().magnitude)
