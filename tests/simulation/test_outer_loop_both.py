"""Running-in in which both bodies wear and the meshes of both are moved."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.geometry.reading.export import write_mesh
from thermowear.simulation.from_case import run
from thermowear.verification.check import run_starter

from ..conftest import two_blocks
from .cylinders import case_tables

RING = "annular-punch-running-in", "analysis.tolerance=1e-3", "analysis.output_times=[]"
SOFTER = 'wear.plate.coefficient="1e-7 1/MPa"'  # half that of the ring
RADIUS = 0.5
STRIP = (
    "punch-on-strip",
    "mesh.degree=3",
    "mesh.elements=6",
    'analysis={type="transient", end_time="2e4 s", tolerance=1e-3}',
    'motion.velocity="-1 m/s"',
)


@pytest.fixture(scope="module")
def groove():
    """A ring that wears itself and the plate, deeper than the elements at its edge are wide."""
    return run_starter(*RING, "analysis.end_time=1500 s", SOFTER, "wear.update=0.02")


def test_volumes_go_with_the_coefficients(groove):
    """requirement: Archard's law for each body, by the wear and by the meshes themselves."""
    summary, i = groove.summary, groove.interface
    assert groove.stopped is None
    assert summary["geometry_change"] < 0.02
    assert summary["geometry_updates"] >= 2
    assert summary["geometry_volume_error"] < 1e-6
    ring, plate = summary["wear_volume_1_m3"], summary["wear_volume_2_m3"]
    assert ring == pytest.approx(2 * plate, rel=1e-6)
    assert ring == pytest.approx(i.weight @ i.wear_1, rel=1e-6)
    assert summary["geometry_volume_1_m3"] == pytest.approx(ring, rel=1e-4)
    # where the plate goes on beside the ring, the walls of its groove stay in the gap
    assert 0.8 * plate < summary["geometry_volume_2_m3"] < plate


def test_a_ring_in_a_groove_presses_like_a_new_one(groove):
    """requirement: the steady pressure goes with 1 / r (Páczelt and Mróz), whatever the groove."""
    i = groove.interface
    assert i.wear_2.max() > 2 * 0.395e-3  # the outermost element of the face
    assert i.x[[0, -1]] == pytest.approx([0.02, 0.12])
    assert i.pressure * i.x == pytest.approx(50e6 * 0.07, rel=2e-3)


@pytest.fixture(scope="module")
def lenses(tmp_path_factory):
    """Two equal bodies of a user's mesh, round where they are pressed together."""
    mesh = two_blocks(
        inner=-0.01, outer=0.01, heights=(0.02, 0.02), columns=(24, 24), rows=(6, 6), order=2
    )
    x, y = mesh.points.T
    upper = np.isin(np.arange(len(y)), mesh.cells[mesh.cell_tags == 1])
    apart = np.where(upper, 1.0, -1.0) * (1 - np.abs(y) / 0.02) * x**2 / (2 * RADIUS)
    path = tmp_path_factory.mktemp("lenses") / "lenses.msh"
    write_mesh(replace(mesh, points=np.column_stack([x, y + apart])), path)
    wear = {"coefficient": "1e-6 1/MPa", "per": "pressure"}
    changes = {
        "motion": {"velocity": "0.1 m/s"},
        "wear": {"update": 0.002, "upper": wear, "lower": wear},
        "analysis": {"type": "transient", "end_time": "100 s", "tolerance": 1e-3},
    }
    return tw.load(case_tables(path, 2e3, thickness="10 mm", **changes))


@pytest.mark.slow
def test_equal_bodies_stay_equal(lenses):
    """requirement: a symmetric problem stays symmetric; the contact is in the middle of both."""
    result = run(lenses)
    summary, i = result.summary, result.interface
    assert summary["geometry_updates"] >= 2
    assert summary["geometry_change"] < 0.01
    assert i.wear_1 == pytest.approx(i.wear_2, rel=1e-5)
    lost = summary["geometry_volume_1_m3"]
    assert lost == pytest.approx(summary["geometry_volume_2_m3"], rel=1e-4)
    assert summary["wear_volume_1_m3"] == pytest.approx(1e-12 * 2e3 * 0.1 * 100, rel=2e-3)
    pressing = i.pressure > 0
    assert i.pressure == pytest.approx(i.pressure[::-1], abs=2e-3 * i.pressure.max())
    # faces that wear alike meet half-way, on a level, and each has lost the round that was there
    round_off = i.x[pressing] ** 2 / (2 * RADIUS)
    flat = i.wear_1[pressing] + round_off
    assert np.ptp(flat) < 0.02 * np.ptp(round_off)


def test_a_track_stays_in_the_gap():
    """requirement: body 2 wears over its whole track, which no mesh has; body 1 is moved."""
    track = 'wear.strip={coefficient="5e-8 1/MPa", spread="track"}'
    summary = run_starter(*STRIP, track, "wear.update=0.01", without=("heat",)).summary
    kept = run_starter(*STRIP, track, 'wear.update="never"', without=("heat",)).summary
    assert summary["geometry_updates"] >= 2
    assert summary["geometry_volume_error"] < 1e-6
    assert summary["geometry_volume_2_m3"] == 0.0
    assert summary["geometry_change"] < 0.01
    worn = 1e-13 * 0.3 * 4e3 * 1.0 * 2e4  # k F s
    assert summary["wear_volume_1_m3"] == pytest.approx(worn, rel=1e-4)
    assert summary["geometry_volume_1_m3"] == pytest.approx(worn, rel=1e-4)
    assert summary["wear_volume_2_m3"] == pytest.approx(worn / 2, rel=1e-4)
    assert summary["wear_volume_2_m3"] == pytest.approx(kept["wear_volume_2_m3"], rel=1e-4)
    assert summary["max_pressure_Pa"] == pytest.approx(kept["max_pressure_Pa"], rel=1e-2)
