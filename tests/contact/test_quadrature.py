"""Gauss-Lobatto rules."""

import numpy as np
import pytest

from thermowear.lagrange import lobatto


@pytest.mark.parametrize("n", range(2, 14))
def test_exact_to_its_degree_and_no_further(n):
    """requirement: exact to degree 2n - 3, both ends among the points."""
    x, w = lobatto(n)
    assert (x[0], x[-1]) == (0.0, 1.0)
    degrees = np.arange(2 * n - 2)
    np.testing.assert_allclose(w @ x[:, None] ** degrees, 1 / (degrees + 1), rtol=1e-13)
    assert abs(w @ (2 * x - 1) ** (2 * n - 2) - 1 / (2 * n - 1)) > 1e-9


def test_one_point_is_refused():
    with pytest.raises(ValueError, match="two points"):
        lobatto(1)
