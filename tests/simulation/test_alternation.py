"""Contact areas that alternate from step to step are told from those that change."""

import numpy as np
import pytest

from thermowear.app.cli import main
from thermowear.simulation import time_loop
from thermowear.simulation.analyses import transient
from thermowear.simulation.time_loop import STEPS, alternates


@pytest.mark.parametrize("period", [2, 4, 6])
def test_two_contact_sets(period):
    """requirement: chatter between two sets is told after a hundred steps, not of earlier ones."""
    areas = np.where(np.arange(STEPS) % period < period // 2, 4.2e-4, 4.6e-4)
    assert alternates(areas)
    assert not alternates([*areas, *np.linspace(4.0e-4, 3.0e-4, STEPS)])


@pytest.mark.parametrize(
    "areas",
    [
        np.linspace(1.0, 0.2, 500),
        np.ones(500),
        np.repeat([1.0, 0.8, 0.9, 0.7, 0.8], 100),
        np.cos(np.arange(500) / 10),
    ],
    ids=["shrinking", "constant", "with a few turns", "slowly varying"],
)
def test_changes(areas):
    """requirement: neither shrinking contact nor periodic loading is told."""
    assert not any(alternates(areas[:end]) for end in range(1, 501))


@pytest.mark.parametrize("turns", [0, 10**6])
def test_a_run_tells_of_it(turns, monkeypatch, tmp_path, capsys):
    """requirement: a running-in with stored heat tells once that its contact area alternates."""
    monkeypatch.setattr(time_loop, "_TURNS", turns)
    monkeypatch.setattr(transient, "STEPS", 5)
    command = ["run", "disk-brake-stop.toml", "-o", "r", "--no-pictures"]
    small = ("mesh.degree=2", 'analysis.end_time="0.1 s"', "analysis.output_times=[]")
    monkeypatch.chdir(tmp_path)
    assert main(["init", "disk-brake-stop"]) == 0
    assert main([*command, *(f"--set={change}" for change in small)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert said.count(" ".join(time_loop.ALTERNATES.split())[:60]) == (turns == 0)
