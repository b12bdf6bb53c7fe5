"""Laws, distributions and layers of the wear of an interface."""

from __future__ import annotations

import numpy as np

from ...contact.wear.implicit_step import WearRates
from ...contact.wear.layered_step import LayeredStep
from ...laws.layered_wear import layers_of
from ..system.conditions import InterfaceConditions
from ..system.system import System
from .sdirk import InterfaceState

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
    is_plain : bool
        True if depths alone describe the wear of a step: a pair without layers.
    nothing : ndarray or None, shape (n_wearing, n_interfaces)
        Volumes worn off at the start; None for a pair.
    """

    def __init__(self, system: System):
        self.laws, self.spreads = list(system.laws.values()), list(system.spreads.values())
        self._layers = [layers_of(law) for law in self.laws]
        self._ranges = system.contacts.ranges
        self.layered = any(layers.thickness for layers in self._layers)
        self.is_plain = system.model.is_pair and not self.layered
        self.nothing: np.ndarray | None = None
        if self.laws and not system.model.is_pair:
            self.nothing = np.zeros((len(self.laws), len(self._ranges)))
            self._areas, self._weights = system.worn_areas[list(system.laws)], system.weights

    def in_step(self, worn: np.ndarray, rates: WearRates) -> WearRates | LayeredStep:
        """Wear in the time step of some rates, from given depths (n_wearing, n)."""
        return LayeredStep(rates, worn) if self.layered else rates

    def after(
        self, before: InterfaceState, rates: WearRates, pressure: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray | None]:
        """Depths, and volumes worn off, after the time step of some rates at a pressure (n,)."""
        grown = self.in_step(before.worn, rates).depths(pressure)
        removed = before.removed
        if removed is not None:
            removed = removed + self._removed(rates, grown, pressure)
        return before.worn + grown, removed

    def _removed(self, rates: WearRates, grown: np.ndarray, pressure: np.ndarray) -> np.ndarray:
        """Volumes worn off by the rates where the faces touch, (n_wearing, n_interfaces) [m³].

        Layers under a track wear by the depth of the whole track: their volume is that of the
        depths ``grown`` (n_wearing, n).
        """
        if self.layered:
            volumes = self._areas * grown
        else:
            local = [rates.local(law, row, pressure) for row, law in enumerate(self.laws)]
            volumes = rates.step * self._weights * np.array(local)
        return np.column_stack([volumes[:, own].sum(axis=1) for own in self._ranges])

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
