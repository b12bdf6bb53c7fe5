"""Search for a mesh: unknowns against the best mesh of error models with known answers."""

from dataclasses import dataclass, replace
from itertools import product

import pytest

from thermowear.simulation.accuracy.mesh_search import MeshSearch, MeshTrial

LIMIT = 12


@dataclass(frozen=True)
class Size:
    """Degree and number of elements."""

    degree: int = 1
    elements: int = 2


STEPS = {
    "degree": lambda s: replace(s, degree=s.degree + 1) if s.degree < LIMIT else None,
    "elements": lambda s: replace(s, elements=3 * s.elements // 2) if s.elements < 4000 else None,
}
BACK = {
    "degree": lambda s: replace(s, degree=s.degree - 1) if s.degree > 1 else None,
    "elements": lambda s: replace(s, elements=2 * s.elements // 3) if s.elements > 2 else None,
}


def unknowns(size):
    return (size.degree * size.elements) ** 2


def smooth(size):
    """Error of a smooth solution."""
    return 0.3 * (1.0 / size.elements) ** size.degree


def with_an_edge(size):
    """Error of a solution with an edge within an element."""
    return 0.3 / size.elements**1.5 / size.degree


def search(error, accuracy, peak=None, history=False, values=lambda _: 1.0):
    """Search for the mesh of an error model."""

    def evaluate(size):
        mean, largest = error(size), (peak or error)(size)
        estimates = {"pressure": mean, "max_pressure": largest}
        changing = {"max_pressure": (values(size), 1.0)}
        return MeshTrial(size, unknowns(size), history, estimates, changing)

    return MeshSearch(evaluate, STEPS, BACK, accuracy)


@pytest.mark.parametrize("error", [smooth, with_an_edge])
@pytest.mark.parametrize("accuracy", [5e-2, 1e-2, 2e-3, 1e-4])
def test_three_times_the_unknowns_of_the_best_mesh(error, accuracy):
    """requirement: the accuracy is reached with at most three times the least unknowns."""
    found = search(error, accuracy).best(Size())
    every = [Size(*both) for both in product(range(1, LIMIT + 1), range(2, 400))]
    least = min(unknowns(size) for size in every if error(size) <= accuracy)
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


def test_shape_needs_a_margin():
    """requirement: the estimate of the shape is trusted to a factor of 2.5."""

    def evaluate(size):
        estimates = {"pressure": 1e-9, "max_pressure": 1e-9, "shape": smooth(size)}
        return MeshTrial(size, unknowns(size), False, estimates, {"max_pressure": (1.0, 1.0)})

    found = MeshSearch(evaluate, STEPS, BACK, 1e-2).best(Size())
    assert 2.5 * smooth(found.mesh) <= 1e-2


def test_a_history_is_judged_by_what_changes():
    """requirement: estimates of a history count for nothing; its changes between meshes do."""
    made = search(smooth, 1e-2, history=True, values=lambda size: 1.0 + 5.0 * smooth(size))
    found = made.best(Size())
    assert 5.0 * smooth(found.mesh) <= 1e-2
    assert made.error(found) <= 1e-2


def test_a_largest_value_that_does_not_converge():
    """requirement: a singular pressure is judged by its mean, at half the accuracy."""
    made = search(with_an_edge, 1e-2, peak=lambda _: 0.3)
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
    assert made.error(found) == 0.3
    assert len(made.trials) <= 70


def test_a_coarse_mesh_without_a_result():
    """requirement: meshes on which nothing can be computed are passed over."""
    made = search(smooth, 1e-2)
    evaluate = made.evaluate
    made.evaluate = lambda size: evaluate(size) if size.elements >= 4 else None
    assert smooth(made.best(Size()).mesh) <= 1e-2
    made.evaluate, made.trials = (lambda _: None), []
    assert made.best(Size()) is None
