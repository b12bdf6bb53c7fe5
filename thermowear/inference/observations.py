"""Measured values with their standard deviations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


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
