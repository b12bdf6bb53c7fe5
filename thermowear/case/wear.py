"""The wear table of a body: ``rate = coefficient · s^b · v^a``; s: friction stress or pressure."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PlainSerializer, model_validator

from .factors import Factors
from .section import KeyFault, Number, Section
from .units import parse, registry

_EXAMPLE = "2e-7 1/MPa"


def _coefficient(text: Any):
    value = parse(text, _EXAMPLE)
    if not value.magnitude > 0:
        raise ValueError(f'found "{text}"; must be greater than 0')
    return value


def _text(value) -> str:
    """As text that is read back to the very same quantity."""
    unit = f"{value.units:~C}"
    if registry().parse_units(unit) != value.units:  # pint rounds the exponents it writes
        unit = " * ".join(f"{name}**{power!r}" for name, power in value.unit_items())
    return f"{value.magnitude!r} {unit}"


Coefficient = Annotated[Any, BeforeValidator(_coefficient), PlainSerializer(_text, return_type=str)]


class Wear(Section):
    """Wear law of one body.

    Attributes
    ----------
    coefficient : pint.Quantity
        In the unit that fits both exponents.
    per : str
        ``"friction-stress"``: it multiplies ``(mu p)^b v^a``; ``"pressure"``: ``p^b v^a``.
    pressure_exponent, velocity_exponent : float
        b and a.
    spread : str
        ``"in-place"``: the body wears where it is pressed; ``"track"``: a body 2 that passes under
        body 1 wears evenly along its whole track.
    factor : Factors
        Of the coefficient, by the temperature of the body's own face, pressure and speed.
    """

    coefficient: Coefficient
    per: Literal["friction-stress", "pressure"] = "friction-stress"
    pressure_exponent: Annotated[Number, Field(ge=0.1, le=10.0)] = 1.0
    velocity_exponent: Annotated[Number, Field(ge=0.0, le=10.0)] = 1.0
    spread: Literal["in-place", "track"] = "in-place"
    factor: Factors = Factors()

    @model_validator(mode="after")
    def _unit_fits(self):
        if not 0 < self.coefficient_si() < math.inf:
            raise KeyFault("coefficient", f'found "{_text(self.coefficient)}"; out of range in SI')
        return self

    def coefficient_si(self) -> float:
        """The coefficient in ``(m/s)^(1-a) Pa^(-b)``.

        Raises
        ------
        ValueError
            If its unit does not fit the exponents.
        """
        a, b = self.velocity_exponent, self.pressure_exponent
        due = {"[length]": 1 - a + b, "[time]": a - 1 + 2 * b, "[mass]": -b}
        found = dict(self.coefficient.dimensionality)
        if any(abs(due.get(k, 0) - found.get(k, 0)) > 1e-9 for k in due.keys() | found.keys()):
            rate = "" if a == 1 else f"(m/s)^{1 - a:.12g} "
            raise KeyFault(
                "coefficient",
                f'the unit of "{_text(self.coefficient)}" does not fit the exponents'
                f" a = {a:g} and b = {b:g}; needs {rate}1/MPa^{b:.12g} or the like",
            )
        return float(self.coefficient.to_base_units().magnitude)
