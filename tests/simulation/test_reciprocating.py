"""Sliding to and fro, from the case to the results."""

import csv
import json
import signal
from dataclasses import replace

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.simulation import Observer
from thermowear.simulation.cycles.reciprocating_problem import ReciprocatingProblem
from thermowear.simulation.cycles.stroke import moved, positions
from thermowear.simulation.from_case import analysis_of
from thermowear.simulation.time_loop import moments

from ..case.starter import RECIPROCATING, solved, tables
from ..systems import built

HALF, AMPLITUDE, THICKNESS, FORCE, FREQUENCY = 5e-3, 5e-3, 1e-2, 2e3, 2.0
SPEED = 4 * AMPLITUDE * FREQUENCY
K = 1e-13
COARSE = ("mesh.degree=2", "mesh.elements=8", "analysis.positions=6")
LAW = {"coefficient": "1e-7 1/MPa", "per": "pressure"}


def close(value, rel=1e-6):
    """Equal numbers, however small: pytest's own allowance of 1e-12 would hide volumes."""
    return pytest.approx(value, rel=rel, abs=0.0)


def run(changes=None, *overrides, cycles=200, **more):
    settings = {"analysis": {"type": "reciprocating", "cycles": cycles, "positions": 6}}
    small = ("mesh.degree=2", "mesh.elements=8")
    return solved(RECIPROCATING, settings | (changes or {}), *small, *overrides, **more)


def case_of(changes=None, *overrides):
    return tw.load(tables(RECIPROCATING, changes), (*COARSE, *overrides))


def stroke_of(case):
    """System of a case, and its positions."""
    system = built(case)
    return system, positions(system, analysis_of(case))


@pytest.fixture(scope="module")
def worn():
    changes = {"analysis.output_times": ["10 s", "50 s"], "analysis.positions": 6}
    return run(changes | {"analysis.cycles": 200})


# ---- the stroke ----


def test_positions_are_a_cycle():
    """requirement: they take the whole period and the whole way, at every place the right speed."""
    for friction, ways in ((0.0, 1), (0.2, 2)):
        _, stroke = stroke_of(case_of({"contact.friction": friction}))
        assert len(stroke) == 6 * ways
        assert sum(p.share for p in stroke) == close(1.0, rel=1e-12)
        assert sum(p.share * p.speed for p in stroke) == close(SPEED, rel=1e-12)
        assert sum(p.length for p in stroke) == close(2 * AMPLITUDE * ways, rel=1e-12)
        for p in stroke:
            exact = 2 * np.pi * FREQUENCY * np.sqrt(AMPLITUDE**2 - p.offset**2)
            assert p.speed == pytest.approx(exact, abs=0.12 * np.pi / 2 * SPEED)


def test_a_moved_body_is_where_it_should_be():
    """requirement: points move, weights and gap stay, friction drags against the sliding; the
    holder's rotation is about the moved pivot.
    """
    system = built(case_of({"holder.free": ["z", "rotation"], "load.point": ["1 mm"]}))
    for way in (1, -1):
        there = moved(system, np.array([2e-3]), way)
        assert there.pairing.points[0, 0] == close(-3e-3)
        assert there.pairing.points[-1, 0] == close(7e-3)
        assert there.weights.sum() == close(2 * HALF * THICKNESS)
        assert there.traction_direction[:, 0] == close(0.2 * way)
        assert there.traction_direction[:, 1] == close(-1.0)
        ends = there.holder.closure[[0, -1], 1]
        assert np.abs(ends) == close(HALF, rel=1e-12)
        assert there.holder.load == close(system.holder.load)


def test_a_stroke_beyond_the_face_of_the_strip_is_a_fault():
    """requirement: one line that names the key and says what to do."""
    message = r"motion.amplitude: .*leaves strip_face.*longer face strip_face is needed"
    with pytest.raises(tw.CaseError, match=message):
        stroke_of(case_of({"motion.amplitude": "6 mm"}))


# ---- volumes and tables ----


def test_volumes_are_those_of_the_way(worn):
    """requirement: V = k F s for both bodies, at every step; tables and summary agree."""
    rows = worn.history
    time = np.array([row.time for row in rows])
    for body in (1, 2):
        volumes = [getattr(row, f"wear_volume_{body}") for row in rows]
        np.testing.assert_allclose(volumes, K * FORCE * SPEED * time, rtol=1e-10, atol=1e-25)
        assert worn.summary[f"wear_volume_{body}_m3"] == volumes[-1]
    assert [row.sliding_distance for row in rows] == close(SPEED * time)
    track = worn.track.last
    volume = np.trapezoid(track.wear_2, track.x) * THICKNESS
    assert volume == close(K * FORCE * SPEED * 100, rel=1e-9)
    rate = np.trapezoid(track.wear_rate_2, track.x) * THICKNESS
    assert rate == close(K * FORCE * SPEED, rel=1e-9)
    i = worn.interface
    assert i.weight @ i.wear_1 == close(K * FORCE * SPEED * 100, rel=1e-9)
    assert i.weight @ i.wear_rate_1 == close(K * FORCE * SPEED, rel=1e-9)
    assert track.x[[0, -1]] == close([-1e-2, 1e-2])


def test_the_interface_is_that_of_the_middle(worn):
    """requirement: the strip's depth seen there; load, gap and balance."""
    i, track = worn.interface, worn.track.last
    np.testing.assert_allclose(i.wear_2, np.interp(i.x, track.x, track.wear_2), rtol=1e-9)
    assert i.weight @ i.pressure == close(FORCE, rel=1e-9)
    assert worn.summary["equilibrium_relative_error"] < 1e-9
    closed = i.pressure > 0.3 * i.pressure.max()
    assert np.abs(i.gap[closed]).max() < 5e-7
    assert i.gap[~closed].min() > -5e-7
    assert worn.summary["cycles"] == close(200)
    assert worn.summary["friction_force_N"] == close(0.2 * FORCE)


def test_output_times_are_hit(worn):
    """requirement: interface and track at the output times."""
    assert set(worn.outputs) == set(worn.track.outputs) == {10.0, 50.0}
    depths = [worn.track.outputs[t].wear_2.max() for t in (10.0, 50.0)]
    assert 0 < depths[0] < depths[1] < worn.track.last.wear_2.max()
    for time, track in worn.track.outputs.items():
        volume = np.trapezoid(track.wear_2, track.x) * THICKNESS
        assert volume == close(K * FORCE * SPEED * time, rel=1e-9)


def test_cycles_and_jumps_of_the_wear_table(worn):
    """requirement: wear.cycles ends it as analysis.cycles does; no step is longer than max_jump;
    steps of many cycles, each done again in halves, find the shape that short ones find.
    """
    settings = {"analysis": {"type": "reciprocating", "positions": 6}, "wear.cycles": 200}
    small = ("mesh.degree=2", "mesh.elements=8")
    same, short = (
        solved(RECIPROCATING, settings | more, *small) for more in ({}, {"wear.max_jump": 9})
    )
    assert same.summary["time_s"] == 200 / FREQUENCY
    assert same.summary["wear_volume_1_m3"] == close(worn.summary["wear_volume_1_m3"], rel=1e-3)
    steps = [row.step for row in short.history]
    assert max(steps) <= 9 / FREQUENCY * (1 + 1e-12)
    assert max(row.step for row in same.history) > 18 / FREQUENCY
    assert short.summary["wear_volume_1_m3"] == close(same.summary["wear_volume_1_m3"], rel=1e-3)
    tracks = [result.track.last.wear_2 for result in (same, short)]
    off = np.abs(np.subtract(*tracks)).max() / tracks[1].max()
    assert off < 2e-4
    assert off < sum(row.error for row in same.history) < 1e-2


def test_both_ways_are_mirror_images(worn):
    """requirement: what friction does one way, it undoes the other way."""
    track, i = worn.track.last, worn.interface
    np.testing.assert_allclose(track.wear_2, track.wear_2[::-1], rtol=1e-6)
    np.testing.assert_allclose(i.wear_1, i.wear_1[::-1], rtol=1e-6)
    assert np.abs(i.pressure - i.pressure[::-1]).max() > 0.2 * i.pressure.mean()


@pytest.mark.parametrize("b", [0.5, 2.0])
def test_other_exponents(b):
    """requirement: b = 0.5 and 2; the depths are k p^b of each position's own pressure, summed."""
    law = {"coefficient": f"1e-7 1/MPa^{b}", "per": "pressure", "pressure_exponent": b}
    result = run({"wear": {"punch": law, "strip": law}}, cycles=20)
    assert result.stopped is None
    volumes = [result.summary[f"wear_volume_{body}_m3"] for body in (1, 2)]
    assert volumes[0] == close(volumes[1], rel=1e-9)
    mean = 1e-7 * 20**b * 2 * HALF * THICKNESS * SPEED * 10  # a uniform pressure
    assert volumes[0] < mean if b < 1 else volumes[0] > mean
    assert volumes[0] == close(mean, rel=0.6)


def test_the_velocity_counts_where_it_is():
    """requirement: a = 2 wears with the mean square of the speed, (A ω)²/2."""
    law = {"coefficient": "1e-7 s/m/MPa", "per": "pressure", "velocity_exponent": 2.0}
    result = run({"wear": {"punch": law}}, "analysis.positions=12", cycles=2)
    square = (2 * np.pi * FREQUENCY * AMPLITUDE) ** 2 / 2
    assert result.summary["wear_volume_1_m3"] == close(K * FORCE * square, rel=2e-2)


# ---- what is known of the end ----


def test_wear_becomes_uniform():
    """requirement: W1' = k F v/(2 h t) along the punch, W2' = k F v/(2 (h + A) t) along the trough
    but for the ends of the stroke; the summary says how near.
    """
    settings = {"type": "reciprocating", "until": "steady", "positions": 12}
    fine = ("mesh.degree=3", "mesh.elements=12")
    result = run({"analysis": settings | {"steady_tolerance": 0.04}}, *fine)
    assert 0.02 < result.summary["distance_from_steady"] <= 0.04
    assert result.stopped is None
    i, track = result.interface, result.track.last
    uniform = K * FORCE * SPEED / (2 * HALF * THICKNESS)
    inner = np.abs(i.x) < 0.8 * HALF
    np.testing.assert_allclose(i.wear_rate_1[inner], uniform, rtol=2e-2)
    inner = np.abs(track.x) < 0.8 * (HALF + AMPLITUDE)
    np.testing.assert_allclose(track.wear_rate_2[inner], uniform / 2, rtol=5e-2)
    assert result.summary["mean_wear_rate_1_m_per_s"] == close(uniform, rel=1e-9)
    assert result.summary["mean_wear_rate_2_m_per_s"] == close(uniform / 2, rel=1e-9)


def test_a_steady_state_that_the_mesh_does_not_resolve():
    """requirement: no endless run, an error that says what to change, and the results so far."""
    settings = {"type": "reciprocating", "until": "steady", "positions": 4}
    coarse = ("mesh.degree=1", "mesh.elements=4")
    result = run({"analysis": settings | {"steady_tolerance": 1e-4}}, *coarse)
    assert "steady_tolerance" in str(result.stopped)
    assert 1e-3 < result.interface.wear_1.max() < 1e-1


def test_a_punch_that_alone_wears_fits_everywhere():
    """requirement: the pressure is uniform, F/(2 h t), in every position, but at the edges."""
    changes = {"wear": {"punch": LAW}, "contact": {}}
    case = case_of(changes, "mesh.degree=4", "mesh.elements=12")
    problem = ReciprocatingProblem(*stroke_of(case), np.ones(1))
    *_, last = moments(problem, replace(analysis_of(case), end_time=1e3), None)
    pressure = last.state.pressure / (FORCE / (2 * HALF * THICKNESS))
    inner = slice(pressure.shape[1] // 6, -(pressure.shape[1] // 6))
    np.testing.assert_allclose(pressure[:, inner], 1.0, rtol=2e-2)
    middle = pressure.shape[1] // 2
    np.testing.assert_allclose(pressure[:, middle], 1.0, rtol=1e-3)


def test_short_strokes_are_wear_in_place():
    """requirement: A << h is the running-in of both faces at the mean speed."""
    mesh = {"geometry.stroke": "0.5 mm", "contact": {}}
    fine = ("mesh.degree=2", "mesh.elements=24")
    motion = {"amplitude": "0.05 mm", "frequency": "200 Hz"}
    settings = {"type": "reciprocating", "end_time": "5 s", "positions": 6}
    short = run(mesh | {"motion": motion, "analysis": settings}, *fine)
    settings = {"type": "transient", "end_time": "5 s"}
    known = run(mesh | {"motion": {"velocity": "40 mm/s"}, "analysis": settings}, *fine)
    inner = np.linspace(-0.7, 0.7, 9) * HALF
    for name in ("wear_1", "wear_2"):
        depths = [
            np.interp(inner, r.interface.x, getattr(r.interface, name)) for r in (short, known)
        ]
        np.testing.assert_allclose(*depths, rtol=2e-2, err_msg=name)
        assert np.ptp(depths[1]) > 0.03 * depths[1].mean()


def test_a_soft_layer_between_the_faces():
    """requirement: what lies between them yields to each point's own pressure."""
    soft = {"contact.compliance": "1e-12 m/Pa"}
    stiff, yielding = (run(changes, cycles=1) for changes in ({}, soft))
    further = yielding.summary["approach_m"] - stiff.summary["approach_m"]
    assert further == close(1e-12 * FORCE / (2 * HALF * THICKNESS), rel=0.2)
    assert yielding.history[0].max_pressure < 0.8 * stiff.history[0].max_pressure
    means = [result.history[-1].approach for result in (stiff, yielding)]
    assert means[1] - means[0] == close(further, rel=0.1)


def test_positions_converge():
    """requirement: twice as many positions change little."""
    few, many = (run(None, f"analysis.positions={n}", cycles=400) for n in (8, 16))
    x = np.linspace(-0.8, 0.8, 9) * (HALF + AMPLITUDE)
    depths = [np.interp(x, r.track.last.x, r.track.last.wear_2) for r in (few, many)]
    np.testing.assert_allclose(*depths, rtol=2e-2)


# ---- what ends early, and files ----


class Stopping(Observer):
    steps = 0

    def row(self, row, distance):
        self.steps += 1
        if self.steps == 6:
            signal.raise_signal(signal.SIGINT)


@pytest.mark.usefixtures("heeds_ctrl_c")
def test_an_interrupted_run_keeps_its_steps():
    """requirement: what was computed before Ctrl-C is kept."""
    result = run(observer=Stopping())
    assert isinstance(result.stopped, KeyboardInterrupt)
    assert len(result.history) == 6
    expected = K * FORCE * SPEED * result.history[-1].time
    assert result.summary["wear_volume_2_m3"] == close(expected, rel=1e-10)


def test_too_few_steps_are_an_error_with_results():
    """requirement: a run that fails keeps what was computed, and says what to change."""
    result = run(None, "analysis.max_steps=4")
    assert isinstance(result.stopped, tw.ComputationError)
    assert "max_steps" in str(result.stopped)
    assert result.history[-1].wear_volume_1 > 0


@pytest.mark.usefixtures("bodies_not_drawn")
def test_files_of_a_run(tmp_path, capsys):
    """requirement: track.csv and its picture, at the output times too."""
    file, folder = tmp_path / "case.toml", tmp_path / "results"
    changes = {"analysis.cycles": 20, "analysis.output_times": ["5 s"]}
    file.write_text(tomli_w.dumps(tables(RECIPROCATING, changes)), encoding="utf-8")
    small = [f"--set={text}" for text in COARSE]
    assert main(["run", str(file), "-o", str(folder), *small]) == 0
    assert "distance from steady" in capsys.readouterr().out
    summary = json.loads((folder / "summary.json").read_text())
    for name, time in (("track.csv", 10), ("track_5.csv", 5)):
        with (folder / name).open() as file:
            rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
        x, worn = (np.array([row[key] for row in rows]) for key in ("x_m", "wear_2_m"))
        assert np.trapezoid(worn, x) * THICKNESS == close(K * FORCE * SPEED * time)
    assert summary["wear_volume_2_m3"] == close(K * FORCE * SPEED * 10, rel=1e-9)
    assert (folder / "track.png").stat().st_size > 1000
