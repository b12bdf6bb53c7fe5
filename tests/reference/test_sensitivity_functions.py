"""Functions with known Sobol indices."""

import numpy as np
import pytest

from thermowear.reference.sensitivity_functions import Ishigami, SobolProduct

NODES = (np.arange(100) + 0.5) / 100


@pytest.mark.parametrize(
    ("function", "lower", "upper"),
    [(Ishigami(5.0, 0.2), -np.pi, np.pi), (SobolProduct((0.0, 1.0, 4.0)), 0.0, 1.0)],
    ids=["ishigami", "g-function"],
)
def test_indices_are_variances_of_conditional_means(function, lower, upper):
    """requirement: first-order and total indices by sums over a grid of 100³ points."""
    axis = lower + (upper - lower) * NODES
    values = function(np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1))
    assert function.variance == pytest.approx(values.var(), rel=1e-3)
    for i in range(3):
        others = tuple(j for j in range(3) if j != i)
        first = values.mean(axis=others).var() / values.var()
        total = values.var(axis=i).mean() / values.var()
        assert function.first[i] == pytest.approx(first, abs=1e-3)
        assert function.total[i] == pytest.approx(total, abs=1e-3)
