"""Hot spots along the sliding direction: closed forms, symmetries, and limits without waves."""

from dataclasses import replace

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.case import load
from thermowear.errors import CaseError, ComputationError, RunNote
from thermowear.laws.waves import first_critical
from thermowear.model.analyses import StabilityAnalysis
from thermowear.simulation import Observer
from thermowear.simulation import run as run_case
from thermowear.simulation.analyses.run import run
from thermowear.simulation.analyses.stability import PerturbedContact, base_state
from thermowear.simulation.from_case import model_of
from thermowear.simulation.hot_spots.wave_model import WaveModel
from thermowear.simulation.system.building import build
from thermowear.timer import Phases
from thermowear.verification.cases.assembly.pad_disk_pad import Brake
from thermowear.verification.cases.heat import hot_spots as layer
from thermowear.verification.check import computed

from ..case.starter import tables as case_tables
from ..test_parallel import same_on_two_ranks
from . import hot_spots_on_ranks

COARSE = {"mesh.degree": 4, "mesh.elements": 4}


def brake(numbers, **changes):
    """Result of the starter of a disk brake on a coarse mesh."""
    given = COARSE | {"analysis.hot_spots": numbers} | changes
    return computed(load(case_tables("disk-brake-stability", given)))


def by_mode(result):
    """Rows by number and symmetry."""
    return {(row.number, row.symmetry): row for row in result.hot_spots.rows}


@pytest.fixture(scope="module")
def found():
    return brake([0, 3, 5])


def test_thick_layer_on_insulating_pads():
    """requirement E2: V = 2 m K/(f α (1 + ν) E*) within 1e-3."""
    m, disk, pads = 40.0, layer.DISK, replace(layer.PADS, expansion=0.0)
    tables = layer.tables_of_layer(20.0 / m, (m,))
    tables["bodies"]["pad"] |= {"expansion": "0 1/K"}
    tables["heat"] |= {"conductance": "1e-6 W/(m^2 K)", "partition": 0.0}
    rows = by_mode(computed(load(tables)))
    modulus = 2 / m / (disk.softness(m) + pads.softness(m))
    exact = 2 * m * disk.conductivity
    exact /= layer.FRICTION * disk.expansion * (1 + disk.poisson_ratio) * modulus
    for symmetry in (1, -1):
        assert rows[1, symmetry].speed_factor == pytest.approx(exact, rel=1e-3)
        assert rows[1, symmetry].drift == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("m", [pytest.param(41.2, marks=pytest.mark.slow), 125.4])
def test_layer_between_half_planes(m):
    """requirement E1: critical speed and drift of the closed form, both symmetries, 1e-3."""
    speeds = layer.critical(layer.THICKNESS, [m])
    for name, symmetric in (("symmetric", True), ("antisymmetric", False)):
        speed, drift = layer.reference(layer.THICKNESS).critical(m, symmetric)
        if name == "symmetric" and m < 100:
            continue  # oblique waves come first in a column of this width
        assert speeds[name][0][0] == pytest.approx(speed, rel=1e-3)
        assert speeds[name][0][1] == pytest.approx(drift, rel=1e-3)


@pytest.mark.parametrize(
    ("conductance", "exact"),
    [pytest.param("1e4", 119.46, marks=pytest.mark.slow), ("1e8", 197.04)],
)
def test_thin_skins_are_told(conductance, exact):
    """requirement: errors by elements larger than the thermal skin are within their estimate.

    Critical speeds [rad/s] are those of finer rows at the contact; Python callers are warned.
    """
    changes = {"analysis.hot_spots": [5], "mesh.degree": 3, "mesh.elements": 4}
    changes["heat.conductance"] = f"{conductance} W/(m^2 K)"
    with pytest.warns(RunNote, match=r"critical speed of hot spots is (uncertain|not resolved)"):
        summary = run_case(load(case_tables("disk-brake-stability", changes))).summary
    error = abs(summary["first_hot_spots_angular_velocity_rad_per_s"] / exact - 1)
    error = error / (1 + error)  # of factors
    estimate = summary["first_hot_spots_error_estimate_relative"]
    assert error < 1.5 * estimate
    assert (estimate > 0.5) == (conductance == "1e8")


def test_modes_without_waves_are_those_of_bands(found):
    """requirement E2: N = 0 gives the static and the oscillatory critical speeds of bands."""
    bands = by_mode(found)[0, 1]
    assert bands.speed_factor == pytest.approx(found.summary["critical_speed_factor"], rel=1e-9)
    worn = found.summary["critical_speed_factor_with_wear"]
    assert bands.speed_factor_with_wear == pytest.approx(worn, rel=1e-9)


def test_stationary_bands_to_rounding():
    """requirement E2: the first stationary critical speed of bands to 1e-9."""
    model = model_of(load(case_tables("disk-brake-stability", COARSE)))
    system = build(model, MPI.COMM_WORLD, Phases())
    end = base_state(system, Observer())[0].contact
    waves = WaveModel(system, end.pressure, end.conditions, ("disk_middle",))
    bands = first_critical(waves.at(0, "symmetric").equations)
    known = PerturbedContact(system, end.pressure, end.conditions).static.factors[0]
    assert bands.rate == pytest.approx(0.0, abs=1e-12)
    assert bands.factor == pytest.approx(known, rel=1e-9)


def test_disk_between_two_pads_is_both_halves():
    """requirement: a whole brake has the modes of the half model of both symmetries."""
    cases = {}
    for disk in ("half", "clamped"):
        tables = Brake(disk, heated=True, elements=4).tables("steady")
        tables["analysis"] = {"type": "stability", "hot_spots": [3, 6]}
        tables["motions"] = {"disk": {"angular_velocity": "20 rad/s"}}
        if disk == "half":
            tables["analysis"]["mirror"] = "disk_bottom"
        cases[disk] = tables
    half, whole = (by_mode(computed(load(cases[disk]))) for disk in cases)
    for number in (3, 6):
        parts = [half[number, symmetry] for symmetry in (1, -1)]
        lowest = min(parts, key=lambda row: row.speed_factor)
        assert whole[number, 0].speed_factor == pytest.approx(lowest.speed_factor, rel=1e-6)
        assert whole[number, 0].drift == pytest.approx(lowest.drift, rel=1e-5)


def test_wear(found):
    """requirement E6: wear of the disk moves the critical speeds up, none leaves them."""
    for row in found.hot_spots.rows:
        assert row.speed_factor_with_wear == pytest.approx(row.speed_factor, rel=1e-4) or (
            row.number == 0 and row.speed_factor_with_wear > row.speed_factor
        )
    hardly = by_mode(brake([5], **{"wear.pad.coefficient": "1e-22 1/MPa"}))
    for symmetry in (1, -1):
        row = hardly[5, symmetry]
        assert row.speed_factor_with_wear == pytest.approx(row.speed_factor, rel=1e-12)
        plain = by_mode(found)[5, symmetry].speed_factor
        assert row.speed_factor == pytest.approx(plain, rel=1e-9)
    worn = layer.layer(layer.THICKNESS, [41.2], layer.WEAR).hot_spots.rows[1]
    exact = layer.reference(layer.THICKNESS, layer.WEAR).critical(41.2, False)
    assert worn.speed_factor_with_wear == pytest.approx(exact[0], rel=1e-3)
    assert worn.speed_factor_with_wear > 1.1 * worn.speed_factor
    assert worn.frequency_with_wear == pytest.approx(-exact[1] * 41.2, rel=1e-3)


class Notes(Observer):
    """Notes of a run."""

    def __init__(self):
        self.found = []

    def note(self, text):
        self.found.append(text)


@pytest.mark.slow
def test_wear_that_holds_the_hot_spots_is_reported():
    """requirement: no critical speed with wear is said in a note, not only by an empty cell."""
    notes = Notes()
    tables = layer.tables_of_layer(layer.THICKNESS, (41.2,), layer.WEAR)
    rows = run_case(load(tables), observer=notes).hot_spots.rows
    said = [note for note in notes.found if "no critical speed with wear" in note]
    assert len(said) == 1
    assert "(symmetric)" in said[0]
    assert [row.symmetry for row in rows if np.isnan(row.speed_factor_with_wear)] == [1]


def test_growth_over_speed(found):
    """requirement: rates vanish at the critical speed, and rise through it."""
    steps, critical = found.hot_spots.growth, found.summary["first_hot_spots_speed_factor"]
    factors = np.array([step.speed_factor for step in steps])
    rates = np.array([step.growth_rate for step in steps])
    assert (np.sign(rates) == np.sign(factors - critical)).all()
    assert np.interp(0.0, rates, factors) == pytest.approx(critical, rel=5e-3)


@pytest.mark.slow
def test_growth_of_the_layer():
    """requirement: growth rates of the closed form."""
    result = layer.layer(layer.THICKNESS, [41.2])
    exact = layer.reference(layer.THICKNESS)
    for step in result.hot_spots.growth:
        rate = exact.growth(41.2, False, step.speed_factor)
        assert complex(step.growth_rate, step.frequency) == pytest.approx(rate, rel=1e-3)


def test_fields_of_the_first_mode(found):
    """requirement: the largest temperature is 1, on the friction face of the disk."""
    first = found.hot_spots.first
    assert (first.number, first.symmetry) == (5, -1)
    assert first.mirror == (1, pytest.approx(-0.006))
    (fields,) = first.blocks
    cell, point = np.unravel_index(np.argmax(np.abs(fields.temperature)), fields.temperature.shape)
    assert abs(fields.temperature[cell, point]) == pytest.approx(1.0, rel=0.02)  # between the nodes
    assert fields.points[cell, point, 1] == pytest.approx(0.0, abs=1e-4)


def face_values(fields, body, radii):
    """Displacements (n, 3, 3) of a body at z = 0 and the next two points inside, and z (n, 3)."""
    own = np.flatnonzero(fields.body == body)
    points, displacement = (
        fields.points[own].reshape(-1, 2),
        fields.displacement[own].reshape(-1, 3),
    )
    found = []
    for radius in radii:
        line = np.flatnonzero(np.abs(points[:, 0] - radius) < 1e-9)
        z, first = np.unique(np.abs(points[line, 1].round(10)), return_index=True)
        found.append((displacement[line[first[:3]]], points[line[first[:3]], 1], z[0]))
    displacements, places, nearest = zip(*found, strict=True)
    assert max(nearest) == 0.0
    return np.array(displacements), np.array(places)


def test_the_first_mode_keeps_contact_without_shear(found):
    """
    requirement: both faces have the same normal displacement, real and imaginary part, and no shear
    traction along the wave, ∂w/∂z + i (N/r) u = 0; its drift is that of the table.
    """
    first = found.hot_spots.first
    (fields,) = first.blocks
    on_pad = (np.abs(fields.points[..., 1]) < 1e-9) & (fields.body == 1)[:, None]
    radii = np.unique(fields.points[on_pad][:, 0].round(9))[2:-2]
    (pad, _), (disk, z) = (face_values(fields, body, radii) for body in (1, 2))
    normal = disk[:, 0, 1]
    for one, other in ((pad[:, 0, 1].real, normal.real), (pad[:, 0, 1].imag, normal.imag)):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=0.02 * np.abs(other).max())
    steps = np.diff(disk[..., 2], axis=1) / np.diff(z, axis=1)
    slope = steps[:, 0] + (steps[:, 0] - steps[:, 1]) * (z[:, 0] - z[:, 1]) / (z[:, 0] - z[:, 2])
    expected = -1j * first.number / radii * normal
    np.testing.assert_allclose(slope, expected, rtol=0.0, atol=0.02 * np.abs(expected).max())
    drift = by_mode(found)[first.number, first.symmetry].drift
    assert drift > 0.0
    assert found.summary["first_hot_spots_drift_m_per_s"] == pytest.approx(drift, rel=1e-9)


@pytest.mark.slow
def test_ranks(tmp_path):
    """requirement: the same critical speeds on two ranks."""
    expected = hot_spots_on_ranks.computed_modes()
    same_on_two_ranks("tests.simulation.hot_spots_on_ranks", tmp_path, expected, rtol=1e-7)


def test_refused():
    """requirement: models without waves along the sliding are refused in one line."""
    model = model_of(load(case_tables("disk-brake-stability", COARSE)))
    for settings, words in (
        ({"wave_lengths": (0.1,)}, "analysis.wave_lengths: needs a plane-strain model"),
        ({"hot_spots": (3,), "mirror": ("pad_face",)}, "analysis.mirror: pad_face is no plane"),
        ({"hot_spots": (3,), "mirror": ("rim",)}, "analysis.mirror: found 'rim'"),
    ):
        with pytest.raises(CaseError, match=words):
            run(model, StabilityAnalysis(**settings))
    tables = case_tables("disk-brake-stability", COARSE | {"analysis.hot_spots": [3]})
    del tables["bodies"]["pad"]["density"]
    case = load(tables)
    with pytest.raises(ComputationError, match="density"):
        run_case(case)
