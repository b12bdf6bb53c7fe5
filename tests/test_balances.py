"""Runs that do not keep their balances end as failed, and say so everywhere."""

import json
import math
from dataclasses import replace

import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.balances import ALLOWED, holds, judged, relative, require
from thermowear.output.report import write_report

from .conftest import HOT

COARSE = ("--set", "mesh.degree=6", "--set", "mesh.elements=4")
NEARLY_INCOMPRESSIBLE = "bodies.punch.poisson_ratio=0.49999999999"


def test_the_bound():
    """requirement: limit 1e-6; infinite and NaN errors violate it, missing ones do not."""
    assert holds(ALLOWED)
    assert not any(holds(error) for error in (1.1e-6, -1.1e-6, math.inf, math.nan))
    assert relative(0.0, 0.0) == 0.0
    assert relative(1.0, 0.0) == relative(math.nan, 1.0) == relative(1.0, math.nan) == math.inf
    assert judged({"heat_balance_relative_error": None}) is None
    with pytest.raises(tw.ComputationError, match=r"worn volume .* 2\.0e-06 .*mesh\.elements"):
        require(geometry_volume_error=2e-6, equilibrium_relative_error=1e-9)


def test_a_run_that_is_not_balanced_fails(tmp_path, capsys):
    """requirement: exit 2 with the reason, also in report, console and plot; results readable."""
    folder = tmp_path / "r"
    arguments = ("run", str(HOT), "--set", NEARLY_INCOMPRESSIBLE, *COARSE, "--no-pictures")
    assert main([*arguments, "-o", str(folder)]) == 2
    said = capsys.readouterr()
    assert "error: not balanced: the equilibrium has a relative error of" in said.err
    assert "Poisson ratios farther from 0.5" in said.err
    assert "NOT BALANCED" in said.out
    assert json.loads((folder / "run.json").read_text())["status"] == "failed"
    assert json.loads((folder / "summary.json").read_text())["equilibrium_relative_error"] > ALLOWED
    assert (folder / "interface.csv").is_file()
    page = write_report(folder).read_text(encoding="utf-8")
    assert '<p class="verdict bad">Stopped: not balanced: the equilibrium' in page
    from thermowear.output.pictures import make

    assert any("not balanced: the equilibrium" in note for note in _notes(make, folder))


def _notes(make, folder):
    """Notes of `plot` without drawing bodies."""
    (folder / "fields.vtu").unlink(missing_ok=True)
    return make.make_pictures(folder)


def test_a_sweep_marks_the_variant_and_goes_on(tmp_path, capsys):
    """requirement: the variant is marked as failed, others continue, exit 2."""
    over = "bodies.punch.poisson_ratio=0.49999999999,0.3"
    arguments = ("sweep", str(HOT), "--over", over, *COARSE, "--no-pictures", "--processes", "1")
    assert main([*arguments, "-o", str(tmp_path / "s")]) == 2
    said = capsys.readouterr()
    assert "1 of 2 variants failed" in said.err
    assert "not balanced" in said.err
    assert "done" in said.out


def test_a_step_that_is_not_balanced_is_not_taken(monkeypatch):
    """requirement: a running-in ends at the last step whose heat balances."""
    from thermowear.simulation.heat.heat_steps import StoredHeat

    balance = StoredHeat.balance

    def lossy(self, initial, comm):
        found = balance(self, initial, comm)
        return replace(found, lost=found.lost + 1e-3 * found.made) if found.made > 50.0 else found

    monkeypatch.setattr(StoredHeat, "balance", lossy)
    sets = (
        "mesh.degree=3",
        "mesh.elements=4",
        'analysis={type="transient", end_time="1 s", tolerance=0.1}',
        "heat.transient=true",
        "bodies.punch.density=7800 kg/m^3",
        "bodies.punch.specific_heat=460 J/(kg K)",
    )
    result = tw.run(tw.load(HOT, sets))
    assert isinstance(result.stopped, tw.ComputationError)
    assert "heat balance" in str(result.stopped)
    assert 0.0 < result.history[-1].time < 1.0
    assert max(row.balance_error for row in result.heat) <= ALLOWED
    assert result.heat[-1].time == result.history[-1].time == result.summary["time_s"]
