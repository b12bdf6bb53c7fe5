"""Contact areas that alternate from step to step are told from those that change."""

import numpy as np
import pytest

from thermowear.simulation.time.alternation import Alternation


def seen(values):
    """Numbers of the values at which alternation is told."""
    quantity = Alternation()
    return [k for k, value in enumerate(values) if quantity.begins(float(value))]


@pytest.mark.parametrize("period", [2, 4, 6])
def test_two_contact_sets(period):
    """requirement: chatter between two sets is told once, within a hundred steps."""
    areas = np.where(np.arange(1000) % period < period // 2, 4.2e-4, 4.6e-4)
    (step,) = seen(areas)
    assert step < 100


@pytest.mark.parametrize(
    "areas",
    [
        np.linspace(1.0, 0.2, 500),
        np.ones(500),
        np.repeat([1.0, 0.8, 0.9, 0.7, 0.8], 100),
        np.cos(np.arange(500) / 10),
    ],
    ids=["shrinking", "constant", "with a few turns", "slowly varying"],
)
def test_changes(areas):
    """requirement: neither shrinking contact nor periodic loading is told."""
    assert not seen(areas)
