"""The examples of models in Python."""

import runpy

import matplotlib.image as mpimg
import numpy as np
import pytest

from ..conftest import DEMOS


@pytest.fixture
def example(tmp_path, monkeypatch):
    """Run an example in an empty folder; returns its names."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    return lambda name: runpy.run_path(str(DEMOS / "python" / f"{name}.py"))


def sliding_time(depth, found, pressure):
    """Time in which a film wears a mean depth: ``dh/dt = k p v (P + (1 - P) exp(-h/F))`` [s]."""
    film, share = found["FILM"], found["PROTECTED"]
    grown = np.log(share * np.exp(depth / film) + 1 - share) / share
    return film * grown / (1e-14 * pressure * 0.5)


def test_own_wear_law(example):
    """requirement: the mean depth of the law in closed form, at both loads."""
    found = example("own_wear_law")
    state, last, area = found["state"], found["last"], found["area"]
    depth = state.row.wear_volume_1 / area
    pressure = 2e3 / area
    assert area == pytest.approx(0.02 * 0.01, rel=1e-9)
    assert sliding_time(depth, found, pressure) == pytest.approx(state.time, rel=0.03)
    more = [sliding_time(d, found, 2 * pressure) for d in (depth, found["mean_depth"])]
    assert np.diff(more)[0] == pytest.approx(last.time - state.time, rel=0.03)
    assert last.time == pytest.approx(2 * found["filmed_at"])


def test_brake_own_mesh(example, tmp_path):
    """requirement: moments about the pivot are balanced, and the friction is that of the law.

    The maximum of the summary is taken at the contact points, too.
    """
    found = example("brake_own_mesh")
    steady, pressure = found["steady"], found["pressure"]
    force = np.asarray(pressure) * pressure.weights
    T = sum(
        np.asarray(steady.surface_temperature(found["face"], found[body])) / 2
        for body in ("pad", "rail")
    )
    friction = found["friction"](np.asarray(pressure), 2.0, T)
    assert force.sum() == pytest.approx(400.0, rel=1e-9)
    assert steady.summary["friction_mean"] == pytest.approx(friction @ force / 400, rel=1e-6)
    moment = abs(force @ pressure.points[:, 0])
    assert moment == pytest.approx(0.016 * (friction @ force), rel=1e-6)
    hottest = max(np.nanmax(steady.temperature(found[b]).x.array) for b in ("pad", "rail"))
    assert 0 <= steady.summary["max_temperature_K"] - hottest < 0.05  # at points between nodes
    assert mpimg.imread(tmp_path / "brake_own_mesh.png").shape[:2] == (500, 700)
