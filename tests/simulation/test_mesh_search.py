"""Search for a mesh: unknowns against the best mesh of error models with known answers."""

import math
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import pytest

from thermowear.simulation.accuracy.mesh_search import MeshSearch, MeshTrial, Number, WornHeights

LIMIT = 12


@dataclass(frozen=True)
class Size:
    """Degree and number of elements."""

    degree: int = 1
    elements: int = 2


def higher(size):
    return replace(size, degree=size.degree + 1) if size.degree < LIMIT else None


def more(size):
    return replace(size, elements=3 * size.elements // 2) if size.elements < 4000 else None


def finer(size):
    """Mesh of the next degree with more elements."""
    return replace(size, degree=size.degree + 1, elements=3 * size.elements // 2)


STEPS = {"degree": higher, "elements": more}
BACK = {
    "degree": lambda s: replace(s, degree=s.degree - 1) if s.degree > 1 else None,
    "elements": lambda s: replace(s, elements=2 * s.elements // 3) if s.elements > 2 else None,
}


EVERY = [Size(*both) for both in product(range(1, LIMIT + 1), range(2, 400))]


def unknowns(size):
    return (size.degree * size.elements) ** 2


def smooth(size):
    """Error of a smooth solution."""
    return 0.3 * (1.0 / size.elements) ** size.degree


def with_an_edge(size):
    """Error of a solution with an edge within an element."""
    return 0.3 / size.elements**1.5 / size.degree


def search(error, accuracy, peak=None, estimate=None, checked=finer, history=False):
    """Search for the mesh of a true error, of the pressure in the mean unless a peak is given.

    Its estimates are the true errors unless an estimate is given.
    """

    def evaluate(size):
        mean, largest = (estimate or error)(size), (peak or estimate or error)(size)
        estimates = {"pressure": mean} | ({} if history else {"max_pressure": largest})
        values = {"max_pressure": Number(1.0 + (peak or error)(size), 1.0)}
        return MeshTrial(size, unknowns(size), estimates, values)

    return MeshSearch(evaluate, STEPS, BACK, checked, accuracy)


@pytest.mark.parametrize("error", [smooth, with_an_edge])
@pytest.mark.parametrize("accuracy", [5e-2, 1e-2, 2e-3, 1e-4])
def test_three_times_the_unknowns_of_the_best_mesh(error, accuracy):
    """requirement: the accuracy is reached with at most three times the least unknowns."""
    found = search(error, accuracy).best(Size())
    least = min(unknowns(size) for size in EVERY if error(size) <= accuracy)
    assert error(found.mesh) <= accuracy
    assert found.unknowns <= 3 * least


def test_each_mesh_is_computed_once():
    """requirement: no mesh is computed twice, and few are."""
    made = search(smooth, 1e-4)
    seen = []
    evaluate = made.evaluate
    made.evaluate = lambda size: seen.append(size) or evaluate(size)
    made.best(Size())
    assert len(seen) == len(set(seen)) <= 24


@pytest.mark.parametrize("share", [0.2, 1.0, 5.0])
def test_estimates_only_steer(share):
    """requirement: the error is that of the values, whatever part of it the estimate finds."""
    made = search(smooth, 1e-3, estimate=lambda size: share * smooth(size))
    found = made.best(Size())
    assert smooth(found.mesh) <= 1e-3
    assert smooth(found.mesh) <= made.error(found) <= 1e-3
    least = min(unknowns(size) for size in EVERY if smooth(size) <= 1e-3)
    assert found.unknowns <= 3 * least


def test_a_noisy_estimate():
    """requirement: a mesh with four times the unknowns is compared where no estimate halves."""
    noisy = {"estimate": lambda size: 0.02 + with_an_edge(size), "history": True}
    made = search(with_an_edge, 1e-2, **noisy)
    found = made.best(Size())
    assert with_an_edge(found.mesh) <= 1e-2
    assert made.error(found) <= 1e-2
    assert max(trial.unknowns for trial in made.trials) <= 16 * found.unknowns


def test_without_a_finer_mesh():
    """requirement: where nothing finer can be compared, the estimate counts five times."""
    made = search(smooth, 1e-3, checked=lambda _: None)
    only = made._try(Size(4, 4))
    assert made.error(only) == pytest.approx(5 * smooth(Size(4, 4)))


def test_a_largest_value_by_chance():
    """requirement: an accurate largest value of a pressure that is not accurate does not count."""

    def lucky(size):
        return 0.0 if size == Size(1, 3) else smooth(size)

    made = search(smooth, 1e-3, peak=lucky)
    assert smooth(made.best(Size(1, 3)).mesh) <= 1e-2


def test_a_largest_value_that_does_not_converge():
    """requirement: a singular pressure is judged by its mean, at half the accuracy."""

    def growing(size):
        return 0.1 * math.log(unknowns(size))

    made = search(with_an_edge, 1e-2, peak=growing)
    found = made.best(Size())
    assert made.singular(found)
    assert with_an_edge(found.mesh) <= 5e-3


def test_where_no_single_step_helps():
    """requirement: the search goes on where degree and elements reduce the error only together."""
    found = search(lambda s: 0.3 / min(s.degree, s.elements / 2) ** 2, 1e-2).best(Size())
    assert found is not None
    assert found.mesh.degree >= 6
    assert found.mesh.elements >= 12


def test_an_accuracy_out_of_reach():
    """requirement: the search ends, with the finest mesh that was reached."""
    made = search(lambda _: 0.3, 1e-2)
    found = made.best(Size())
    assert made.error(found) > 1e-2
    assert len(made.trials) <= 70


def test_a_coarse_mesh_without_a_result():
    """requirement: meshes on which nothing can be computed are passed over."""
    made = search(smooth, 1e-2)
    evaluate = made.evaluate
    made.evaluate = lambda size: evaluate(size) if size.elements >= 4 else None
    assert smooth(made.best(Size()).mesh) <= 1e-2
    made.evaluate, made.trials = (lambda _: None), []
    assert made.best(Size()) is None


def test_profiles_differ_except_for_their_mean():
    """requirement: heights on different points are compared by contact, relative to the range."""

    def profile(points, height, pressing=1.0):
        both = np.concatenate([points, points])  # two contacts
        heights = np.concatenate([height(points), 3.0 + 2.0 * height(points)])
        return WornHeights(both, heights, np.full(len(both), pressing))

    coarse, fine = np.linspace(0.1, 0.9, 7), np.linspace(0.0, 1.0, 101)
    exact = profile(fine, np.sin)
    assert profile(coarse, lambda x: 5.0 + np.sin(x)).change(exact) < 1e-4
    off = profile(coarse, lambda x: np.sin(x) + 0.01 * (x > 0.5)).change(exact)
    assert off == pytest.approx(2 * 0.01 * 4 / 7 / np.ptp(exact.height), rel=1e-3)
    assert profile(coarse, np.cos, pressing=0.0).change(exact) == 0.0
