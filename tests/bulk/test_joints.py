"""Conditions of joints: independent of each other, beside fixed values too."""

from mpi4py import MPI

import numpy as np
import pytest
import scipy.sparse as sp

from thermowear.bulk.joints import Border, Joint, Joints, conditions
from thermowear.bulk.spaces import groups_of

COMM = MPI.COMM_SELF


def border(own, other, resistance=0.0, closed=False):
    """Border of two bodies from the parts of the conditions (m, n) in each of them."""
    count = len(own)
    jump = sp.csr_matrix(np.hstack([-np.array(own), np.array(other)]).T)
    first = sp.csr_matrix(np.hstack([-np.array(own), 0 * np.array(other)]).T)
    return Border(jump, first, resistance * sp.eye(count, format="csr"), np.arange(count), closed)


def line(nodes):
    """Mass matrix of linear functions on a line of equal elements."""
    mass = np.diag(np.full(nodes, 4.0)) + np.diag(np.ones(nodes - 1), 1)
    mass += np.diag(np.ones(nodes - 1), -1)
    mass[0, 0] = mass[-1, -1] = 2.0
    return mass


def test_joints_of_free_bodies_are_kept_as_they_are():
    """requirement: without fixed values all conditions remain."""
    found = conditions(border(line(4), line(4)), np.zeros(8, dtype=bool), COMM)
    assert (found != sp.eye_array(4)).nnz == 0


def test_conditions_beside_fixed_values():
    """requirement: as many conditions as the first body has free values, which sum up to those of
    all, so that uniform multipliers remain.
    """
    fixed = np.zeros(10, dtype=bool)
    fixed[[0, 4, 5, 9]] = True
    found = conditions(border(line(5), line(5) @ np.diag([1, 2, 3, 2, 1])), fixed, COMM)
    assert found.shape == (5, 3)
    assert found.sum(axis=1) == pytest.approx(np.ones(5))
    assert np.linalg.matrix_rank(line(5)[1:-1] @ found) == 3


def test_conditions_on_fixed_values_alone():
    """requirement: where the first body is fixed at the whole joint, the other one is held by all
    conditions; where both are, none is left.
    """
    fixed = np.repeat([True, False], 4)
    assert conditions(border(line(4), line(4)), fixed, COMM).shape == (4, 4)
    assert conditions(border(line(4), line(4)), fixed | True, COMM).shape == (4, 0)


def test_conditions_that_follow_from_others():
    """requirement: of joints in a circle those that the others imply are left out."""
    known = np.vstack([line(4), line(4)[:2] + 3 * line(4)[1:3]]), np.zeros((6, 4))
    free = np.zeros(8, dtype=bool)
    assert conditions(border(*known, closed=True), free, COMM).shape == (6, 4)
    assert conditions(border(*known, 1.0, closed=True), free, COMM).shape == (6, 6)


def test_groups_of_glued_bodies():
    """requirement: bodies glued in a chain are one group, others one each."""
    assert groups_of(5, [(3, 0), (3, 4)]) == ((0, 3, 4), (1,), (2,))
    assert groups_of(2, []) == ((0,), (1,))


@pytest.mark.parametrize(
    ("pairs", "closed"), [([(0, 1), (1, 2)], 0), ([(0, 1), (2, 1), (2, 0)], 1)]
)
def test_joints_in_a_circle(pairs, closed):
    """requirement: circles of joints are known, those of other groups do not count."""
    none = sp.csr_matrix((6, 1))
    pairs = [*pairs, (4, 5)]
    joints = Joints(tuple(Joint(pair, ("", ""), none, none, none[:1]) for pair in pairs))
    assert joints.border((0, 1, 2), slice(None)).closed == closed
    assert not joints.border((4, 5), slice(None)).closed
    assert joints.border((4, 5), slice(None)).columns.tolist() == [len(pairs) - 1]
    assert joints.border(range(6), slice(None)).closed == closed
    assert joints.border((3,), slice(None)).count == 0
