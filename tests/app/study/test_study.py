"""Studies from Python: quantiles and indices against closed forms, inputs, failures."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

import thermowear as tw
from thermowear.app.batch.pool import ProcessPool
from thermowear.app.study.bands import bands
from thermowear.app.study.design import study_design
from thermowear.app.study.inputs import inputs_of
from thermowear.app.study.study import StudyPlan, evaluated
from thermowear.case import load
from thermowear.errors import CaseError

from .cases import BOTH, FRICTION, PRESSURE, calibration, ring


def test_a_linear_response_to_a_normal_input_is_normal():
    """requirement: friction power is linear in the load: its quantiles are those of the load."""
    found = tw.study(ring({"load.mean_pressure": PRESSURE}, samples=64))
    k = found.outputs.index("friction_power_W")
    power, base = found.quantiles, found.swings.base[k]
    assert power.mean[k] == pytest.approx(base, rel=1e-4)
    assert power.deviation[k] == pytest.approx(0.04 * base, rel=0.03)
    levels = stats.norm.ppf(power.levels, 1.0, 0.04)
    np.testing.assert_allclose(power.values[:, k], levels * base, rtol=0.015)
    assert found.swings.high[0, k] == pytest.approx(stats.norm.ppf(0.95, 1, 0.04) * base, rel=1e-8)
    assert found.inputs == ("load.mean_pressure",)
    assert found.samples["load.mean_pressure_Pa"].mean() == pytest.approx(50e6, rel=1e-4)
    pressure = found.bands.tables["interface"]
    ratio = pressure["pressure_Pa_97.5"] / pressure["pressure_Pa_50"]
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-6)  # the shape of the pressure is fixed
    assert ratio[0] == pytest.approx(1 + 0.04 * stats.norm.ppf(0.975), abs=6e-3)
    assert found.indices is None


@pytest.mark.slow
def test_sobol_indices_of_a_product():
    """requirement: torque = friction x force x radius has the indices of a product, within 0.02."""
    pressure = {"distribution": "uniform", "lower": "20 MPa", "upper": "80 MPa"}
    friction = {"distribution": "uniform", "lower": 0.2, "upper": 0.3}
    inputs = {"load.mean_pressure": pressure, "contact.friction": friction}
    found = tw.study(ring(inputs, samples=256, indices=True))
    k = found.outputs.index("friction_torque_Nm")
    shares = np.array([60.0 / 50.0, 0.1 / 0.25]) ** 2 / 12
    variance = np.prod(1 + shares) - 1
    np.testing.assert_allclose(found.indices.first[:, k], shares / variance, atol=0.02)
    np.testing.assert_allclose(
        found.indices.total[:, k], shares * (1 + shares[::-1]) / variance, atol=0.02
    )
    assert found.indices.dropped[k] == 0
    assert len(found.design.values) == 5 + 4 * 256
    assert len(found.sampled("friction_torque_Nm")) == 2 * 256


def test_processes_give_the_same_numbers():
    """requirement: an executor changes no number."""
    tables = ring(BOTH, samples=16)
    alone = tw.study(tables)
    with ProcessPool(2) as pool:
        shared = tw.study(tables, executor=pool, workers=2)
    assert alone.outputs == shared.outputs
    for name, values in alone.numbers.items():
        np.testing.assert_allclose(shared.numbers[name], values, rtol=1e-9, err_msg=name)


def test_histories_have_bands():
    """requirement: bands of a running-in end with its shortest run, and contain its median."""
    tables = ring(BOTH, samples=8) | {"analysis": {"type": "transient", "until": "steady"}}
    found = tw.study(tables)
    history = found.bands.tables["history"]
    assert {"time_s", "wear_volume_1_m3_2.5", "max_pressure_Pa_50"} <= history.keys()
    assert np.all(np.diff(history["time_s"]) > 0)
    low, middle, high = (history[f"wear_volume_1_m3_{q}"] for q in ("2.5", "50", "97.5"))
    assert np.all(low <= middle)
    assert np.all(middle <= high)
    assert np.all(np.diff(middle) >= 0)
    ends = found.numbers["time_s"][found.design.sample]
    assert history["time_s"][-1] == pytest.approx(ends.min(), rel=1e-6)
    assert "shortest run" in found.bands.notes[0]


def test_bands_at_other_points_are_interpolated():
    """requirement: on x; a curve counts only where it has points."""
    x = np.linspace(0.0, 1.0, 5)
    whole = {"x": x, "y": 0 * x, "pressure": 1 + x}
    short = {"x": 0.5 * x, "y": 0 * x, "pressure": 3 + 0.5 * x}
    found = bands([{"interface": whole}, {"interface": short}])
    assert "interpolated on x" in found.notes[0]
    middle, high = (found.tables["interface"][f"pressure_Pa_{q}"] for q in ("50", "97.5"))
    np.testing.assert_allclose(middle, np.where(x <= 0.5, 2 + x, 1 + x), rtol=1e-6)
    np.testing.assert_allclose(high - middle, np.where(x <= 0.5, 1.0, 0.0), atol=1e-6)


def test_numbers_that_vary_are_outputs():
    """requirement: more than rounding, over the sample; counts of variants of the sample alone."""
    case = load(ring(BOTH, samples=4))
    design = study_design(inputs_of(case.study.inputs, tw.case.as_plain(case)), case.study)
    count = len(design.values)
    numbers = {
        k + 1: {"max_pressure_Pa": 1 + 1e-6 * k, "approach_m": 1 + 1e-12 * k, "seconds": 1.0 * k}
        for k in range(count)
    }
    found = evaluated(design, dict.fromkeys(numbers, "done"), numbers, {})
    assert found.outputs == ("max_pressure_Pa",)
    sample = 1 + 1e-6 * np.arange(5, 9)
    assert found.quantiles.counts.tolist() == [4]
    assert found.quantiles.mean == pytest.approx([sample.mean()], rel=1e-12)
    assert found.swings.high[:, 0] == pytest.approx(1 + 1e-6 * np.array([3, 4]), rel=1e-12)


def test_units_are_kept(tmp_path):
    """requirement: values are sampled in their units, and listed in SI, temperatures too."""
    ambient = {"distribution": "uniform", "lower": "10 degC", "upper": "30 degC"}
    spread = {"distribution": "lognormal", "median": "1e3 kW/(m^2 K)", "factor": 2}
    tables = ring({"heat.ambient": ambient, "heat.conductance": spread}, hot=True)
    case = load(tables)
    design = study_design(inputs_of(case.study.inputs, tw.case.as_plain(case)), case.study)
    assert [c.header for c in design.columns] == ["heat.ambient_K", "heat.conductance_W_per_m2_K"]
    np.testing.assert_allclose(design.si[0], [293.15, 1e6])
    low, high = design.swing_values
    np.testing.assert_allclose([low[0], high[0]], [284.15, 302.15])
    for k in (0, 1, 30):
        changed = load(tables, design.overrides(k))
        np.testing.assert_allclose(
            [changed.heat.ambient, changed.heat.conductance], design.si[k], rtol=1e-12
        )


SPEED = {"distribution": "uniform", "lower": "0.1 rad/s", "upper": "0.2 rad/s"}
MU = {"key": "contact.friction", "unit": "", "value": 0.25, "lower": 0.2, "upper": 0.3}
MU |= {"scale": "log", "internal": float(np.log(0.25))}
P = {"key": "load.mean_pressure", "unit": "MPa", "value": 50.0, "lower": 10.0, "upper": 90.0}
P |= {"scale": "linear", "internal": 0.5, "internal_scale": 100.0}


def test_calibrated_parameters_are_one_input(in_folder):
    """requirement: calibrated parameters keep their covariance; samples stay within bounds."""
    folder = calibration("c", [[0.01, 0.0004], [0.0004, 0.0004]], mu=MU, p=P)
    plan = StudyPlan.of(load(ring({}, samples=1024)), folder)
    (one,) = plan.design.inputs
    assert [column.header for column in one.columns] == [
        "contact.friction",
        "load.mean_pressure_Pa",
    ]
    friction, pressure = plan.design.values[plan.design.sample].T
    assert pressure.std() == pytest.approx(2.0, rel=0.02)
    assert pressure.mean() == pytest.approx(50.0, rel=1e-3)
    assert np.corrcoef(np.log(friction), pressure)[0, 1] == pytest.approx(0.2, abs=0.04)
    assert friction.min() == 0.2
    assert friction.max() == 0.3
    assert "were beyond the bounds of a calibrated parameter" in plan.design.notes[0]
    assert plan.design.overrides(0) == (
        f"contact.friction={plan.design.values[0, 0].item()!r}",
        f'load.mean_pressure="{plan.design.values[0, 1].item()!r} MPa"',
    )
    found = tw.study(ring({}, samples=8), calibration=folder)
    assert found.inputs == ("calibrated parameters",)
    beside = ring({"motion.angular_velocity": SPEED}, samples=8, indices=True)
    assert len(StudyPlan.of(load(beside), folder).design.inputs) == 2
    with pytest.raises(CaseError, match="need two inputs"):
        StudyPlan.of(load(beside))


@pytest.mark.parametrize(
    ("covariance", "said"),
    [
        (None, "do not determine all parameters"),
        ([[None]], "do not determine mu"),
        ([[0.1, 0.0]], "must have 1 rows"),
        ([[-0.1]], "not positive semidefinite"),
    ],
)
def test_an_undetermined_calibration_is_refused(covariance, said, in_folder):
    """requirement: one line on what is missing in a calibration."""
    folder = calibration("c", covariance, mu=MU)
    with pytest.raises(CaseError, match=said) as caught:
        tw.study(ring({}), calibration=folder)
    assert len(caught.value.faults) == 1
    with pytest.raises(CaseError, match=r"contains no readable calibration\.json"):
        tw.study(ring({}), calibration="nothing")
    calibration("d", [[0.01]], mu=MU)
    with pytest.raises(CaseError, match=r"study\.inputs\.contact\.friction: is a calibrated"):
        tw.study(ring({"contact.friction": FRICTION}), calibration="d")
    template = {"set": {"contact.friction": "{mu}"}}
    calibration("e", [[0.01]], template, mu=MU | {"key": None})
    assert StudyPlan.of(load(ring({})), "e").design.overrides(0) == ("contact.friction=0.25",)
    with pytest.raises(CaseError, match=r"contact\.friction: is a calibrated .* depends on one"):
        tw.study(ring({"contact.friction": FRICTION}), calibration="e")
    calibration("f", [[0.01]], {"planned": True}, mu=MU)
    with pytest.raises(CaseError, match="is that of a plan"):
        tw.study(ring({}), calibration="f")


def test_invalid_samples_are_one_line():
    """requirement: samples that leave the range of a key are reported once, before any run."""
    wide = {"distribution": "normal", "mean": "5 MPa", "deviation": "4 MPa"}
    with pytest.raises(CaseError) as caught:
        tw.study(ring({"load.mean_pressure": wide, "contact.friction": FRICTION}, samples=32))
    (line,) = caught.value.faults
    assert line.startswith("study.inputs.load.mean_pressure: ")
    assert " samples are invalid; load.mean_pressure: " in line
    assert line.endswith("limit the distribution by lower and upper")
    long = PRESSURE | {"mean": "5 mm"}
    with pytest.raises(
        CaseError, match=r"study\.inputs\.load\.mean_pressure: .* mm; must be in Pa"
    ):
        tw.study(ring({"load.mean_pressure": long}))
    with pytest.raises(CaseError, match=r"load\.no_such_key"):
        tw.study(ring({"load.no_such_key": FRICTION}))
    with pytest.raises(CaseError, match=r"study\.inputs: missing; .*--calibration DIR"):
        tw.study(ring({}))
