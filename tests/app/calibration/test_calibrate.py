"""Calibration of small running-ins: known values, units, conditions, and what is not determined."""

from __future__ import annotations

import sys
from itertools import permutations

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.batch.pool import ProcessPool
from thermowear.app.calibration.calibrate import problem_of, record_of, rows_of
from thermowear.calibration.candidate_run import Prediction
from thermowear.calibration.case_model import CaseModel
from thermowear.calibration.measurement import Measurement
from thermowear.calibration.readings import reading
from thermowear.calibration.solution import solve
from thermowear.inference import JointNormal, Parameter, ParameterSpace

from .rings import FRICTION, MU, TIMES, WEAR, K, rows_at_times, tables, truth, volumes, write


def calibrated(data=None, **calibrate):
    return tw.calibrate(tw.load(tables(**calibrate)), data)


def test_the_true_value_is_found(tmp_path):
    """requirement: exact data give the value they were made with, and the error of the data."""
    found = calibrated(volumes(tmp_path / "d.csv", truth()), parameters={"k": WEAR})
    assert found.values["k"] == pytest.approx(K, rel=1e-6)
    low, high = found.intervals()["k"]
    assert low < K < high
    # V = k F s: a relative error of 2 % of each of five volumes
    assert found.standard_errors["k"] == pytest.approx(0.02 / np.sqrt(5), rel=0.05)
    assert found.fit.chi2 == pytest.approx(0.0, abs=1e-4)
    assert found.notes() == []


def test_units_of_the_data_and_of_the_parameter(tmp_path):
    """requirement: other units of data and parameters give the same value and error."""
    expected = calibrated(volumes(tmp_path / "d.csv", truth(), 0.02), parameters={"k": WEAR})
    rows = rows_at_times(truth())
    draw = np.random.default_rng(1).normal(size=len(rows))
    values = [1e9 * r.wear_volume_1 * (1 + 0.02 * e) for r, e in zip(rows, draw, strict=True)]
    errors = [0.02e6 * row.wear_volume_1 for row in rows]
    head = "time [min]; wear volume 1 [mm^3]; wear volume 1 deviation [cm^3]"
    times = np.array(TIMES) / 60
    path = write(tmp_path / "other.csv", head, (times, values, errors))
    path.write_text(path.read_text().replace(",", ";"))
    per_pascal = WEAR | {"start": "1e-13 1/Pa", "lower": "1e-8 1/MPa", "upper": "1e-3 1/GPa"}
    found = calibrated(path, parameters={"k": per_pascal})
    assert found.values["k"] == pytest.approx(1e-6 * expected.values["k"], rel=1e-7)
    assert found.standard_errors["k"] == pytest.approx(expected.standard_errors["k"], rel=1e-6)


def test_wear_and_friction_from_volumes_and_torque(tmp_path):
    """requirement F3: a torque tells wear and friction apart; an executor gives the same values."""
    torque = [row.friction_torque / 1e3 for row in rows_at_times(truth())]
    write(tmp_path / "t.csv", "time [s], friction_torque [kN m]", (TIMES, torque))
    table = {
        "parameters": {"k": WEAR, "mu": FRICTION},
        "observations": {
            "depth": {"file": str(volumes(tmp_path / "d.csv", truth()))},
            "torque": {"file": str(tmp_path / "t.csv"), "deviation": "3 %"},
        },
    }
    found = calibrated(**table)
    assert found.values == pytest.approx({"k": K, "mu": MU}, rel=1e-5)
    assert found.identifiability.identified
    with ProcessPool(2) as pool:
        other = tw.calibrate(tw.load(tables(**table)), executor=pool, workers=2)
    assert other.values == pytest.approx(found.values, rel=1e-9)


def test_wear_and_friction_from_volumes_alone(tmp_path):
    """requirement F3: the combination that volumes determine, and a measurement that settles it."""
    path = volumes(tmp_path / "d.csv", truth(), 0.02)
    found = calibrated(path, parameters={"k": WEAR, "mu": FRICTION})
    (combination,) = found.identifiability.combinations
    assert combination.text == "k · mu^1.00"
    product = found.values["k"] * found.values["mu"]
    assert product == pytest.approx(K * MU, rel=0.03)
    assert combination.deviation == pytest.approx(0.02 / np.sqrt(5), rel=0.05)
    assert found.intervals()["k"] == (0.0, np.inf)
    told = " ".join(found.notes())
    assert "do not determine" in told
    assert "friction_torque" in told


def test_exponent_and_coefficient_from_one_load_and_from_two(tmp_path):
    """requirement F3: one load gives k p^b with the mean pressure; two loads give both."""
    ring = tables()
    ring["wear"]["punch"] |= {"coefficient": "5e-8 1/MPa", "per": "pressure"}
    parameters = {
        "k": {"start": 1e-7, "lower": 1e-10, "upper": 1e-5, "scale": "log"},
        "b": {"start": 1.1, "lower": 0.5, "upper": 2.0},
    }
    law = {"wear.punch.coefficient": "{k} 1/MPa^{b}", "wear.punch.pressure_exponent": "{b}"}
    files = {}
    for pressure in (50, 25):
        change = f'load.mean_pressure="{pressure} MPa"'
        run = tw.run(tw.load(ring, (change, 'analysis={type="steady"}')))
        rate = run.summary["rigid_wear_velocity_m_per_s"]
        head = "rigid_wear_velocity [nm/s]"
        files[pressure] = write(tmp_path / f"{pressure}.csv", head, ([1e9 * rate],))

    def observed(*pressures):
        return {
            f"at_{p}": {
                "file": str(files[p]),
                "deviation": "1 %",
                "set": {"load.mean_pressure": f"{p} MPa"},
            }
            for p in pressures
        }

    steady = ring | {"analysis": {"type": "steady"}}
    table = {"parameters": parameters, "set": law, "observations": observed(50)}
    one = tw.calibrate(tw.load(steady | {"calibrate": table}))
    (combination,) = one.identifiability.combinations
    slope = np.diff([np.log(steady_rate(one.values["b"] + h)) for h in (-1e-4, 1e-4)])[0] / 2e-4
    assert combination.text == f"k · {np.exp(slope):.3g}^b"
    assert "at another load.mean_pressure" in " ".join(one.notes())
    table |= {"observations": observed(50, 25)}
    two = tw.calibrate(tw.load(steady | {"calibrate": table}))
    assert two.identifiability.identified
    assert two.values == pytest.approx({"k": 5e-8, "b": 1.0}, rel=1e-5)
    # ln(rate) = ln k + b ln p at two pressures
    assert two.standard_errors["b"] == pytest.approx(0.01 * np.sqrt(2) / np.log(2), rel=1e-3)


def in_any_order(tmp_path, order, backwards, loads=(4, 9, 4), errors=(0.01, -0.02, 0.03)):
    """Calibration of ``V = k p^b t`` by tests at pressures [MPa], by a closed form for runs."""
    ring = tables()
    ring["wear"]["punch"] |= {"coefficient": "5e-8 1/MPa", "per": "pressure"}
    parameters = {
        "k": {"start": 1e-7, "lower": 1e-10, "upper": 1e-5, "scale": "log"},
        "b": {"start": 1.1, "lower": 0.5, "upper": 2.0},
    }
    law = {"wear.punch.coefficient": "{k} 1/MPa^{b}", "wear.punch.pressure_exponent": "{b}"}
    times = np.array([5.0, 20.0, 50.0])
    observations = {}
    for k in order:
        rows = [times, 3e-7 * loads[k] ** 0.8 * times * (1 + errors[k]), 1e-8 * times]
        head = "time [s], wear_volume_1 [mm^3], deviation [mm^3]"
        path = write(tmp_path / f"{k}.csv", head, [row[::-1] if backwards else row for row in rows])
        pressure = {"load.mean_pressure": f"{loads[k]} MPa"}
        observations[f"test_{k}"] = {"file": str(path), "set": pressure}

    def predicted(run):
        words = dict(change.split("=") for change in run.overrides)
        k = float(words["wear.punch.coefficient"].strip('"').partition(" ")[0])
        b = float(words["wear.punch.pressure_exponent"])
        load = 1e-6 * float(run.experiment.tables["load"]["mean_pressure"].removesuffix(" Pa"))
        each = [1e-9 * k * load**b * one.reading.times for one in run.experiment.measurements]
        numbers = {"friction_force": load * k}
        return Prediction(run.number, np.concatenate(each), (50.0,), np.zeros(2), numbers)

    table = {"parameters": parameters, "set": law, "observations": observations}
    problem = problem_of(tw.load(ring | {"calibrate": table}))
    runs = lambda groups: [predicted(run) for group in groups for run in group]  # noqa: E731
    return solve(problem, runs)


def test_the_order_of_observations_has_no_effect(tmp_path):
    """requirement: values, errors and each row, for any order of tests and of rows, to 1e-12.

    The reference is the least-squares line of ln V over ln p, the errors being small.
    """
    found = [
        in_any_order(tmp_path, order, backwards)
        for order in permutations(range(3))
        for backwards in (False, True)
    ]
    rate, load = 0.8 * np.log([4, 9, 4]) + np.log1p([0.01, -0.02, 0.03]), np.log([4, 9, 4])
    weight = 3e-7 * np.array([4.0, 9.0, 4.0]) ** 0.8  # of a logarithm, as deviations are equal
    b, ln_k = np.polyfit(load, rate, 1, w=weight)
    assert found[0].values == pytest.approx({"k": 3e-7 * np.exp(ln_k), "b": b}, rel=1e-3)
    rows = []
    for one in found:
        assert one.values == pytest.approx(found[0].values, rel=1e-12, abs=0.0)
        errors = found[0].standard_errors
        assert one.standard_errors == pytest.approx(errors, rel=1e-12, abs=0.0)
        assert one.fit.chi2 == pytest.approx(found[0].fit.chi2, rel=1e-12)
        records = rows_of(
            *(one.measurements, one.fit.predicted, one.deviations),
            *(one.fit.jacobian, one.normal, 0.95, one.fit.noise),
        )
        rows.append({(row["observation"], row["time_s"]): row for row in records})
        for row in records:
            assert row["predicted"] == pytest.approx(row["observed"], rel=0.05, abs=0.0)
    for own in rows[1:]:
        for key, row in own.items():
            numbers = {name: v for name, v in row.items() if isinstance(v, float)}
            expected = {name: rows[0][key][name] for name in numbers}
            assert numbers == pytest.approx(expected, rel=1e-11, abs=0.0)


def steady_rate(b):
    """Steady wear rate of the ring by k = 1 /MPa^b, from p = (V/(k ω r))^(1/b) and the force."""
    r = np.linspace(0.02, 0.12, 20001)
    ends = 50.0 * (r[-1] ** 2 - r[0] ** 2) / 2
    return (ends / np.trapezoid(r * (10.0 * r) ** (-1 / b), r)) ** b


def test_profile_at_a_time_and_distances(tmp_path):
    """requirement: profiles at a time, and depths at sliding distances."""
    run = truth()
    face = run.outputs[20.0]
    chosen = slice(2, -2, 5)
    head = "time [s], x [mm], wear_1 [um], deviation [um]"
    columns = (np.full_like(face.x, 20.0), 1e3 * face.x, 1e6 * face.wear_1, np.ones_like(face.x))
    write(tmp_path / "p.csv", head, [column[chosen] for column in columns])
    rows = rows_at_times(run)
    head = "sliding_distance [m], wear_volume_1 [mm^3], deviation [mm^3]"
    columns = (
        [row.sliding_distance for row in rows],
        [1e9 * row.wear_volume_1 for row in rows],
        np.ones(len(rows)),
    )
    write(tmp_path / "v.csv", head, columns)
    observations = {name: {"file": str(tmp_path / f"{name}.csv")} for name in "pv"}
    found = calibrated(parameters={"k": WEAR}, observations=observations)
    assert found.values["k"] == pytest.approx(K, rel=1e-5)
    assert np.abs(found.fit.residuals).max() < 1e-2


def test_priors_and_estimated_deviations(tmp_path):
    """requirement: a sharp prior holds a parameter; the scatter of the data gives their error."""
    path = volumes(tmp_path / "d.csv", truth(), 0.1)
    held = WEAR | {"prior": {"value": "3e-7 1/MPa", "deviation": "0.01 %"}}
    assert calibrated(path, parameters={"k": held}).values["k"] == pytest.approx(3e-7, rel=1e-3)
    found = calibrated(path, parameters={"k": WEAR}, deviations="estimated")
    known = calibrated(path, parameters={"k": WEAR})
    scatter = np.sqrt(known.fit.chi2 / 4)
    ratio = found.standard_errors["k"] / known.standard_errors["k"]
    assert ratio == pytest.approx(scatter, rel=1e-6)
    assert any("larger than the deviations explain" in note for note in known.notes())
    # the size of relative weights has no effect, on combinations neither
    rows = rows_at_times(truth())
    wide = WEAR | {"lower": "1e-9 1/MPa", "upper": "1e-5 1/MPa"}
    both = {"parameters": {"k": wide, "mu": FRICTION}, "deviations": "estimated"}
    one = calibrated(path, **both)
    columns = (TIMES, 1e9 * one.fit.observations.values, [20e9 * row.wear_volume_1 for row in rows])
    head = "time [s], wear_volume_1 [mm^3], deviation [mm^3]"
    other = calibrated(write(tmp_path / "w.csv", head, columns), **both)
    (first,), (second,) = (found.identifiability.combinations for found in (one, other))
    assert first.deviation == pytest.approx(found.standard_errors["k"], rel=1e-4)
    assert second.deviation == pytest.approx(first.deviation, rel=1e-4)
    assert other.deviations == pytest.approx(one.deviations, rel=1e-4)
    assert record_of(other)["p_value"] is None
    assert other.fit.scatter == pytest.approx(one.fit.scatter / 1000, rel=1e-4)
    weighed = WEAR | {"prior": {"value": "2e-7 1/MPa", "deviation": "20 %"}}
    noted = calibrated(tmp_path / "w.csv", parameters={"k": weighed}, deviations="estimated")
    assert any("against which the priors were weighed" in note for note in noted.notes())


def test_plan(tmp_path):
    """requirement: planned measurements have the errors that a calibration with them has."""
    path = volumes(tmp_path / "d.csv", truth())
    table = {"parameters": {"k": WEAR | {"start": f"{K} 1/MPa"}}}
    planned = tw.plan(tw.load(tables(**table)), path)
    found = calibrated(path, **table)
    expected = list(found.standard_errors.values())
    np.testing.assert_allclose(planned.design.complete.standard_errors, expected, rtol=1e-4)
    only = write(tmp_path / "t.csv", "time [s], wear_volume_1_deviation [mm^3]", ([50.0], [1.0]))
    later = tw.plan(tw.load(tables(**table)), only)
    volume = 1e9 * rows_at_times(truth())[-1].wear_volume_1
    assert later.design.complete.standard_errors[0] == pytest.approx(1 / volume, rel=0.06)
    table["observations"] = {"d": {"deviation": "4 %", "quantity": "wear_volume_1"}}
    relative = write(tmp_path / "r.csv", "time [s]", ([50.0],))
    again = tw.plan(tw.load(tables(**table)), {"d": relative})
    assert again.design.complete.standard_errors[0] == pytest.approx(0.04, rel=0.06)
    with pytest.raises(tw.CaseError, match=r"\(d\): the deviation is relative, but .* is 0"):
        tw.plan(tw.load(tables(**table)), {"d": write(relative, "time [s]", ([0.0, 50.0],))})


def test_the_start_says_nothing_of_wear(tmp_path):
    """requirement: a volume of zero at the start is no obstacle, and determines nothing."""
    head = "time [s], wear_volume_1 [mm^3], deviation [mm^3]"
    path = write(tmp_path / "d.csv", head, ([0.0], [0.0], [1.0]))
    found = calibrated(path, parameters={"k": WEAR})
    assert not found.identifiability.identified
    assert found.fit.predicted == [0.0]


@pytest.mark.slow
def test_posterior(tmp_path):
    """requirement: the posterior of sharp data is the normal distribution of the fit."""
    pytest.importorskip("emcee")
    path = volumes(tmp_path / "d.csv", truth(), 0.02)
    found = calibrated(
        path, parameters={"k": WEAR}, posterior={"walkers": 8, "steps": 60, "seed": 2}
    )
    assert found.posterior is not None
    logs = np.log(found.posterior.values[:, 0])
    assert logs.mean() == pytest.approx(np.log(found.values["k"]), abs=0.01)
    assert logs.std() == pytest.approx(found.standard_errors["k"], rel=0.4)


def test_without_the_sampler_nothing_is_computed(tmp_path, monkeypatch):
    """requirement: a missing package is told before the first run."""
    monkeypatch.setitem(sys.modules, "emcee", None)
    monkeypatch.setattr(CaseModel, "predict", None)
    path = volumes(tmp_path / "d.csv", truth())
    with pytest.raises(tw.ComputationError, match="needs the package emcee"):
        calibrated(path, parameters={"k": WEAR}, posterior={})


def test_bands_of_rough_runs_are_finite():
    """requirement: noise of the derivatives along k·mu = const does not widen a band of k·mu."""
    space = ParameterSpace((
        Parameter("k", 1.0, 0.1, 10.0, log=True), Parameter("mu", 1.0, 0.1, 10.0, log=True)
    ))  # fmt: skip
    predicted, deviations = np.array([1.0, 2.0]), np.array([0.05, 0.1])
    jacobian = np.array([[1.0, 1.0 + 1e-3], [2.0, 2.0 - 1e-3]])
    weighted = jacobian / deviations[:, None]
    normal = JointNormal.from_jacobian(space, np.zeros(2), weighted, 0.05)
    depth = reading("max_wear_1", {}, 2, None, {})
    measured = (Measurement("d", depth, predicted + 0.1, deviations),)
    rows = rows_of(measured, predicted, deviations, jacobian, normal, 0.9, 0.05)
    half = 1.6448536 * 0.05 / np.sqrt(2)  # two measurements of k·mu, each within 5 %
    for row, value in zip(rows, predicted, strict=True):
        assert row["upper"] - value == pytest.approx(half * value, rel=1e-2)
        assert value - row["lower"] == pytest.approx(half * value, rel=1e-2)
        assert row["weighted_residual"] == pytest.approx(0.1 / row["deviation"])
    sharp = rows_of(measured, predicted, deviations, jacobian, normal, 0.9, 1e-6)
    assert sharp[0]["upper"] == np.inf


@pytest.mark.parametrize(
    ("head", "cells", "said"),
    [
        ("time [s], max_wear_1 [um]", "5, 1", "has no column deviation"),
        ("time [s], depth [um], deviation [um]", "5, 1, 1", "known:"),
        ("time [s], max_wear_1 [kg], deviation [um]", "5, 1, 1", "must be in m"),
        ("time [s], max_wear_1 [um], deviation [um]", "5, 1, 0", "greater than 0"),
        ("time [s], max_wear_1 [um], deviation [um]", "70, 1, 1", "the analysis ends before"),
        ("time [s], temperature_1 [K], deviation [K]", "5, 300, 1", "known:"),
        ("time [s], mean_temperature_1 [K], deviation [K]", "5, 300, 1", "no table of this"),
        ("x [mm], wear_1 [um], deviation [um]", "500, 1, 1", "outside the contact face"),
        ("viscosity [Pa s], deviation [Pa s]", "1, 1", "known:"),
        ("worn_mass_1 [g], time [s], deviation [g]", "1, 5, 1", "needs the density"),
    ],
)
def test_data_that_do_not_fit(tmp_path, head, cells, said):
    """requirement: one line says what is wrong with the data."""
    path = tmp_path / "d.csv"
    path.write_text(f"{head}\n{cells}\n", encoding="utf-8")
    with pytest.raises(tw.CaseError, match=said) as error:
        calibrated(path, parameters={"k": WEAR})
    assert len(str(error.value).splitlines()) == 1


def test_cases_that_do_not_fit(tmp_path):
    """requirement: a case without parameters, without data, or whose first run fails."""
    with pytest.raises(tw.CaseError, match="calibrate: missing"):
        tw.calibrate(tw.load(tables()), tmp_path / "d.csv")
    with pytest.raises(tw.CaseError, match="observations: missing"):
        calibrated(parameters={"k": WEAR})
    with pytest.raises(tw.CaseError, match="cannot be read"):
        calibrated(tmp_path / "none.csv", parameters={"k": WEAR})
    head = "time [s], wear_volume_1 [mm^3], deviation [mm^3]"
    one = write(tmp_path / "one.csv", head, ([50.0], [5.0], [1.0]))
    with pytest.raises(tw.CaseError, match=r"deviations: .* 1 observations determine 1 parameters"):
        calibrated(one, parameters={"k": WEAR}, deviations="estimated")
    low = FRICTION | {"start": -0.1, "lower": -0.2, "scale": "linear"}
    with pytest.raises(tw.CaseError, match=r"contact\.friction: found -0\.1"):
        calibrated(one, parameters={"mu": low})
    path = volumes(tmp_path / "d.csv", truth())
    stopped = tables(parameters={"k": WEAR})
    stopped["analysis"]["max_steps"] = 2
    with pytest.raises(tw.ComputationError, match=r"first values failed.*max_steps"):
        tw.calibrate(tw.load(stopped), path)
