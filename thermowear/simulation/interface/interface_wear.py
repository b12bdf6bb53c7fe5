"""Laws, distributions and layers of the wear of an interface."""

from __future__ import annotations

import numpy as np

from ...contact.wear.implicit_step import WearRates
from ...laws.layered_wear import layers_of
from ..system.conditions import InterfaceConditions
from ..system.system import System

_LEVEL = 1e-3
"""Largest variation of the depth, relative to it, of points that pass a border at once."""


class InterfaceWear:
    """Wear of the faces of an interface.

    Attributes
    ----------
    laws : list of Law
        Wear laws of the wearing bodies.
    spreads : list of Distribution
        Distributions of the wear of these bodies.
    layered : bool
        True if a face has layers.
    """

    def __init__(self, system: System):
        self.laws, self.spreads = list(system.laws.values()), list(system.spreads.values())
        self._layers = [layers_of(law) for law in self.laws]
        self._ranges = system.contacts.ranges
        self.layered = any(layers.thickness for layers in self._layers)

    def final_rates(self, conditions: InterfaceConditions) -> WearRates:
        """Wear rates of faces that have lost all their layers."""
        substrates = [layers.substrate for layers in self._layers]
        return WearRates(substrates, self.spreads, conditions.wear, conditions.states)

    def below_layers(self, worn: np.ndarray) -> list[np.ndarray]:
        """Points of an interface below the lower border of each layer, shape (n,) each.

        A border that all its points pass nearly at once is left out.
        """
        found = []
        for layers, depth in zip(self._layers, worn, strict=True):
            borders = np.broadcast_to(layers.borders, (len(layers.borders), len(depth)))
            for border in borders[:-1]:
                for own in self._ranges:
                    if depth[own].min() < (1 - _LEVEL) * border[own][0]:
                        below = np.zeros(len(depth), dtype=bool)
                        below[own] = depth[own] >= border[own]
                        found.append(below)
        return found

    def are_left(self, worn: np.ndarray, points: np.ndarray) -> bool:
        """True if the faces have any of their layers left at points selected by a mask (n,)."""
        pairs = zip(self._layers, worn, strict=True)
        return any(bool(np.any((depth < layers.total)[points])) for layers, depth in pairs)
