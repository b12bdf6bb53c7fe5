"""Temperatures in time: balance, courses of load and speed, order, instability, steadiness."""

import csv
import json

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.output import tables as csv_tables
from thermowear.reference.instability import SlidingRod
from thermowear.simulation.heat.heat_steps import HeatSteps
from thermowear.simulation.interface.interface_problem import interface_problem
from thermowear.simulation.interface.sdirk import advance

from ..case.starter import GONE, solved, tables
from ..systems import prepared

STOP, BLOCKS, PUNCH = "disk-brake-stop", "stacked-blocks", "annular-punch"
COARSE = ("mesh.degree=3", "mesh.elements=5")
COLD = 293.15


def column(rows, name):
    return np.array([getattr(row, name) for row in rows])


@pytest.fixture(scope="module")
def stop():
    """The braking stop, until it has cooled for a while."""
    return solved(STOP, None, *COARSE, "analysis.end_time=30 s")


def test_heat_is_kept_in_every_step(stop):
    """requirement: friction heat is stored or lost, to rounding, at every moment."""
    made, stored, lost = (column(stop.heat, f"heat_{what}") for what in ("in", "stored", "lost"))
    np.testing.assert_allclose(stored + lost, made, rtol=1e-10, atol=1e-9)
    assert column(stop.heat, "balance_error").max() < 1e-10
    time, power = column(stop.heat, "time"), column(stop.heat, "friction_power")
    assert made[-1] == pytest.approx(np.trapezoid(power, time), rel=1e-3)
    assert lost[-1] > 100.0
    assert np.all(np.diff(lost) >= 0)


def test_hottest_before_the_end_of_the_stop(stop):
    """requirement: the peak comes before the car stands; then the brake only cools."""
    summary, time = stop.summary, column(stop.history, "time")
    hottest = column(stop.history, "max_temperature")
    assert 1.0 < summary["peak_temperature_time_s"] < 3.0
    assert summary["peak_temperature_K"] == hottest.max()
    assert hottest.max() - COLD > 100.0
    assert np.all(np.diff(hottest[time >= 4.0]) < 0.1)  # a little more where the pads let go
    assert hottest[-1] < hottest[time == 4.0] - 15.0
    for body in (1, 2):
        largest, mean = (column(stop.heat, f"{k}_temperature_{body}") for k in ("max", "mean"))
        assert np.all(largest >= mean)
    both = np.maximum(*(column(stop.heat, f"max_temperature_{body}") for body in (1, 2)))
    np.testing.assert_allclose(both, hottest)


def test_summary_is_the_last_row(stop):
    for key in ("heat_in", "heat_stored", "heat_lost"):
        assert stop.summary[f"{key}_J"] == getattr(stop.heat[-1], key)
    assert stop.summary["heat_balance_relative_error"] == stop.heat[-1].balance_error


def test_the_way_slid_is_the_integral_of_the_speed(stop):
    """requirement: v0 (t - t²/8 s) while the disk slows down in 4 s, nothing after."""
    time, slid = column(stop.history, "time"), column(stop.history, "sliding_distance")
    speed, t = column(stop.heat, "speed"), np.minimum(time, 4.0)
    np.testing.assert_allclose(slid, speed[0] * (t - t**2 / 8), rtol=1e-12)
    np.testing.assert_allclose(speed, speed[0] * (1 - t / 4), atol=1e-12)
    worn = column(stop.history, "wear_volume_1")
    assert np.all(np.diff(worn[time <= 4.0]) > 0)
    assert np.ptp(worn[time >= 4.0]) == 0.0


def test_loads_follow_their_history(stop):
    time = column(stop.heat, "time")
    expected = np.interp(time, [0.0, 0.2, 4.5, 5.0], [0.0, 7900.0, 7900.0, 0.0])
    np.testing.assert_allclose(column(stop.heat, "normal_force"), expected, rtol=1e-9, atol=1e-6)
    assert {0.2, 4.0, 4.5, 5.0} <= set(time)


def test_pads_that_let_go(stop):
    """requirement: nothing presses, the holder stays, both bodies go on cooling by themselves."""
    apart = [row for row in stop.history if row.time >= 5.0]
    assert all(row.max_pressure == row.contact_area == 0.0 for row in apart)
    before = stop.history[-len(apart) - 1]
    assert {row.approach for row in apart} == {apart[0].approach}
    assert apart[0].approach == pytest.approx(before.approach, abs=2e-6)
    assert abs(apart[0].approach) > 5e-6
    assert not stop.interface.heat_flux_1.any()
    after = [row for row in stop.heat if row.time >= 5.0]
    assert len({row.heat_in for row in after}) == 1
    # a pad that insulates has a hot face; apart from the disk it cools faster
    assert after[-1].mean_temperature_1 < after[-1].mean_temperature_2 - 10.0


def test_hot_bodies_that_nothing_presses_are_in_equilibrium():
    """requirement: reactions of a disk that expands freely are rounding, and so is their sum."""
    insulated = ("heat.partition=0", "heat.cooling={}", "heat.conductance=1e-3 W/(m^2 K)")
    result = solved(STOP, None, *COARSE, *insulated, "analysis.end_time=5000 s")
    assert result.stopped is None
    assert result.summary["max_temperature_K"] - COLD > 30.0
    assert result.interface.pressure.max() == 0.0


def test_steps_are_efficient(monkeypatch):
    """requirement: no tiny steps to begin with, few sizes, few steps."""
    sizes = []
    make = HeatSteps.operators_within

    def counted(steps, step):
        sizes.append(step)
        return make(steps, step)

    monkeypatch.setattr(HeatSteps, "operators_within", counted)
    result = solved(STOP, None, *COARSE)
    assert len(result.history) < 80
    assert result.history[1].step > 1e-4
    assert len(sizes) == len(set(sizes)) <= 20


@pytest.mark.slow
def test_tolerance_rules_the_error():
    """requirement: a tighter tolerance moves temperatures and wear by no more than promised."""

    def after_a_second(tolerance):
        found = solved(
            STOP,
            {"analysis.output_times": ["1 s"]},
            *COARSE,
            "analysis.end_time=1.5 s",
            f"analysis.tolerance={tolerance}",
        ).outputs[1.0]
        return found.temperature_1, found.wear_1

    exact = after_a_second(1e-6)
    for tolerance, allowed in ((1e-2, 1e-2), (1e-3, 1e-3)):
        for found, known in zip(after_a_second(tolerance), exact, strict=True):
            assert np.abs(found - known).max() < allowed * np.ptp(np.append(known, known * 0))


def test_second_order():
    """requirement: order >= 1.9 with contact, wear and heat together, in steps of one size."""
    case = tw.load(tables(STOP), (*COARSE, "mesh.degree=2"))
    problem = interface_problem(prepared(case))

    def march(state, begin, end, steps):
        step = (end - begin) / steps
        for k in range(steps):
            state = advance(problem, state, begin + k * step, step)
        return state

    warm = march(march(problem.start(), 0.0, 0.2, 16), 0.2, 0.5, 32)
    exact = march(warm, 0.5, 1.5, 96)
    errors = np.array(
        [
            [
                np.abs(np.subtract(found.faces.rise, exact.faces.rise)).max(),
                np.abs(found.pressure - exact.pressure).max(),
                np.abs(found.worn - exact.worn).max(),
            ]
            for found in (march(warm, 0.5, 1.5, steps) for steps in (4, 8, 16))
        ]
    )
    assert np.all(np.log2(errors[:-1] / errors[1:]) > 1.9)
    assert np.all(np.log2(errors[:-1] / errors[1:]) < 2.3)


# ---- histories ----

CYCLE = {
    "load": {
        "history": {
            "time": ["0 s", "1 s", "6 s", "7 s", "20 s"],
            "force": ["0 N", "3 kN", "3 kN", "0 N", "0 N"],
            "repeat": True,
        }
    },
    "motion": {"angular_velocity": "40 rad/s"},
    "analysis.output_times": ["10 s"],
}


def test_duty_cycle():
    """requirement: released to 0 N between, the brake cools, and takes up its work again."""
    result = solved(STOP, CYCLE, *COARSE, "analysis.end_time=27 s", "analysis.tolerance=3e-3")
    assert result.stopped is None
    time, made = column(result.heat, "time"), column(result.heat, "heat_in")
    pressed = (time % 20 > 0) & (time % 20 < 7)
    force = column(result.heat, "normal_force")
    assert np.all((force > 0) == pressed)
    at = {t: result.heat[int(np.flatnonzero(time == t)[0])] for t in (7.0, 20.0, 27.0)}
    assert at[7.0].heat_in == at[20.0].heat_in
    assert at[20.0].max_temperature_1 < at[7.0].max_temperature_1 - 20.0
    assert at[27.0].heat_in / at[7.0].heat_in == pytest.approx(2.0, rel=1e-2)
    assert at[27.0].mean_temperature_2 > at[7.0].mean_temperature_2 + 10.0
    assert column(result.heat, "balance_error").max() < 1e-10
    assert np.all(np.diff(made) >= 0)
    apart = result.outputs[10.0]
    assert not apart.pressure.any()
    assert not apart.heat_flux_1.any()
    assert not apart.wear_rate_1.any()
    approach = [row.approach for row in result.history if 7.0 <= row.time <= 20.0]
    assert len(set(approach)) == 1


def test_faces_apart_may_exchange_heat():
    """requirement: across the gap, by its conductance; what one gets the other loses."""
    gap = {**CYCLE, "heat.gap_conductance": "200 W/(m^2 K)"}
    result = solved(STOP, gap, *COARSE, "analysis.end_time=10 s", "analysis.tolerance=3e-3")
    i = result.interface
    np.testing.assert_allclose(i.heat_flux_1, 200 * (i.temperature_2 - i.temperature_1), rtol=1e-8)
    np.testing.assert_allclose(i.heat_flux_2, -i.heat_flux_1, rtol=1e-8)
    assert np.abs(i.heat_flux_1).max() > 100.0


def test_intermittent_sliding():
    """requirement: while the disk stands it neither heats nor wears, but stays pressed."""
    history = {"time": ["0 s", "1 s", "1.5 s", "3 s", "3.5 s"], "factor": [1, 1, 0, 0, 1]}
    changes = {
        "load": {"force": "3 kN"},
        "motion.history": {**history, "repeat": True},
        "analysis.output_times": [],
    }
    result = solved(STOP, changes, *COARSE, "analysis.end_time=7 s")
    time = column(result.heat, "time")
    stands = (time % 3.5 > 1.5) & (time % 3.5 <= 3.0)
    assert np.all((column(result.heat, "friction_power") == 0.0)[stands])
    assert np.all(column(result.history, "max_pressure") > 0)
    for values in (column(result.heat, "heat_in"), column(result.history, "wear_volume_1")):
        change = np.diff(values)
        assert np.all(change[stands[1:]] == 0.0)
        assert np.all(change[~stands[1:]] > 0.0)
    # 1 s at full speed and half a second down and up again, each period
    slid, speed = result.history[-1].sliding_distance, result.heat[0].speed
    assert slid == pytest.approx(2 * 1.5 * speed, rel=1e-12)


# ---- closed forms ----

ROD = SlidingRod(0.05, 2.1e11, 1.2e-5, 50.0, 7800 * 474.0, 0.3)


def rod(speed, **changes):
    """A column held between its cold top and a rigid wall that insulates."""
    return {
        "geometry": {
            "type": BLOCKS,
            "width": "10 mm",
            "upper_height": "50 mm",
            "lower_height": "5 mm",
            "thickness": "10 mm",
        },
        "bodies.upper": {
            "young_modulus": "210 GPa",
            "poisson_ratio": 0.0,
            "conductivity": "50 W/(m K)",
            "expansion": "1.2e-5 1/K",
            "density": "7800 kg/m^3",
            "specific_heat": "474 J/(kg K)",
        },
        "bodies.lower": {
            "young_modulus": "1e8 GPa",
            "poisson_ratio": 0.0,
            "conductivity": "0.01 W/(m K)",
            "expansion": "0 1/K",
            "density": "8000 kg/m^3",
            "specific_heat": "500 J/(kg K)",
        },
        "contact.friction": 0.3,
        "load": {"approach": "1 um"},
        "motion.velocity": f"{speed} m/s",
        "wear": GONE,
        "heat": {
            "transient": True,
            "partition": 1.0,
            "conductance": "1e-6 W/(m^2 K)",
            "temperature": {"upper_top": "20 degC"},
        },
        "analysis": {
            "type": "transient",
            "end_time": "450 s",
            "tolerance": 1e-4,
            "output_times": ["250 s", "350 s"],
        },
        **changes,
    }


def grown(result):
    """Rate at which the pressure of the last steps has grown [1/s].

    As in a geometric series: what does not grow is left out.
    """
    time, pressure = (column(result.history, name) for name in ("time", "max_pressure"))
    late = [int(np.abs(time - t).argmin()) for t in (250.0, 350.0, 450.0)]
    assert time[late].tolist() == [250.0, 350.0, 450.0]
    first, second = np.diff(pressure[late])
    return np.log(second / first) / 100.0


def test_instability_grows_as_it_should():
    """requirement: the rod of 3.10, at twice the critical speed by 0.0127 a second."""
    result = solved(BLOCKS, rod(2 * ROD.critical_speed))
    assert result.stopped is None
    expected = ROD.growth_rate(2 * ROD.critical_speed)
    assert expected.real == pytest.approx(0.0127, rel=2e-3)
    assert grown(result) == pytest.approx(expected.real, rel=2e-3)


def test_wear_holds_instability_back():
    """requirement: the rod of 3.10 with k_w = 1e-8 1/MPa grows by 0.012256 a second."""
    worn = SlidingRod(*(getattr(ROD, k) for k in list(ROD.__dict__)[:6]), wear=1e-14)
    wear = {"upper": {"coefficient": "1e-8 1/MPa", "per": "pressure"}}
    result = solved(BLOCKS, rod(2 * ROD.critical_speed, wear=wear))
    expected = worn.growth_rate(2 * ROD.critical_speed)
    assert expected.real < 0.98 * ROD.growth_rate(2 * ROD.critical_speed).real
    assert grown(result) == pytest.approx(expected.real, rel=2e-3)


def test_below_the_critical_speed_it_settles():
    speed = ROD.critical_speed / 2
    result = solved(BLOCKS, rod(speed), "analysis.end_time=2000 s")
    expected = ROD.pressure(1e-6, speed)
    assert result.summary["max_pressure_Pa"] == pytest.approx(expected, rel=1e-3)
    # what goes out where the temperature is given counts as lost
    assert result.heat[-1].heat_lost > 0.5 * result.heat[-1].heat_in
    assert column(result.heat, "balance_error").max() < 1e-9


def test_runaway_is_called_by_its_name(tmp_path, capsys):
    """requirement: what was computed is kept, exit code 2, and the reason is the instability."""
    file, folder = tmp_path / "rod.toml", tmp_path / "results"
    case = tables(BLOCKS, rod(2 * ROD.critical_speed))
    file.write_text(tomli_w.dumps(case), encoding="utf-8")
    late = ["--set=analysis.end_time=4000 s", "--set=analysis.tolerance=1e-3", "--no-pictures"]
    assert main(["run", str(file), "-o", str(folder), *late]) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "thermal runaway" in said
    assert "thermoelastic instability" in said
    heat = csv_tables.read(folder / "heat.csv")
    assert heat["max_temperature_1"][-1] > 5000.0
    assert 400.0 < heat["time"][-1] < 600.0
    assert json.loads((folder / "run.json").read_text())["status"] == "failed"
    assert json.loads((folder / "summary.json").read_text())["time_s"] == heat["time"][-1]


def test_a_failing_step_tells_of_instability():
    """requirement: whatever ends the run while it runs away."""
    few = ("analysis.end_time=2000 s", "analysis.tolerance=1e-3", "analysis.max_steps=32")
    result = solved(BLOCKS, rod(2 * ROD.critical_speed), *few)
    assert "max_steps" in str(result.stopped)
    assert "thermoelastic instability" in str(result.stopped)
    stable = solved(BLOCKS, rod(ROD.critical_speed / 2), *few, "analysis.max_steps=5")
    assert "max_steps" in str(stable.stopped)
    assert "instability" not in str(stable.stopped)


def test_a_small_hot_body_cools_evenly():
    """requirement: exp(-h t/(ρ c L)) where conduction is fast, from an initial temperature."""
    case = rod(
        1e-9,
        heat={
            "transient": True,
            "initial": "120 degC",
            "conductance": "1e-6 W/(m^2 K)",
            "cooling": {"upper_top": "1 W/(m^2 K)"},
        },
        load={"force": "1 N"},
    )
    result = solved(BLOCKS, case, "analysis.end_time=1e5 s")
    time = column(result.heat, "time")
    expected = 100 * np.exp(-time / (7800 * 474 * 0.05))
    found = column(result.heat, "mean_temperature_1") - COLD
    np.testing.assert_allclose(found, expected, rtol=2e-3)
    # the other one, insulated, keeps its heat
    assert result.heat[-1].mean_temperature_2 - COLD == pytest.approx(100.0, rel=1e-5)
    lost = 7800 * 474 * 0.05 * 0.01 * 0.01 * (100 - found[-1])
    assert result.summary["heat_lost_J"] == pytest.approx(lost, rel=2e-3)
    assert result.summary["heat_stored_J"] == pytest.approx(-lost, rel=2e-3)


def test_it_ends_where_the_quasi_steady_running_in_ends():
    """requirement: pressure, temperature and worn depth of heat that has no memory, to 1e-3."""
    stored = {"density": "7800 kg/m^3", "specific_heat": "460 J/(kg K)"}
    case = tables(PUNCH, {f"bodies.punch.{key}": value for key, value in stored.items()})
    case["analysis"] = {"type": "transient", "end_time": "20000 s", "tolerance": 1e-3}
    found = {}
    for transient in (True, False):
        case["heat"]["transient"] = transient
        found[transient] = tw.run(tw.load(case, ("mesh.degree=4", "mesh.elements=6")))
    slow, quick = (found[key].interface for key in (True, False))
    assert np.abs(slow.pressure - quick.pressure).max() < 1e-3 * quick.pressure.max()
    hottest = quick.temperature_1.max() - COLD
    assert hottest > 70.0
    assert np.abs(slow.temperature_1 - quick.temperature_1).max() < 1e-3 * hottest
    assert np.abs(slow.shape - quick.shape).max() < 1e-3 * np.ptp(quick.shape)
    # and both where the principle has the steady state of the same interface
    assert all(result.summary["distance_from_steady"] < 1e-3 for result in found.values())
    # on the way there it was another one
    assert len(found[True].heat) > 20
    assert found[False].heat == []


# ---- files ----


@pytest.mark.usefixtures("bodies_not_drawn")
def test_files(tmp_path):
    """requirement: heat.csv has a row a step in the agreed columns, heat.png shows it."""
    file, folder = tmp_path / "stop.toml", tmp_path / "results"
    file.write_text(tomli_w.dumps(tables(STOP)), encoding="utf-8")
    small = [f"--set={text}" for text in (*COARSE, "analysis.end_time=6 s")]
    assert main(["run", str(file), "-o", str(folder), *small]) == 0
    with (folder / "heat.csv").open(encoding="utf-8") as text:
        header, *rows = csv.reader(text)
    assert header == [
        "time_s", "speed_m_per_s", "normal_force_N", "friction_power_W", "heat_in_J",
        "heat_stored_J", "heat_lost_J", "balance_relative_error", "max_temperature_1_K",
        "max_temperature_2_K", "mean_temperature_1_K", "mean_temperature_2_K",
    ]  # fmt: skip
    history = csv_tables.read(folder / "history.csv")
    assert [float(row[0]) for row in rows] == history["time"].tolist()
    assert len(next(csv.reader((folder / "history.csv").open(encoding="utf-8")))) == 15
    assert (folder / "heat.png").stat().st_size > 20_000
    assert main(["run", str(file), "-o", str(folder), "--overwrite", "--no-pictures", *small]) == 0
    assert not (folder / "heat.png").exists()
