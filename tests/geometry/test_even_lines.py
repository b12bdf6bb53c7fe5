"""Lines that are divided for quadrilaterals."""

import numpy as np
import pytest

from thermowear.geometry.moving.skeleton import OutlinePiece, even


def straight(sizes, ends=(0, 1), start=(0.0, 0.0), way=(1.0, 0.0)):
    """A line of edges of order 2."""
    at = np.concatenate([[0.0], np.cumsum(sizes)])
    along = at[:-1, None] + np.diff(at)[:, None] * np.array([0.0, 0.5, 1.0])
    return OutlinePiece(
        ends, np.array(start) + along[..., None] * np.array(way), 1, {1: True}, False
    )


def lengths(line):
    return np.linalg.norm(line.edges[:, -1] - line.edges[:, 0], axis=1)


def test_edges_of_one_length_stay_if_they_are_even_in_number():
    line = straight([1.0] * 6)
    (ends,) = even([line])
    assert np.array_equal(ends, np.arange(7.0))
    assert np.array_equal(line.cut(ends).edges, line.edges)


@pytest.mark.parametrize("sizes", [[1.0] * 5, [0.1, 0.3, 1.0, 1.0, 0.3, 0.1], [5.0, 0.2]])
def test_pairs_are_even_and_grow_little(sizes):
    line = straight(sizes)
    found = lengths(line.cut(even([line])[0]))
    assert len(found) % 2 == 0
    assert found.sum() == pytest.approx(sum(sizes), rel=1e-14)
    pairs = found.reshape(-1, 2)
    assert np.all(pairs.max(axis=1) <= 1.6 * pairs.min(axis=1) * (1 + 1e-12))
    sums = pairs.sum(axis=1)
    growth = np.maximum(sums[1:] / sums[:-1], sums[:-1] / sums[1:])
    assert np.all(growth <= 4.0 * (1 + 1e-12))


def test_a_short_edge_round_the_corner_counts():
    lines = [straight([8.0, 8.0]), straight([0.5] * 4, (1, 2), (16.0, 0.0), (0.0, 1.0))]
    found = [lengths(line.cut(ends)) for line, ends in zip(lines, even(lines), strict=True)]
    assert np.array_equal(found[1], lengths(lines[1]))
    assert found[0][-2:].sum() <= 4.0 * found[1][:2].sum()
    assert found[0][:2].sum() > found[0][-2:].sum()


def test_halves_of_a_curved_edge_are_of_the_same_curve():
    x = np.array([0.0, 0.5, 1.0])
    line = OutlinePiece((0, 1), np.column_stack([x, x**2])[None], 1, {1: True}, False)
    halves = line.cut(np.array([0.0, 0.5, 1.0])).edges
    assert halves.shape == (2, 3, 2)
    assert halves[..., 1] == pytest.approx(halves[..., 0] ** 2, abs=1e-15)
    assert np.array_equal(halves[0, 0], line.edges[0, 0])
    assert np.array_equal(halves[1, -1], line.edges[0, -1])
