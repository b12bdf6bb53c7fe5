"""Runs behind predictions: time steps, derivatives of rough runs, values that are not allowed."""

import numpy as np
import pytest

from thermowear.calibration.candidate_run import CandidateRun, Prediction, predict
from thermowear.calibration.case_model import CaseModel
from thermowear.calibration.experiments import Experiment
from thermowear.calibration.measurement import Measurement
from thermowear.calibration.problem import Problem, space_of
from thermowear.calibration.readings import reading
from thermowear.case.studies.calibration import CalibrationTable
from thermowear.inference import Normal, central_jacobian, identify

from ..case.starter import tables

TABLE = CalibrationTable(
    parameters={
        "k": {"key": "a.k", "start": 2.0, "lower": 0.1, "upper": 10.0, "scale": "log"},
        "mu": {"key": "a.mu", "start": 0.3, "lower": 0.05, "upper": 0.9, "scale": "log"},
    }
)
LOADS = np.array([1.0, 2.0, 4.0])


def experiment(name="wear_volume_1", deviation=1.0, **options):
    one = reading(name, {}, len(LOADS), None, {})
    return Experiment({}, (Measurement("d", one, LOADS, deviation * LOADS),), **options)


class Product:
    """Runner of a model ``k mu p`` with an error that differs between runs with own steps."""

    def __init__(self, error=0.0):
        self.error, self.runs, self.random = error, [], np.random.default_rng(5)

    def __call__(self, groups):
        return [self._run(run) for group in groups for run in group]

    def _run(self, run):
        self.runs.append(run)
        k, mu = (float(change.partition("=")[2]) for change in run.overrides)
        noise = 0.0 if run.steps else self.error * self.random.standard_normal(len(LOADS))
        own = run.steps or (k, 10.0)
        return Prediction(run.number, k * mu * LOADS * (1 + noise), own)


def problem(*experiments):
    return Problem(TABLE, space_of(TABLE), [], list(experiments))


def test_neighbours_take_the_steps_of_their_point():
    """requirement: runs beside a point end their steps at its times, and are smooth."""
    runner = Product(error=1e-3)
    model = CaseModel(TABLE, [experiment()], runner)
    at = np.array([3.0, 0.4])
    predicted = model.predict(at)
    model.neighbours(at, [np.array([3.1, 0.4]), np.array([3.0, 0.5])])
    assert [run.steps for run in runner.runs] == [(), (3.0, 10.0), (3.0, 10.0)]
    assert model.runs == 3
    assert np.array_equal(model.predict(at), predicted)
    assert model.runs == 3


def test_rough_runs_have_derivatives_and_do_not_identify_by_their_noise():
    """requirement: runs with steps of their own: k·mu is one combination, in spite of errors."""
    rough = problem(experiment(smooth=False))
    model = rough.model(Product(error=1e-4))
    at = np.array([3.0, 0.4])
    found = central_jacobian(rough.space, model, rough.space.internal(at), model.predict(at))
    np.testing.assert_allclose(found, 1.2 * np.stack([LOADS, LOADS], axis=1), rtol=0.02)
    identified = identify(rough.space, found / LOADS[:, None], rough.noise(model))
    assert identified.structural.tolist() == [False, True]
    smooth = problem(experiment())
    assert smooth.noise(smooth.model(Product())) < 1e-3


def test_values_that_the_case_does_not_allow_fail_like_a_run():
    """requirement: the reason of the case, NaN for all values, no error that ends the search."""
    one = experiment()
    wrong = Experiment(tables("annular-punch"), one.measurements)
    found = predict(None, CandidateRun(4, wrong, ("contact.friction=-0.1",)))
    assert found.number == 4
    assert np.isnan(found.values).all()
    assert found.values.shape == LOADS.shape
    assert found.failure.startswith("contact.friction: ")


def test_runs_end_with_the_last_time():
    """requirement: only if there is one; a measurement at the start or the end needs the run."""

    def timed(*times):
        at = {"time": np.array(times)}
        values = np.zeros(len(times))
        one = Measurement("d", reading("wear_volume_1", at, len(times), None, {}), values, values)
        return Experiment({}, (one,), tuple(t for t in times if t > 0.0))

    assert timed(0.0, 5.0).ends_with_times()
    assert not timed(0.0).ends_with_times()
    assert not experiment().ends_with_times()


@pytest.mark.parametrize(
    ("name", "compares"),
    [
        ("rigid_wear_velocity", True),
        ("holders.lid.rigid_wear_velocity", True),
        ("distance_from_steady", True),
        ("wear_volume_1", False),
    ],
)
def test_runs_compare_with_the_steady_state_if_it_is_measured(name, compares):
    """requirement: numbers of the steady state that a running-in approaches."""
    assert experiment(name).compares_with_steady() == compares


def test_priors_of_logarithms_in_other_units():
    """requirement: 3e-7 ± 6e-8 1/MPa: a deviation of the logarithm of 0.2 about that of 3e-7."""
    k = {"start": "1e-7 1/MPa", "lower": "1e-9 1/MPa", "upper": "1e-5 1/MPa", "key": "a.k"}
    prior = {"value": "3e-4 1/GPa", "deviation": "6e-5 1/GPa"}
    for scale, expected in (
        ("log", Normal(float(np.log(3e-7)), 0.2)),
        ("linear", Normal(3e-7, 6e-8)),
    ):
        table = CalibrationTable(parameters={"k": k | {"scale": scale, "prior": prior}})
        found = space_of(table).parameters[0].prior
        assert found.mean == pytest.approx(expected.mean, rel=1e-12)
        assert found.deviation == pytest.approx(expected.deviation, rel=1e-12)
