"""Grids of points in cells, at which fields of the bodies are recorded."""

import numpy as np
import pytest

from thermowear.simulation.results.recording import GRIDS


@pytest.mark.parametrize("n", [1, 2, 3, 6])
def test_small_tetrahedra_fill_the_cell(n):
    """requirement: n³ positively oriented parts of the same volume, without unused points."""
    points, pieces = GRIDS["tetrahedron"](n)
    assert len(points) == (n + 1) * (n + 2) * (n + 3) // 6
    assert len(pieces) == n**3
    volumes = np.linalg.det(points[pieces[:, 1:]] - points[pieces[:, :1]]) / 6
    np.testing.assert_allclose(volumes, 1 / 6 / n**3, rtol=1e-12)
    assert np.array_equal(np.unique(pieces), np.arange(len(points)))
