"""Thermal loads beside friction: given heat and temperatures, surroundings, in time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...bulk.bodies import Bodies
from ...bulk.compiled import surface_area
from ...bulk.heat.conduction import Conduction
from ...bulk.heat.heat_equation import given_rises, surface_heat
from ...bulk.kinematics import Kinematics
from ...laws.time_course import TimeFunction
from ...model.conditions import Heat
from ...model.model import Model


@dataclass(frozen=True)
class ThermalLoad:
    """Thermal loads at one time.

    Attributes
    ----------
    heat : ndarray, shape (n_owned,)
        Nodal heat: prescribed, and from surroundings at other than the ambient temperature of the
        model [W].
    prescribed : float
        Heat into the bodies through surfaces with a given flux or power [W].
    magnitude : float
        Sum of the magnitudes of that heat [W].
    ambient : float
        Rise of the surroundings over the ambient temperature of the model [K].
    given : ndarray or None, shape (n_owned,)
        Prescribed rises at the fixed nodes, zero elsewhere; None: those of the conduction [K].
    """

    heat: np.ndarray
    prescribed: float
    magnitude: float
    ambient: float = 0.0
    given: np.ndarray | None = None


@dataclass(frozen=True)
class ThermalLoads:
    """Thermal loads beside friction as functions of time.

    Attributes
    ----------
    base : ThermalLoad
        Loads constant in time.
    reference : float
        Ambient temperature of the model [K].
    given : dict of str to (TimeFunction or float, ndarray)
        Prescribed temperatures by surface, with the nodal rises (n_owned,) per unit rise of it;
        empty if all are constant.
    surroundings : tuple or None
        Temperature history of the surroundings, and nodal heat (n_owned,) per rise of it [W/K].
    fluxes : dict of str to float
        Given heat into the bodies by surface [W/m²].
    """

    base: ThermalLoad
    reference: float
    given: dict[str, tuple[TimeFunction | float, np.ndarray]]
    surroundings: tuple[TimeFunction, np.ndarray] | None
    fluxes: dict[str, float]

    @cached_property
    def constant(self) -> ThermalLoad | None:
        """Loads at all times; None if they change."""
        return None if self.given or self.surroundings is not None else self.base

    def at(self, time: float) -> ThermalLoad:
        """Thermal loads at a time [s]."""
        load = self.base
        if self.surroundings is not None:
            history, per_rise = self.surroundings
            above = history.at(time) - self.reference
            load = replace(load, heat=load.heat + above * per_rise, ambient=above)
        if self.given:
            rises = ((temperature_at(T, time) - self.reference) * n for T, n in self.given.values())
            load = replace(load, given=sum(rises, np.zeros(len(load.heat))))
        return load


def temperature_at(given: TimeFunction | float, time: float) -> float:
    """Prescribed temperature [K] at a time [s]."""
    return given.at(time) if isinstance(given, TimeFunction) else given


def thermal_loads(
    model: Model, heat: Heat, bodies: Bodies, kinematics: Kinematics, conduction: Conduction
) -> ThermalLoads:
    """Assemble the thermal loads of a model with heat. Every rank calls."""
    spaces = conduction.spaces
    total = np.zeros(len(conduction.fixed))
    areas = {s: surface_area(bodies, kinematics, s) for s in (*heat.flux, *heat.power)}
    powers = {s: q * model.ring(s) * areas[s] for s, q in heat.flux.items()} | dict(heat.power)
    fluxes = {surface: power / areas[surface] for surface, power in powers.items()}
    for surface, flux in fluxes.items():
        total += surface_heat(bodies, kinematics, spaces, surface, flux)
    given, surroundings = {}, None
    if any(isinstance(T, TimeFunction) for T in heat.temperature.values()):
        for surface, T in heat.temperature.items():
            unit = {name: float(name == surface) for name in heat.temperature}
            given[surface] = T, given_rises(bodies, spaces, unit, conduction.even)[1]
    if heat.ambient_history is not None:
        surroundings = heat.ambient_history, conduction.per_ambient()
    constant = ThermalLoad(total, sum(powers.values()), sum(map(abs, powers.values())))
    return ThermalLoads(constant, heat.ambient, given, surroundings, fluxes)
