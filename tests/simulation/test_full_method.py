"""Penalty and Nitsche's method: wear, heat, and what is said about their settings."""

import json

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.simulation import Observer

from ..case.starter import GONE, HERTZ, PUNCH, RUNNING_IN, STEADY, solved, tables

FULL = ("penalty", "nitsche")
QUICK = (pytest.param("penalty", marks=pytest.mark.slow), "nitsche")
SMALL = ("mesh.degree=3", "mesh.elements=8")


class Notes(Observer):
    """Keeps what is said."""

    def __init__(self):
        self.said = []

    def note(self, text):
        self.said.append(text)


def by(method):
    return f"contact.method={method}"


def at(result, radii, name="pressure"):
    """Values at radii, linearly between the points."""
    return np.interp(radii, result.interface.x, getattr(result.interface, name))


# ---- wear ----


def running_in(method):
    short = ("analysis.end_time=3 s", "analysis.output_times=[]", "analysis.tolerance=1e-3")
    return solved(RUNNING_IN, {}, *SMALL, by(method), *short)


@pytest.fixture(scope="module")
def condensed_running_in():
    return running_in("condensed")


@pytest.mark.parametrize("method", FULL)
def test_running_in_is_that_of_condensed_contact(method, condensed_running_in):
    """requirement: a worn ring has the same pressure and volume by every method."""
    result, known = running_in(method), condensed_running_in
    radii = np.linspace(0.025, 0.115, 60)
    assert result.stopped is None
    assert at(result, radii) == pytest.approx(at(known, radii), rel=1e-2)
    assert at(result, radii, "wear_1") == pytest.approx(
        at(known, radii, "wear_1"), rel=1e-2, abs=0.0
    )
    for key in ("wear_volume_1_m3", "approach_m"):
        assert result.summary[key] == pytest.approx(known.summary[key], rel=1e-4)
    assert result.summary["normal_force_N"] == pytest.approx(50e6 * np.pi * 0.014, rel=1e-9)
    assert result.summary["equilibrium_relative_error"] < 1e-9
    assert result.interface.pressure.min() >= 0.0


@pytest.mark.parametrize("method", ["condensed", *FULL])
def test_worn_volume_is_archards(method):
    """requirement: V = k F s exactly where all points slide alike, friction included."""
    changes = {
        "motion": {"velocity": "-1 m/s"},
        "contact": {"friction": 0.3},
        "wear": {"punch": {"coefficient": "1e-6 1/MPa"}},
        "analysis": {"type": "transient", "end_time": "2 s", "tolerance": 1e-2},
    }
    result = solved(PUNCH, changes, *SMALL, by(method))
    assert len(result.history) > 5
    volumes = np.array([row.wear_volume_1 for row in result.history])
    distances = np.array([row.sliding_distance for row in result.history])
    assert distances[-1] == pytest.approx(2.0)
    np.testing.assert_allclose(volumes, 1e-12 * 0.3 * 200.0 * distances, rtol=1e-6, atol=1e-20)
    assert result.summary["wear_volume_1_m3"] == pytest.approx(1.2e-10, rel=1e-6, abs=0.0)
    assert result.summary["guide_force_N"] == pytest.approx(-60.0, rel=1e-9)
    # the edges wear down
    first, last = result.history[0].max_pressure, result.history[-1].max_pressure
    assert 20e6 < last < first / 2


# ---- heat ----

SLOW = 'motion.angular_velocity="0.05 rad/s"'


@pytest.fixture(scope="module")
def condensed_heat():
    return hot_ring("condensed")


def hot_ring(method):
    settings = ("mesh.degree=5", "mesh.elements=12", SLOW, by(method))
    return solved(STEADY, {"analysis": {"type": "initial"}, "wear": GONE}, *settings)


@pytest.mark.slow
@pytest.mark.parametrize("method", FULL)
def test_hot_contact_is_that_of_condensed_contact(method, condensed_heat):
    """requirement: friction heat that lifts the edge off, by every method."""
    result, known = hot_ring(method), condensed_heat
    radii = np.linspace(0.025, 0.08, 40)
    assert at(result, radii) == pytest.approx(at(known, radii), rel=5e-3)
    rise, known_rise = (at(r, radii, "temperature_1") - 293.15 for r in (result, known))
    assert rise == pytest.approx(known_rise, rel=1e-3)
    assert result.summary["contact_area_m2"] < 0.95 * np.pi * 0.014
    (zone,), (known_zone,) = (r.summary["contact_zones_m"] for r in (result, known))
    assert zone == pytest.approx(known_zone, rel=1e-2)
    assert result.summary["heat_balance_relative_error"] < 1e-9
    assert result.summary["equilibrium_relative_error"] < 1e-9


def test_variants_of_nitsche_know_the_thermal_stress():
    """requirement: consistent with heat: the approach is the same whatever theta is."""
    changes = {"analysis": {"type": "initial"}, "wear": GONE}
    approaches = [
        solved(STEADY, changes, *SMALL, SLOW, by("nitsche"), f"contact.theta={theta}").summary[
            "approach_m"
        ]
        for theta in (1, 0, -1)
    ]
    assert approaches == pytest.approx([approaches[0]] * 3, rel=1e-6, abs=0.0)


def hot_steps(method):
    changes = {"analysis": {"type": "transient", "end_time": "20 s", "tolerance": 1e-2}}
    return solved(STEADY, changes, "mesh.degree=5", "mesh.elements=8", SLOW, by(method))


@pytest.fixture(scope="module")
def condensed_steps():
    return hot_steps("condensed")


@pytest.mark.parametrize("method", QUICK)
def test_hot_steps(method, condensed_steps):
    """requirement: heat and wear together, step by step, by every method."""
    result, known = hot_steps(method), condensed_steps
    assert len(result.history) > 2
    assert result.stopped is None
    radii = np.linspace(0.03, 0.08, 40)
    assert at(result, radii) == pytest.approx(at(known, radii), rel=1e-2)
    volume = known.summary["wear_volume_1_m3"]
    assert result.summary["wear_volume_1_m3"] == pytest.approx(volume, rel=1e-3, abs=0.0)
    assert result.summary["heat_balance_relative_error"] < 1e-9


# ---- settings ----

PRESSED = {"load": {"force": "1.5 kN"}}


def notes_of(**contact):
    observer = Notes()
    changes = PRESSED | {"contact": {"method": "nitsche"} | contact}
    try:
        solved(HERTZ, changes, *SMALL, observer=observer)
    except tw.ComputationError as error:
        return observer.said, str(error)
    return observer.said, None


@pytest.mark.parametrize("contact", [{}, {"theta": 0}, {"theta": -1}, {"method": "penalty"}])
def test_nothing_is_said_about_defaults(contact):
    """requirement: no warning without a reason."""
    assert notes_of(**contact) == ([], None)


def test_too_little_stabilisation_is_said():
    """requirement: gamma below the limit of stability is a warning with a number that helps."""
    (said,), error = notes_of(gamma=0.01)
    assert "contact.gamma" in said
    assert "times too small" in said
    assert error is None or "contact.gamma larger" in error
    factor = float(said.split("Multiply it by ")[1].split()[0])
    assert notes_of(gamma=0.01 * factor) == ([], None)


def test_the_skew_symmetric_variant_is_stable_with_any_gamma():
    """requirement: theta = -1 needs no warning."""
    assert notes_of(gamma=0.01, theta=-1) == ([], None)


def test_theta_hardly_matters():
    """requirement: the three variants converge to one pressure."""
    results = [
        solved(HERTZ, PRESSED | {"contact": {"method": "nitsche", "theta": theta}}, *SMALL)
        for theta in (1, 0, -1)
    ]
    peaks = [result.summary["max_pressure_Pa"] for result in results]
    assert peaks == pytest.approx([peaks[0]] * 3, rel=5e-3)
    assert len(set(peaks)) == 3


def test_a_softer_penalty_lets_more_through():
    """requirement: the penetration is pressure over penalty, exactly."""
    for penalty in (1e14, 1e15):
        contact = {"method": "penalty", "penalty": f"{penalty!r} Pa/m"}
        i = solved(HERTZ, PRESSED | {"contact": contact}, *SMALL).interface
        pressing = i.pressure > 0
        assert i.gap[pressing] == pytest.approx(-i.pressure[pressing] / penalty, rel=1e-6)
        assert i.gap[~pressing].min() > 0


# ---- from the command line ----


@pytest.fixture
def run(tmp_path, capsys):
    """Run a case by the command line; exit code, output, errors and run.json."""

    def call(changes, *words):
        file, folder = tmp_path / "case.toml", tmp_path / "results"
        file.write_text(tomli_w.dumps(tables(HERTZ, PRESSED | changes)), encoding="utf-8")
        small = ["--set=mesh.degree=3", "--set=mesh.elements=8", "--no-pictures"]
        code = main(["run", str(file), "-o", str(folder), *small, *words])
        printed = capsys.readouterr()
        return code, printed.out, printed.err, json.loads((folder / "run.json").read_text())

    return call


def test_the_warning_is_printed(run):
    """requirement: the person at the terminal sees it, on a line of its own."""
    changes = {"contact": {"method": "nitsche", "gamma": 0.01}}
    _, out, _, _ = run(changes)
    assert "note: contact.gamma is" in out.splitlines()[0]
    code, out, err, status = run(changes, "--set=contact.theta=-1", "--overwrite")
    assert (code, err, status["status"]) == (0, "", "done")
    assert "note:" not in out


def test_a_penalty_beyond_all_bounds_fails_with_advice(run):
    """requirement: what cannot be solved ends with exit code 2 and a way out, and is recorded."""
    code, _, err, status = run({"contact": {"method": "penalty", "penalty": "1e25 Pa/m"}})
    assert code == 2
    (line,) = err.splitlines()
    assert "make contact.penalty smaller" in line
    assert status["status"] == "failed"
    assert status["message"] in line


def test_a_stiff_penalty_is_still_right(run):
    """requirement: a penalty of a thousand times the default gives the same force and pressure."""
    code, _, _, status = run({"contact": {"method": "penalty", "penalty": "1e20 Pa/m"}})
    assert (code, status["status"]) == (0, "done")
    contact = {"method": "penalty", "penalty": "1e20 Pa/m"}
    stiff = solved(HERTZ, PRESSED | {"contact": contact}, *SMALL)
    known = solved(HERTZ, PRESSED | {"contact": {}}, *SMALL)
    assert stiff.summary["normal_force_N"] == pytest.approx(1500.0, rel=1e-8)
    approach = known.summary["approach_m"]
    assert stiff.summary["approach_m"] == pytest.approx(approach, rel=1e-4, abs=0.0)


def test_the_thermal_stress_is_that_of_body_1():
    """requirement: consistent where the faces differ in temperature."""
    changes = {
        "analysis": {"type": "initial"},
        "wear": GONE,
        "heat.conductance": "1e3 W/(m^2 K)",
    }
    approaches = [
        solved(STEADY, changes, *SMALL, SLOW, by("nitsche"), f"contact.theta={theta}").summary[
            "approach_m"
        ]
        for theta in (1, 0, -1)
    ]
    assert approaches == pytest.approx([approaches[0]] * 3, rel=1e-6, abs=0.0)
