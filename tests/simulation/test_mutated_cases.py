"""Mutated cases that are accepted, run to their end: balanced and possible, or failed in words.

A few are run always. ``THERMOWEAR_MUTANTS=N`` in the environment asks for N accepted ones, and
``THERMOWEAR_SEED=M`` for others::

    THERMOWEAR_MUTANTS=200 THERMOWEAR_SEED=1000000 pytest -s tests/simulation/test_mutated_cases.py
"""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import signal
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.balances import ALLOWED, BALANCES
from thermowear.errors import CaseNote
from thermowear.output.files import name_at

from ..case.mutations import mutated

FEW = 2
MANY = int(os.environ.get("THERMOWEAR_MUTANTS", FEW))
FIRST = int(os.environ.get("THERMOWEAR_SEED", "20080"))
_PATIENCE = 60.0  # s of processor time; then a run is asked to stop
_LARGEST = (100, 24)
"""Degree times elements along the contact, in a section and in space."""


class Hang(Exception):
    """A run that does not stop where it is asked to."""


@contextlib.contextmanager
def asked_to_stop():
    """Stop what computes for long, by SIGTERM, twice; raise where it computes on.

    That is as Ctrl-C, which a process in the background ignores.
    """
    calls = itertools.count()

    def stop(*_):
        if next(calls) == 2:
            raise Hang
        signal.raise_signal(signal.SIGTERM)

    before = {number: signal.getsignal(number) for number in (signal.SIGPROF, signal.SIGTERM)}
    signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, _PATIENCE, _PATIENCE)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        for number, handler in before.items():
            signal.signal(number, handler)


def accepted(seed: int, path: Path) -> tuple[str, tuple[str, ...]] | None:
    """The class and the overrides of a mutated case that `load` takes and that is no large one."""
    kind, (content, overrides) = mutated(seed, coarse=True)
    path.write_bytes(content)
    with warnings.catch_warnings(), contextlib.suppress(tw.CaseError):
        warnings.simplefilter("ignore", CaseNote)
        case = tw.load(path, overrides)
        if case.mesh.degree * case.mesh.elements <= _LARGEST[case.model == "3d"]:
            return kind, overrides
    return None


def run_one(seed: int, folder: Path, capsys) -> int | None:
    """Exit code of an accepted mutant, and everything that must hold of what it left."""
    path, results = folder / "case.toml", folder / f"r{seed}"
    found = accepted(seed, path)
    if found is None:
        return None
    kind, overrides = found
    sets = [word for text in overrides for word in ("--set", text)]
    with asked_to_stop():
        code = main(["run", str(path), "-o", str(results), "--no-pictures", *sets])
    said = capsys.readouterr()
    where = f"seed {seed} ({kind}), exit code {code}\n{said.err}"
    assert code in (0, 1, 2, 130), where
    lines = said.err.splitlines()
    assert all(line.startswith(("note: ", "error: ")) for line in lines), where
    assert any(line.startswith("error: ") for line in lines) == (code != 0), where
    if code == 0:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", CaseNote)
            possible(tw.load(path, overrides), results, where)
    return code


def possible(case: tw.Case, results: Path, where: str) -> None:
    """Assert properties of the results of any successful run."""
    summary = json.loads((results / "summary.json").read_text())
    assert json.loads((results / "run.json").read_text())["status"] == "done", where
    for name in BALANCES:
        assert summary.get(name) is None or abs(summary[name]) <= ALLOWED, f"{name}: {where}"
    contacts = summary.get("contacts", {})
    for name, numbers in contacts.items() or [("", summary)]:
        possible_contact(results / name_at("interface", None, name), numbers, where)
    if not isinstance(case, tw.Case):
        return
    given = case.force()
    if given is not None and case.load.history is None and case.load.lever is None:
        pressed, pressure = summary["normal_force_N"], summary["contact_force_N"]
        curved = pressed < (1 - 1e-9) * pressure  # friction carries a part of the load there
        share = curved * (summary["friction_force_N"] + case.contact.transverse_friction * pressure)
        assert abs(pressed - given) <= share + 1e-6 * given, where


def possible_contact(path: Path, numbers: dict, where: str) -> None:
    """Assert properties of the table of a contact, and of its numbers."""
    names = path.read_text().partition("\n")[0].split(",")
    rows = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    table = dict(zip(names, rows.T, strict=True))
    pressure, weight = table["pressure_Pa"], table["weight_m2"]
    assert np.isfinite(pressure).all(), where
    assert pressure.min() >= -1e-6 * pressure.max(), where
    assert (weight >= 0.0).all(), where
    carried = numbers["mean_pressure_Pa"] * numbers["contact_area_m2"]
    assert weight @ pressure == pytest.approx(carried, rel=1e-6), where
    for body in (1, 2):
        temperature = table[f"temperature_{body}_K"]
        assert np.isnan(temperature).all() or temperature.min() > 0.0, where
        rate = table[f"wear_rate_{body}_m_per_s"]
        assert np.isnan(rate).all() or rate.min() >= -1e-9 * rate.max(), where


def test_mutated_cases_run(tmp_path, capsys):
    """
    requirement: no traceback, no hang, nothing out of balance or impossible with exit code 0.
    """
    codes: Counter = Counter()
    faults = []
    for seed in itertools.count(FIRST):
        try:
            codes[run_one(seed, tmp_path, capsys)] += 1
        except AssertionError as fault:
            faults.append(str(fault))
            codes["fault"] += 1
        if codes.total() - codes[None] >= MANY:
            break
    with capsys.disabled():
        if MANY > FEW:
            print(f"seeds {FIRST} to {seed}: exit codes {dict(codes)}")
    assert not faults, "\n".join(faults)
    assert codes[0] > 0
