"""Warning of a run in Python that stops early."""

import pytest

from tests.simulation.geometry_update.test_outer_loop import STRIP
from thermowear import load, run
from thermowear.errors import CaseNote


def test_a_run_that_stops_early_warns():
    """requirement: its results are returned, and nobody has to look at `stopped` to know."""
    case = load(STRIP, ("analysis.max_steps=1",))
    with pytest.warns(CaseNote, match=r"stopped early.*analysis\.max_steps"):
        result = run(case)
    assert len(result.history) == 2
