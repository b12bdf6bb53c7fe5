"""Depth worn in an implicit step by faces with layers, exact in the depth.

The pressure and the other conditions are those at the end of the step; under them every point
passes through its layers as `laws.layered_wear` describes. The depth is a continuous and
increasing function of the pressure with kinks where a border is just reached, for which
`implicit_step.newton_with_wear` uses the derivative on one of both sides.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...laws.interfaces import Law
from ...laws.layered_wear import LayerPassage, layers_of
from .implicit_step import Slope, WearRates


@dataclass(frozen=True)
class LayeredStep:
    """Wear in a time step as a function of the pressure at its end.

    Where wear is spread over a track, each layer has the rate that the track would have if all of
    it had reached that layer: points with common means have the same depth.

    Attributes
    ----------
    rates : WearRates
        Rates by the laws of the wearing bodies, and the time step.
    before : ndarray, shape (n_wearing, n)
        Depths before the step [m].
    """

    rates: WearRates
    before: np.ndarray

    def depths(self, pressure: np.ndarray) -> np.ndarray:
        """Depths worn in the time step, shape (n_wearing, n) [m]."""
        worn = np.zeros_like(self.before)
        for row in range(len(worn)):
            worn[row] = self._passage(row, pressure).depth
        return worn

    def value(self, pressure: np.ndarray, last: object = None) -> np.ndarray:
        """Total depth worn in the time step, shape (n,) [m]."""
        return self.depths(pressure).sum(axis=0)

    def slope(self, pressure: np.ndarray, last: object = None) -> Slope:
        """Derivative of `value` by the pressures [m/Pa]."""
        return self.rates.linearised(pressure, self._terms(pressure))

    def _terms(self, pressure: np.ndarray) -> Iterator[tuple[int, Law, np.ndarray | float]]:
        """Wearing body, law and part of the time step of each layer, see `LayerPassage.by_rate`."""
        for row, law in enumerate(self.rates.laws):
            parts = self._passage(row, pressure).by_rate / self.rates.step
            for layer, part in zip(layers_of(law).laws, parts, strict=True):
                yield row, layer, part

    def _passage(self, row: int, pressure: np.ndarray) -> LayerPassage:
        layers = layers_of(self.rates.laws[row])
        rates = np.array([self.rates.by(law, row, pressure) for law in layers.laws])
        return layers.passage(self.before[row], rates, self.rates.step)
