"""Comparison of a case with a coarser and a finer discretisation."""

from __future__ import annotations

import json

import pytest

from thermowear.app.cli import main
from thermowear.app.session import neighbours
from thermowear.verification.check import starter

from ..simulation.test_accuracy import LINE


@pytest.mark.parametrize(
    ("settings", "coarser", "finer"),
    [
        ((), ("mesh.degree=5",), ("mesh.degree=7",)),
        (("mesh.degree=1",), ("mesh.elements=6",), ("mesh.degree=2",)),
        (("mesh.degree=10",), ("mesh.degree=9",), ("mesh.elements=24",)),
        (
            ("contact.pressure_degree=4",),
            ("mesh.degree=5", "contact.pressure_degree=3"),
            ("mesh.degree=7", "contact.pressure_degree=5"),
        ),
    ],
)
def test_neighbours(settings, coarser, finer):
    """requirement: one degree coarser and finer, at the ends of the range half or twice as many."""
    found = neighbours(starter("cylinder-on-block", "mesh.elements=12", *settings))
    assert found == {"coarser": coarser, "finer": finer}


@pytest.mark.slow
def test_three_side_by_side(tmp_path, capsys):
    """requirement: ``run --accuracy`` prints coarser, own and finer numbers, and keeps them."""
    assert main(["init", "cylinder-on-block", "-o", str(tmp_path / "case.toml")]) == 0
    changes = [
        word for key in (*LINE, "mesh.degree=2", "mesh.elements=4") for word in ("--set", key)
    ]
    words = ["run", str(tmp_path / "case.toml"), "-o", str(tmp_path / "out"), "--no-pictures"]
    assert main([*words, "--accuracy", *changes]) == 0
    said = capsys.readouterr().out
    assert "coarser: mesh.degree=1" in said
    assert "±" in said
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    finer, coarser = summary["finer_discretisation"], summary["coarser_discretisation"]
    key = "pressure_error_estimate_relative"
    assert finer[key] < summary[key] < coarser[key]
    assert finer["dofs_displacement"] > summary["dofs_displacement"]
