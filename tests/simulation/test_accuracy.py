"""Estimates of the discretisation error against true errors."""

from __future__ import annotations

import numpy as np
import pytest

from thermowear.errors import ComputationError
from thermowear.results.points import part_of
from thermowear.simulation import Observer, run
from thermowear.verification.check import run_starter, starter

from ..benchmarks.error_estimates import LINE, RING, Study, line, worn_shape

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
    ((_, true, estimate),) = Study("cylinder-on-block", LINE + mesh, line()).rows()
    assert estimate / 3 < true < 3 * estimate


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
    ((_, true, estimate),) = Study("cylinder-on-block", (*LINE, key, *mesh), line()).rows()
    assert estimate / 3 < true < 3 * estimate


def test_what_is_not_estimated_is_said():
    """requirement: null with the reason where there is no estimate."""
    result = run_starter(
        "cylinder-on-block", *LINE, 'contact.pressure_degree="lobatto"', "mesh.elements=4"
    )
    missing = result.summary["error_estimate_missing"]
    assert estimates(result)["pressure"] is None
    assert "lobatto" in missing["pressure"]
    assert missing["temperature"] == "isothermal"


def test_no_estimate_never_ends_a_run(monkeypatch):
    """requirement: results are kept where the richer contact has no solution."""

    def fails(*_):
        raise ComputationError("no pressure satisfies the contact conditions")

    monkeypatch.setattr("thermowear.simulation.accuracy.error_estimate.enriched_pressure", fails)
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


def relative_change(coarse, fine, quantity):
    """Mean change of the pressure, or largest one of the shape up to a translation."""
    known = np.interp(coarse.x, fine.x, getattr(fine, quantity))
    change = getattr(coarse, quantity) - known
    if quantity == "pressure":
        return coarse.weight @ np.abs(change) / (coarse.weight @ known)
    return np.abs(change - np.average(change, weights=coarse.weight)).max() / np.ptp(known)
