"""The distortion study: what speed changes of a steady state, and what it does not."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.batch.variants import parse_over
from thermowear.output.tables import write_points

from ..conftest import DEMOS, demo_script

COARSE = ("mesh.degree=3", "mesh.elements=8")
NAMES = ("punch_on_strip", "block_on_disk", "drum_brake", "annular_punch", "disk_brake")


@cache
def studies():
    """The studies of the script, by their cases."""
    return {study.case: study for study in demo_script("studies").STUDIES}


@cache
def swept(name):
    """Speeds (n,) and results of a study on a coarse mesh."""
    study = studies()[name]
    case = tw.load(DEMOS / f"{name}.toml", (*study.sets, *COARSE))
    results = tw.sweep(case, parse_over([study.over]))
    speeds = np.array([float(values[study.key].split()[0]) for values, _ in results])
    return speeds, [result for _, result in results]


def bent(result) -> np.ndarray:
    """What wear has taken off, but for the rigid motion that it goes on with [m]."""
    lost = result.interface.shape.max() - result.interface.shape
    rigid, weight = result.profile.wear_rate, result.interface.weight
    return lost - (weight @ (rigid * lost)) / (weight @ rigid**2) * rigid


def hollow(result) -> float:
    """How much higher the ends are than the middle, along the press [µm]."""
    shape, s = result.profile.shape_along_press, result.interface.s
    return 1e6 * float((shape[0] + shape[-1]) / 2 - np.interp((s[0] + s[-1]) / 2, s, shape))


def test_every_case_of_the_study_is_there():
    """requirement: special cases 1, 3, 7, 8 and 9."""
    assert tuple(studies()) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_the_pressure_does_not_know_the_speed(name):
    """requirement: the seeds' conclusion; both bodies balance at all speeds."""
    _, results = swept(name)
    first = results[0].interface.pressure
    for result in results:
        assert result.interface.pressure == pytest.approx(first, rel=1e-13, abs=0.0)
        assert result.summary["heat_balance_relative_error"] < 1e-9
        assert result.summary["equilibrium_relative_error"] < 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_the_shape_bends_in_proportion_to_the_speed(name):
    """requirement: friction heat is linear in the speed, so is what it adds to the shape."""
    speeds, results = swept(name)
    shapes = np.array([bent(result) for result in results])
    fitted = np.vander(speeds, 2) @ np.polyfit(speeds, shapes, 1)
    assert np.abs(shapes - fitted).max() < 1e-12 * np.ptp(shapes[0])
    assert np.abs(shapes[-1] - shapes[0]).max() > 0.25 * np.ptp(shapes[0])


@pytest.mark.parametrize("name", NAMES)
def test_a_part_of_the_worn_shape_needs_no_running_in(name, tmp_path):
    """requirement: hot contact of faces that have it begins with the steady pressure.

    Contact of unworn faces is another solution than the principle: sign and size of the distortion
    must be right. With the shape worn when cold, a hot contact presses in other places.
    """
    study, (_, results) = studies()[name], swept(name)
    steady, weight = results[-1].interface.pressure, results[-1].interface.weight
    found = []
    for result in (results[-1], results[0]):
        write_points(tmp_path / "profile.csv", result.profile)
        sets = (*study.sets, *COARSE, f"{study.key}={study.values[-1]}")
        more = ('analysis={type="initial"}', f"geometry.initial_shape={tmp_path}/profile.csv")
        unworn = tw.run(tw.load(DEMOS / f"{name}.toml", (*sets, *more)))
        wrong = unworn.interface.pressure - steady
        found.append(np.sqrt(weight @ wrong**2 / (weight @ steady**2)))
    assert found[0] < 0.01
    assert found[1] > 0.5


@pytest.mark.parametrize(
    ("name", "per_speed", "cold", "hot"),
    [
        ("punch_on_strip", 0.1605, 3.61, 3.61),
        ("block_on_disk", 0.835, 1.104, 2.05),
        ("drum_brake", -6.405, 5.25, 10.04),
        ("annular_punch", 259.2, 39.92, 39.6),
        ("disk_brake", 1.514, 2.228, 10.46),
    ],
)
def test_figures(name, per_speed, cold, hot):
    """requirement: how much hollower each speed makes it [µm per mm/s or rad/s]; ranges [µm]."""
    speeds, results = swept(name)
    bending = (hollow(results[-1]) - hollow(results[0])) / abs(speeds[-1] - speeds[0])
    assert bending == pytest.approx(per_speed, rel=0.01)
    ranges = [1e6 * result.summary["shape_range_m"] for result in results]
    assert [ranges[0], ranges[-1]] == pytest.approx([cold, hot], rel=0.01)


@pytest.mark.parametrize("name", NAMES)
def test_the_contact_is_stable(name):
    """requirement: all speeds of the study are below the critical one."""
    study = studies()[name]
    case = tw.load(DEMOS / f"{name}.toml", (*study.sets, *COARSE))
    own = [part for part, body in case.bodies.items() if body.like is None]
    metal = [
        f'bodies.{part}.{key}="{value}"'
        for part in own
        for key, value in (("density", "7500 kg/m^3"), ("specific_heat", "480 J/(kg K)"))
    ]
    fastest = (f"{study.key}={study.values[-1]}", 'analysis={type="stability"}')
    tried = tw.run(tw.load(DEMOS / f"{name}.toml", (*study.sets, *COARSE, *metal, *fastest)))
    assert tried.summary["critical_speed_factor"] > 1.4
    assert tried.summary["growth_rate_per_s"] < 0


def test_one_end_of_the_punch_is_higher_by_friction_alone():
    """requirement: heat makes both ends of a symmetric case equally high."""
    for name in ("punch_on_strip", "block_on_disk"):
        tilts = [r.interface.shape[0] - r.interface.shape[-1] for r in swept(name)[1]]
        assert tilts == pytest.approx([tilts[0]] * len(tilts), rel=1e-9)
        assert abs(tilts[0]) > 0.5e-6


def test_heat_turns_the_ring_round():
    """requirement: cold, the inner edge is high; hot, the outer one."""
    _, results = swept("annular_punch")
    outer = [1e6 * (r.interface.shape[-1] - r.interface.shape[0]) for r in results]
    assert np.diff(outer) == pytest.approx(np.diff(outer)[-1], rel=1e-3)
    assert outer[0] < -35
    assert outer[-1] > 20
