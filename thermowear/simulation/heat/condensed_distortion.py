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
    """Condenses the distortion by a conduction.

    Operators of heat keep this, not the friction heat that keeps them: in a circle of references
    they would stay in memory when the meshes that they are of have been given up.

    Attributes
    ----------
    system : System
    thermal : ThermalSystem
    """

    system: System
    thermal: ThermalSystem

    def __call__(self, conduction: Conduction, face: InterfaceHeat) -> ThermalDistortion:
        """Weak gap per heat at the faces, by a conduction; every rank calls."""
        with self.system.phases("condense distortion"):
            if conduction is not self.thermal.conduction:  # over a step of time
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
