"""Wear law of faces of several materials, or of several interfaces: one at each contact point."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from .interfaces import Law, LocalState
from .layered_wear import LayeredWear, layers_of
from .power_wear import PowerWear


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
