"""Thermal loads beside friction: heat through surfaces, given temperatures, the surroundings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...bulk.bodies import Bodies
from ...bulk.heat.conduction import Conduction
from ...bulk.heat.heat_equation import given_rises
from ...bulk.heat.surface_heat import surface_heat
from ...bulk.kinematics import Model
from ...bulk.surface_area import surface_area
from ...case.tables.heat import HeatTable
from ...case.tables.history import TemperatureHistory


@dataclass(frozen=True)
class ThermalLoad:
    """Thermal loads at one time.

    Attributes
    ----------
    heat : ndarray, shape (n_owned,)
        Nodal heat: prescribed, and that of surroundings whose temperature is not the ambient one
        of the case [W].
    prescribed : float
        Heat through surfaces with a given flux or power, into the bodies [W].
    magnitude : float
        Likewise, the sum of its magnitudes [W].
    ambient : float
        Rise of the surroundings over the ambient temperature of the case [K].
    given : ndarray or None, shape (n_owned,)
        Rises of the fixed values, zero in the others; None: those of the conduction [K].
    """

    heat: np.ndarray
    prescribed: float
    magnitude: float
    ambient: float = 0.0
    given: np.ndarray | None = None

    def on(self, conduction: Conduction) -> Conduction:
        """The bodies with the temperatures that are given at this time."""
        return conduction if self.given is None else conduction.holding(self.given)


class ThermalLoads:
    """Thermal loads of a case at any time.

    Parameters
    ----------
    constant : ThermalLoad
        What does not change.
    ambient : float
        Of the case [K].
    given : dict of str to (TemperatureHistory or float, ndarray)
        Temperatures by surface, with the rises (n_owned,) per rise of it; only where some change.
    surroundings : tuple or None
        Temperature of the surroundings in time, and nodal heat (n_owned,) per rise of it [W/K].
    """

    def __init__(
        self,
        constant: ThermalLoad,
        ambient: float,
        given: Mapping[str, tuple[TemperatureHistory | float, np.ndarray]],
        surroundings: tuple[TemperatureHistory, np.ndarray] | None,
    ):
        self._constant = constant
        self._ambient = ambient
        self._given = given
        self._surroundings = surroundings

    def at(self, time: float) -> ThermalLoad:
        """The loads at a time [s]."""
        if not self._given and self._surroundings is None:
            return self._constant
        constant, heat, above, given = self._constant, self._constant.heat, 0.0, None
        if self._surroundings is not None:
            history, per_rise = self._surroundings
            above = history.at(time) - self._ambient
            heat = heat + above * per_rise
        if self._given:
            rises = ((temperature_at(T, time), per) for T, per in self._given.values())
            given = sum(((T - self._ambient) * per for T, per in rises), np.zeros(len(heat)))
        return ThermalLoad(heat, constant.prescribed, constant.magnitude, above, given)


def temperature_at(given: TemperatureHistory | float, time: float) -> float:
    """A given temperature [K] at a time [s]."""
    return given.at(time) if isinstance(given, TemperatureHistory) else given


def thermal_loads(
    heat: HeatTable,
    bodies: Bodies,
    model: Model,
    conduction: Conduction,
    round_the_ring: Mapping[str, float],
) -> ThermalLoads:
    """The loads of a case on its conducting bodies. Every rank calls.

    Parameters
    ----------
    heat : HeatTable
    bodies : Bodies
    model : Model
    conduction : Conduction
    round_the_ring : mapping of str to float
        How many times the surface that the model counts a surface of the case is.
    """
    space = conduction.space
    total = np.zeros(len(conduction.fixed))
    areas = {s: surface_area(bodies, model, s) for s in (*heat.flux, *heat.power)}
    powers = {s: q * round_the_ring[s] * areas[s] for s, q in heat.flux.items()} | heat.power
    for surface, power in powers.items():
        total += surface_heat(bodies, model, space, surface, power / areas[surface])
    given, surroundings = {}, None
    if any(isinstance(T, TemperatureHistory) for T in heat.temperature.values()):
        for surface, T in heat.temperature.items():
            unit = {name: float(name == surface) for name in heat.temperature}
            given[surface] = T, given_rises(bodies, space, unit, conduction.even)[1]
    if heat.ambient_history is not None:
        surroundings = heat.ambient_history, conduction.per_ambient()
    constant = ThermalLoad(total, sum(powers.values()), sum(map(abs, powers.values())))
    return ThermalLoads(constant, heat.ambient, given, surroundings)
