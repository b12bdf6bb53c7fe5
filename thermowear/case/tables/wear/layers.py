"""Table ``wear.BODY.layers``: layers on a contact face, each with its own wear law.

Each key is a list with a value for every layer, from the surface down; the body's own law is that
of the substrate below them. A table without layers means the same with and without a coating.
"""

from __future__ import annotations

from pydantic import model_serializer, model_validator

from ...values.section import KeyFault, Section
from ...values.units import Length
from ..laws import RateOfWear
from ..tabulated import must_match
from .wear_rate import (
    OF_POWER,
    Coefficient,
    PressureExponent,
    RateTable,
    Stress,
    VelocityExponent,
)

_LAWS = ("rate", *OF_POWER)


class LayersTable(Section):
    """Layers of a face, from the surface down.

    Attributes
    ----------
    thickness : tuple of float
        Thickness along the normal of the unworn face [m].
    coefficient : tuple of pint.Quantity or None
        Wear coefficients.
    rate : tuple of (Expression or LawTable) or None
        Wear rates in place of the coefficients.
    per, pressure_exponent, velocity_exponent : tuple or None
        As of `RateTable`; without them, those of the body hold for all layers. Its factors do so in
        any case.
    """

    thickness: tuple[Length, ...]
    coefficient: tuple[Coefficient, ...] | None = None
    rate: tuple[RateOfWear, ...] | None = None
    per: tuple[Stress, ...] | None = None
    pressure_exponent: tuple[PressureExponent, ...] | None = None
    velocity_exponent: tuple[VelocityExponent, ...] | None = None

    @model_validator(mode="after")
    def _one_law_each(self):
        if not self.thickness:
            raise KeyFault("thickness", "is empty; give the thickness of one layer at least")
        given = self._given
        if "rate" not in given and "coefficient" not in given:
            raise KeyFault("coefficient", "missing; each layer needs one, or a rate")
        for key, values in given.items():
            if key in OF_POWER and "rate" in given:
                raise KeyFault(key, "not allowed together with rate")
            must_match(key, values, self.thickness, "layers")
        return self

    @model_serializer(mode="wrap")
    def _without_other_keys(self, handler):
        return {k: v for k, v in handler(self).items() if v is not None}

    @property
    def _given(self) -> dict[str, tuple]:
        """Lists of the laws that are given, by key."""
        return {key: values for key in _LAWS if (values := getattr(self, key)) is not None}

    def each(self, body: RateTable) -> tuple[RateTable, ...]:
        """Law of each layer, completed by the keys of the body."""
        given, shared = self._given, {"factor": body.factor}
        if self.rate is None:
            shared |= {key: getattr(body, key) for key in OF_POWER[1:]}
        return tuple(
            RateTable.model_construct(**shared | {key: values[i] for key, values in given.items()})
            for i in range(len(self.thickness))
        )
