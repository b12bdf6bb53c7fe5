"""Functions of place."""

import numpy as np
import pytest

from thermowear.case.values.units import expression
from thermowear.laws.formulas import PLACE, PlaceFunction

POINTS = np.array([[3.0, 4.0, 1.0], [0.0, 2.0, 5.0]])


def test_the_radius_by_model():
    """requirement: r is x of an axisymmetric section, else the distance from the z axis."""
    radius = PlaceFunction(expression("1 Pa * r / (1 m)", "Pa", tuple(PLACE)))
    assert radius.at(POINTS, False).tolist() == [5.0, 2.0]
    assert radius.at(POINTS[:, :2], True).tolist() == [3.0, 0.0]


def test_numbers_and_functions():
    """requirement: the same at all points; a function by the names of its parameters."""
    assert PlaceFunction.of(7.0).at(POINTS, False).tolist() == [7.0, 7.0]
    assert PlaceFunction.of(lambda z, x: z + x).at(POINTS, False).tolist() == [4.0, 5.0]


def test_rounding_below_zero_is_zero():
    """requirement: an expression may vanish at the edge of a face."""
    given = PlaceFunction.of(lambda x: x - 3.0 - 1e-12)
    assert given.at(POINTS[:1] + [[1.0], [0.0]], False).tolist() == [1.0 - 1e-12, 0.0]


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda x: x - 3.0, "-3 at x = 0 m, y = 2 m, z = 5 m, r = 2 m; must be"),
        (lambda x: 1 / x, "inf at x = 0 m"),
        (lambda x: np.where(x > 0, x, np.nan), "nan at x = 0 m"),
    ],
)
def test_faults(function, message):
    """requirement: the first point at which the value is wrong."""
    with pytest.raises(ValueError, match=message):
        PlaceFunction.of(function).at(POINTS, False)


def test_z_in_a_section():
    """requirement: refused, as the axis of an axisymmetric section is y."""
    with pytest.raises(ValueError, match="z is a coordinate of 3d models only"):
        PlaceFunction.of(lambda z: z).at(POINTS[:, :2], True)
