"""Tables of factors: what changes with temperature, pressure or speed."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from ..values import units
from ..values.section import KeyFault, Number, Section

Positive = Annotated[Number, Field(gt=0.0)]
NotNegative = Annotated[Number, Field(ge=0.0)]


def must_increase(key: str, values: tuple[float, ...]) -> None:
    """Refuse a list that is empty, or that somewhere does not increase."""
    if not values:
        raise KeyFault(key, "is empty; needs at least one value")
    if any(b <= a for a, b in pairwise(values)):
        raise KeyFault(key, "must increase")


def must_match(key: str, values: tuple[float, ...], places: tuple[float, ...], what: str) -> None:
    """Refuse a list with more or fewer values than there are places for them."""
    if len(values) != len(places):
        raise KeyFault(key, f"has {len(values)} values for {len(places)} {what}")


class Factor(Section):
    """A factor by straight lines between given places, constant beyond the ends.

    Attributes
    ----------
    at : tuple of float
        Increasing, in SI.
    factor : tuple of float
    """

    at: tuple[float, ...]
    factor: tuple[Positive, ...]

    @model_validator(mode="after")
    def _fits(self):
        must_increase("at", self.at)
        must_match("factor", self.factor, self.at, "places")
        return self

    def value(self, x: np.ndarray) -> np.ndarray:
        """The factor at `x`, an array of any shape in SI."""
        return np.interp(x, self.at, self.factor)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Its derivative; where lines meet, that of the next one."""
        slopes = np.concatenate([[0.0], np.diff(self.factor) / np.diff(self.at), [0.0]])
        return slopes[np.searchsorted(self.at, x, side="right")]

    def integral(self, start: float, x: np.ndarray) -> np.ndarray:
        """Its integral from `start` to `x`."""
        return self._integral(np.asarray(x, dtype=float)) - self._integral(np.asarray(start))

    def _integral(self, x: np.ndarray) -> np.ndarray:
        """From the first place on: straight lines are integrated exactly by their means."""
        at, factor = np.array(self.at), np.array(self.factor)
        whole = np.concatenate([[0.0], np.cumsum(np.diff(at) * (factor[1:] + factor[:-1]) / 2)])
        last = np.maximum(np.searchsorted(at, x, side="right") - 1, 0)
        return whole[last] + (x - at[last]) * (factor[last] + self.value(x)) / 2


class TemperatureFactor(Factor):
    """A factor that depends on the temperature [K]."""

    at: tuple[units.Temperature, ...]


class ExpansionFactor(TemperatureFactor):
    """A factor of the secant coefficient of expansion, which may vanish."""

    factor: tuple[NotNegative, ...]


class PressureFactor(Factor):
    """A factor that depends on the pressure [Pa]."""

    at: tuple[units.LeastPressure, ...]


class SpeedFactor(Factor):
    """A factor that depends on the sliding speed [m/s]."""

    at: tuple[units.Speed, ...]


class Factors(Section):
    """Factors that multiply each other."""

    temperature: TemperatureFactor | None = None
    pressure: PressureFactor | None = None
    speed: SpeedFactor | None = None

    @property
    def depends_on(self) -> tuple[str, ...]:
        """Which of temperature, pressure and speed there is a table of."""
        names = ("temperature", "pressure", "speed")
        return tuple(name for name in names if getattr(self, name) is not None)

    def value(
        self,
        temperature: np.ndarray | float | None,
        pressure: np.ndarray | float,
        speed: np.ndarray | float,
    ) -> np.ndarray:
        """Product of the factors at points.

        Parameters
        ----------
        temperature : ndarray, shape (n,)
            [K]; may be None where nothing depends on it.
        pressure : ndarray, shape (n,)
            [Pa]
        speed : ndarray, shape (n,)
            [m/s]

        Returns
        -------
        ndarray, shape (n,)
        """
        found = {"temperature": temperature, "pressure": pressure, "speed": speed}
        product = np.ones(np.broadcast_shapes(np.shape(pressure), np.shape(speed)))
        for name in self.depends_on:
            product = product * getattr(self, name).value(found[name])
        return product
