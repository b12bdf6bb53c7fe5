"""Wear of the faces of an interface: its rates, and the depths worn in a step."""

from __future__ import annotations

import numpy as np

from ...contact.wear.implicit_step import WearRates
from ...contact.wear.layered_step import LayeredStep
from ...laws.layered_wear import layers_of
from ..system.conditions import InterfaceConditions
from ..system.system import System

_LEVEL = 1e-3
"""Largest variation of the depth, relative to it, of points that pass a border at once."""


class InterfaceWear:
    """Wear of the faces by their laws and distributions.

    Attributes
    ----------
    count : int
        Number of wearing bodies.
    layered : bool
        True if a face has layers.
    """

    def __init__(self, system: System):
        self._laws, self._spreads = list(system.laws.values()), list(system.spreads.values())
        self._layers = [layers_of(law) for law in self._laws]
        self.count = len(self._laws)
        self.layered = any(layers.thickness for layers in self._layers)

    def rates(self, conditions: InterfaceConditions) -> WearRates:
        """Wear rates under given conditions."""
        return self._rates(conditions, 1.0)

    def in_step(
        self, before: np.ndarray, conditions: InterfaceConditions, step: float
    ) -> WearRates | LayeredStep:
        """Depths worn in a time step from given depths.

        Parameters
        ----------
        before : ndarray, shape (n_wearing, n) [m]
        conditions : InterfaceConditions
            Conditions during the step.
        step : float
            [s]
        """
        rates = self._rates(conditions, step)
        return LayeredStep(rates, before) if self.layered else rates

    def final_rates(self, conditions: InterfaceConditions) -> WearRates:
        """Wear rates of faces that have lost all their layers."""
        substrates = [layers.substrate for layers in self._layers]
        return WearRates(substrates, self._spreads, conditions.wear, conditions.states)

    def below_layers(self, worn: np.ndarray) -> list[np.ndarray]:
        """Points below the lower border of each layer, shape (n,) each.

        A border that all points pass nearly at once is left out.
        """
        return [
            depth >= border
            for layers, depth in zip(self._layers, worn, strict=True)
            for border in layers.borders[:-1]
            if depth.min() < (1 - _LEVEL) * border
        ]

    def is_final(self, worn: np.ndarray, points: np.ndarray) -> bool:
        """True if the faces have lost all their layers at points selected by a mask (n,)."""
        pairs = zip(self._layers, worn, strict=True)
        return all(bool(np.all(depth[points] >= layers.total)) for layers, depth in pairs)

    def _rates(self, conditions: InterfaceConditions, step: float) -> WearRates:
        return WearRates(self._laws, self._spreads, conditions.wear, conditions.states, step)
