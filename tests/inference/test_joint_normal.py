"""Normal distribution of parameters in internal coordinates."""

import numpy as np
import pytest

from thermowear.inference import JointNormal, Normal, Parameter, ParameterSpace, latin_hypercube

SPACE = ParameterSpace((
    Parameter("k", 1.0, 1e-3, 1e3, log=True),
    Parameter("b", 1.0, -3.0, 5.0),
    Parameter("c", 2.0, 0.1, 9.0, log=True),
))  # fmt: skip
COVARIANCE = np.array([[0.04, 0.01, 0.0], [0.01, 0.09, -0.02], [0.0, -0.02, 0.01]])
MEAN = np.array([0.5, 0.2, 0.7])


def test_samples_have_mean_and_covariance():
    """requirement: mean and covariance of the internal coordinates, by a Latin hypercube."""
    normal = JointNormal.from_covariance(SPACE, MEAN, COVARIANCE)
    assert normal.covariance == pytest.approx(COVARIANCE, rel=1e-12, abs=1e-15)
    assert normal.cholesky == pytest.approx(np.linalg.cholesky(COVARIANCE), rel=1e-9, abs=1e-12)
    sample = SPACE.internal(latin_hypercube([normal], 20000, seed=1).values)
    assert sample.mean(axis=0) == pytest.approx(MEAN, abs=1e-4)
    assert np.cov(sample.T) == pytest.approx(COVARIANCE, abs=1e-3)


def test_a_singular_covariance_is_sampled():
    """requirement: parameters that depend on each other exactly stay so."""
    line = np.outer([1.0, 2.0, -1.0], [1.0, 2.0, -1.0]) * 0.01
    normal = JointNormal.from_covariance(SPACE, MEAN, line)
    sample = SPACE.internal(latin_hypercube([normal], 50).values) - MEAN
    assert sample[:, 1] == pytest.approx(2 * sample[:, 0], abs=1e-7)
    assert sample[:, 2] == pytest.approx(-sample[:, 0], abs=1e-7)
    assert normal.correlation == pytest.approx(np.array([[1, 1, -1], [1, 1, -1], [-1, -1, 1]]))
    with pytest.raises(ValueError, match="not positive semidefinite"):
        JointNormal.from_covariance(SPACE, MEAN, np.diag([1.0, -1.0, 1.0]))


def test_undetermined_parameters_cannot_be_sampled():
    """requirement: an error with their names, not finite values."""
    normal = JointNormal.from_jacobian(SPACE, MEAN, np.array([[1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]))
    with pytest.raises(ValueError, match="k, c: not determined"):
        normal.ppf(np.full((1, 3), 0.5))


def test_a_weak_prior_beside_sharp_data_counts():
    """requirement: the noise of the derivatives of the data does not hide a prior."""
    prior = Normal(0.0, 2.0)
    space = ParameterSpace((
        Parameter("k", 1.0, 1e-3, 1e3, log=True), Parameter("m", 1.0, 1e-3, 1e3, True, prior)
    ))  # fmt: skip
    jacobian = 1e6 * np.array([[1.0, 1.0], [1.0, 1.0 + 1e-7]])
    normal = JointNormal.from_jacobian(space, np.zeros(2), jacobian)
    assert normal.deviations == pytest.approx([2.0, 2.0], rel=1e-5)
