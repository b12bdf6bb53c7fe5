"""Meshes for an accuracy: true errors, keys that are kept, results folder, sweeps."""

import tomllib

import numpy as np
import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case import starters
from thermowear.reference.elastic_contact.hertz import contact_modulus, line_contact
from thermowear.simulation import Observer
from thermowear.simulation.from_case import with_accurate_mesh
from thermowear.verification.check import computed, run_starter, starter

from ..conftest import DEMOS

LINE = (
    "geometry.radius=6 mm",
    "bodies.cylinder.young_modulus=200 GPa",
    'load={force="120 N"}',
    "contact.positioning=false",
)


def asking(name, accuracy, *overrides, without=("mesh",)):
    """Starter case on a mesh that is to be found."""
    return starter(name, f'mesh.accuracy="{accuracy}"', *overrides, without=without)


class Notes(Observer):
    """Notes of a run."""

    def __init__(self):
        self.texts = []

    def note(self, text):
        self.texts.append(text)


@pytest.mark.parametrize("accuracy", [5.0, 1.0, pytest.param(0.2, marks=pytest.mark.slow)])
def test_the_largest_pressure_of_a_line_contact(accuracy):
    """requirement: Hertz's largest pressure to the accuracy that is asked for."""
    result = computed(asking("cylinder-on-block", f"{accuracy:g} %", *LINE))
    exact = line_contact(120e3, 6e-3, contact_modulus(*2 * ((200e9, 0.3),)))
    assert result.summary["max_pressure_Pa"] == pytest.approx(exact.peak, rel=accuracy / 100)


@pytest.mark.slow
def test_the_shape_of_a_hot_ring():
    """requirement: the steady worn shape to 1 % of its range, against a fine mesh."""
    case = with_accurate_mesh(asking("annular-punch", "1 %"))
    found, fine = computed(case).interface, run_starter("annular-punch").interface
    change = found.shape - np.interp(found.x, fine.x, fine.shape)
    change -= np.average(change, weights=found.weight)
    assert np.abs(change).max() <= 0.01 * np.ptp(fine.shape)
    assert case.mesh.degree < 8  # that of the starter
    assert case.mesh.elements < 12


def test_keys_that_are_given_are_kept():
    """requirement: the search changes only keys that the case does not give, or says so."""
    case = with_accurate_mesh(asking("annular-punch", "2 %", "mesh.degree=4"))
    assert case.mesh.degree == 4
    assert case.mesh.accuracy == 0.02
    notes = Notes()
    given = starter("annular-punch", 'mesh.accuracy="1 %"')
    assert with_accurate_mesh(given, observer=notes) is given
    assert notes.texts == [
        "mesh.accuracy: the mesh is kept, as all keys that it could choose are given"
    ]


def test_of_a_mesh_file_only_the_degree_is_chosen():
    """requirement: elements and grading have no effect on a mesh file."""
    tables = tomllib.loads((DEMOS / "own_mesh.toml").read_text())
    tables["mesh"] = {"accuracy": "5 %"}
    tables["geometry"]["path"] = str(DEMOS / "own-mesh.msh")
    case = tw.load(tables)
    found = with_accurate_mesh(case)
    assert (found.mesh.elements, found.mesh.grading) == (case.mesh.elements, case.mesh.grading)
    assert computed(found).summary["shape_error_estimate_relative"] < 0.05


@pytest.mark.slow
def test_of_bodies_from_cad_only_the_degree_is_chosen(monkeypatch):
    """requirement: sizes of bodies from CAD are kept, and the note says so."""
    monkeypatch.chdir(next(iter(starters.__path__)))  # that of the STEP files
    notes = Notes()
    sizes = ("mesh.size=30 mm", "mesh.contact_size=15 mm")
    found = with_accurate_mesh(asking("cad-pad", "60 %", *sizes), observer=notes)
    assert found.mesh.grading == asking("cad-pad", "60 %").mesh.grading
    (text,) = notes.texts
    assert text.startswith("mesh.accuracy: mesh.degree = ")
    assert "mesh.elements" not in text
    assert text.endswith(
        "mesh.size, mesh.contact_size and mesh.grading of bodies from CAD are kept"
    )


def test_an_accuracy_out_of_reach_is_said():
    """requirement: the note tells the error that was reached."""
    notes = Notes()
    with_accurate_mesh(
        asking("annular-punch", "0.001 %", "mesh.degree=1", "mesh.elements=4"), observer=notes
    )
    (text,) = notes.texts
    assert "not 0.001 %: no mesh that was tried reaches it" in text


def test_without_an_estimate():
    """requirement: an analysis whose error is not estimated is refused with the reason."""
    with pytest.raises(tw.CaseError, match=r"mesh\.accuracy: .* not known: nothing presses"):
        with_accurate_mesh(asking("disk-brake-stop", "1 %"))


def test_the_folder_has_the_mesh(tmp_path, capsys):
    """requirement: the case with all values names the mesh; a finished run is not repeated."""
    path, folder = tmp_path / "ring.toml", tmp_path / "results"
    tables = tomllib.loads((DEMOS / "annular_punch.toml").read_text())
    path.write_text(tomli_w.dumps(tables | {"mesh": {"accuracy": "2 %"}}))
    words = ["run", str(path), "--no-pictures", "-o", str(folder)]
    assert main(words) == 0
    assert "mesh.accuracy: mesh.degree = " in capsys.readouterr().out
    mesh = tomllib.loads((folder / "case.resolved.toml").read_text())["mesh"]
    assert {"degree", "elements", "grading", "accuracy"} <= mesh.keys()
    assert main([*words, "--resume"]) == 0
    assert "nothing is left to compute" in capsys.readouterr().out
    assert main(["mesh", str(path), "-o", str(tmp_path / "ring.vtu")]) == 0


@pytest.mark.slow
def test_a_sweep_of_accuracies():
    """requirement: each variant has a mesh of its own."""
    (_, coarse), (_, fine) = tw.sweep(
        asking("annular-punch", "5 %"), {"mesh.accuracy": ["5 %", "1 %"]}
    )
    assert coarse.summary["dofs_displacement"] < fine.summary["dofs_displacement"]


@pytest.mark.parametrize("given", ["0 %", "101 %", "1", "-1 %", "one %", 0.01, True])
def test_percentages(given):
    """requirement: an accuracy is a percentage."""
    tables = tomllib.loads((DEMOS / "annular_punch.toml").read_text())
    with pytest.raises(tw.CaseError, match=r'mesh\.accuracy: must be .* such as "1 %"'):
        tw.load(tables | {"mesh": {"accuracy": given}})
