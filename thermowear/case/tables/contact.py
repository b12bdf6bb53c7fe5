"""Table ``contact``: laws and numerics of the interface."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from ...errors import quoted
from ...laws.formulas import typical_value
from ...laws.interfaces import Law
from ..values import units
from ..values.section import Number, Section, Switch, number_or
from .laws import FluidPressure, Friction, law_of
from .tabulated import FactorHistory, MultiplierTables

_PRESSURE_DEGREE = number_or(
    "lobatto",
    None,
    where=lambda degree: isinstance(degree, int) and 1 <= degree <= 10,
    allowed='a whole number from 1 to 10, or "lobatto"',
)


def _exact(value: Any) -> Any:
    """Reject 1.0 and true, which are equal to 1 in Python."""
    if isinstance(value, bool | float):
        raise ValueError(f"found {quoted(value)}; must be 1, 0 or -1")
    return value


class InterfaceTable(Section):
    """Friction and pressure space of an interface, see `model.interface.Interface`.

    Attributes
    ----------
    friction_factor : MultiplierTables
        Multipliers of the friction: tables of mean face temperature, pressure and speed.
    """

    friction: Friction = 0.0
    friction_factor: MultiplierTables = MultiplierTables()
    friction_history: FactorHistory | None = None
    transverse_friction: Annotated[Number, Field(ge=0.0)] = 0.0
    compliance: units.Compliance | None = None
    fluid_pressure: FluidPressure | None = None
    pressure_degree: Annotated[int | Literal["lobatto"] | None, _PRESSURE_DEGREE] = None

    @property
    def friction_law(self) -> Law:
        """Coefficient of friction as a law, without `friction_factor`."""
        return law_of(self.friction, "contact.friction", -math.inf)

    @property
    def nominal_friction(self) -> float:
        """Coefficient of friction; for a law, its value in a typical state."""
        given = self.friction
        return given if isinstance(given, float) else typical_value(self.friction_law)

    @property
    def friction_variables(self) -> frozenset[str]:
        """Variables of the coefficient of friction and its factors: of p, v and T."""
        return self.friction_law.variables | self.friction_factor.multipliers.variables


class ContactTable(InterfaceTable):
    """Table ``contact`` of a pair.

    Attributes
    ----------
    penalty, theta, gamma
        See `model.interface.ContactMethod`.
    method
        ``"condensed"``: static condensation of the bodies to the interface; ``"pointwise"``: the
        same with contact conditions at each point, without wear, heat and friction; ``"penalty"``
        and ``"nitsche"``: full system.
    positioning : bool
        Move the mesh until element ends coincide with the contact edges.
    """

    method: Literal["condensed", "pointwise", "penalty", "nitsche"] = "condensed"
    penalty: units.Foundation | None = None
    theta: Annotated[Literal[1, 0, -1] | None, BeforeValidator(_exact)] = None
    gamma: Annotated[Number, Field(gt=0.0)] | None = None
    positioning: Switch = False
