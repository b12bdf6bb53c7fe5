"""Thermal distortion of the bodies of a system, condensed to the pressure space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...bulk.heat.conduction import Conduction
from ...contact.operators.heat import InterfaceHeat
from ...contact.operators.heat_condensation import (
    ThermalDistortion,
    condense_distortion,
    gap_per_rise,
)
from ..model.system import System
from ..model.thermal_system import ThermalSystem


@dataclass(frozen=True, eq=False)
class CondensedDistortion:
    """Condensation of the thermal distortion for a conduction operator.

    Heat operators reference this object, not the friction heat that owns them: a reference cycle
    would keep them in memory after their meshes have been discarded.

    Attributes
    ----------
    system : System
    thermal : ThermalSystem
    """

    system: System
    thermal: ThermalSystem

    def __call__(self, conduction: Conduction, face: InterfaceHeat) -> ThermalDistortion:
        """Condense the weak gap per heat at the faces for a conduction; every rank calls."""
        with self.system.phases("condense distortion"):
            if conduction is not self.thermal.conduction:  # of a time step
                return condense_distortion(conduction, self.per_rise, face)
            return self.system.parts.get(
                "distortion",
                self.system.inputs.conduction,
                lambda: condense_distortion(conduction, self.per_rise, face),
            )

    @cached_property
    def per_rise(self) -> np.ndarray:
        """Weak gap per nodal rise of temperature."""
        return self.system.parts.get(
            "gap per rise",
            self.system.inputs.elasticity,
            lambda: gap_per_rise(self.thermal.load, self.system.contact),
        )
