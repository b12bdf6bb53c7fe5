"""Conduction and thermal distortion of the bodies of a system, condensed to the interface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...bulk.heat.conduction import Conduction
from ...bulk.heat.varying import VaryingExpansion
from ...contact.operators.heat import HeatExchange, InterfaceHeat
from ...contact.operators.heat_condensation import (
    ThermalDistortion,
    condense_distortion,
)
from ..system.conditions import InterfaceConditions
from ..system.setup_cache import SetupCache
from ..system.system import System
from ..system.thermal_system import ThermalSystem


@dataclass(frozen=True, eq=False)
class CondensedDistortion:
    """Weak gap opened by the temperatures of the bodies, and its tangent.

    Heat operators reference this object, not the friction heat that owns them: a reference cycle
    would keep them in memory after their meshes have been discarded.

    Attributes
    ----------
    system : System
    thermal : ThermalSystem
    """

    system: System
    thermal: ThermalSystem

    def __call__(
        self,
        conduction: Conduction,
        face: InterfaceHeat,
        slope: Callable[[], np.ndarray] | None = None,
    ) -> ThermalDistortion:
        """Condense the weak gap per heat at the faces, with `per_rise` or another slope.

        Every rank calls.
        """

        def condensed() -> ThermalDistortion:
            per_rise = self.per_rise if slope is None else slope()
            return condense_distortion(conduction, per_rise, face)

        with self.system.phases("condense distortion"):
            if conduction is not self.thermal.conduction:  # of a time step, or a tangent
                return condensed()
            return self.system.parts.get("distortion", self.system.inputs.conduction, condensed)

    @property
    def per_rise(self) -> np.ndarray:
        """Weak gap per nodal rise at constant expansion, shape (n_owned, m) [m³/K]."""
        return self.system.influence.per_rise[0]

    def slope(self, rise: np.ndarray) -> np.ndarray:
        """Derivative of the weak gap by a nodal rise, shape (n_owned, m) [m³/K]."""
        result = self.per_rise
        for part, per_rise in self._per_excess:
            result = result + part.slope(rise)[:, None] * per_rise
        return result

    def excess(self, rise: np.ndarray, reference: np.ndarray | None = None) -> np.ndarray | float:
        """Weak gap of this rank beyond that of `per_rise`, or of `slope` at a reference [m³].

        Zero if expansion does not depend on temperature; otherwise of shape (m,).
        """
        total: np.ndarray | float = 0.0
        for part, per_rise in self._per_excess:
            linear = 0.0 if reference is None else part.slope(reference) * rise
            total = total + per_rise.T @ (part.excess(rise) - linear)
        return total

    @property
    def _per_excess(self) -> list[tuple[VaryingExpansion, np.ndarray]]:
        """Varying expansions and the weak gap per excess rise of their parts, (n_owned, m)."""
        per_excess = self.system.influence.per_rise[1:]
        return list(zip(self.thermal.expansions, per_excess, strict=True))


class HeatOperators:
    """Linear conduction condensed to the interface: steady, or over a time step of one size.

    The last exchange and coupling are cached, as conditions seldom change.

    Parameters
    ----------
    conduction : Conduction
    face : InterfaceHeat
    condensed : CondensedDistortion
    reference : ndarray, shape (n_owned,)
        Rise at which conduction and distortion are linearised [K].
    """

    def __init__(
        self,
        conduction: Conduction,
        face: InterfaceHeat,
        condensed: CondensedDistortion,
        reference: np.ndarray,
    ):
        self.conduction = conduction
        self.face = face
        self.reference = reference
        self._condensed = condensed
        self._last = SetupCache()

    @cached_property
    def distortion(self) -> ThermalDistortion:
        """Weak gap per heat at the faces. Every rank calls."""
        return self._condensed(self.conduction, self.face, lambda: self.per_rise)

    @cached_property
    def per_rise(self) -> np.ndarray:
        """Derivative of the weak gap by the nodal rise, shape (n_owned, m) [m³/K]."""
        return self._condensed.slope(self.reference)

    def exchange(self, conductance: np.ndarray) -> HeatExchange:
        """Heat exchange of the faces for conductances at the points, shape (n,)."""
        key = conductance.tobytes()
        return self._last.get("exchange", key, lambda: self.face.exchange(conductance))

    def compliance(self, conditions: InterfaceConditions, basis: np.ndarray) -> np.ndarray:
        """Thermal compliance ``H diag(mu v) Ψ``, shape (m, m)."""
        conductance, heating = conditions.conductance, conditions.heating

        def condensed() -> np.ndarray:
            per_heat = self.distortion.per_friction_heat(self.exchange(conductance))
            return per_heat @ (heating[:, None] * basis)

        return self._last.get("compliance", conductance.tobytes() + heating.tobytes(), condensed)
