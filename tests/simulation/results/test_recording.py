"""Worn shapes of steady states and of running-ins."""

import numpy as np

from tests.case.starter import changed, tables
from thermowear import load, run

COARSE = {"mesh.elements": 6, "mesh.degree": 3}


def test_a_running_in_ends_with_the_shape_of_the_steady_state():
    """requirement: both without the motion of the holder, which turns the block by far more."""
    case = changed(tables("pivoted-block"), COARSE)
    until = {"type": "transient", "until": "steady", "tolerance": 1e-2}
    steady = run(load(changed(case, {"analysis": {"type": "steady"}}))).interface.shape
    found = run(load(changed(case, {"analysis": until, "wear.update": "never"}))).interface.shape
    assert np.abs(found - steady).max() < 0.05 * np.ptp(steady)
