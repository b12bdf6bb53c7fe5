"""Wear law of a coated face: a law for each layer, and that of the substrate below them.

Each point wears by the law of the layer that its own worn depth has reached, ``d' = r_i`` in layer
i. As long as the rates r_i are constant, the depth is a piecewise linear function of time whose
kinks are known: a layer takes the time of its remaining thickness over its rate. `LayerPassage`
evaluates it, so that no event has to be located and a point that passes a border within a time
step reaches its exact depth. If the laws differ by a coefficient only, ``r_i = k_i f(p, v, …)``,
the depth is a function of the dose ``∫ f dt`` alone, whatever the pressure does in that time, and
``Σ d_i / k_i`` over the depths d_i worn of the layers is the dose: the balance of volumes is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .interfaces import Law, LocalState


@dataclass(frozen=True)
class LayeredWear:
    """One of several laws, by the worn depth.

    Attributes
    ----------
    thickness : tuple of (float or ndarray, shape (n,))
        Thickness of each layer, from the surface down, of the face or at each of its points; a
        layer of no thickness is left out there [m].
    laws : tuple of Law
        Law of each layer and, last, of the substrate. A law that depends on the depth gets the
        depth below the unworn surface.
    """

    thickness: tuple[float | np.ndarray, ...]
    laws: tuple[Law, ...]

    @property
    def variables(self) -> frozenset[str]:
        """Variables of any of the laws, and the depth."""
        return self.inner_variables | ({"depth"} if self.thickness else set())

    @property
    def inner_variables(self) -> frozenset[str]:
        """Variables of any of the laws."""
        return frozenset().union(*(law.variables for law in self.laws))

    @property
    def substrate(self) -> Law:
        """Law below all layers."""
        return self.laws[-1]

    @cached_property
    def borders(self) -> np.ndarray:
        """Depth of the lower border of each layer, infinite for the substrate [m].

        Shape (n_layers + 1, 1) or, by point, (n_layers + 1, n).
        """
        each = [np.atleast_1d(thickness) for thickness in self.thickness]
        last = np.full_like(each[0], np.inf) if each else np.array([np.inf])
        return np.cumsum([*each, last], axis=0)

    @property
    def total(self) -> np.ndarray:
        """Thickness of all layers together, shape (1,) or (n,) [m]."""
        return self.borders[-2] if self.thickness else np.zeros(1)

    def reached(self, depth: np.ndarray) -> np.ndarray:
        """Index of the layer that a depth has reached; a border belongs to the layer below it."""
        count, points = self.borders.shape
        borders = self.borders.reshape(count, *[1] * (np.ndim(depth) - 1), points)
        return (np.asarray(depth) >= borders).sum(axis=0)

    def worn(self, depth: np.ndarray) -> np.ndarray:
        """Depth worn of each layer and of the substrate, shape (n_layers + 1, n) [m]."""
        upper = np.vstack([np.zeros_like(self.borders[:1]), self.borders[:-1]])
        return np.clip(depth, upper, self.borders) - upper

    def value(self, at: LocalState) -> np.ndarray:
        """Depth worn per time at the points [m/s]."""
        return self._reached(at, [law.value(at) for law in self.laws])

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure [m/(s Pa)]."""
        return self._reached(at, [law.slope(at) for law in self.laws])

    def _reached(self, at: LocalState, values: list[np.ndarray]) -> np.ndarray:
        """Values of the layers reached, from those of each law."""
        layer, *each = np.broadcast_arrays(self.reached(np.asarray(at.depth)), *values)
        return np.take_along_axis(np.stack(each), layer[None], axis=0)[0]

    def passage(self, depth: np.ndarray, rates: np.ndarray, time: float) -> LayerPassage:
        """Wear through the layers at constant rates.

        Parameters
        ----------
        depth : ndarray, shape (n,)
            Depth at the beginning [m].
        rates : ndarray, shape (n_layers + 1, n)
            Rate of each layer at every point, 0 or more [m/s].
        time : float
            Duration [s].
        """
        spent, gained = np.zeros_like(rates), np.zeros_like(rates)
        left, last = np.full(len(depth), time), np.zeros(len(depth))
        upper = np.vstack([np.full_like(self.borders[:1], -np.inf), self.borders[:-1]])
        for layer, (begin, end) in enumerate(zip(upper, self.borders, strict=True)):
            rate, thick = rates[layer], np.maximum(end - np.maximum(depth, begin), 0.0)
            with np.errstate(divide="ignore", invalid="ignore"):
                needed = np.where(thick > 0.0, thick / rate, 0.0)
            ends = (left > 0.0) & (needed >= left)
            spent[layer] = np.minimum(left, needed)
            gained[layer] = np.where(needed > left, left * rate, thick)
            last[ends] = rate[ends]
            left = left - spent[layer]
        return LayerPassage(spent, gained, rates, last)


@dataclass(frozen=True)
class LayerPassage:
    """Wear of points through the layers in a time with constant rates.

    Attributes
    ----------
    spent : ndarray, shape (n_layers + 1, n)
        Time in each layer [s].
    gained : ndarray, shape (n_layers + 1, n)
        Depth worn of each layer in that time [m].
    rates : ndarray, shape (n_layers + 1, n)
        Rate of each layer [m/s].
    last : ndarray, shape (n,)
        Rate of the layer reached at the end [m/s].
    """

    spent: np.ndarray
    gained: np.ndarray
    rates: np.ndarray
    last: np.ndarray

    @property
    def depth(self) -> np.ndarray:
        """Depth worn in the time, shape (n,) [m]."""
        return self.gained.sum(axis=0)

    @property
    def by_rate(self) -> np.ndarray:
        """Derivative of the depth with respect to the rate of each layer, (n_layers + 1, n) [s].

        A layer that is left sooner leaves more time to the last one:
        ``∂d/∂r_i = spent_i r_last / r_i``.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = np.where(self.rates == self.last, 1.0, self.last / self.rates)
        return np.where(self.spent > 0.0, self.spent * scale, 0.0)


def layers_of(law: Law) -> LayeredWear:
    """Layers of a law; any other law is that of a substrate without layers."""
    return law if isinstance(law, LayeredWear) else LayeredWear((), (law,))
