"""Models with closed forms for the tests of inference."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np


@dataclass
class FunctionModel:
    """Model of a function of the values, which records its calls."""

    function: Any
    step: float = 1e-4
    predicted: list = field(default_factory=list)
    calls: list = field(default_factory=list)

    def predict(self, values):
        self.predicted.append(np.array(values))
        return self.function(values)

    def neighbours(self, values, others):
        self.calls.append((np.array(values), len(others)))
        return [self.function(other) for other in others]


def saturating(times):
    """Depths ``a (1 - exp(-t/b))``."""
    return lambda values: values[0] * (1 - np.exp(-times / values[1]))


def depths(loads):
    """Depths ``k mu^b p^b`` of values k, mu, b."""
    loads = np.asarray(loads, dtype=float)
    return lambda values: values[0] * (values[1] * loads) ** values[2]
