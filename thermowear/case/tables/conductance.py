"""Contact conductance: how much heat passes from face to face where they touch."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import PlainSerializer, PlainValidator, TypeAdapter, model_validator

from ...errors import quoted
from ..values import units
from ..values.section import KeyFault, Section
from .multipliers import must_increase, must_match


def harmonic_mean(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """``2 a b / (a + b)``: of two things in series."""
    return 2 * a * b / (a + b)


class PressureConductance(Section):
    """Conductance in proportion to the pressure: ``h = coefficient k p / H``.

    k and H are the harmonic means ``2 k1 k2 / (k1 + k2)`` of both bodies' conductivities and
    hardnesses. The model of MOOSE (``GapFluxModelPressureDependentConduction``) and of 4C.

    Attributes
    ----------
    coefficient : float
        [1/m]
    """

    type: Literal["pressure"]
    coefficient: units.PerLength

    def value(
        self, pressure: np.ndarray, conductivity: np.ndarray, hardness: np.ndarray
    ) -> np.ndarray:
        """Conductance [W/(m² K)] at pressures [Pa], by the harmonic means of both bodies."""
        return self.coefficient * conductivity * np.asarray(pressure) / hardness


class TabulatedConductance(Section):
    """Conductance by straight lines between given pressures, constant beyond the ends.

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
            raise KeyFault("conductance", "one at least must be greater than 0")
        return self

    def value(self, pressure: np.ndarray) -> np.ndarray:
        """Conductance [W/(m² K)] at pressures [Pa]."""
        return np.interp(pressure, self.pressure, self.conductance)


_KINDS: dict[str, type[Section]] = {
    "pressure": PressureConductance,
    "table": TabulatedConductance,
}
_CONSTANT = TypeAdapter(units.HeatTransfer)
_ALLOWED = " or ".join(repr(kind) for kind in _KINDS)


def _read(data: Any) -> Any:
    """A constant where it is text, else the table that its type names."""
    if isinstance(data, PressureConductance | TabulatedConductance):
        return data
    if not isinstance(data, dict):
        return _CONSTANT.validate_python(data)
    if "type" not in data:
        raise KeyFault("type", f"missing; must be {_ALLOWED}")
    kind = data["type"]
    if not isinstance(kind, str) or kind not in _KINDS:
        raise KeyFault("type", f"found {quoted(kind)}; must be {_ALLOWED}")
    return _KINDS[kind].model_validate(data)


def _written(value: Any) -> Any:
    return value.model_dump() if isinstance(value, Section) else _CONSTANT.dump_python(value)


Conductance = Annotated[
    float | PressureConductance | TabulatedConductance,
    PlainValidator(_read),
    PlainSerializer(_written),
]
"""A constant [W/(m² K)], or one of the tables."""
