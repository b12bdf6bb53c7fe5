"""Regions of space by comparisons of lengths."""

import numpy as np
import pytest

from thermowear.case.values.regions import region

POINTS = np.array([[3.0, 4.0, 1.0], [1.0, 0.5, -2.0]])


@pytest.mark.parametrize(
    ("text", "depths"),
    [
        ("x < 2 m", [-1.0, 1.0]),
        ("400 cm < r and r < 10 m", [1.0, np.sqrt(1.25) - 4.0]),
        ("0 m > z > -3 m", [-1.0, 1.0]),
        ("2*x - y >= z", [1.0, 3.5]),
        ("x < sqrt(x*y)", [np.sqrt(12) - 3.0, np.sqrt(0.5) - 1.0]),
    ],
)
def test_depth_in_space(text, depths):
    """
    requirement: the least difference of all comparisons; r is the distance from the z axis.
    """
    assert region(text).depth(POINTS) == pytest.approx(depths, rel=1e-14)


def test_coordinates_of_sections():
    """
    requirement: in axisymmetric models r is x and z is y; in plane ones r² = x² + y² and z = 0.
    """
    points = POINTS[:, :2]
    assert region("1 m < r").depth(points, axisymmetric=True) == pytest.approx([2.0, 0.0])
    assert region("z > 1 m").depth(points, axisymmetric=True) == pytest.approx([3.0, -0.5])
    assert region("r > 1 m").depth(points) == pytest.approx([4.0, np.sqrt(1.25) - 1.0])
    assert region("z < 1 m").depth(points) == pytest.approx([1.0, 1.0])


@pytest.mark.parametrize("text", ["", "and", "x <", "x < 2", "x < 1 s", "x = 1 m", "1 m < 2 m"])
def test_refused(text):
    """
    requirement: faulty regions are refused in one line.
    """
    with pytest.raises(ValueError, match=r"^[^\n]+$"):
        region(text)
