"""Depths that are carried over to a mesh made for a wider zone."""

from types import SimpleNamespace

import numpy as np
import pytest

from thermowear.laws.distribution import InPlace
from thermowear.simulation.geometry_update.wider_zone import _carried


def face(begin, end, count):
    """A system of which only contact points and weights are asked."""
    x = np.linspace(begin, end, count)
    weights = np.full(count, (end - begin) / (count - 1))
    weights[[0, -1]] /= 2
    pairing = SimpleNamespace(points=np.column_stack([x, np.zeros(count)]))
    return SimpleNamespace(pairing=pairing, weights=weights, spreads={1: InPlace()})


@pytest.mark.parametrize("off", [0.0, 1e-17, -1e-17])
def test_an_end_that_has_moved_by_rounding_is_the_end(off):
    """requirement: depth at the axis, whose node a moved mesh has displaced by rounding.

    Without it the only point that was not worn carried all the load.
    """
    before, after = face(off, 2e-3, 81), face(0.0, 5e-3, 101)
    worn = np.maximum(1e-4 - 1e-4 * (before.pairing.points[:, 0] / 1.5e-3) ** 2, 0.0)
    row = _carried(before, after, worn[None])[0]
    assert row[0] == pytest.approx(1e-4, rel=5e-3)
    assert row @ after.weights == pytest.approx(worn @ before.weights, rel=1e-12)
    assert np.all(row[after.pairing.points[:, 0] > 2e-3] == 0.0)
