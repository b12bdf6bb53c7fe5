"""Heat sources and thermal boundary conditions of the bodies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from ..laws.time_course import TimeFunction


@dataclass(frozen=True)
class Heat:
    """Heat sources and thermal boundary conditions; surfaces not named are insulated.

    Attributes
    ----------
    ambient : float
        Temperature of the surroundings and of the stress-free state [K].
    ambient_history : TimeFunction or None
        Time-dependent temperature of the surroundings [K].
    initial : float or None
        Initial temperature of the bodies, by default the ambient one [K].
    transient : bool
        Temperatures in time, instead of the steady ones of the present friction heat.
    advection : str
        Heat transport by a body 2 that passes under body 1: ``"none"``, conduction as at rest;
        ``"resolved"``, advection with the motion; ``"spread"``, the limit of fast motion.
    cooling : mapping of str to float
        Heat transfer coefficients of surfaces [W/(m² K)].
    temperature : mapping of str to (float or TimeFunction)
        Prescribed temperatures of surfaces [K].
    flux : mapping of str to float
        Heat flux into the body through surfaces [W/m²].
    power : mapping of str to float
        Total heat into surfaces, distributed evenly [W].
    """

    ambient: float = 293.15
    ambient_history: TimeFunction | None = None
    initial: float | None = None
    transient: bool = False
    advection: Literal["none", "resolved", "spread"] = "none"
    cooling: Mapping[str, float] = field(default_factory=dict)
    temperature: Mapping[str, float | TimeFunction] = field(default_factory=dict)
    flux: Mapping[str, float] = field(default_factory=dict)
    power: Mapping[str, float] = field(default_factory=dict)

    @property
    def histories(self) -> list[TimeFunction]:
        """Functions of time of the boundary conditions."""
        given = (*self.temperature.values(), self.ambient_history)
        return [value for value in given if isinstance(value, TimeFunction)]

    @property
    def driven(self) -> bool:
        """True if the bodies are heated or cooled by anything besides friction."""
        given = [*self.temperature.values(), self.ambient if self.initial is None else self.initial]
        return bool(self.flux or self.power or self.ambient_history) or any(
            value != self.ambient for value in given
        )
