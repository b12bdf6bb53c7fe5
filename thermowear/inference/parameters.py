"""Unknown parameters of a model with bounds and priors, and what is observed of it.

Internal coordinates are of order one: ``z = ln(value)`` for a parameter that is positive and known
to its order of magnitude (`log`), ``z = value/scale`` for others. Derivatives, covariances and
steps of finite differences refer to them; a deviation of ln(value) is a relative one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from .distributions import Normal


@dataclass(frozen=True)
class Observations:
    """Independent measurements with normally distributed errors.

    Attributes
    ----------
    values, deviations : ndarray, shape (n,)
        Measured values and their standard deviations, each in the unit of its quantity.
    labels : tuple of str
        Name of the measurement that each value belongs to, such as its quantity; n names.
    """

    values: np.ndarray
    deviations: np.ndarray
    labels: tuple[str, ...]

    def __post_init__(self):
        values = np.atleast_1d(np.asarray(self.values, dtype=float))
        deviations = np.broadcast_to(np.asarray(self.deviations, dtype=float), values.shape)
        labels = tuple(self.labels)
        if values.ndim != 1 or len(values) == 0:
            raise ValueError(f"observations of shape {values.shape}; must be a list of values")
        if len(labels) != len(values):
            raise ValueError(f"{len(labels)} labels for {len(values)} observations")
        for label, value, deviation in zip(labels, values, deviations, strict=True):
            if not np.isfinite(value):
                raise ValueError(f"{label}: observed value {value}; must be finite")
            if not (np.isfinite(deviation) and deviation > 0):
                raise ValueError(f"{label}: standard deviation {deviation:g}; must be positive")
        for name, content in (("values", values), ("deviations", deviations), ("labels", labels)):
            object.__setattr__(self, name, content)

    def __len__(self) -> int:
        return len(self.values)

    def ordered(self, order: np.ndarray) -> Observations:
        """The observations in another order, given by indices."""
        labels = tuple(self.labels[k] for k in order)
        return Observations(self.values[order], self.deviations[order], labels)

    def residuals(self, predicted) -> np.ndarray:
        """Weighted residuals ``(predicted - observed)/σ``, shape (…, n)."""
        return (np.asarray(predicted, dtype=float) - self.values) / self.deviations


class ForwardModel(Protocol):
    """Model that predicts n observations from p parameters.

    Predictions that cannot be computed are NaN: a fit then takes a smaller step.

    Attributes
    ----------
    step : float
        Step of finite differences in internal coordinates, hence relative for logarithmic ones.
    """

    @property
    def step(self) -> float: ...

    def predict(self, values: np.ndarray) -> np.ndarray:
        """Predictions, shape (n,), at values of the parameters (SI units), shape (p,)."""
        ...

    def neighbours(self, values: np.ndarray, others: Sequence[np.ndarray]) -> list[np.ndarray]:
        """Predictions at other parameters with the discretisation of ``predict(values)``.

        Equal discretisation (time steps) makes differences of predictions smooth; the others may
        be computed in parallel.
        """
        ...


@dataclass(frozen=True)
class Parameter:
    """Unknown parameter with its bounds.

    Attributes
    ----------
    name : str
        Name, such as the path of a key; its parts are separated by dots.
    start : float
        Value at the start of a fit (SI units, as the bounds).
    lower, upper : float
        Bounds, finite.
    log : bool
        True if the internal coordinate is the natural logarithm of the value.
    prior : Normal, optional
        Prior distribution of the value; of its natural logarithm if `log` is true.
    short : str
        Short name for reports; by default the last parts of the name that distinguish it.
    """

    name: str
    start: float
    lower: float
    upper: float
    log: bool = False
    prior: Normal | None = None
    short: str = ""

    def __post_init__(self):
        numbers = {"start": self.start, "lower": self.lower, "upper": self.upper}
        for what, number in numbers.items():
            if not np.isfinite(number):
                raise ValueError(f"{self.name}: {what} is {number}; must be finite")
        if self.lower >= self.upper:
            raise ValueError(
                f"{self.name}: the lower bound {self.lower:g} is not below {self.upper:g}"
            )
        if self.log and self.lower <= 0:
            raise ValueError(
                f"{self.name}: the lower bound is {self.lower:g}; must be positive for a logarithm"
            )
        if not self.lower <= self.start <= self.upper:
            raise ValueError(
                f"{self.name}: the start {self.start:g} is outside the bounds "
                f"{self.lower:g} … {self.upper:g}"
            )

    @property
    def scale(self) -> float:
        """Change of the value, or of its logarithm, per unit of the internal coordinate."""
        return 1.0 if self.log else max(abs(self.start), (self.upper - self.lower) / 2)


@dataclass(frozen=True)
class ParameterSpace:
    """Parameters in a fixed order; arrays of values and coordinates end with an axis of length p.

    Attributes
    ----------
    parameters : tuple of Parameter
        p parameters with different names.
    """

    parameters: tuple[Parameter, ...]

    def __post_init__(self):
        if not self.parameters:
            raise ValueError("no parameters: at least one is needed")
        object.__setattr__(self, "parameters", tuple(self.parameters))
        for what, names in (("name", self.names), ("short name", self.short_names)):
            if twice := [name for name, count in Counter(names).items() if count > 1]:
                raise ValueError(f"{', '.join(twice)}: {what} of several parameters")

    def __len__(self) -> int:
        return len(self.parameters)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(parameter.name for parameter in self.parameters)

    @cached_property
    def short_names(self) -> tuple[str, ...]:
        """Given short names, or the fewest last parts of the names that differ from all others."""
        return tuple(
            parameter.short or _shortest(parameter.name, self.names)
            for parameter in self.parameters
        )

    @cached_property
    def log(self) -> np.ndarray:
        """True for parameters with a logarithmic coordinate, shape (p,)."""
        return np.array([parameter.log for parameter in self.parameters])

    @cached_property
    def scale(self) -> np.ndarray:
        """Scales of the coordinates, 1 for logarithmic ones, shape (p,)."""
        return np.array([parameter.scale for parameter in self.parameters])

    @cached_property
    def start(self) -> np.ndarray:
        """Values at the start, shape (p,)."""
        return np.array([parameter.start for parameter in self.parameters], dtype=float)

    @cached_property
    def limits(self) -> np.ndarray:
        """Lower and upper bounds of the values, shape (2, p)."""
        pairs = [(parameter.lower, parameter.upper) for parameter in self.parameters]
        return np.array(pairs, dtype=float).T

    @cached_property
    def bounds(self) -> np.ndarray:
        """Lower and upper bounds of the internal coordinates, shape (2, p)."""
        return self.internal(self.limits)

    @property
    def widths(self) -> np.ndarray:
        """Distances between the bounds of the internal coordinates, shape (p,)."""
        return self.bounds[1] - self.bounds[0]

    def internal(self, values) -> np.ndarray:
        """Internal coordinates of values, shape (…, p); NaN for logarithms of negative values."""
        values = np.asarray(values, dtype=float)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(self.log, np.log(np.where(self.log, values, 1.0)), values / self.scale)

    def values(self, internal) -> np.ndarray:
        """Values at internal coordinates, shape (…, p), also beyond the bounds."""
        internal = np.asarray(internal, dtype=float)
        with np.errstate(over="ignore"):
            return np.where(
                self.log, np.exp(np.where(self.log, internal, 0.0)), internal * self.scale
            )

    def admissible(self, internal) -> np.ndarray:
        """Values at internal coordinates, moved to the bounds where they are beyond."""
        return np.clip(self.values(internal), *self.limits)

    def contains(self, internal) -> np.ndarray:
        """True for points within the bounds, shape (…)."""
        internal = np.asarray(internal, dtype=float)
        return np.all((internal >= self.bounds[0]) & (internal <= self.bounds[1]), axis=-1)

    def reach(self, directions: np.ndarray) -> np.ndarray:
        """Distances of the bounds along directions (p, m) of unit length, shape (m,)."""
        with np.errstate(divide="ignore"):
            return np.min(self.widths[:, None] / np.abs(directions), axis=0)

    def prior_residuals(self, internal) -> np.ndarray:
        """Deviations from the means of the priors, in standard deviations, shape (…, m)."""
        scaled = np.asarray(internal, dtype=float) * self.scale
        chosen = [(i, p.prior) for i, p in enumerate(self.parameters) if p.prior is not None]
        columns = [(scaled[..., i] - prior.mean) / prior.deviation for i, prior in chosen]
        return np.stack(columns, axis=-1) if columns else np.zeros((*scaled.shape[:-1], 0))

    @cached_property
    def prior_jacobian(self) -> np.ndarray:
        """Derivatives of the residuals of the priors, shape (m, p)."""
        rows = [
            row / parameter.prior.deviation
            for row, parameter in zip(np.diag(self.scale), self.parameters, strict=True)
            if parameter.prior is not None
        ]
        return np.array(rows).reshape(-1, len(self))


def _shortest(name: str, names: tuple[str, ...]) -> str:
    """Fewest last parts of a name that no other name ends with."""
    parts = name.split(".")
    for count in range(1, len(parts)):
        end = parts[-count:]
        if sum(other.split(".")[-count:] == end for other in names) == 1:
            return ".".join(end)
    return name
