"""Regions of pairs of calibrated parameters."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

from thermowear.inference import JointNormal, Parameter, ParameterSpace
from thermowear.output.calibration.pictures import _draw_pair, _Parameter

COVARIANCE = np.array([[0.04, 0.012], [0.012, 0.01]])


def test_regions_contain_their_part_of_a_sample():
    """requirement: 95 % and 68 % of the joint normal distribution, in values of the parameters."""
    space = ParameterSpace((
        Parameter("k", 2.0, 0.1, 9.0, log=True), Parameter("b", 1.0, -3.0, 5.0)
    ))  # fmt: skip
    mean = np.array([np.log(2.0), 0.3])
    shown = [
        _Parameter(
            one.name, {"unit": "", "scale": scale, "internal_scale": one.scale, "internal": z}
        )
        for one, scale, z in zip(space.parameters, ("log", "linear"), mean, strict=True)
    ]
    figure, axis = plt.subplots()
    _draw_pair(axis, *shown, COVARIANCE, None)
    quantiles = np.random.default_rng(3).random((40000, 2))
    sample = JointNormal.from_covariance(space, mean, COVARIANCE).ppf(quantiles)
    parts = [region.get_path().contains_points(sample).mean() for region in axis.patches]
    plt.close(figure)
    assert parts == pytest.approx([0.95, 0.68], abs=0.01)
