"""Interface of models that predict observations from parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np


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
