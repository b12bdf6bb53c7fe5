"""Wear laws: modified Archard's, those of several materials, and those of layers.

Each point wears by the law of the layer that its own worn depth has reached, ``d' = r_i`` in layer
i. As long as the rates r_i are constant, the depth is a piecewise linear function of time whose
kinks are known: a layer takes the time of its remaining thickness over its rate. `LayerPassage`
evaluates it, so that no event has to be located and a point that passes a border within a time
step reaches its exact depth. If the laws differ by a coefficient only, ``r_i = k_i f(p, v, …)``,
the depth is a function of the dose ``∫ f dt`` alone, whatever the pressure does in that time, and
``Σ d_i / k_i`` over the depths d_i worn of the layers is the dose: the balance of volumes is exact.

A contact point stands for an area, over which the depth varies: the border of a layer passes it
while the depth of the point goes on by that variation. Meanwhile the layer covers a share f of the
area, which falls from 1 to 0, and both materials wear at one rate r: with linear laws under the
pressures ``r/k_1`` and ``r/k_2``, whose mean is that of the point,

    1/r = f/r_1 + (1 - f)/r_2,

with the rates r_1 and r_2 of both laws at the pressure of the point. The pressures of the layers
that are left would saw if the border moved by whole points. Points weight their surroundings by
hat functions; f is constant in each of `_PARTS` parts of the border, which are layers of their own.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from .interfaces import Law, LocalState, Values

_FLOOR = 1e-9  # relative to the largest pressure: avoids the infinite slope of p^b (b < 1) at p = 0


def floored(pressure: Values) -> np.ndarray:
    """Pressures bounded from below, so that a law has a finite slope at zero pressure [Pa]."""
    return np.maximum(pressure, _FLOOR * max(float(np.max(pressure, initial=0.0)), 1.0))


@dataclass(frozen=True)
class PowerWear:
    """Power law of wear of one body, friction included.

    Attributes
    ----------
    coefficient : float or ndarray, shape (n,)
        κ in ``(m/s)^(1-a) Pa^(-b)``; for a = b = 1 Archard's k.
    pressure_exponent, velocity_exponent : float or ndarray, shape (n,)
        b and a. Arrays are values at the contact points, see `law_by_point`.
    """

    coefficient: Values
    pressure_exponent: Values = 1.0
    velocity_exponent: Values = 1.0
    variables: ClassVar[frozenset[str]] = frozenset({"p", "v"})

    @classmethod
    def per_friction_stress(cls, β: float, friction: float, b: float, a: float) -> PowerWear:
        """Build the law ``β (μ p)^b v^a`` in the friction stress."""
        return cls(β * friction**b, b, a)

    def factor(self, speed: Values) -> np.ndarray:
        """Factor Z = κ v^a at points, so that the rate is Z p^b."""
        return self.coefficient * np.power(speed, self.velocity_exponent)

    def value(self, at: LocalState) -> np.ndarray:
        """Depth worn per time at points (n,) [m/s]."""
        return self.factor(at.v) * np.power(np.maximum(at.p, 0.0), self.pressure_exponent)

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure [m/(s Pa)]; finite at p = 0 for b < 1, too."""
        b = self.pressure_exponent
        return self.factor(at.v) * b * np.power(floored(at.p), b - 1.0)


_PARTS = 16
"""Parts of a border of a layer, of constant shares of both materials."""


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
    variation : float or ndarray, shape (n,)
        Range of depths in the area of each point, in which it passes a border; at most the thinner
        of both layers [m].
    """

    thickness: tuple[float | np.ndarray, ...]
    laws: tuple[Law, ...]
    variation: float | np.ndarray = 0.0

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
        each = self._each
        last = np.full_like(each[0], np.inf) if each else np.array([np.inf])
        return np.cumsum([*each, last], axis=0)

    @property
    def total(self) -> np.ndarray:
        """Thickness of all layers together, shape (1,) or (n,) [m]."""
        return self.borders[-2] if self.thickness else np.zeros(1)

    @cached_property
    def _ends(self) -> np.ndarray:
        """Depth of the lower end of each part, see `_shares`, shape (n_parts, n or 1) [m]."""
        if not self.thickness:
            return self.borders
        thinnest = np.stack(np.broadcast_arrays(*self._each)).min(axis=0)
        half = np.minimum(thinnest, self.variation) / 2
        steps = np.outer(2 * np.arange(_PARTS + 1) / _PARTS - 1, half)
        passed = [border + steps for border in self.borders[:-1]]
        return np.vstack([*passed, np.full_like(passed[0][:1], np.inf)])

    @property
    def _each(self) -> list[np.ndarray]:
        """Thickness of each layer."""
        return [np.atleast_1d(thickness) for thickness in self.thickness]

    @cached_property
    def _shares(self) -> np.ndarray:
        """Share of each layer in the parts, (n_parts, n_layers + 1): itself, then its border."""
        count, u = len(self.laws), (2 * np.arange(_PARTS) + 1) / _PARTS - 1
        share = 0.5 + u - u * np.abs(u) / 2  # part of the hat function 1 - |u| below
        units = np.split(np.eye(count), count)
        rows = [units[0]]
        for above, below in itertools.pairwise(units):
            rows += [np.outer(1 - share, above) + np.outer(share, below), below]
        return np.vstack(rows)

    @property
    def through(self) -> np.ndarray:
        """Depth at which no layer is left, shape (1,) or (n,) [m]."""
        return self._ends[-2] if self.thickness else np.zeros(1)

    def reached(self, depth: np.ndarray) -> np.ndarray:
        """Index of the layer that a depth has reached; a border belongs to the layer below it."""
        return self._beyond(self.borders, np.asarray(depth))

    def _beyond(self, ends: np.ndarray, depth: np.ndarray) -> np.ndarray:
        ends = ends.reshape(len(ends), *[1] * (np.ndim(depth) - 1), ends.shape[1])
        return (depth >= ends).sum(axis=0)

    def worn(self, depth: np.ndarray) -> np.ndarray:
        """Depth worn of each layer and of the substrate, shape (n_layers + 1, n) [m]."""
        upper = np.vstack([np.zeros_like(self._ends[:1]), self._ends[:-1]])
        return self._shares.T @ (np.clip(depth, upper, self._ends) - upper)

    def value(self, at: LocalState) -> np.ndarray:
        """Depth worn per time at the points [m/s]."""
        return self._reached(at, [law.value(at) for law in self.laws])

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure [m/(s Pa)]."""
        return self._reached(at, [law.slope(at) for law in self.laws])

    def _reached(self, at: LocalState, values: list[np.ndarray]) -> np.ndarray:
        """Values of the part reached, from those of each law."""
        part, *each = np.broadcast_arrays(self._beyond(self._ends, np.asarray(at.depth)), *values)
        return np.take_along_axis(self._mixed(np.stack(each)), part[None], axis=0)[0]

    def _mixed(self, rates: np.ndarray) -> np.ndarray:
        """Rate of each part from those of the layers (n_layers + 1, ...), harmonic means."""
        with np.errstate(divide="ignore"):
            times = np.where(rates > 0.0, 1 / rates, np.inf)
            each = [
                rates[shares.argmax()]
                if shares.max() == 1.0
                else 1 / sum(f * time for f, time in zip(shares, times, strict=True) if f > 0.0)
                for shares in self._shares
            ]
        return np.stack(each)

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
        mixed = self._mixed(rates)
        spent, gained = np.zeros_like(mixed), np.zeros_like(mixed)
        left, last = np.full(len(depth), time), np.zeros(len(depth))
        upper = np.vstack([np.full_like(self._ends[:1], -np.inf), self._ends[:-1]])
        for part, (begin, end) in enumerate(zip(upper, self._ends, strict=True)):
            rate, thick = mixed[part], np.maximum(end - np.maximum(depth, begin), 0.0)
            with np.errstate(divide="ignore", invalid="ignore"):
                needed = np.where(thick > 0.0, thick / rate, 0.0)
            ends = (left > 0.0) & (needed >= left)
            spent[part] = np.minimum(left, needed)
            gained[part] = np.where(needed > left, left * rate, thick)
            last[ends] = rate[ends]
            left = left - spent[part]
        return LayerPassage(spent, gained, mixed, last, rates, self._shares)


@dataclass(frozen=True)
class LayerPassage:
    """Wear of points through the layers and their borders in a time with constant rates.

    Attributes
    ----------
    spent : ndarray, shape (n_parts, n)
        Time in each layer and in each part of the borders [s].
    gained : ndarray, shape (n_parts, n)
        Depth worn of each part in that time [m].
    mixed : ndarray, shape (n_parts, n)
        Rate of each part [m/s].
    last : ndarray, shape (n,)
        Rate of the part reached at the end [m/s].
    rates : ndarray, shape (n_layers + 1, n)
        Rate of each layer [m/s].
    shares : ndarray, shape (n_parts, n_layers + 1)
        Share of each layer in the parts.
    """

    spent: np.ndarray
    gained: np.ndarray
    mixed: np.ndarray
    last: np.ndarray
    rates: np.ndarray
    shares: np.ndarray

    @property
    def depth(self) -> np.ndarray:
        """Depth worn in the time, shape (n,) [m]."""
        return self.gained.sum(axis=0)

    @property
    def by_rate(self) -> np.ndarray:
        """Derivative of the depth with respect to the rate of each layer, (n_layers + 1, n) [s].

        A part that is left sooner leaves more time to the last one: ``∂d/∂r = spent r_last / r``
        for its rate r, whose derivative by that of layer i is ``f_i (r / r_i)²``.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = np.where(self.mixed == self.last, 1.0, self.last / self.mixed)
            by_part = np.where(self.spent > 0.0, self.spent * scale, 0.0)
            result = np.zeros_like(self.rates)
            for part, shares in enumerate(self.shares):
                for layer in np.flatnonzero(shares):
                    ratio = np.where(
                        self.mixed[part] > 0.0, self.mixed[part] / self.rates[layer], 1.0
                    )
                    result[layer] += shares[layer] * ratio**2 * by_part[part]
        return result


def layers_of(law: Law) -> LayeredWear:
    """Layers of a law; any other law is that of a substrate without layers."""
    return law if isinstance(law, LayeredWear) else LayeredWear((), (law,))


@dataclass(frozen=True, eq=False)
class LawByPoint:
    """One of several laws at each contact point.

    Attributes
    ----------
    laws : tuple of Law
    at : ndarray of int, shape (n,)
        Index of the law at each point.
    """

    laws: tuple[Law, ...]
    at: np.ndarray

    @property
    def variables(self) -> frozenset[str]:
        """Variables of any of the laws."""
        return frozenset().union(*(law.variables for law in self.laws))

    def value(self, at: LocalState) -> np.ndarray:
        """Depth worn per time at the points [m/s]; each law only sees its own points."""
        return self._each(at, [law.value for law in self.laws])

    def slope(self, at: LocalState) -> np.ndarray:
        """Derivative with respect to the pressure [m/(s Pa)]."""
        return self._each(at, [law.slope for law in self.laws])

    def _each(
        self, at: LocalState, functions: Sequence[Callable[[LocalState], np.ndarray]]
    ) -> np.ndarray:
        result = np.zeros(len(self.at))
        state = [np.broadcast_to(values, self.at.shape) for values in at]
        for index, function in enumerate(functions):
            own = self.at == index
            if own.any():
                result[own] = function(LocalState(*(values[own] for values in state)))
        return result


def law_by_point(laws: Sequence[Law], at: np.ndarray) -> Law:
    """Law of a face from the laws of its materials; a power law if all of them are.

    Parameters
    ----------
    laws : sequence of Law
    at : ndarray of int, shape (n,)
        Index of the law at each contact point.
    """
    if len(laws) == 1:
        return laws[0]
    powers = [law for law in laws if type(law) is PowerWear]  # a derived class may override it
    if len(powers) < len(laws):
        return LawByPoint(tuple(laws), at)
    return PowerWear(
        np.array([law.coefficient for law in powers])[at],
        np.array([law.pressure_exponent for law in powers])[at],
        np.array([law.velocity_exponent for law in powers])[at],
    )


def joined_laws(laws: Sequence[Law | None], counts: Sequence[int]) -> Law:
    """Law of the points of several interfaces; a power law if all of them are.

    If any has layers, so has the law: those of the others have no thickness.

    Parameters
    ----------
    laws : sequence of Law or None
        Law of the points of each interface; None where nothing wears.
    counts : sequence of int
        Number of points of each interface.
    """
    known = [PowerWear(0.0) if law is None else law for law in laws]
    if len(known) == 1:
        return known[0]
    if any(isinstance(law, LayeredWear) for law in known):
        return _joined_layers([layers_of(law) for law in known], counts)
    powers = [law for law in known if type(law) is PowerWear]
    if len(powers) < len(known):
        return LawByPoint(tuple(known), np.repeat(np.arange(len(known)), counts))
    columns = (
        np.concatenate(
            [np.broadcast_to(getattr(law, name), n) for law, n in zip(powers, counts, strict=True)]
        )
        for name in ("coefficient", "pressure_exponent", "velocity_exponent")
    )
    return PowerWear(*columns)


def _joined_layers(each: Sequence[LayeredWear], counts: Sequence[int]) -> LayeredWear:
    """Layers of the points of several interfaces, counted from the substrate up."""
    most = max(len(face.thickness) for face in each)
    missing = [most - len(face.thickness) for face in each]
    pairs = list(zip(each, missing, strict=True))
    thickness = [(0.0,) * n + face.thickness for face, n in pairs]
    laws = [(face.laws[0],) * n + face.laws for face, n in pairs]
    return LayeredWear(
        tuple(np.repeat(layer, counts) for layer in zip(*thickness, strict=True)),
        tuple(joined_laws(layer, counts) for layer in zip(*laws, strict=True)),
        np.concatenate([np.zeros(n) + f.variation for f, n in zip(each, counts, strict=True)]),
    )
