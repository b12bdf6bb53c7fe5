"""Samples of uncertain inputs."""

import numpy as np
import pytest

from thermowear.inference import (
    JointNormal,
    LogUniform,
    Normal,
    Parameter,
    ParameterSpace,
    Uniform,
    latin_hypercube,
    saltelli,
    sobol_sequence,
)

SPACE = ParameterSpace((Parameter("x", 0.0, -9.0, 9.0), Parameter("y", 1.0, 0.1, 9.0, log=True)))
JOINT = JointNormal.from_covariance(SPACE, np.zeros(2), np.diag([0.1, 0.2]))
INPUTS = [Uniform(0.0, 1.0), JOINT, LogUniform(1.0, 10.0)]


def test_latin_hypercube_has_a_point_in_each_stratum():
    """requirement: one point in each of n intervals of equal probability of every input."""
    sample = latin_hypercube(
        [Uniform(2.0, 4.0), Normal(0.0, 1.0), LogUniform(1.0, 10.0)], 37, seed=4
    )
    quantiles = [
        (sample.values[:, 0] - 2) / 2,
        Normal(0.0, 1.0).scipy.cdf(sample.values[:, 1]),
        np.log10(sample.values[:, 2]),
    ]
    for column in quantiles:
        assert sorted(np.floor(37 * column).astype(int)) == list(range(37))
    assert sample.note == ""


def test_sobol_sequence_says_its_rounding():
    """requirement: the next power of two, said; no note for a power of two."""
    sample = sobol_sequence(INPUTS, 100)
    assert sample.values.shape == (128, 4)
    assert sample.note.startswith("100 points rounded up to 128")
    assert sobol_sequence(INPUTS, 64).note == ""
    assert np.isfinite(sample.values).all()


def test_sobol_integrates_better_than_chance():
    """requirement: mean of a product within 1e-4 (chance: 5e-3 at 4096 points)."""
    x = sobol_sequence([Uniform(0.0, 1.0)] * 3, 4096).values
    assert np.prod(12 * (x - 0.5) ** 2, axis=1).mean() == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize("way", [latin_hypercube, sobol_sequence])
def test_samples_are_repeatable(way):
    """requirement: the same sample for the same seed, another for another."""
    first, again, other = (way(INPUTS, 16, seed=seed).values for seed in (5, 5, 6))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_saltelli_exchanges_the_columns_of_one_input():
    """requirement: AB_i is A but for input i, all columns of a joint one; A and B differ."""
    design = saltelli(INPUTS, 30)
    assert design.a.shape == design.b.shape == (32, 4)
    assert design.ab.shape == (3, 32, 4)
    for mixed, columns in zip(design.ab, ([0], [1, 2], [3]), strict=True):
        rest = [i for i in range(4) if i not in columns]
        assert np.array_equal(mixed[:, columns], design.b[:, columns])
        assert np.array_equal(mixed[:, rest], design.a[:, rest])
    assert abs(np.corrcoef(design.a[:, 0], design.b[:, 0])[0, 1]) < 0.3
    a, b, ab = design.split(design.points)
    assert np.array_equal(a, design.a)
    assert np.array_equal(b, design.b)
    assert np.array_equal(ab, design.ab)


def test_without_inputs():
    """requirement: an error that says so."""
    with pytest.raises(ValueError, match="at least one"):
        latin_hypercube([], 3)
