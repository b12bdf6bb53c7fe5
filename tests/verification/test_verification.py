"""The verification cases, the same that ``thermowear verify`` runs."""

import json
import math

import pytest

from thermowear import verification
from thermowear.app.cli import main
from thermowear.errors import CaseError, ComputationError
from thermowear.verification import CASES, SLOW, Check, compare
from thermowear.verification.check import computed, starter

LONG = SLOW | {
    "hertz-sphere-3d",
    "annular-punch", "beam-shakedown", "block-on-ring", "braking-stop", "cad-part", "calibration",
    "case-2",
    "case-3", "case-4", "case-5", "case-6", "case-7", "case-8", "case-9", "clutch-pack",
    "coated-bush", "coating", "deep-wear-3d", "floating-caliper", "fretting-cylinder",
    "fretting-sphere", "fretting-wear", "fuel-fretting", "growing-cylinder", "growing-sphere",
    "half-plane-instability", "hertz-elliptical", "hertz-line", "layer-instability",
    "methods-agree", "mindlin", "mindlin-sphere", "minimality", "moving-band", "optimal-shape",
    "pad-disk-pad", "patch", "patch-3d", "pin-on-disk-3d", "pressure-conductance", "reciprocating",
    "reciprocating-3d", "ring-3d", "running-in", "sliding-rod", "sobol", "step-flux", "tei-growth",
    "tei-layer-antisymmetric", "tei-layer-symmetric", "tei-ring", "temperature-dependent",
    "two-shoes", "two-slabs",
}  # fmt: skip
"""Cases of more than three seconds; run by `make verify`."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name in LONG else ()) for name in CASES]
)
def test_case(name):
    """requirement: every quantity within what is allowed of its reference."""
    checks = list(CASES[name]())
    assert len(checks) > 5
    assert all(check.source and check.id == name for check in checks)
    assert not [check for check in checks if not check.passed]
    assert json.dumps([check.as_row() for check in checks])


def fake(error):
    return lambda: iter([Check("one [1]", 1.0 + error, 1.0, error, 1e-3, "nobody", "fake")])


def test_rows_and_exit_code(monkeypatch, capsys):
    """requirement: id, quantity, computed, reference, error, allowed, verdict; 2 if one fails."""
    monkeypatch.setitem(verification.CASES, "fake", fake(1e-4))
    assert main(["verify", "fake"]) == 0
    out = capsys.readouterr().out
    assert "one [1]" in out
    assert "1 passed, 0 failed" in out
    monkeypatch.setitem(verification.CASES, "fake", fake(1e-2))
    assert main(["verify", "fake"]) == 2
    assert "FAILED" in capsys.readouterr().out


def failing(error):
    """A case that ends with an error after its first check."""
    yield from fake(1e-4)()
    raise error


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ComputationError("no step\nis small enough"), "not computed: no step is small enough"),
        (CaseError("mesh.degree: too high"), "not computed: mesh.degree: too high"),
        (ZeroDivisionError("by zero"), "not computed: ZeroDivisionError: by zero"),
    ],
)
def test_a_case_that_raises_is_a_failed_row(error, said, monkeypatch, capsys):
    """requirement: its id and the reason; the cases after it are computed, and the code is 2."""
    cases = {"broken": lambda: failing(error), "fake": fake(2e-4)}
    monkeypatch.setattr(verification, "CASES", cases)
    assert main(["verify", "--json"]) == 2
    before, broken, after = json.loads(capsys.readouterr().out)
    assert (before["passed"], broken["passed"], after["passed"]) == (True, False, True)
    assert (broken["id"], broken["quantity"]) == ("broken", said)
    assert broken["computed"] is broken["error"] is None
    assert main(["verify"]) == 2
    heard = capsys.readouterr()
    assert "2 passed, 1 failed" in heard.out
    assert "Traceback" not in heard.out + heard.err


def test_a_run_that_stops_on_its_way_is_not_compared():
    """requirement: no number of a run that failed, or was interrupted, is held against any."""
    case = starter("annular-punch-running-in", "mesh.degree=2", "analysis.max_steps=3")
    with pytest.raises(ComputationError, match="max_steps"):
        computed(case)


def test_json(monkeypatch, capsys):
    """requirement: ``--json`` prints a list with the agreed keys and nothing else."""
    monkeypatch.setitem(verification.CASES, "fake", fake(1e-4))
    assert main(["verify", "fake", "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert list(row) == [
        "id", "quantity", "computed", "reference", "error", "allowed", "source", "passed",
    ]  # fmt: skip
    assert row["passed"] is True


@pytest.mark.parametrize(
    ("words", "run"),
    [
        ([], ["quick"]),
        (["--slow"], ["quick", "long"]),
        (["long"], ["long"]),
        (["quick"], ["quick"]),
    ],
)
def test_slow_cases_are_asked_for(words, run, monkeypatch, capsys):
    """requirement: ``--slow`` or their names; what was left out is said, apart from the list."""
    by_error = {1e-4: "quick", 2e-4: "long"}
    cases = {name: fake(error) for error, name in by_error.items()}
    monkeypatch.setattr(verification, "CASES", cases)
    monkeypatch.setattr(verification, "SLOW", {"long"})
    assert main(["verify", "--json", *words]) == 0
    heard = capsys.readouterr()
    assert [by_error[row["error"]] for row in json.loads(heard.out)] == run
    assert ("long" in heard.err) == (words == [])


def test_slow_cases_are_cases():
    assert set(CASES) > SLOW


def test_unknown_id(capsys):
    assert main(["verify", "nothing"]) == 1
    assert "annular-punch, running-in" in capsys.readouterr().err


def test_nan_is_a_failure():
    """requirement: what was not computed has not passed."""
    assert not compare("y", math.nan, 1.0, 1.0, "z").passed
    assert compare("y", 1.01, 1.0, 0.02, "z").passed
    assert compare("y", 0.001, 0.0, 0.02, "z", scale=1.0).error == pytest.approx(0.001)
