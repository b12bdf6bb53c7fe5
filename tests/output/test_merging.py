"""Coinciding points of the cells of a body merged."""

import numpy as np
import pytest

pyvista = pytest.importorskip("pyvista")

from thermowear.output.pictures.in_space.solids import merged  # noqa: E402


def apart(shift=0.0):
    """Two by one by one cubes whose points are their own, off by `shift` at the common face."""
    one = pyvista.ImageData(dimensions=(2, 2, 2)).cast_to_unstructured_grid()
    other = one.translate((1.0 + shift, 0.0, 0.0))
    for grid, value in ((one, 1.0), (other, 3.0)):
        grid.point_data["stress"] = np.full(grid.n_points, value)
        grid.cell_data["body"] = np.full(grid.n_cells, int(value))
    return one.merge(other, merge_points=False)


@pytest.mark.parametrize("shift", [0.0, 1e-9])
def test_neighbours_share_points(shift):
    """requirement: points of one place are one, also but for rounding, and inner faces vanish."""
    grid = apart(shift)
    assert grid.n_points == 16
    found = merged(grid)
    assert found.n_points == 12
    assert found.volume == pytest.approx(2.0, rel=1e-8)
    assert found.extract_surface().area == pytest.approx(10.0, rel=1e-8)
    assert grid.extract_surface().area == pytest.approx(12.0, rel=1e-8)
    np.testing.assert_array_equal(np.sort(found.cell_data["body"]), [1, 3])


def test_means_of_their_values():
    """requirement: the mean at common points, the own value at others."""
    found = merged(apart())
    at = found.points[:, 0]
    for x, value in ((0.0, 1.0), (1.0, 2.0), (2.0, 3.0)):
        np.testing.assert_allclose(found.point_data["stress"][np.isclose(at, x)], value)


def test_points_apart_remain():
    """requirement: a gap that can be seen is none to be closed."""
    assert merged(apart(1e-3)).n_points == 16
