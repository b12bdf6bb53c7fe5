"""Measured values of one quantity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .readings import Reading


@dataclass(frozen=True)
class Measurement:
    """Values of one quantity, measured in one experiment.

    Attributes
    ----------
    label : str
        Name of the observation, with the quantity where a file has several.
    reading : Reading
    values, deviations : ndarray, shape (n,)
        Values and standard deviations [SI]; NaN where only a measurement is planned, deviations if
        they are relative.
    changes : tuple of str
        Keys of the case that had other values, as ``KEY=VALUE``.
    file : str
    relative : float
        Relative deviation of a planned measurement.
    """

    label: str
    reading: Reading
    values: np.ndarray
    deviations: np.ndarray
    changes: tuple[str, ...] = ()
    file: str = ""
    relative: float = 0.0

    @property
    def conditions(self) -> tuple[str, ...]:
        """Conditions that it was made under: its changes, whatever their order."""
        return tuple(sorted(self.changes))
