"""Running-in whose meshes follow the worn faces."""

import gc
import weakref

import numpy as np
import pytest

from thermowear.reference.elastic_contact.growing_contact import growing_point
from thermowear.simulation.geometry_update import geometry_update
from thermowear.simulation.system.building import build
from thermowear.verification.cases.wear.growing import worn_half_width
from thermowear.verification.check import run_starter

from .hot_ring import HEAT

PUNCH = ("mesh.degree=6", "mesh.elements=4", "analysis.tolerance=1e-3")
END = 'analysis.end_time="3000 s"'
AREA = np.pi * (0.12**2 - 0.02**2)


@pytest.fixture(scope="module")
def worn_ring():
    """A tenth of the height of the ring worn off, cold."""
    return run_starter(
        "annular-punch-running-in", *PUNCH, END, "analysis.output_times=[]", "wear.update=0.01"
    )


def test_the_mesh_loses_what_is_worn_off(worn_ring):
    """requirement: the volume of the mesh and the integral of the wear."""
    summary, interface = worn_ring.summary, worn_ring.interface
    assert summary["geometry_updates"] >= 8
    assert summary["geometry_volume_error"] < 1e-9
    assert summary["geometry_smallest_scaled_jacobian"] > 0.9
    lost, worn = summary["geometry_volume_1_m3"], summary["wear_volume_1_m3"]
    assert worn == pytest.approx(interface.weight @ interface.wear_1, rel=1e-8)
    assert lost == pytest.approx(worn, rel=1e-8)  # in the end nothing is left in the gap
    # Archard's law: k F s, with the mean radius of the steady pressure
    assert worn == pytest.approx(0.05e-12 * 50e6 * AREA * 10 * 0.07 * 3000, rel=0.15)


def test_steady_wear_takes_one_step_from_update_to_update(worn_ring):
    """requirement: a step that an update has cut short does not limit those behind it."""
    steps = np.array([row.step for row in worn_ring.history if 1000 < row.time < 2500])
    assert steps.min() > 0.9 * steps.max()


def test_the_face_of_the_mesh_is_where_it_was_worn_to(worn_ring):
    """The points of the interface are those of the worn face, above the unworn one at z = 0."""
    interface, lost = worn_ring.interface, worn_ring.summary["geometry_volume_1_m3"]
    assert interface.weight @ interface.y == pytest.approx(lost, rel=1e-6)
    assert interface.y == pytest.approx(interface.wear_1, abs=1e-3 * interface.wear_1.max())
    assert interface.x.min() == pytest.approx(0.02)
    assert interface.x.max() == pytest.approx(0.12)


def test_systems_of_earlier_meshes_are_given_up(monkeypatch):
    """requirement: deep wear keeps no more than the last meshes and the next ones in memory."""
    made, most = [], 0

    def counted(*args):
        nonlocal most
        found = build(*args)
        made.append(weakref.ref(found.elastic))
        most = max(most, sum(one() is not None for one in made))
        return found

    monkeypatch.setattr(geometry_update, "build", counted)
    few = ("mesh.degree=2", "mesh.elements=2", 'analysis.end_time="25 h"')
    gc.collect()
    gc.disable()
    try:
        found = run_starter("annular-punch-deep", *few, "analysis.output_times=[]")
    finally:
        gc.enable()
    assert found.summary["geometry_updates"] >= 4
    assert most <= 3


def test_little_wear_moves_nothing():
    """Existing cases keep their numbers: up to 1 % of the height stays in the gap."""
    short = PUNCH + ('analysis.end_time="200 s"', "analysis.output_times=[]")
    found = [
        run_starter("annular-punch-running-in", *short, f"wear.update={update}").summary
        for update in ('"auto"', '"never"')
    ]
    assert "geometry_updates" not in found[0]
    assert found[0] == found[1]


@pytest.mark.slow
def test_it_ends_in_the_steady_state_of_the_height_that_is_left():
    """requirement: heat that takes a shorter way, without stepping through all of it."""
    hot = "annular-punch", "mesh.degree=6", "mesh.elements=4"
    transient = 'analysis={type="transient", end_time="1.2e5 s", tolerance=1e-3}'
    worn = run_starter(*hot, transient, "wear.update=0.01", "analysis.end_time=300000 s")
    summary = worn.summary
    height = 0.05 - summary["geometry_volume_1_m3"] / AREA
    assert height < 0.0476
    steady = run_starter(*hot, f"geometry.punch_height={height!r} m").summary
    unworn = run_starter(*hot).summary
    change = unworn["max_temperature_K"] - steady["max_temperature_K"]
    assert change > 1.0
    late = summary["max_temperature_K"] - steady["max_temperature_K"]
    assert abs(late) < 0.05 * change
    assert summary["max_pressure_Pa"] == pytest.approx(steady["max_pressure_Pa"], rel=5e-3)


@pytest.mark.slow
def test_heat_of_both_that_lose_material_is_accounted_for():
    """Heat of the worn material counts as lost; the balance holds at each step."""
    result = run_starter("annular-punch", *HEAT)
    assert result.summary["geometry_updates"] >= 2
    assert 0.0 < result.summary["geometry_temperature_error"] < 1e-4
    assert max(row.balance_error for row in result.heat) < 1e-8


@pytest.fixture(scope="module")
def pin():
    """Sphere worn on a flat, its mesh moved."""
    return run_starter(
        "sphere-on-block-growing",
        "mesh.elements=60",
        'analysis.end_time="12.8 s"',
        "analysis.output_times=[]",
        "wear.update=0.0005",
    )


def test_a_curved_face_grows_flat(pin):
    """requirement: a pin after 640 mm, Argatov, Wear 271 (2011) 1147."""
    law = growing_point(10.385, 50e-3, 115.385e9, 1.33e-13)
    assert worn_half_width(pin.interface, 3) / law.start == pytest.approx(3.2543, rel=0.01)
    assert pin.interface.wear_1[0] == pytest.approx(2.3829e-6, rel=0.02)


def test_the_volume_of_the_pin_is_that_of_archard(pin):
    """requirement: ``k P s`` by the volume of the mesh itself to 1e-4."""
    summary = pin.summary
    assert summary["geometry_updates"] >= 3
    assert summary["geometry_volume_error"] < 1e-9
    assert summary["wear_volume_1_m3"] == pytest.approx(1.33e-13 * 10.385 * 0.64, rel=1e-4)
    assert summary["geometry_volume_1_m3"] == pytest.approx(1.33e-13 * 10.385 * 0.64, rel=1e-4)
    # the mesh's face is flat up to the edge of the contact: lower in the middle than it was
    flat = pin.interface.x < 0.3e-3
    assert np.ptp(pin.interface.y[flat]) < 0.35 * (0.3e-3) ** 2 / (2 * 50e-3)
