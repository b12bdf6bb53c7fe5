"""Starters of several bodies: files by contact, forces and balances."""

import contextlib
import io
import json
import tomllib

import numpy as np
import pytest

import thermowear as tw
from thermowear.app.cli import main
from thermowear.case.starters import starter_text, starters
from thermowear.output import tables

from .test_end_to_end import COARSE, HEADS, run, sets, summary_of

QUICK = {
    "clutch-pack": ("mesh.degree=2", "analysis.end_time=0.3 s", 'analysis.output_times=["0.1 s"]'),
}


def separate(name):
    """True for a starter of several bodies without glued faces."""
    contacts = tomllib.loads(starter_text(name)).get("contacts", {})
    several = "holders" in tomllib.loads(starter_text(name))
    return several and not any(contact.get("tie") for contact in contacts.values())


@pytest.fixture(scope="module", params=[name for name in starters() if separate(name)])
def finished(request, tmp_path_factory):
    """Case and results folder of a coarse run."""
    name = request.param
    place = tmp_path_factory.mktemp(name)
    words = (*COARSE, *QUICK.get(name, ()))
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(["init", name, "-o", str(place / "case.toml")]) == 0
        assert run(place / "case.toml", place / "results", *sets(*words)) == 0
    assert tw.load(place / "case.toml", words) == tw.load(place / "results/case.resolved.toml")
    return tw.load(place / "results/case.resolved.toml"), place / "results"


def test_files_by_contact(finished):
    """requirement: an interface and a profile of each contact, with the columns of a pair."""
    case, folder = finished
    expected = {"summary.json", "run.json", "case.resolved.toml", "fields.vtu"}
    at = [""]
    if case.analysis.type == "transient":
        at += [f"_at_{time:g}" for time in case.analysis.output_times]
        expected |= {"checkpoint.npz", "history.csv"}
        expected |= {"heat.csv"} if case.heat.transient else set()
    expected |= {f"interface_{name}{time}.csv" for name in case.contacts for time in at}
    expected |= {f"profile_{name}.csv" for name in case.contacts}
    assert {path.name for path in folder.iterdir()} == expected
    assert json.loads((folder / "run.json").read_text(encoding="utf-8"))["status"] == "done"
    for path in folder.glob("*.csv"):
        head = path.read_text(encoding="utf-8").splitlines()[0]
        assert head == HEADS[path.stem.partition("_")[0]], path


def test_summary_by_contact(finished):
    """requirement: force, peak and heat of each contact are those of its table; balances."""
    case, folder = finished
    summary = summary_of(folder)
    assert list(summary["contacts"]) == list(case.contacts)
    assert list(summary["holders"]) == list(case.holders)
    assert list(summary["bodies"]) == list(case.geometry.bodies)
    assert summary["equilibrium_relative_error"] < 1e-9
    assert summary["heat_balance_relative_error"] < 1e-9
    into = 0.0
    for name, found in summary["contacts"].items():
        i = tables.read(folder / f"interface_{name}.csv")
        assert i["pressure"].max() == pytest.approx(found["max_pressure_Pa"], rel=1e-12)
        assert i["weight"] @ i["pressure"] == pytest.approx(found["normal_force_N"], rel=1e-9)
        heat = i["weight"] @ (i["heat_flux_1"] + i["heat_flux_2"])
        assert heat == pytest.approx(found["friction_power_W"], rel=1e-9)
        assert np.all(np.diff(i["s"]) >= 0)
        into += heat
    assert into == pytest.approx(summary["friction_power_W"], rel=1e-9)
