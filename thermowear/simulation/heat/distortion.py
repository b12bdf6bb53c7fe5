"""Thermal distortion of the bodies of a system, condensed to the interface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...bulk.heat.conduction import Conduction
from ...bulk.heat.varying import VaryingExpansion
from ...contact.operators.heat import InterfaceHeat, ThermalDistortion
from ...contact.operators.heat_condensation import condense_distortion
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
