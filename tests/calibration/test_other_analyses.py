"""Calibration of fretting and of reciprocating wear."""

from __future__ import annotations

import pytest

import thermowear as tw

from ..case.starter import tables

FRICTION = {"key": "contact.friction", "start": 0.45, "lower": 0.35, "upper": 0.9}


def test_friction_from_the_dissipated_energy(tmp_path):
    """requirement: fretting: friction from the energy dissipated at the ends of load segments."""
    case = tables("cylinder-stick-slip", {"mesh.degree": 2, "analysis.increments": 5})
    run = tw.run(tw.load(case))
    rows = {row.time: row.dissipated for row in run.friction.rows}
    lines = [f"{time}, {1e3 * rows[time]!r}" for time in (2.0, 3.0)]
    path = tmp_path / "energy.csv"
    path.write_text("\n".join(["time [s], dissipated [mJ]", *lines]) + "\n")
    case["calibrate"] = {
        "parameters": {"mu": FRICTION},
        "observations": {"energy": {"file": str(path), "deviation": "5 %"}},
    }
    found = tw.calibrate(tw.load(case))
    assert found.values["mu"] == pytest.approx(0.6, rel=1e-3)
    assert found.standard_errors["mu"] > 0.0


def test_wear_from_the_depth_of_a_stroke(tmp_path):
    """requirement: reciprocating: wear coefficient from the worn volume, V ~ k."""
    case = tables("punch-on-strip-reciprocating", {"mesh.degree": 2, "mesh.elements": 4})
    run = tw.run(tw.load(case))
    row = run.history[len(run.history) // 2]
    volume = 1e9 * row.wear_volume_1
    path = tmp_path / "volume.csv"
    head = "time [s], wear_volume_1 [mm^3], deviation [mm^3]"
    path.write_text(f"{head}\n{row.time!r}, {volume!r}, {volume / 100!r}\n")
    number, _, unit = case["wear"]["punch"]["coefficient"].partition(" ")
    k = float(number)
    case["calibrate"] = {
        "parameters": {
            "k": {
                "key": "wear.punch.coefficient",
                "start": f"{2 * k} {unit}",
                "lower": f"{k / 10} {unit}",
                "upper": f"{10 * k} {unit}",
                "scale": "log",
            }
        },
        "observations": {"volume": {"file": str(path)}},
    }
    found = tw.calibrate(tw.load(case))
    assert found.values["k"] == pytest.approx(k, rel=1e-3)
    assert found.standard_errors["k"] == pytest.approx(0.01, rel=0.1)
