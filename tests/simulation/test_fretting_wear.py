"""Wear in fretting, from the case to the results."""

import csv
import json

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.results import CycleRow
from thermowear.simulation import Observer

from ..case.starter import FRETTING, TUBE, solved, tables

SMALL = ("mesh.degree=2", "mesh.elements=16", "analysis.increments=4")
BOTH = {
    "wear.cylinder": {"coefficient": "1e-8 1/MPa", "per": "pressure"},
    "wear.block": {"coefficient": "1e-7 1/MPa"},  # per friction stress: k = 6e-8
}
K = 1e-14, 0.6e-13
FRICTION, FORCE = 0.6, 120.0


def close(value, rel=1e-6):
    """Equal numbers, however small: pytest's own allowance of 1e-12 would hide volumes."""
    return pytest.approx(value, rel=rel, abs=0.0)


STRONG = {"wear.cylinder": {"coefficient": "3e-7 1/MPa", "per": "pressure"}}


def moved(amplitude="10 um", **more):
    """A cycle of displacement, beyond the limit of friction."""
    places = ["0 um", amplitude, "0 um", f"-{amplitude}", "0 um"]
    history = {"time": [f"{t} s" for t in range(5)], "tangential_displacement": places}
    return BOTH | {"load.history": history, "analysis.output_times": []} | more


@pytest.fixture(scope="module")
def sticking():
    """The starter, which does not slide, with wear and five cycles that stand for many."""
    changes = BOTH | {"analysis.cycles": 10**5, "analysis.jump": 20000, "analysis.output_times": []}
    return solved(FRETTING, changes, *SMALL)


@pytest.fixture(scope="module")
def sliding():
    return solved(FRETTING, moved(), *SMALL, "analysis.cycles=60", "analysis.jump=20")


@pytest.fixture(scope="module")
def every():
    """All cycles of a contact that grows, one by one."""
    return growing("analysis.jump=1").friction.cycles


@pytest.fixture(scope="module")
def adaptive():
    return growing('analysis.jump="auto"')


def growing(*settings, cycles=120, **more):
    """A contact that is pushed farther than it sticks, and wears fast."""
    return solved(FRETTING, moved(**STRONG | more), *SMALL, f"wear.cycles={cycles}", *settings)


@pytest.mark.parametrize(
    "name", ["sticking", "sliding", pytest.param("adaptive", marks=pytest.mark.slow)]
)
def test_volumes_are_those_of_the_energy(name, request):
    """requirement: V = k/mu E for both bodies, at every increment; all tables agree."""
    result = request.getfixturevalue(name)
    i, rows, cycles = result.interface, result.friction.rows, result.friction.cycles
    strengths = (3e-13, K[1]) if name == "adaptive" else K
    for body, k in enumerate(strengths, start=1):
        volumes = np.array([getattr(row, f"wear_volume_{body}") for row in rows])
        lost = np.array([row.dissipated for row in rows])
        np.testing.assert_allclose(volumes, k / FRICTION * lost, rtol=1e-9, atol=1e-9 * volumes[-1])
        assert np.all(np.diff(volumes) >= 0)
        assert getattr(cycles[-1], f"wear_volume_{body}") == close(volumes[-1], rel=1e-12)
        worn = getattr(i, f"wear_{body}")
        assert i.weight @ worn == close(volumes[-1], rel=1e-12)
        assert result.summary[f"wear_volume_{body}_m3"] == close(volumes[-1], rel=1e-12)
        assert worn.max() == getattr(cycles[-1], f"max_wear_{body}")
        last = volumes[-1] - getattr(cycles[-2], f"wear_volume_{body}")
        per_cycle = result.summary[f"wear_volume_per_cycle_{body}_m3"]
        jump = cycles[-1].cycle - cycles[-2].cycle
        assert per_cycle == close(last / jump, rel=1e-9)
        rate = i.weight @ getattr(i, f"wear_rate_{body}")
        period = 2.0 if name == "sticking" else 4.0
        assert rate == close(per_cycle / period, rel=1e-9)
    assert result.summary["cycles"] == cycles[-1].cycle


def test_cycles_are_counted(sticking):
    """requirement: a row a computed cycle, with its number and its time."""
    cycles = sticking.friction.cycles
    assert [row.cycle for row in cycles] == [1, 20000, 40000, 60000, 80000, 100000]
    assert [row.time for row in cycles] == close([3, 40001, 80001, 120001, 160001, 200001])
    assert [row.cycle for row in sticking.friction.rows[:8]] == [0] * 8
    assert all(row.max_pressure > 0 < row.contact_area for row in cycles)
    lost = [row.dissipated for row in cycles]
    assert np.all(np.diff(lost, prepend=0.0) > 0)


def test_the_middle_sticks_and_does_not_wear(sticking):
    """requirement: wear where it slips, none in the middle; the pressure there grows for it."""
    i = sticking.interface
    middle, rim = np.abs(i.x) < 3e-5, (np.abs(i.x) > 7.5e-5) & (np.abs(i.x) < 8.5e-5)
    assert np.all(i.wear_2[middle] == 0.0)
    assert np.all(i.wear_2[rim] > 1e-10)
    rows = sticking.friction.rows
    assert rows[-1].max_pressure > 1.1 * rows[7].max_pressure
    assert sticking.summary["equilibrium_relative_error"] < 1e-9


def test_full_sliding_wears_nearly_at_the_bound(sliding):
    """requirement: V = k F 4 (d - C mu F) a cycle, with the compliance C of little loads."""
    history = {"time": ["0 s", "1 s"], "tangential_force": ["0 N", "0.5 N"]}
    little = solved(FRETTING, {"load.history": history, "analysis.output_times": []}, *SMALL)
    compliance = little.summary["tangential_displacement_m"] / 0.5
    slid = 4 * (10e-6 - compliance * FRICTION * FORCE)
    found = sliding.summary["wear_volume_per_cycle_2_m3"]
    assert found == close(K[1] * FORCE * slid, rel=2e-2)
    assert slid < 0.75 * 4 * 10e-6


def test_jumps_change_little(sliding):
    """requirement: jumps of 20 cycles and of 5 agree."""
    fine = solved(FRETTING, moved(), *SMALL, "analysis.cycles=60", "analysis.jump=5")
    coarse, fine = (result.friction.cycles[-1] for result in (sliding, fine))
    assert coarse.wear_volume_2 == close(fine.wear_volume_2, rel=5e-3)
    assert coarse.max_wear_2 == close(fine.max_wear_2, rel=5e-2)


@pytest.mark.slow
def test_adaptive_jumps_are_those_of_all_cycles(adaptive, every):
    """requirement: depths and volumes of cycles one by one, from a few of them."""
    jumps = adaptive.friction.cycles
    assert [row.cycle for row in every] == list(range(1, 121))
    assert sum(row.jump for row in jumps) == jumps[-1].cycle == 120
    assert len(jumps) < 25
    for row in jumps:
        exact = every[row.cycle - 1]
        assert row.time == exact.time
        for name in ("wear_volume_1", "wear_volume_2", "dissipated"):
            assert getattr(row, name) == close(getattr(exact, name), rel=2e-3)
        for name in ("max_wear_1", "max_wear_2", "contact_area"):
            assert getattr(row, name) == close(getattr(exact, name), rel=2e-2)
        assert 0 <= row.error <= 1e-2


@pytest.mark.slow
def test_the_tolerance_of_jumps(every):
    """requirement: errors go with it; where it is large, no jump is longer than told."""
    errors = []
    for tolerance in (4e-2, 1e-2, 2.5e-3):
        rows = growing(f"analysis.tolerance={tolerance}").friction.cycles
        errors.append(abs(rows[-1].max_wear_2 / every[-1].max_wear_2 - 1))
        assert max(row.error for row in rows) <= tolerance
    assert errors[2] < errors[0] / 3
    rows = growing("analysis.tolerance=0.1", "wear.max_jump=9").friction.cycles
    assert max(row.jump for row in rows) == 9
    assert rows[-1].max_wear_2 == close(every[-1].max_wear_2, rel=1e-2)


@pytest.mark.slow
def test_adaptive_jumps_hit_output_times():
    """requirement: exactly, and within a cycle the cycle is computed for itself."""
    changes = {"analysis.output_times": ["81.5 s", "160 s"]}
    result = growing(cycles=50, **changes)
    rows = {row.cycle: row for row in result.friction.cycles}
    assert set(result.outputs) == {81.5, 160.0}
    assert rows[21].jump == 1
    assert {20, 21, 40, 50} <= set(rows)
    at = result.outputs[160.0]
    assert at.weight @ at.wear_2 == close(rows[40].wear_volume_2, rel=1e-12)
    inside = result.outputs[81.5]
    assert rows[20].wear_volume_2 < inside.weight @ inside.wear_2 < rows[21].wear_volume_2


def test_adaptive_jumps_where_the_middle_sticks():
    """requirement: wear of partial slip, and none in the middle, in few jumps as in many."""
    changes, count = BOTH | {"analysis.output_times": []}, "wear.cycles=100000"
    result = solved(FRETTING, changes, *SMALL, count)
    many = solved(FRETTING, changes, *SMALL, count, "analysis.jump=2500")
    last, known = result.friction.cycles[-1], many.friction.cycles[-1]
    assert last.cycle == 100000
    assert len(result.friction.cycles) < len(many.friction.cycles) / 1.5
    assert last.wear_volume_2 == close(known.wear_volume_2, rel=0.03)
    i = result.interface
    assert np.all(i.wear_2[np.abs(i.x) < 3e-5] == 0.0)
    assert result.summary["wear_volume_2_m3"] == close(
        K[1] / FRICTION * result.summary["dissipated_energy_J"], rel=1e-9
    )


@pytest.mark.parametrize("push", [24.0, 26.0, 27.0])
def test_the_end_of_partial_slip_and_its_estimate(push):
    """
    requirement: pressure only where it sticks; the edge is found within a twentieth of an element
    in all cycles, wherever it lies in it, and the volume as far from the closed form of half-planes
    as the estimate says.

    On the stick zone, ``c² = a² (1 - Q/μP)`` as in the first cycle, the pressure is that of the
    unworn cylinder and a punch of the force Q/μ; where wear ends, faces just touch beyond it.
    """
    radius, modulus = 6e-3, 2e11 / (2 * (1 - 0.3**2))  # per length of 1 mm
    history = {"time": ["0 s", "1 s", "3 s", "5 s"]}
    history["tangential_force"] = ["0 N", f"{push} N", f"-{push} N", f"{push} N"]
    strong = {"coefficient": "1e-6 1/MPa", "per": "pressure"}
    changes = {"load.history": history, "wear.cylinder": strong, "wear.block": strong}
    settings = "mesh.elements=48", "mesh.grading=1.0", "mesh.degree=2", "analysis.increments=3"
    changes |= {"analysis.output_times": [], "geometry.zone": "0.12 mm"}
    result = solved(FRETTING, changes, *settings, "wear.cycles=8000", "analysis.jump=400")
    c2 = 4 * 1e3 * FORCE * radius / (np.pi * modulus) * (1 - push / (FRICTION * FORCE))
    c, element = np.sqrt(c2), 0.24e-3 / 48
    x = c * np.linspace(1.0 + 1e-9, 2.0, 20001)
    far = np.arccosh(x / c)
    depth = 2e3 * push / (np.pi * FRICTION * modulus) * far
    depth -= (x * np.sqrt(x**2 - c2) - c2 * far) / (2 * radius)
    known = 2e-3 * np.trapezoid(np.maximum(depth, 0.0), x)
    summary, i = result.summary, result.interface
    volume = summary["wear_volume_1_m3"] + summary["wear_volume_2_m3"]
    error = summary["wear_volume_error_estimate_relative"]
    assert np.all(i.pressure[np.abs(i.x) > c + 1.5 * element] < 0.02 * i.pressure.max())
    assert summary["shape_error_estimate_relative"] >= error > abs(volume / known - 1.0)
    assert abs(volume - known) < 0.06 * known
    assert 0.02 < error < 0.2
    cycles = result.friction.cycles
    assert summary["stick_radius_m"] == cycles[-1].stick_radius
    assert all(abs(row.stick_radius - c) < 0.05 * element for row in cycles)
    assert volume == close(2e-12 / FRICTION * summary["dissipated_energy_J"], rel=1e-8)


def test_the_gap_is_closed_where_it_presses():
    """requirement: the gap of the interface has body 1's profile where body 1 has slid to."""
    changes = moved(**{"analysis.output_times": ["301 s"]})
    changes["wear"] = {"cylinder": {"coefficient": "1e-6 1/MPa", "per": "pressure"}}
    result = solved(FRETTING, changes, *SMALL, "analysis.cycles=80", "analysis.jump=20")
    turned = result.outputs[301.0]
    pressing = turned.pressure > 0.3 * turned.pressure.max()
    assert turned.wear_1.max() > 5e-7
    assert np.abs(turned.gap[pressing]).max() < 0.1 * turned.wear_1.max()


def test_the_velocity_exponent():
    """requirement: with a = 2 wear goes with the speed: half the time, twice the wear."""
    law = {"coefficient": "1e-7 s/mm/MPa", "per": "pressure", "velocity_exponent": 2.0}
    slow = moved(**{"wear": {"block": law}})
    fast = moved(**{"wear": {"block": law}})
    fast["load.history"]["time"] = [f"{t / 2} s" for t in range(5)]
    volumes = [
        solved(FRETTING, changes, *SMALL).summary["wear_volume_2_m3"] for changes in (slow, fast)
    ]
    assert volumes[1] == close(2 * volumes[0], rel=1e-4)


def test_a_sphere_wears_where_unlike_bodies_slip():
    """requirement: an axisymmetric body under a force that comes and goes."""
    history = {"time": ["0 s", "1 s", "2 s"], "force": ["100 N", "500 N", "100 N"]}
    changes = {
        "load": {"history": history},
        "analysis": {"type": "fretting", "increments": 4, "cycles": 40, "jump": 10},
        "bodies.sphere": {"young_modulus": "600 GPa", "poisson_ratio": 0.22},
        "contact": {"friction": 0.05},
        "wear.block": {"coefficient": "1e-7 1/MPa", "per": "pressure"},
    }
    result = solved("sphere-on-block", changes, "mesh.degree=3", "mesh.elements=12")
    pressed, last = result.friction.rows[3].dissipated, result.friction.rows[-1].dissipated
    known = 1e-13 / 0.05 * (last - pressed)  # nothing wears at the first instant
    assert result.summary["wear_volume_2_m3"] == close(known, rel=1e-9)
    assert result.interface.wear_2.max() > 0
    assert result.summary["wear_volume_1_m3"] == 0.0


def test_output_times_in_later_cycles():
    """requirement: an output time is hit in the cycle that it falls in, wear and all."""
    times = ["1 s", "21.5 s", "43 s"]
    result = solved(
        FRETTING,
        BOTH | {"analysis.output_times": times},
        *SMALL,
        "analysis.cycles=30",
        "analysis.jump=15",
    )
    assert set(result.outputs) == {1.0, 21.5, 43.0}
    assert [row.cycle for row in result.friction.cycles] == [1, 11, 15, 21, 30]
    depths = [result.outputs[t].wear_2.max() for t in (1.0, 21.5, 43.0)]
    assert 0 < depths[0] < 0.2 * depths[1] < 0.5 * depths[2]
    row = next(row for row in result.friction.rows if row.time == 21.5)
    at = result.outputs[21.5]
    assert row.wear_volume_2 == close(at.weight @ at.wear_2, rel=1e-12)


# ---- what ends early, and files ----


class Stopping(Observer):
    """Presses Ctrl-C after some cycles."""

    def row(self, row, distance):
        if isinstance(row, CycleRow) and row.cycle == 40:
            import signal

            signal.raise_signal(signal.SIGINT)


@pytest.mark.usefixtures("heeds_ctrl_c")
def test_an_interrupted_run_keeps_its_cycles():
    """requirement: what was computed is kept, wear included."""
    changes = BOTH | {"analysis.cycles": 100, "analysis.jump": 20, "analysis.output_times": []}
    result = solved(FRETTING, changes, *SMALL, observer=Stopping())
    assert isinstance(result.stopped, KeyboardInterrupt)
    assert result.summary["cycles"] == 40
    assert result.friction.cycles[-1].wear_volume_2 > 0
    assert result.summary["wear_volume_2_m3"] == close(
        result.friction.cycles[-1].wear_volume_2, rel=1e-12
    )


@pytest.mark.usefixtures("bodies_not_drawn")
def test_files_of_a_run(tmp_path, capsys):
    """requirement: cycles.csv has the cycles, interface.csv the depths; pictures of them."""
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    changes = BOTH | {"analysis.cycles": 6, "analysis.output_times": ["3 s"]}
    file.write_text(tomli_w.dumps(tables(FRETTING, changes)), encoding="utf-8")
    small = [f"--set={text}" for text in (*SMALL, "analysis.jump=2")]
    assert main(["run", str(file), "-o", str(folder), *small]) == 0
    assert "worn volume" in capsys.readouterr().out
    with (folder / "cycles.csv").open() as rows:
        cycles = list(csv.DictReader(rows))
    assert [row["cycle"] for row in cycles] == ["1", "2", "4", "6"]
    summary = json.loads((folder / "summary.json").read_text())
    for body in (1, 2):
        volume = float(cycles[-1][f"wear_volume_{body}_m3"])
        assert volume == close(summary[f"wear_volume_{body}_m3"], rel=1e-12)
    for picture in ("cycles.png", "wear.png", "loads.png"):
        assert (folder / picture).stat().st_size > 1000


def test_the_tube_in_its_support():
    """requirement: the starter; both bodies lose as much, where the contact travels."""
    result = solved(TUBE, {}, "analysis.cycles=6000", "analysis.output_times=[]")
    assert [row.cycle for row in result.friction.cycles] == [1, 2000, 4000, 6000]
    volumes = [result.summary[f"wear_volume_{body}_m3"] for body in (1, 2)]
    assert volumes[0] == close(volumes[1], rel=1e-12)
    assert volumes[0] == close(5e-14 * 20 * 4 * 5e-6 * 6000, rel=1e-2)
    i = result.interface
    worn = np.abs(i.x[i.wear_1 > 0.05 * i.wear_1.max()])
    assert 4.5e-4 < worn.max() < 8e-4
    assert abs(np.average(i.x, weights=i.weight * i.wear_1)) < 0.02 * worn.max()


def test_bodies_of_a_case_that_do_not_wear():
    """requirement: without wear tables all is as before, and volumes are zero."""
    result = solved(FRETTING, {"analysis.output_times": []}, *SMALL, "analysis.cycles=2")
    assert result.summary["wear_volume_1_m3"] == result.summary["wear_volume_2_m3"] == 0.0
    assert [row.cycle for row in result.friction.cycles] == [1, 2]
    once = solved(FRETTING, {"analysis.output_times": []}, *SMALL)
    assert result.friction.cycles[0].dissipated == close(
        once.summary["dissipated_energy_J"], rel=1e-12
    )
    assert isinstance(result.friction.rows[0], tw.results.LoadRow)
