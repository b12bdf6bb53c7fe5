"""Estimates of the discretisation error against true errors."""

from __future__ import annotations

from mpi4py import MPI

import numpy as np
import pytest

from thermowear.contact.operators.exchange_matrix import BaselineResponse
from thermowear.contact.solvers.enriched_pressure import EnrichedContact
from thermowear.errors import ComputationError
from thermowear.results.points import part_of
from thermowear.simulation import Observer, run
from thermowear.simulation.accuracy.enriched_bodies import heated_faces
from thermowear.simulation.analyses.positioning import prepare
from thermowear.simulation.analyses.stability import base_state
from thermowear.simulation.from_case import model_of
from thermowear.timer import Phases
from thermowear.verification.cases.contact import hertz_in_space
from thermowear.verification.check import run_starter, starter

from ..benchmarks.error_estimates import (
    ELLIPSES,
    LINE,
    PAIRS,
    RING,
    Study,
    cad_pad,
    ellipse,
    line,
    on_the_same_cells,
    worn_shape,
)

MESHES = [(1, 4), (2, 2), (2, 8), (4, 4)]
HOT = ("mesh.degree=2", "mesh.elements=4")


def estimates(result):
    return {
        key.removesuffix("_error_estimate_relative"): value
        for key, value in result.summary.items()
        if key.endswith("_error_estimate_relative")
    }


class Notes(Observer):
    def __init__(self):
        self.texts = []

    def note(self, text):
        self.texts.append(text)


@pytest.mark.parametrize(("degree", "elements"), MESHES)
def test_pressure_of_a_line_contact(degree, elements):
    """requirement: the true error, of Hertz's closed form, is within a factor 3 of the estimate."""
    mesh = f"mesh.degree={degree}", f"mesh.elements={elements}"
    (_, true, estimate), largest = Study("cylinder-on-block", LINE + mesh, line()).rows()
    assert estimate / 3 < true < 3 * estimate
    assert largest[0] == "max_pressure"
    assert largest[1] < 3 * largest[2]


def test_the_largest_pressure_does_not_agree_by_chance():
    """requirement: an unchanged maximum next to pressures that change is no accuracy.

    On this mesh the largest value is 11 % wrong, and changes by 1.5 % with the next degree.
    """
    mesh = "mesh.degree=1", "mesh.elements=8"
    true, estimate = Study("cylinder-on-block", LINE + mesh, line()).rows()[1][1:]
    assert true > 0.1
    assert true < 3 * estimate


def test_shape_and_temperature_of_a_hot_ring():
    """requirement: so are shape and temperature of a steady state, of a converged one."""
    errors = worn_shape(
        "annular-punch", *RING, "mesh.degree=6", "mesh.elements=8", modes=lambda x: x[:, None] ** 0
    )
    rows = Study("annular-punch", RING + HOT, errors).rows()
    assert [quantity for quantity, *_ in rows] == ["shape", "temperature"]
    for _, true, estimate in rows:
        assert estimate / 3 < true < 3 * estimate


def test_locking_is_said():
    """requirement: degree 1 at the largest Poisson ratio that it may have is not silent."""
    notes = Notes()
    mesh = "mesh.degree=1", "mesh.elements=8"
    case = starter("cylinder-on-block", *LINE, "bodies.cylinder.poisson_ratio=0.45", *mesh)
    result = run(case, observer=notes)
    assert estimates(result)["pressure"] > 0.1
    (text,) = [text for text in notes.texts if "discretisation error" in text]
    assert "run --accuracy" in text


def test_a_fine_mesh_is_not_blamed():
    """requirement: no warning where the errors are below 5 %."""
    notes = Notes()
    run(starter("cylinder-on-block", *LINE, "mesh.degree=3", "mesh.elements=8"), observer=notes)
    assert not notes.texts


@pytest.mark.parametrize("method", ["penalty", "nitsche"])
def test_all_methods_are_judged(method):
    """requirement: penalty and Nitsche's method have the estimate, of their own pressure."""
    mesh = "mesh.degree=2", "mesh.elements=4"
    key = f"contact.method={method}"
    _, true, estimate = Study("cylinder-on-block", (*LINE, key, *mesh), line()).rows()[0]
    assert estimate / 3 < true < 3 * estimate


IN_TIME = 'analysis={{type="transient", end_time="{} s", tolerance=1e-4}}'


@pytest.mark.parametrize("end", [5, 200])
def test_shape_of_a_running_in(end):
    """requirement: so is a shape that wears in, long before the steady state and near to it."""
    words = (*RING, IN_TIME.format(end))
    fine = (*words, "mesh.degree=4", "mesh.elements=10")
    errors = worn_shape("annular-punch-running-in", *fine, modes=lambda x: x[:, None] ** 0)
    mesh = "mesh.degree=1", "mesh.elements=4"
    _, true, estimate = Study("annular-punch-running-in", words + mesh, errors).rows()[0]
    assert estimate / 3 < true < 3 * estimate


def test_the_largest_pressure_of_a_growing_contact():
    """requirement: elements cut by the end of the wear are not held against it; the change on finer
    meshes is within the estimate, which stays small.
    """
    words = "analysis.end_time=10 s", "analysis.output_times=[]"
    *found, fine = (
        run_starter("cylinder-on-block-growing", *words, f"mesh.elements={n}").summary
        for n in (20, 40, 80, 160)
    )
    for each in found:
        estimate = each["max_pressure_error_estimate_relative"]
        assert abs(each["max_pressure_Pa"] / fine["max_pressure_Pa"] - 1) < estimate < 0.03


@pytest.mark.parametrize("mesh", [HOT, ("mesh.degree=3", "mesh.elements=3")], ids=str)
def test_temperatures_in_time(mesh):
    """requirement: so are temperatures while heat is stored, also those by a wrong pressure."""
    words = (
        *(*RING, IN_TIME.format(20), "heat.transient=true"),
        *("bodies.punch.density=7800 kg/m^3", "bodies.punch.specific_heat=460 J/(kg K)"),
    )
    fine = (*words, "mesh.degree=4", "mesh.elements=10")
    errors = worn_shape("annular-punch", *fine, modes=lambda x: x[:, None] ** 0)
    _, true, estimate = Study("annular-punch", words + mesh, errors).rows()[1]
    assert estimate / 3 < true < 3 * estimate


def test_heat_of_a_wrong_pressure():
    """requirement: details of the friction heat warm both faces as in the exchange of the faces."""
    model = model_of(starter("annular-punch", *RING, "mesh.degree=2", "mesh.elements=16"))
    end, _ = base_state(prepare(model, MPI.COMM_WORLD, Phases()), Observer())
    system, conductance = end.system, end.contact.conditions.conductance
    x = system.contacts.each[0].points[:, 0]
    heat = 1e4 * np.sin(6 * np.pi * (x - x.min()) / np.ptp(x))
    found = heated_faces(system, system.thermal, heat, conductance)
    none = np.zeros(len(x))
    coupled = system.thermal.face.exchange(conductance).state(heat, BaselineResponse((none, none)))
    known = np.array(coupled.rise)
    assert np.abs(found - known).max() < 0.3 * np.abs(known).max()


def test_heat_carried_along():
    """requirement: so are temperatures where the disk carries heat along, on few cells in space."""
    mesh = ("mesh.elements=6",)
    fine = (*mesh, "mesh.degree=3")
    errors = on_the_same_cells("disk-brake-3d", *fine, quantities=("shape", "temperature"))
    for _, true, estimate in Study("disk-brake-3d", (*mesh, "mesh.degree=1"), errors).rows():
        assert estimate / 3 < true < 3 * estimate


@pytest.mark.parametrize("many", [0, 10**9])
def test_pressure_in_space(monkeypatch, many):
    """requirement: so is the pressure of crossed cylinders on own tetrahedra, of many points, too.

    Then the enriched contact is linearised.
    """
    monkeypatch.setattr("thermowear.simulation.accuracy.error_estimate._MANY", many)
    exact = ELLIPSES["cylinders"]
    result = hertz_in_space.pressed(PAIRS["cylinders"](), exact, (0.8, 0.4))
    for quantity, true in ellipse(exact, result).items():
        assert true < 3 * estimates(result)[quantity]
    assert estimates(result)["pressure"] < 3 * ellipse(exact, result)["pressure"]


def test_what_is_not_estimated_is_said():
    """requirement: null with the reason, and a note, where there is no estimate."""
    notes = Notes()
    words = 'contact.pressure_degree="lobatto"', "mesh.elements=4"
    result = run(starter("cylinder-on-block", *LINE, *words), observer=notes)
    (note,) = notes.texts
    assert note.startswith("no estimate of the discretisation error of pressure, because contact.")
    missing = result.summary["error_estimate_missing"]
    assert estimates(result)["pressure"] is None
    assert "lobatto" in missing["pressure"]
    assert missing["temperature"] == "isothermal"


def test_the_largest_pressure_of_a_cycle_has_no_estimate():
    """requirement: that of a stroke has none, unlike the one at mid-stroke, and a note says so."""
    notes = Notes()
    words = "analysis.cycles=10", "analysis.output_times=[]"
    result = run(starter("punch-on-strip-reciprocating", *words), observer=notes)
    (note,) = (text for text in notes.texts if text.startswith("no estimate"))
    assert "of the largest pressure of the cycle, because all estimates are those of mid" in note
    assert "max_pressure_of_cycle" in result.summary["error_estimate_missing"]
    assert estimates(result)["max_pressure"] is not None


def test_no_estimate_never_ends_a_run(monkeypatch):
    """requirement: results are kept where the richer contact has no solution."""

    def fails(*_):
        raise ComputationError("no pressure satisfies the contact conditions")

    monkeypatch.setattr(EnrichedContact, "solved", fails)
    result = run_starter("cylinder-on-block", *LINE, "mesh.degree=2", "mesh.elements=4")
    assert estimates(result)["pressure"] is None
    assert "satisfies" in result.summary["error_estimate_missing"]["pressure"]


def test_a_flat_shape_has_no_error():
    """requirement: rounding is not held against a shape that is flat."""
    result = run_starter("stacked-blocks", "mesh.degree=1")
    assert estimates(result)["shape"] is None
    assert estimates(result)["temperature"] < 1e-9  # straight through: exact


def test_errors_of_several_bodies():
    """requirement: so are the errors of pad, disk and pad, with glued back plates."""
    mesh = "mesh.degree=2", "mesh.elements=4"
    for kind, quantity in (("initial", "pressure"), ("steady", "shape")):
        found, fine = (
            run_starter("disk-brake-two-pads", f"analysis.type={kind}", *words)
            for words in (mesh, ("mesh.degree=5", "mesh.elements=12"))
        )
        true = max(
            relative_change(part_of(found.interface, own), part_of(fine.interface, other), quantity)
            for own, other in zip(found.contacts.values(), fine.contacts.values(), strict=True)
        )
        assert estimates(found)[quantity] / 3 < true < 3 * estimates(found)[quantity]


def test_glued_bodies_behind_the_contact():
    """requirement: a thin back plate that linear cells do not bend makes the shape wrong, too."""
    errors = on_the_same_cells("cad-pad", *cad_pad(15), "mesh.degree=2", quantities=("shape",))
    found = run_starter("cad-pad", *cad_pad(15), "mesh.degree=1")
    assert errors(found)["shape"] < 5 * estimates(found)["shape"]


def relative_change(coarse, fine, quantity):
    """Mean change of the pressure, or largest one of the shape up to a translation."""
    known = np.interp(coarse.x, fine.x, getattr(fine, quantity))
    change = getattr(coarse, quantity) - known
    if quantity == "pressure":
        return coarse.weight @ np.abs(change) / (coarse.weight @ known)
    return np.abs(change - np.average(change, weights=coarse.weight)).max() / np.ptp(known)
