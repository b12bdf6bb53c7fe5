"""Running-in with bodies that are meshed anew on the way.

Good cells are called slanted at one update, so that the same run without that is a reference.
"""

import json
import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import astuple

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.geometry.mesh.tagged import quality
from thermowear.serialise import pack
from thermowear.simulation import Observer
from thermowear.simulation.from_case import run
from thermowear.simulation.geometry_update import geometry_update
from thermowear.simulation.geometry_update import remesh as meshing_anew
from thermowear.verification.check import run_starter, starter

from .hot_ring import HEAT

COLD = (
    "mesh.degree=6",
    "mesh.elements=4",
    "analysis.tolerance=1e-3",
    'analysis.end_time="3000 s"',
    "analysis.output_times=[]",
    "wear.update=0.01",
)
SMALL = (*HEAT, "mesh.degree=3", "mesh.elements=2", "analysis.end_time=120 s")
RADII = (0.022, 0.03, 0.045, 0.07, 0.09, 0.11, 0.118)


@contextmanager
def slanted(update):
    """Cells are called slanted at an update."""
    calls = 0

    def told(mesh, parts):
        nonlocal calls
        calls += 1
        return 0.15 if calls == update else quality(mesh, parts)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(meshing_anew, "quality", told)
        yield


@pytest.fixture(scope="module")
def cold():
    """A tenth of the height of the ring worn off: as it is, and meshed anew on the way."""
    plain = run_starter("annular-punch-running-in", *COLD)
    with slanted(3):
        return plain, run_starter("annular-punch-running-in", *COLD)


@pytest.fixture(scope="module")
def hot():
    """Temperatures in time."""
    plain = run_starter("annular-punch", *HEAT)
    with slanted(2):
        return plain, run_starter("annular-punch", *HEAT)


def at(result, quantity):
    return np.interp(RADII, result.interface.x, getattr(result.interface, quantity))


def test_no_volume_is_lost(cold):
    """requirement: volumes of mesh and wear to 1e-6, also where the mesh was made anew."""
    plain, anew = (result.summary for result in cold)
    assert plain["geometry_meshed_anew"] == 0
    assert anew["geometry_meshed_anew"] == 1
    assert anew["geometry_smallest_scaled_jacobian"] > 0.1
    assert anew["geometry_volume_error"] < 1e-9
    assert 0.0 < anew["geometry_remeshing_error"] < 1e-3
    volume = anew["wear_volume_1_m3"]
    assert anew["geometry_volume_1_m3"] == pytest.approx(volume, rel=1e-6)
    assert volume == pytest.approx(plain["wear_volume_1_m3"], rel=1e-6)
    interface = cold[1].interface
    assert interface.weight @ interface.wear_1 == pytest.approx(volume, rel=1e-6)
    assert interface.weight @ interface.y == pytest.approx(volume, rel=1e-5)  # the mesh's own face


def test_nothing_jumps_in_the_record(cold):
    """Volumes grow at the rate that the load asks for, across the update, too."""
    for result in cold:
        time, volume = (
            np.array([getattr(row, key) for row in result.history if row.time > 500.0])
            for key in ("time", "wear_volume_1")
        )
        rates = np.diff(volume) / np.diff(time)
        assert rates == pytest.approx(rates[-1], rel=2e-3)
    assert np.all(np.diff([row.sliding_distance for row in cold[1].history]) > 0.0)


def test_it_ends_as_it_would_have_without(cold):
    """requirement: pressure against the closed form p = c / r, depths to 1e-3."""
    plain, anew = cold
    exact = steady(np.array(RADII))
    for result in cold:
        assert at(result, "pressure") == pytest.approx(exact, rel=1e-2)
    assert at(anew, "wear_1") == pytest.approx(at(plain, "wear_1"), rel=1e-3)
    ranges = [result.summary["shape_range_m"] for result in cold]
    assert ranges[1] == pytest.approx(ranges[0], rel=1e-3)


def steady(radii):
    """``p = F / (2 π (b - a) r)`` under 50 MPa in the mean."""
    return 50e6 * (0.12 + 0.02) / 2 / radii


@pytest.mark.slow
def test_temperatures_are_carried_over(hot):
    """requirement: the balance of heat closes at each step, temperatures and heat to 1e-3."""
    plain, anew = hot
    assert anew.summary["geometry_meshed_anew"] == 1
    assert 0.0 < anew.summary["geometry_temperature_error"] < 1e-3
    assert max(row.balance_error for row in anew.heat) < 1e-8
    rise = plain.summary["max_temperature_K"] - 293.15
    for body in (1, 2):
        found, known = (at(result, f"temperature_{body}") for result in (anew, plain))
        assert found == pytest.approx(known, abs=1e-3 * rise)
    for key in ("heat_stored_J", "heat_lost_J"):
        # what goes with the interpolation counts as lost, and is as little as its error
        assert anew.summary[key] == pytest.approx(plain.summary[key], rel=1e-4)
    assert at(anew, "wear_1") == pytest.approx(at(plain, "wear_1"), rel=1e-3)


class _Watched(Observer):
    def __init__(self):
        self.saved = []

    def checkpoint(self, saved):
        worn = saved.progress.own[1][0]  # of the outer loop
        self.saved.append((worn, pack(MPI.COMM_WORLD, saved)))


@pytest.mark.slow
def test_a_run_goes_on_from_a_mesh_made_anew():
    """requirement: bitwise the same."""
    often = "analysis.checkpoint_every=1e-9 s"
    case = starter("annular-punch", *HEAT, often, "analysis.end_time=120 s")
    watched = _Watched()
    with slanted(1):
        whole = run(case, None, watched)
    since = [saved for worn, saved in watched.saved if worn is not None and worn.meshed_anew]
    assert len(since) > 2
    for checkpoint in (since[0], since[len(since) // 2]):
        again = run(case, saved=checkpoint.state(0))
        assert again.summary == whole.summary
        for ours, known in zip(*map(astuple, (again.interface, whole.interface)), strict=True):
            np.testing.assert_array_equal(ours, known)


SCRIPT = """
import json, sys
from tests.simulation.test_meshing_anew import SMALL, slanted
from thermowear.verification.check import run_starter
from mpi4py import MPI
with slanted(1):
    summary = run_starter("annular-punch", *SMALL).summary
if MPI.COMM_WORLD.rank == 0:
    print(json.dumps(summary))
"""


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("mpirun") is None, reason="needs mpirun")
def test_two_ranks_give_the_serial_numbers():
    found = []
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PMIX", "PRTE_"))}
    for start in ([], ["mpirun", "--oversubscribe", "-n", "2"]):
        done = subprocess.run(
            [*start, sys.executable, "-c", SCRIPT],
            capture_output=True,
            text=True,
            check=False,
            env=environment,
            timeout=200,
        )
        assert done.returncode == 0, done.stderr
        found.append(json.loads(done.stdout))
    serial, parallel = found
    assert serial["geometry_meshed_anew"] == parallel["geometry_meshed_anew"] == 1
    for key in ("wear_volume_1_m3", "max_temperature_K", "max_pressure_Pa", "heat_lost_J"):
        assert parallel[key] == pytest.approx(serial[key], rel=1e-8)
    assert parallel["geometry_remeshing_error"] == pytest.approx(
        serial["geometry_remeshing_error"], rel=1e-5
    )


def test_cells_that_no_mesh_mends_stop_the_run(monkeypatch):
    """requirement: never a cell below the floor; what was computed before is kept."""
    monkeypatch.setattr(geometry_update, "FLOOR", 1.5)  # that no cell reaches
    coarse = starter("annular-punch-running-in", *COLD, "mesh.degree=4", "mesh.elements=3")
    result = run(coarse)
    assert "cells of the worn bodies become too slanted" in str(result.stopped)
    worn = result.summary["wear_volume_1_m3"]
    height = 0.05 * np.pi * (0.12**2 - 0.02**2)
    assert 0.009 * height < worn < 0.012 * height  # up to the first update
    assert len(result.history) == result.summary["steps"] + 1 > 10
    assert np.isfinite(result.interface.pressure).all()
