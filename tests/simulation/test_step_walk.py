"""Files of the program that one accepted step of wear visits."""

import pytest

from ..benchmarks.step_walk import CASES, of_a_step


@pytest.mark.parametrize(
    ("name", "most"),
    [
        ("cold", 10),
        ("hot", 12),
        pytest.param("temperatures in time", 15, marks=pytest.mark.slow),
    ],
)
def test_a_step_of_wear_visits_few_files(name, most):
    """requirement: a reader follows one accepted step through at most 10, 12, and 15 files.

    Without heat, with friction heat, and with temperatures in time.
    """
    visited = of_a_step(*CASES[name])
    assert len({file for file, _ in visited}) <= most
