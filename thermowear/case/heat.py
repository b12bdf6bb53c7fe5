"""Friction heat and where it goes."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator

from ..errors import quoted
from . import units
from .conductance import Conductance
from .section import Section, Switch


def _share(value: Any) -> Any:
    """A number as a float; one message for all that is neither a part nor the word."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if number and math.isfinite(value) and 0 <= value <= 1:
        return float(value)
    if value == "effusivity":
        return value
    raise ValueError(f'found {quoted(value)}; must be at least 0 and at most 1, or "effusivity"')


Partition = Annotated[float | Literal["effusivity"], BeforeValidator(_share)]


class Heat(Section):
    """Friction heat.

    Attributes
    ----------
    conductance : float, PressureConductance, TabulatedConductance or None
        Contact conductance [W/(m² K)], or how it depends on the pressure; None: perfect contact.
    gap_conductance : float or None
        Of faces that are apart [W/(m² K)]; None: they exchange no heat.
    partition : float or str
        Part of the friction heat that is set free on body 1; ``"effusivity"``: ``e1/(e1 + e2)``.
    advection : str
        What a body 2 that passes under body 1 does with heat: ``"none"``, it conducts as if it
        stood still; ``"resolved"``, it carries heat along; ``"spread"``, it passes so fast that
        heat is spread evenly along its way.
    transient : bool
        Temperatures in time, instead of those that the present friction heat would lead to.
    initial : float or None
        Temperature of both bodies at the start, by default the ambient one [K].
    ambient : float
        Temperature of the surroundings, and of the stress-free state [K].
    cooling : dict of str to float
        Heat transfer coefficients of named surfaces [W/(m² K)].
    temperature : dict of str to float
        Given temperatures of named surfaces [K].
    """

    conductance: Conductance | None = None
    gap_conductance: units.HeatTransfer | None = None
    partition: Partition = 0.5
    advection: Literal["none", "resolved", "spread"] = "none"
    transient: Switch = False
    initial: units.Temperature | None = None
    ambient: units.Temperature = 293.15
    cooling: dict[str, units.HeatTransfer] = {}
    temperature: dict[str, units.Temperature] = {}
