"""Running-in in space whose meshes follow the worn faces."""

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.simulation.from_case import run as run_case

from ..case.starter import changed
from ..test_parallel import summaries
from .space import BRAKE, PUNCH
from .test_checkpoint import Watched, assert_the_same

AREA = 0.06 * 0.08
TRANSIENT = {"type": "transient", "tolerance": 1e-3}
CENTRED = {"holder": None, "load": {"force": "10 kN"}}
HOT = {
    "bodies.punch.conductivity": "50 W/(m K)",
    "bodies.punch.expansion": "1.2e-5 1/K",
    "heat": {
        "conductance": "1e5 W/(m^2 K)",
        "ambient": "20 degC",
        "cooling": {"punch_top": "2000 W/(m^2 K)", "block_bottom": "2000 W/(m^2 K)"},
    },
}


def run(tables, changes):
    result = tw.run(tw.load(changed(tables, changes)))
    assert result.stopped is None
    return result


def until(time):
    return {"analysis": TRANSIENT | {"end_time": f"{time} s"}}


@pytest.fixture(scope="module")
def worn_punch():
    """A thirtieth of the height worn off, hot."""
    return run(PUNCH, CENTRED | HOT | until(3e6) | {"wear.update": 0.004})


def test_the_mesh_loses_what_is_worn_off(worn_punch):
    """requirement: in space, the volume of the mesh and the integral of the wear."""
    summary, i = worn_punch.summary, worn_punch.interface
    assert summary["geometry_updates"] >= 4
    assert summary["geometry_volume_error"] < 1e-9
    assert summary["geometry_smallest_scaled_jacobian"] > 0.999
    lost, worn = summary["geometry_volume_1_m3"], summary["wear_volume_1_m3"]
    # Archard's law, k F s
    assert worn == pytest.approx(2e-13 * 0.25 * 1e4 * 5e-3 * 3e6, rel=1e-5)
    assert worn == pytest.approx(i.weight @ i.wear_1, rel=1e-8)
    assert worn == pytest.approx(lost, rel=1e-5)  # all of it in the end
    assert i.weight @ i.z == pytest.approx(lost, rel=1e-6)
    assert np.abs(i.x).max() == pytest.approx(0.03, rel=1e-9)
    assert np.abs(i.y).max() == pytest.approx(0.04, rel=1e-9)
    # a punch that may not tilt: all of the face at the same rate
    assert i.pressure == pytest.approx(1e4 / AREA, rel=0.01)


def test_it_ends_in_the_steady_state_of_the_height_that_is_left(worn_punch):
    """requirement: in space, shape and temperatures of a punch that is meshed so low."""
    height = 0.05 - worn_punch.summary["geometry_volume_1_m3"] / AREA
    low, high = (run(PUNCH, CENTRED | HOT | {"geometry.height": f"{h} m"}) for h in (height, 0.05))
    ours, theirs = worn_punch.interface, low.interface
    shapes = [i.shape - np.average(i.shape, weights=i.weight) for i in (ours, theirs)]
    assert np.abs(shapes[0] - shapes[1]).max() < 3e-3 * np.ptp(theirs.shape)
    rise = theirs.temperature_1.max() - 293.15
    assert np.abs(ours.temperature_1 - theirs.temperature_1).max() < 1e-3 * rise
    # which is not that of the unworn one
    assert np.ptp(high.interface.shape - theirs.shape) > 0.02 * np.ptp(theirs.shape)
    assert (high.interface.temperature_1 - theirs.temperature_1).max() > 5e-3 * rise


@pytest.mark.slow
def test_a_tilting_punch_on_a_block_that_does_not_match():
    """Points that wander over the face: special case 2 with its pressure, a plane."""
    law = {"coefficient": "5e-8 1/MPa", "per": "pressure"}
    result = run(
        PUNCH,
        until(1e6)
        | {"contact.friction": 0.0, "wear.punch": law, "wear.update": 0.003}
        | {"mesh.bodies": {"block": {"elements": 5}}},
    )
    i, summary = result.interface, result.summary
    assert summary["geometry_updates"] >= 4
    assert summary["geometry_volume_error"] < 1e-9
    assert np.ptp(i.z) > 3e-4
    # but for what a tilted face turns the pressure by
    plane = 1e4 / AREA * (1.0 - 0.005 * i.x / (0.06**2 / 12))
    assert i.pressure == pytest.approx(plane, abs=1e-3 * 3.125e6)
    assert summary["wear_volume_1_m3"] == pytest.approx(5e-14 * 1e4 * 5e-3 * 1e6, rel=1e-4)
    assert summary["wear_volume_1_m3"] == pytest.approx(i.weight @ i.wear_1, rel=3e-4)


def test_both_faces_move():
    """As Archard's law has it; the rim of the block's face stays, where its top goes on."""
    block = {"coefficient": "1e-7 1/MPa"}
    changes = CENTRED | until(5e5) | {"wear.block": block, "wear.update": 0.002}
    summary = run(PUNCH, changes).summary
    assert summary["geometry_updates"] >= 2
    assert summary["geometry_volume_error"] < 1e-9
    for body, law in ((1, 2e-13), (2, 1e-13)):
        volume = law * 0.25 * 1e4 * 5e-3 * 5e5
        assert summary[f"wear_volume_{body}_m3"] == pytest.approx(volume, rel=1e-5)
        assert summary[f"geometry_volume_{body}_m3"] > 0.7 * volume


@pytest.mark.slow
def test_a_pad_slides_along_its_curved_sides():
    """Points stay between its radii; pressure and wear are those of a pad that loses nothing."""
    moved, kept = (
        run(BRAKE, until(500) | {"mesh.elements": 8, "wear.update": update}).interface
        for update in (0.01, "never")
    )
    assert moved.z.min() > 3e-4
    r = np.hypot(moved.x, moved.y)
    assert r == pytest.approx(np.hypot(kept.x, kept.y), rel=1e-9)
    assert moved.pressure == pytest.approx(kept.pressure, abs=0.01 * kept.pressure.max())
    assert moved.wear_1 == pytest.approx(kept.wear_1, abs=0.01 * kept.wear_1.max())


def test_heat_of_a_body_that_loses_material_is_accounted_for():
    """Heat of the worn material counts as lost; the balance holds at each step."""
    changes = {
        "bodies.punch.density": "7800 kg/m^3",
        "bodies.punch.specific_heat": "460 J/(kg K)",
        "heat.transient": True,
        "heat.initial": "30 degC",
        "motion.velocity": "1 m/s",
        "load.force": "1 kN",
        "wear.punch.coefficient": "1e-3 1/MPa",
        "wear.update": 0.001,
        "mesh.elements": 2,
        "analysis": TRANSIENT | {"end_time": "3 s", "tolerance": 1e-2},
    }
    result = run(changed(PUNCH, CENTRED | HOT), changes)
    assert result.summary["geometry_updates"] >= 1
    assert 0.0 < result.summary["geometry_temperature_error"] < 1e-3
    assert max(row.balance_error for row in result.heat if row.time > 0.01) < 1e-10


def test_a_run_goes_on_from_a_moved_mesh():
    """requirement: in space, to the last bit from a checkpoint after an update."""
    changes = until(4e5) | {"wear.update": 0.004, "mesh.elements": 3}
    changes["analysis"] |= {"checkpoint_every": "1e-9 s"}
    case, watched = tw.load(changed(PUNCH, changes)), Watched()
    whole = run_case(case, None, watched)
    assert whole.summary["geometry_updates"] >= 2
    saved = watched.checkpoints[-2].state(rank=0)
    assert_the_same(whole, run_case(case, None, Watched(), None, saved))


@pytest.mark.slow
def test_two_ranks_give_the_serial_numbers(tmp_path):
    case = tmp_path / "case.toml"
    changes = until(4e5) | {"wear.update": 0.004, "mesh.elements": 3}
    case.write_text(tomli_w.dumps(changed(PUNCH, changes)), encoding="utf-8")
    (serial, _), (parallel, _) = summaries(tmp_path, case)
    assert serial["geometry_updates"] >= 1
    for key, value in serial.items():
        if isinstance(value, float) and not key.endswith("error"):
            near = 1e-8 * abs(serial["normal_force_N"] if key.endswith("_N") else value)
            if key.endswith("_error_estimate_relative"):  # from equations solved no more precisely
                near = 1e-2 * value
            assert parallel[key] == pytest.approx(value, rel=1e-7, abs=max(near, 1e-15)), key
