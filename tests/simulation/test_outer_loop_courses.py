"""Moved meshes while load, speed or temperatures change in time, and after a run went on."""

import numpy as np
import pytest

from thermowear.output.tables import write_points
from thermowear.simulation.from_case import run
from thermowear.verification.check import run_starter, starter

from .test_checkpoint import Watched, assert_the_same

RING = ("annular-punch-running-in", "mesh.degree=3", "mesh.elements=4", "analysis.output_times=[]")
FORCE, RATE = 2.2e6, 5e-14 * 10.0  # k ω of the starter case
STORED = (
    "annular-punch",
    "mesh.degree=3",
    "mesh.elements=4",
    'bodies.punch.density="7800 kg/m^3"',
    'bodies.punch.specific_heat="460 J/(kg K)"',
    "heat.transient=true",
    "motion.angular_velocity=1 rad/s",
    "wear.punch.coefficient=2e-5 1/MPa",
    "load.mean_pressure=5 MPa",
    "wear.update=0.002",
    'analysis={type="transient", end_time="200 s", tolerance=1e-3}',
)


@pytest.mark.parametrize(
    ("keys", "share"),
    [
        pytest.param(
            "load={history={time=['0 s', '500 s', '1500 s', '2000 s'],"
            " force=['2.2 MN', '2.2 MN', '1.1 MN', '1.1 MN']}}",
            0.75,
            id="load",
        ),
        pytest.param(
            "load={history={time=['0 s', '1000 s', '1100 s', '1200 s', '1300 s', '2000 s'],"
            " force=['2.2 MN', '2.2 MN', '0 N', '0 N', '2.2 MN', '2.2 MN']}}",
            0.9,
            id="released",
        ),
        pytest.param(
            "motion.history={time=['0 s', '500 s', '1500 s', '2000 s'],"
            " factor=[1.0, 1.0, 0.5, 0.5]}",
            0.75,
            id="speed",
        ),
    ],
)
def test_loads_and_speeds_go_on_where_they_were(keys, share):
    """requirement: Archard's law over the whole course, with updates in the middle of it."""
    courses = "analysis.end_time=2000 s", "analysis.tolerance=1e-3", "wear.update=0.01"
    force = () if keys.startswith("load") else ("load={force='2.2 MN'}",)
    result = run_starter(*RING, *courses, *force, keys)
    summary = result.summary
    assert result.stopped is None
    assert summary["geometry_updates"] >= 3
    assert summary["geometry_volume_error"] < 1e-6
    worn = RATE * FORCE * 0.07 * 2000 * share
    assert summary["wear_volume_1_m3"] == pytest.approx(worn, rel=0.02)
    assert summary["geometry_volume_1_m3"] == pytest.approx(summary["wear_volume_1_m3"], rel=1e-3)


def test_a_shape_that_bodies_begin_with_lasts_through_updates(tmp_path):
    """requirement: what the mesh lacks of the initial shape stays in the gap: no running-in."""
    steady = run_starter(*RING, "analysis={type='steady'}")
    file = tmp_path / "profile.csv"
    write_points(file, steady.profile)
    shaped = f"geometry.initial_shape={str(file)!r}"
    keys = "analysis.end_time=1000 s", "analysis.output_times=['400 s', '700 s']"
    worn = run_starter(*RING, *keys, shaped, "wear.update=0.005")
    assert worn.summary["geometry_updates"] >= 4
    assert worn.summary["geometry_change"] < 0.01  # without it a third, for a step
    known = 50e6 * 0.07
    for i in (*worn.outputs.values(), worn.interface):
        inner = (i.x > 0.022) & (i.x < 0.118)
        assert (i.pressure * i.x)[inner] == pytest.approx(np.full(inner.sum(), known), rel=0.05)
    assert max(row.max_pressure for row in worn.history) < 1.05 * steady.interface.pressure.max()


def test_temperatures_in_time_do_not_see_that_meshes_move():
    """requirement: nothing lost, and no dependence on the size of the updates above 0.5 %."""
    found = [run_starter(*STORED, f"wear.update={size}") for size in ('"never"', 0.004, 0.002)]
    kept, coarse, fine = (result.summary for result in found)
    assert "geometry_updates" not in kept
    assert fine["geometry_updates"] > coarse["geometry_updates"] >= 1
    assert fine["geometry_temperature_error"] < 1e-4
    assert 1e-3 < fine["geometry_change"] < 0.7 * coarse["geometry_change"] < 0.02
    rises = [s["max_temperature_K"] - 293.15 for s in (kept, coarse, fine)]
    assert rises[1:] == pytest.approx([rises[0], rises[0]], rel=5e-3)
    assert fine["heat_in_J"] == pytest.approx(kept["heat_in_J"], rel=1e-3)
    assert fine["wear_volume_1_m3"] == pytest.approx(kept["wear_volume_1_m3"], rel=1e-3)
    assert all(row.balance_error < 1e-8 for row in found[2].heat)


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(
            (
                *RING,
                "analysis.end_time=700 s",
                "wear.update=0.004",
                'wear.plate.coefficient="1e-7 1/MPa"',
            ),
            id="both",
        ),
        pytest.param(STORED, id="heat-in-time", marks=pytest.mark.slow),
    ],
)
def test_a_run_goes_on_after_an_update(case):
    """requirement: from checkpoints before, between and after updates, the same to the last bit."""
    case, watched = starter(*case, "analysis.checkpoint_every=1e-9 s"), Watched()
    whole = run(case, None, watched)
    assert whole.summary["geometry_updates"] >= 2
    last = len(watched.checkpoints) - 1
    for number in sorted({last // 3, 2 * last // 3, last - 1}):
        saved = watched.checkpoints[number].state(rank=0)
        assert_the_same(whole, run(case, None, Watched(), None, saved))
