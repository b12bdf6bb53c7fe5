"""Confidence intervals of calibrated parameters contain the truth as often as they say."""

import numpy as np
import pytest

from tests.conftest import HOT
from thermowear.app.calibration.calibrate import problem_of, runner
from thermowear.case import load
from thermowear.inference import Observations, fit

TRUTH = np.array([2e-7, 0.25])
"""Wear coefficient [1/MPa] and friction."""
SCATTER = 0.05
AMBIENT = 293.15
TIMES = np.linspace(20.0, 120.0, 6)
OVERRIDES = (
    'analysis={type="transient", end_time="120 s", tolerance=1e-3}',
    "mesh.degree=3",
    "mesh.elements=3",
    'calibrate.parameters.k={key="wear.punch.coefficient", start="1.5e-7 1/MPa", '
    'lower="1e-8 1/MPa", upper="2e-6 1/MPa", scale="log"}',
    'calibrate.parameters.mu={key="contact.friction", start=0.2, lower=0.05, upper=0.6}',
)


@pytest.fixture(scope="module")
def forward(tmp_path_factory):
    """Problem and model of a hot running-in with depths and temperatures at six times."""
    folder = tmp_path_factory.mktemp("data")
    for name, unit in (("wear_1", "um"), ("max_temperature", "K")):
        place, where = (", x [mm]", ", 70") if name == "wear_1" else ("", "")  # the middle
        rows = (f"{time!r}{where}, 1, 1" for time in map(float, TIMES))
        head = f"time [s]{place}, {name} [{unit}], deviation [{unit}]"
        (folder / f"{name}.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    files = {path.stem: path for path in folder.iterdir()}
    problem = problem_of(load(HOT, OVERRIDES), files)
    return problem, problem.model(runner())


def covered(forward, number):
    """Fits of measurements with noise whose intervals contain the truth, shape (number, 2)."""
    problem, model = forward
    exact, (_, labels) = model.predict(TRUTH), problem.weights
    hot = np.array(["temperature" in label for label in labels])
    deviations = SCATTER * (exact - np.where(hot, AMBIENT, 0.0))
    random, found = np.random.default_rng(7), np.zeros((number, 2), dtype=bool)
    for row in found:
        measured = exact + deviations * random.normal(size=len(exact))
        one = fit(problem.space, Observations(measured, deviations, labels), model, 1e-3)
        assert one.converged
        low, high = one.intervals(0.95).T
        row[:] = (low < TRUTH) & (high > TRUTH)
    return found


def test_few_sets(forward):
    """requirement: of 15 intervals for 95 % at least 12 contain the truth, of each parameter."""
    assert (covered(forward, 15).sum(axis=0) >= 12).all()


@pytest.mark.slow
def test_many_sets(forward):
    """requirement: of 200 intervals for 95 % between 92 and 98 % contain the truth."""
    parts = covered(forward, 200).mean(axis=0)
    assert (parts >= 0.92).all()
    assert (parts <= 0.98).all()
