"""Signorini's conditions under given loads."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermowear import ComputationError
from thermowear.contact.solvers.lemke import lemke
from thermowear.contact.solvers.signorini import (
    NoEquilibrium,
    SignoriniSolution,
    _pressing,
    _pressing_by_lemke,
    _Problem,
    _verified,
    _with_active,
    active_set,
    solve_contact,
)

from ..conftest import examples


def random_problem(seed, n, skew=0.0):
    """A compliance like an elastic one, a rough gap, one or two rigid directions."""
    rng = np.random.default_rng(seed)
    x = np.sort(rng.uniform(-1, 1, n))
    compliance = -np.log(np.abs(np.subtract.outer(x, x)) + 0.02) + np.log(3.0)
    noise = rng.normal(size=(n, n))
    compliance = compliance + 0.05 * np.eye(n) + skew * (noise - noise.T)
    gap = rng.normal(size=n) * rng.choice([0.0, 1e-3, 1.0]) + rng.choice([0.0, 5.0]) * x**2
    k = rng.integers(1, 3)
    modes = np.column_stack([np.ones(n), x])[:, :k]
    pressure = rng.uniform(0.1, 1, n)
    return compliance, gap, modes, modes.T @ pressure


def violations(problem, solution):
    compliance, gap, modes, load = problem
    λ = solution.coefficients
    r = compliance @ λ + gap - modes @ solution.motion
    scale = np.abs(compliance @ λ).max() + np.abs(gap).max()
    return max(
        -λ.min() / λ.max(),
        -r.min() / scale,
        np.abs(λ * r).max() / (λ.max() * scale),
        np.abs(modes.T @ λ - load).max() / np.abs(load).max(),
    )


@settings(max_examples=examples(200), deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(3, 40), skew=st.sampled_from([0.0, 0.01]))
def test_every_solution_satisfies_the_conditions(seed, n, skew):
    """requirement: no penetration, no tension, equilibrium, from any start."""
    problem = random_problem(seed, n, skew)
    start = np.random.default_rng(seed).random(n) < 0.5
    solution = solve_contact(*problem, start=start)
    assert violations(problem, solution) < 1e-8


@settings(max_examples=examples(200), deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(3, 40), far=st.sampled_from([0.0, 50.0]))
def test_a_given_approach_needs_no_modes(seed, n, far):
    """requirement: under displacement control, from any start; from far nothing touches."""
    compliance, gap, modes, _ = random_problem(seed, n)
    problem = compliance, gap + far, modes[:, :0], np.zeros(0)
    start = np.random.default_rng(seed).random(n) < 0.5
    λ = solve_contact(*problem, start=start).coefficients
    r = compliance @ λ + gap + far
    scale = np.abs(compliance @ λ).max() + np.abs(gap + far).max()
    assert λ.min() >= 0
    assert r.min() >= -1e-8 * scale
    assert np.abs(λ * r).max() <= 1e-8 * scale * max(λ.max(), 1.0)
    assert not far or not λ.any()


@settings(max_examples=examples(200), deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(3, 40))
def test_friction_in_the_section_enters_equilibrium(seed, n):
    """requirement: with forces that work on other modes than those that close the gap."""
    compliance, gap, modes, _ = random_problem(seed, n, 0.01)
    rng = np.random.default_rng(seed)
    forces = modes + 0.1 * rng.uniform(size=modes.shape)
    load = forces.T @ rng.uniform(0.1, 1, n)
    solution = solve_contact(compliance, gap, modes, load, force_modes=forces)
    r = compliance @ solution.coefficients + gap - modes @ solution.motion
    scale = np.abs(compliance @ solution.coefficients).max() + np.abs(gap).max()
    assert solution.coefficients.min() >= 0
    assert r.min() > -1e-8 * scale
    assert np.abs(solution.coefficients * r).max() < 1e-8 * scale * solution.coefficients.max()
    assert forces.T @ solution.coefficients == pytest.approx(load, rel=1e-8, abs=1e-8)


@settings(max_examples=examples(50), deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(3, 30))
def test_lemke_agrees_with_the_active_set(seed, n):
    """requirement: the fallback finds the same contact."""
    problem = random_problem(seed, n)
    solution = solve_contact(*problem)
    active = _pressing_by_lemke(_Problem(*problem, problem[2]))
    pressing = solution.coefficients > 1e-9 * solution.coefficients.max()
    assert np.array_equal(active, pressing)


@pytest.mark.parametrize("wrong", ["tension", "penetration", "open but pressing", "imbalance"])
def test_every_wrong_pressure_is_caught(wrong):
    """requirement: the check after convergence sees each kind of violation."""
    compliance, gap = np.eye(3), np.zeros(3)
    modes, load = np.ones((3, 1)), np.array([3.0])
    λ, d = np.ones(3), 1.0
    if wrong == "tension":
        λ, gap = np.array([-1e-6, 1.5, 1.5 + 1e-6]), np.array([1 + 1e-6, -0.5, -0.5 - 1e-6])
    elif wrong == "penetration":
        λ, gap = np.array([0.0, 1.5, 1.5]), np.array([1 - 1e-6, -0.5, -0.5])
    elif wrong == "open but pressing":
        gap = np.array([1e-6, 0.0, 0.0])
    else:
        load = load * (1 + 1e-6)
    solution = SignoriniSolution(λ, np.array([d]), λ != 0)
    with pytest.raises(ComputationError):
        _verified(_Problem(compliance, gap, modes, load, modes), solution)
    right = SignoriniSolution(np.ones(3), np.array([1.0]), np.ones(3, dtype=bool))
    problem = _Problem(compliance, np.zeros(3), modes, np.array([3.0]), modes)
    assert _verified(problem, right) is not None


def test_nearly_parallel_modes_from_a_start_that_cannot_carry():
    """requirement: a start with fewer points than rigid directions, a pivot far away."""
    x = np.array([0.94112293, 0.95127171, 0.96622326])
    compliance = np.array(
        [[5.06063529, 4.57670915, 4.1971277], [4.62373695, 5.06063529, 4.46767739]]
        + [[4.19782828, 4.43713219, 5.06063529]]
    )
    gap = np.array([4.42751831, 4.52462457, 4.66845079])
    modes = np.column_stack([np.ones(3), x])
    problem = (compliance, gap, modes, np.array([1.60942561, 1.53844958]))
    for active in (0, 0, 1), (0, 0, 0), (1, 0, 0):
        solution = solve_contact(*problem, start=np.array(active, dtype=bool))
        assert violations(problem, solution) < 1e-8
        assert solution.coefficients == pytest.approx([0.53504581, 0.21302487, 0.86135493])
    assert _pressing_by_lemke(_Problem(*problem, problem[2])).all()


@settings(max_examples=examples(100), deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(1, 25))
def test_lemke_on_positive_definite_problems(seed, n):
    """requirement: always ends, with w, z >= 0 and z·w = 0, degenerate ones included."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(n, n))
    matrix = root @ root.T + 0.1 * np.eye(n)
    right = rng.integers(-2, 3, n).astype(float)
    z = lemke(matrix, right)
    w = matrix @ z + right
    assert z.min() >= -1e-9
    assert w.min() >= -1e-8
    assert abs(z @ w) <= 1e-7


def test_load_that_no_pressure_carries():
    """requirement: a moment beyond the edge is reported, never a wrong pressure."""
    x = np.linspace(-1, 1, 11)
    compliance = np.eye(11) + 0.1
    modes = np.column_stack([np.ones(11), x])
    with pytest.raises(ComputationError):
        solve_contact(compliance, np.zeros(11), modes, np.array([1.0, 1.5]))


def test_indefinite_compliance_is_reported():
    """requirement: beyond the instability the solver says so instead of returning."""
    with pytest.raises(NoEquilibrium):
        solve_contact(-np.eye(6) - 0.2, np.linspace(0, 1, 6), np.ones((6, 1)), np.ones(1))


@pytest.mark.parametrize("seed", range(50))
def test_lemke_with_friction_in_the_section(seed):
    """requirement: the fallback finds the same contact where forces work on other modes."""
    compliance, gap, modes, _ = random_problem(seed, 3 + seed % 28, 0.01)
    rng = np.random.default_rng(seed)
    forces = modes + 0.1 * rng.uniform(size=modes.shape)
    load = forces.T @ rng.uniform(0.1, 1, len(gap))
    solution = solve_contact(compliance, gap, modes, load, force_modes=forces)
    active = _pressing_by_lemke(_Problem(compliance, gap, modes, load, forces))
    pressing = solution.coefficients > 1e-9 * solution.coefficients.max()
    assert np.array_equal(active, pressing)


@pytest.mark.parametrize("first", range(8))
def test_active_sets_that_return_do_not_end_the_search(first):
    """requirement: the solution of a P-matrix on which Newton's method cycles.

    I. Ben Gharbia and J.C. Gilbert, Math. Program. 134 (2012) 349: 1 on the diagonal, a > 1 beside
    it, cyclic; each of three equal coefficients is then 1 / (1 + a).
    """
    matrix, empty = np.eye(3) + 2.0 * np.eye(3)[[2, 0, 1]], np.zeros((3, 0))
    problem = _Problem(matrix, -np.ones(3), empty, np.zeros(0), empty)
    start = np.array([first & 1, first & 2, first & 4]) > 0
    found = active_set(start, partial(_with_active, problem), partial(_pressing, problem), True)
    assert found is not None
    assert found.coefficients == pytest.approx(np.full(3, 1 / 3))


@pytest.mark.parametrize("arm", [0.0, 1e-17, -1e-17])
def test_a_pad_that_touches_right_below_its_pivot(arm):
    """requirement: one function carries all, up to the rounding of its arm; the least tilt."""
    modes = np.array([[1.0, -1.0], [2.0, arm], [1.0, 1.0]])
    compliance, gap = 1e-3 * np.eye(3), np.array([3.0, 0.0, 3.0])
    found = solve_contact(compliance, gap, modes, np.array([10.0, 0.0]))
    assert found.coefficients == pytest.approx([0.0, 5.0, 0.0], rel=1e-12, abs=1e-12)
    assert found.motion == pytest.approx([2.5e-3, 0.0], rel=1e-12, abs=1e-12)
    # a load beside it tilts the pad until it touches once more
    found = solve_contact(compliance, gap, modes, np.array([10.0, 1.0]))
    assert found.coefficients == pytest.approx([0.0, 4.5, 1.0], rel=1e-9)
