"""Iterative solution of heat that a disk in space carries round."""

import numpy as np
import pytest

from thermowear.bulk.heat.paths import PathSolver
from thermowear.bulk.solvers.multigrid import MultigridSolver

from ..conftest import DEMOS
from ..slow import marked_slow
from ..test_parallel import pytestmark as needs_mpirun
from ..test_parallel import summaries
from .turning_disk import turning, turning_case

ITERATIVE = {"mesh.solver": "multigrid"}


@pytest.mark.parametrize("turned", marked_slow([1, -1], -1))
@pytest.mark.parametrize("peclet", [1e3, 1e5])
def test_iterations_do_not_depend_on_the_speed(peclet, turned, monkeypatch):
    """requirement: temperatures of a factor, in as few iterations in both senses at any speed."""
    solved = []
    original = MultigridSolver._solved

    def counted(self, load):
        found = original(self, load)
        solved.append((type(self), self.iterations[-1]))
        return found

    monkeypatch.setattr(MultigridSolver, "_solved", counted)
    speed = turning_case(peclet, 4)["motion"]["angular_velocity"]
    motion = {"motion": {"angular_velocity": speed if turned > 0 else f"-{speed}"}}
    found, direct = turning(peclet, 4, **ITERATIVE, **motion), turning(peclet, 4, **motion)
    heat = [count for kind, count in solved if kind is PathSolver]
    assert 0 < max(heat) <= 30
    rise = direct.interface.temperature_2 - 293.15
    np.testing.assert_allclose(found.interface.temperature_2 - 293.15, rise, atol=1e-7 * rise.max())
    assert found.summary["heat_balance_relative_error"] < 1e-9


@needs_mpirun
@pytest.mark.slow
def test_two_ranks(tmp_path):
    """requirement: the temperatures of one rank to 1e-7 of their rise."""
    overrides = "mesh.solver=multigrid", "mesh.elements=4"
    (serial, _), (parallel, _) = summaries(tmp_path, DEMOS / "disk_brake_3d.toml", *overrides)
    for key in ("max_temperature_K", "shape_range_m", "heat_cooled_W"):
        assert parallel[key] == pytest.approx(serial[key], rel=1e-7, abs=0.0)
    assert parallel["heat_balance_relative_error"] < 1e-9
