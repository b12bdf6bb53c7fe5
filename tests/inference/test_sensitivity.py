"""Sobol indices and swings."""

import numpy as np
import pytest

from thermowear.inference import (
    JointNormal,
    Normal,
    Parameter,
    ParameterSpace,
    Uniform,
    saltelli,
    sobol_indices,
    swing_points,
    swings,
)
from thermowear.reference.sensitivity_functions import Ishigami, SobolProduct

PI = np.pi


def indices_of(function, inputs, n=4096, **options):
    design = saltelli(inputs, n)
    outputs = function(design.points)
    return sobol_indices(*design.split(outputs), **options)


@pytest.mark.parametrize(
    ("function", "inputs"),
    [(Ishigami(), [Uniform(-PI, PI)] * 3), (SobolProduct(), [Uniform(0.0, 1.0)] * 5)],
    ids=["ishigami", "g-function"],
)
def test_indices_of_known_functions(function, inputs):
    """requirement: first-order and total indices within 0.02, inside their intervals."""
    found = indices_of(function, inputs)
    assert found.first[:, 0] == pytest.approx(function.first, abs=0.02)
    assert found.total[:, 0] == pytest.approx(function.total, abs=0.02)
    for (low, high), exact in (
        (found.first_interval[..., 0], function.first),
        (found.total_interval[..., 0], function.total),
    ):
        assert np.all((low <= exact + 1e-3) & (exact - 1e-3 <= high))
    assert found.dropped.tolist() == [0]


def test_offsets_do_not_spoil_first_order_indices():
    """requirement: a constant of 1e6 added to the output changes nothing."""
    inputs = [Uniform(-PI, PI)] * 3
    plain, moved = (indices_of(lambda x, c=c: Ishigami()(x) + c, inputs, n=256) for c in (0.0, 1e6))
    assert moved.first == pytest.approx(plain.first, abs=1e-7)


def test_many_outputs_and_failed_rows():
    """requirement: failed points drop their rows of that output alone, with their count."""
    design = saltelli([Uniform(0.0, 1.0)] * 2, 1024)
    x = design.points
    outputs = np.stack([x[:, 0] + 2 * x[:, 1], x[:, 0], 0.1 * (1 + 1e-16 * x[:, 0]) + 0.2], axis=1)
    whole = sobol_indices(*design.split(outputs))
    assert whole.first[:, 0] == pytest.approx([0.2, 0.8], abs=0.01)
    assert whole.total[:, 1] == pytest.approx([1.0, 0.0], abs=1e-2)
    assert np.isnan(whole.first[:, 2]).all()
    outputs[[3, 1024 + 3, 2048 + 7], 0] = np.nan
    found = sobol_indices(*design.split(outputs))
    assert found.dropped.tolist() == [2, 0, 0]
    assert found.rows.tolist() == [1022, 1024, 1024]
    kept = np.delete(np.arange(1024), [3, 7])
    a, b, ab = design.split(outputs[:, :1])
    without = sobol_indices(a[kept], b[kept], ab[:, kept])
    assert found.first[:, 0] == pytest.approx(without.first[:, 0], rel=1e-12)
    assert found.total[:, 0] == pytest.approx(without.total[:, 0], rel=1e-12)


def test_intervals_cover():
    """requirement: 90 % intervals hold for most of 40 random designs of plain sampling."""
    rng, g, inside = np.random.default_rng(7), SobolProduct((0.0, 1.0)), []
    for _ in range(40):
        a, b = rng.random((2, 256, 2))
        ab = np.stack([np.where(np.eye(2, dtype=bool)[i], b, a) for i in range(2)])
        found = sobol_indices(g(a)[:, None], g(b)[:, None], g(ab)[..., None], level=0.9)
        low, high = found.total_interval[..., 0]
        inside.append((low <= g.total) & (g.total <= high))
    assert 0.8 <= np.mean(inside) <= 0.98


def test_intervals_are_as_wide_as_their_level_says():
    """requirement: 2·1.645 and 2·0.674 standard errors for 90 and 50 %, of 300 random designs."""
    rng, g = np.random.default_rng(9), SobolProduct((0.0, 1.0))

    def design(n):
        a, b = rng.random((2, n, 2))
        ab = np.stack([np.where(np.eye(2, dtype=bool)[i], b, a) for i in range(2)])
        return g(a)[:, None], g(b)[:, None], g(ab)[..., None]

    found = [sobol_indices(*design(512), resamples=2) for _ in range(300)]
    errors = np.std([[one.first[:, 0], one.total[:, 0]] for one in found], axis=0)
    for level, reach in ((0.9, 1.645), (0.5, 0.674)):
        each = [sobol_indices(*design(512), level=level) for _ in range(10)]
        widths = np.mean(
            [np.diff([o.first_interval, o.total_interval], axis=1) for o in each], axis=0
        )
        assert widths[:, 0, :, 0] == pytest.approx(2 * reach * errors, rel=0.2)


def test_dependent_inputs_count_as_one():
    """requirement: correlated x and y as one input: share of x + y beside an independent z."""
    space = ParameterSpace((Parameter("x", 0.0, -9.0, 9.0), Parameter("y", 0.0, -9.0, 9.0)))
    joint = JointNormal.from_covariance(space, np.zeros(2), np.array([[1.0, 0.5], [0.5, 1.0]]) / 81)
    found = indices_of(lambda v: v.sum(axis=1), [joint, Normal(0.0, 1.0)])
    assert found.first[:, 0] == pytest.approx([0.75, 0.25], abs=0.01)


def test_swings_of_one_input_at_a_time():
    """requirement: a linear function swings by its coefficients times the quantiles."""
    inputs = [Uniform(0.0, 1.0), Normal(2.0, 0.5)]
    points = swing_points(inputs, level=0.8)
    assert points.shape == (5, 2)
    found = swings((3 * points[:, 0] - points[:, 1])[:, None])
    assert found.base == pytest.approx([-0.5])
    assert found.low[:, 0] == pytest.approx([0.3 - 2.0, 1.5 - 2.0 + 0.5 * 1.2815515655446004])
    assert found.widths[:, 0] == pytest.approx([2.4, 1.2815515655446004])
