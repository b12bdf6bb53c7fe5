"""Sticking and slipping under a history of loads, from the case to the results folder."""

import csv
import json
import re

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main

from ..case.starter import FRETTING, SPHERE, solved, tables
from ..systems import built

SMALL = ("mesh.degree=2", "mesh.elements=16")
TIMES = ["0 s", "1 s", "2 s", "3 s"]
LIMIT = 0.6 * 120.0


def columns(result):
    """Histories of all quantities, an unloaded start before the first increment."""
    rows = result.friction.rows
    return {name: np.array([0.0, *(getattr(row, name) for row in rows)]) for name in vars(rows[0])}


def work(table, start=0):
    """Work of the holder on body 1 since an increment, by the trapezoidal rule [J]."""
    total = 0.0
    for force, motion in (
        ("normal_force", "approach"),
        ("tangential_force", "tangential_displacement"),
    ):
        f, d = table[force][start:], table[motion][start:]
        total += np.sum((f[1:] + f[:-1]) / 2 * np.diff(d))
    return total


@pytest.fixture(scope="module")
def starter():
    return solved(FRETTING, {}, *SMALL, "analysis.increments=10")


# ---- the history ----


def test_output_times_and_corners_are_hit(starter):
    """requirement: loads are followed by increments between the corners, output times exact."""
    rows = starter.friction.rows
    assert starter.stopped is None
    assert [row.time for row in rows[:10]] == [0.0] * 10  # pressing comes first
    np.testing.assert_allclose([row.time for row in rows[10:]], np.arange(1, 31) / 10, rtol=1e-12)
    assert set(starter.outputs) == set(starter.friction.outputs) == {1.0, 2.0}
    assert starter.summary["steps"] == 40
    assert starter.summary["time_s"] == 3.0


def test_an_output_time_between_corners_is_a_corner():
    """requirement: an output time anywhere in the history is reached exactly."""
    settings = ('analysis.output_times=["0 s", "0.25 s"]', "analysis.increments=4")
    result = solved(FRETTING, {}, *SMALL, *settings)
    times = [row.time for row in result.friction.rows]
    assert times[:8] == pytest.approx([0.0] * 4 + [0.0625, 0.125, 0.1875, 0.25])
    assert set(result.friction.outputs) == {0.0, 0.25}
    at = result.friction.outputs[0.25]
    push = next(row for row in result.friction.rows if row.time == 0.25).tangential_force
    assert push == pytest.approx(9.0, rel=1e-9)
    assert at.weight @ at.shear == pytest.approx(-9.0, rel=1e-3)


def test_loads_follow_straight_lines(starter):
    """requirement: forces between the corners are interpolated."""
    table = columns(starter)
    given = np.interp(table["time"][11:], [0, 1, 2, 3], [0, 36, -36, 36])
    np.testing.assert_allclose(table["tangential_force"][11:], given, atol=1e-9 * LIMIT)
    np.testing.assert_allclose(table["normal_force"][11:], 120.0, rtol=1e-9)
    np.testing.assert_allclose(table["normal_force"][1:11], np.arange(1, 11) * 12.0, rtol=1e-9)


def test_shear_opposes_the_push(starter):
    """requirement: the traction on body 1 balances the holder's force; it turns with it."""
    for time, push in ((1.0, 36.0), (2.0, -36.0)):
        f = starter.friction.outputs[time]
        assert f.weight @ f.shear == pytest.approx(-push, rel=1e-3)
        assert np.all(np.abs(f.shear) <= 0.6 * f.pressure + 1e-9 * f.pressure.max())
        sliding = f.status == 2
        np.testing.assert_allclose(np.abs(f.shear[sliding]), 0.6 * f.pressure[sliding], rtol=1e-5)
        assert np.all(np.sign(f.shear[sliding]) == -np.sign(push))
        middle, rim = np.abs(f.x) < 2e-5, sliding & (np.abs(f.x) > 7e-5)
        assert np.all(f.status[middle] == 1)
        assert np.all(f.shear[rim] * push < 0)
        assert np.all(f.status[f.pressure == 0] == 0)
    one, other = (starter.friction.outputs[t] for t in (1.0, 2.0))
    after_a_cycle = starter.friction.last
    assert np.abs(one.shear - after_a_cycle.shear).max() < 1e-9 * np.abs(one.shear).max()
    # turned round, but for the element in which sticking ends
    assert one.weight @ np.abs(one.shear + other.shear) < 0.06 * 36


def test_the_bodies_are_in_balance(starter):
    """requirement: forces balance to 1e-9 with shear in the contact too."""
    summary = starter.summary
    assert summary["equilibrium_relative_error"] < 1e-9
    assert summary["normal_force_N"] == pytest.approx(120.0, rel=1e-9)
    assert summary["tangential_force_N"] == pytest.approx(36.0, rel=1e-9)
    assert summary["friction_force_N"] == pytest.approx(36.0, rel=1e-9)
    assert 0 < summary["stick_area_m2"] < summary["contact_area_m2"]


# ---- energy ----


def test_energy_is_only_lost(starter):
    """requirement: dissipation grows, and not at all while there is no push."""
    lost = columns(starter)["dissipated"]
    assert np.all(np.diff(lost) > -1e-9 * lost[-1])
    assert np.abs(lost[:11]).max() < 1e-9 * lost[-1]
    assert lost[-1] == pytest.approx(1.907e-6, rel=2e-3)
    assert starter.summary["dissipated_energy_J"] == pytest.approx(lost[-1], rel=1e-12)


def energy_missing(increments):
    """Work less what is stored and lost, and the work of a cycle less its loss; over the loss."""
    case = tw.load(tables(FRETTING), (*SMALL, f"analysis.increments={increments}"))
    result = tw.run(case)
    table, f = columns(result), result.friction.last
    gap = built(case).pairing.gap
    last = result.friction.rows[-1]
    stored = 0.5 * (
        last.normal_force * last.approach
        + last.tangential_force * last.tangential_displacement
        - f.weight @ (f.pressure * gap)
        + f.weight @ (f.shear * f.slip)
    )
    assert stored > 50 * last.dissipated
    start = 1 + next(k for k, row in enumerate(result.friction.rows) if row.time == 1.0)
    lost = last.dissipated - table["dissipated"][start]
    return (
        (work(table) - stored - last.dissipated) / last.dissipated,
        (work(table, start) - lost) / lost,
    )


def test_work_is_stored_or_lost():
    """
    requirement: work of the external forces = energy stored + energy dissipated. The work is summed
    up by straight lines: what is missing falls with the square of the increments.
    """
    (coarse, of_cycle), (fine, of_fine_cycle) = map(energy_missing, (10, 20))
    assert 0 < fine < 0.4 * coarse < 0.05
    assert abs(of_fine_cycle) < 0.5 * abs(of_cycle) < 0.01


# ---- what is controlled ----


def test_a_given_displacement_is_like_the_force(starter):
    """requirement: pushed to the places where the forces led, the same forces are found."""
    table = columns(starter)
    places = [0.0, *(table["tangential_displacement"][k] for k in (20, 30, 40))]
    history = {"time": TIMES, "tangential_displacement": [f"{d!r} m" for d in map(float, places)]}
    moved = solved(FRETTING, {"load.history": history}, *SMALL, "analysis.increments=10")
    found = columns(moved)
    corners = [20, 30, 40]
    np.testing.assert_allclose(found["tangential_force"][corners], [36, -36, 36], rtol=1e-5)
    assert found["dissipated"][-1] == pytest.approx(table["dissipated"][-1], rel=1e-4)
    f, known = moved.friction.last, starter.friction.last
    assert np.abs(f.shear - known.shear).max() < 1e-3 * np.abs(known.shear).max()


def test_a_displacement_may_slide():
    """requirement: beyond the limit of friction everything slips, and the force is the limit."""
    history = {"time": ["0 s", "1 s"], "tangential_displacement": ["0 um", "10 um"]}
    changes = {"load.history": history, "analysis.output_times": []}
    result = solved(FRETTING, changes, *SMALL, "analysis.increments=4")
    last = result.friction.rows[-1]
    assert last.tangential_force == pytest.approx(LIMIT, rel=5e-3)
    assert last.stick_area == 0.0
    assert set(result.friction.last.status[result.friction.last.pressure > 0]) == {2}


def test_full_sliding_keeps_what_was_computed():
    """requirement: a force beyond the limit is an error with advice; results up to there stay."""
    history = {"time": ["0 s", "1 s"], "tangential_force": ["0 N", "100 N"]}
    changes = {"load.history": history, "analysis.output_times": []}
    result = solved(FRETTING, changes, *SMALL, "analysis.increments=5")
    assert isinstance(result.stopped, tw.ComputationError)
    assert "slides" in str(result.stopped)
    assert "tangential displacement" in str(result.stopped)
    assert result.friction.rows[-1].tangential_force == pytest.approx(60.0, rel=1e-9)
    assert result.summary["time_s"] == pytest.approx(0.6)


def pressed(**history):
    times = {"time": ["0 s", "1 s", "2 s"]}
    changes = {"load": {"history": times | history}, "analysis.output_times": ["1 s"]}
    return solved(FRETTING, changes, *SMALL, "analysis.increments=5")


@pytest.fixture(scope="module")
def by_force():
    return pressed(force=["60 N", "120 N", "60 N"])


def test_pressing_and_letting_go_loses_nothing(by_force):
    """requirement: equal bodies do not slip when pressed; unloading leads back the same way."""
    table = columns(by_force)
    assert table["normal_force"][[5, 10, 15]] == pytest.approx([60, 120, 60], rel=1e-9)
    for name in ("approach", "contact_area", "max_pressure"):
        back = table[name][10:16][::-1]
        np.testing.assert_allclose(table[name][5:11], back, rtol=1e-7, err_msg=name)
    assert (
        np.abs(table["dissipated"]).max()
        < 1e-12 * table["normal_force"].max() * table["approach"].max()
    )
    assert np.all(np.diff(table["approach"][:11]) > 0)
    peaks = table["max_pressure"]
    assert peaks[10] / peaks[5] == pytest.approx(2**0.5, rel=1e-2)  # Hertz
    assert by_force.friction.outputs[1.0].pressure.max() == pytest.approx(peaks[10])
    assert np.all(table["tangential_force"] == 0)


def test_a_history_of_approaches_is_like_one_of_forces(by_force):
    """requirement: the approaches that the forces led to carry these forces."""
    table = columns(by_force)
    depths = [f"{float(table['approach'][k])!r} m" for k in (5, 10, 15)]
    found = columns(pressed(approach=depths))
    np.testing.assert_allclose(found["approach"][[5, 10, 15]], table["approach"][[5, 10, 15]])
    # within the error of the meshes, which are made for what is expected of force or approach
    assert found["normal_force"][[5, 10, 15]] == pytest.approx([60, 120, 60], rel=3e-3)
    assert found["normal_force"][15] == pytest.approx(found["normal_force"][5], rel=1e-9)


def test_less_pressure_lets_go_of_the_shear():
    """requirement: the normal force may change while the push stays; less of it sticks then."""
    result = pressed(force=["120 N", "120 N", "50 N"], tangential_force=["0 N", "25 N", "25 N"])
    table = columns(result)
    assert table["tangential_force"][[10, 15]] == pytest.approx([25, 25], rel=1e-9)
    share = table["stick_area"][1:] / table["contact_area"][1:]
    assert share[14] < 0.7 * share[9]
    assert table["dissipated"][15] > 1.5 * table["dissipated"][10] > 0
    late = pressed(force=["120 N", "120 N", "30 N"], tangential_force=["0 N", "25 N", "25 N"])
    assert "slides" in str(late.stopped)  # 30 N carry no more than 18 N


def test_a_sphere_is_pressed_to_and_fro():
    """requirement: without tangential loads an axisymmetric model has a history too."""
    history = {"time": ["0 s", "1 s"], "force": ["100 N", "500 N"]}
    changes = {
        "load": {"history": history},
        "analysis": {"type": "fretting", "increments": 4},
        "contact": {"friction": 0.3},
    }
    result = solved(SPHERE, changes, "mesh.degree=3", "mesh.elements=12")
    table = columns(result)
    assert table["max_pressure"][8] / table["max_pressure"][4] == pytest.approx(
        5 ** (1 / 3), rel=5e-2
    )
    assert result.summary["tangential_force_N"] == 0.0
    assert result.summary["equilibrium_relative_error"] < 1e-9


# ---- from the command line ----


def test_full_sliding_from_the_command_line(tmp_path, capsys):
    """requirement: exit code 2, one line, the results up to there with status failed, and what a
    longer history could go on from.
    """
    history = {"time": ["0 s", "1 s"], "tangential_force": ["0 N", "100 N"]}
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    changes = {"load.history": history, "analysis.output_times": ["0.2 s"]}
    file.write_text(tomli_w.dumps(tables(FRETTING, changes)), encoding="utf-8")
    small = [f"--set={text}" for text in (*SMALL, "analysis.increments=5")]
    assert main(["run", str(file), "-o", str(folder), "--no-pictures", *small]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: contact: body 1 slides")
    status = json.loads((folder / "run.json").read_text())
    assert status["status"] == "failed"
    assert status["message"] in line
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["time_s"] < 1.0
    assert {path.name for path in folder.iterdir()} == {
        "summary.json",
        "run.json",
        "checkpoint.npz",
        "case.resolved.toml",
        "fields.vtu",
        "interface.csv",
        "profile.csv",
        "interface_0.2.csv",
        "friction.csv",
        "friction_0.2.csv",
        "loads.csv",
    }
    with (folder / "loads.csv").open() as rows:
        last = list(csv.DictReader(rows))[-1]
    assert float(last["time_s"]) == pytest.approx(summary["time_s"], rel=1e-12)
    assert float(last["tangential_force_N"]) == pytest.approx(summary["tangential_force_N"])


def slid(**history):
    """Pushed across the press from one instant to the next."""
    changes = {"load.history": {"time": ["0 s", "1 s"]} | history, "analysis.output_times": []}
    return solved(FRETTING, changes, *SMALL, "analysis.increments=4")


def test_the_limit_of_a_round_face():
    """requirement: the force that is said to be carried is that of sliding, not yet displaced."""
    near, far = (
        slid(tangential_displacement=["0 um", f"{d} um"]).friction.rows[-1].tangential_force
        for d in (5, 10)
    )
    refused = str(slid(tangential_force=["0 N", "100 N"]).stopped)
    carried = float(re.search(r"carries ([\d.e+]+) N", refused).group(1))
    assert carried == pytest.approx(2 * near - far, rel=2e-5)


def test_the_interface_after_sliding_back():
    """requirement: gap, area and friction force of a body that has moved across the press."""
    moved = slid(tangential_displacement=["0 um", "-10 um"])
    last, i = moved.friction.rows[-1], moved.interface
    assert moved.summary["friction_force_N"] == pytest.approx(-last.tangential_force, rel=1e-12)
    assert last.contact_area == pytest.approx(i.weight[i.pressure > 0].sum(), rel=1e-12)
    assert last.contact_area < 0.9 * i.weight.sum()
    pressing = i.pressure > 0.2 * i.pressure.max()
    assert np.abs(i.gap[pressing]).max() < 2e-3 * last.approach
