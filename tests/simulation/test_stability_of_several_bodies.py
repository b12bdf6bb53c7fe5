"""Thermoelastic stability of several contacts: half models, pairs, a layer between half-planes."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.case import load
from thermowear.errors import CaseError
from thermowear.model.analyses import StaticAnalysis
from thermowear.reference.instability import ConductorOnInsulator, LayerBetweenInsulators
from thermowear.simulation.analyses.run import run
from thermowear.simulation.from_case import model_of
from thermowear.verification.cases.assembly.layer_instability import (
    CONDUCTIVITY,
    EXPANSION,
    FRICTION,
    HALF_PLANES,
    RATIO,
    WAVE,
    YOUNG_MODULUS,
    layer_checks,
)
from thermowear.verification.cases.assembly.pad_disk_pad import Brake

from ..case.starter import tables
from ..slow import marked_slow

SPEED, STABILITY = 20.0, {"type": "stability"}


def brake(disk, speed=SPEED, **changes):
    """Result of a disk between two pads, or of one half."""
    case = Brake(disk, heated=True, elements=6).tables("steady") | {"analysis": STABILITY}
    case["motions"] = {"disk": {"angular_velocity": f"{speed!r} rad/s"}}
    return tw.run(load(case | changes))


def modes_at(result, contact):
    """Columns of the modes at a contact."""
    return result.columns(f"mode_{contact}")


@pytest.fixture(scope="module")
def half():
    return brake("half")


@pytest.mark.parametrize("disk", ["floating", "clamped"])
def test_symmetric_modes_are_those_of_the_half_model(half, disk):
    """requirement: critical speeds to 1e-7, static ones to 1e-9; shapes alike at both."""
    found = brake(disk)
    keys = [key for key in half.summary if key.startswith(("critical_speed_f", "growth_rate"))]
    assert len(keys) == 4
    for key in keys:
        assert found.summary[key] == pytest.approx(half.summary[key], rel=1e-7), key
    expected = half.summary["static_speed_factors"]
    np.testing.assert_allclose(found.summary["static_speed_factors"], expected, rtol=1e-9)
    left, right = (modes_at(found, side) for side in ("left", "right"))
    for one in (right, modes_at(half, "left")):
        np.testing.assert_allclose(left["pressure"], one["pressure"], atol=1e-5)
    critical = found.summary["contacts"]["right"]["critical_angular_velocity_with_wear_rad_per_s"]
    factor = found.summary["critical_speed_factor_with_wear"]
    assert critical == pytest.approx(factor * SPEED, rel=1e-12)


def test_rates_at_the_critical_speed_vanish():
    """requirement: of two unequal pads what grows beyond the speed found decays below."""
    factor = brake("clamped", wear={}).summary["critical_speed_factor"]
    below, above = (
        brake("clamped", part * factor * SPEED, wear={}).summary["growth_rate_per_s"]
        for part in (0.98, 1.02)
    )
    assert below < 0.0 < above


def test_a_pair_as_one_of_several():
    """requirement: one contact with a name has the numbers of the pair."""
    case = load(tables("disk-brake-stability", {"mesh": {"degree": 3, "elements": 6}}))
    model, analysis = model_of(case), StaticAnalysis("stability")
    named = replace(model, interfaces=(replace(model.interface, name="pad-disk"),))
    pair, one = (run(each, analysis).summary for each in (model, named))
    for key in ("critical_speed_factor", "critical_speed_factor_with_wear", "growth_rate_per_s"):
        assert one[key] == pytest.approx(pair[key], rel=1e-9)
    for key in ("critical_angular_velocity_rad_per_s", "critical_speed_with_wear_m_per_s"):
        assert one["contacts"]["pad-disk"][key] == pytest.approx(pair[key], rel=1e-9)


@pytest.mark.parametrize("half_planes", marked_slow(HALF_PLANES, "rigid"))
def test_a_layer_between_two_half_planes(half_planes):
    """requirement: the critical speeds of all four modes, and their shapes at both contacts."""
    checks = list(layer_checks(half_planes))
    assert len(checks) == 9
    assert not [check for check in checks if not check.passed]
    assert max(check.error for check in checks[:5]) < 2e-6


def test_thick_layers_are_half_planes():
    """requirement: the closed form of a conductor on an insulator, in the limit."""
    steel = RATIO, EXPANSION, CONDUCTIVITY, FRICTION
    thick = LayerBetweenInsulators(WAVE, 10 * WAVE, YOUNG_MODULUS, *steel)
    one = ConductorOnInsulator(WAVE, YOUNG_MODULUS / (1 - RATIO**2), *steel)
    assert thick.symmetric == pytest.approx(one.critical_speed, rel=1e-12)
    assert thick.antisymmetric == pytest.approx(one.critical_speed, rel=1e-12)
    thin = replace(thick, thickness=1e-3 * WAVE)
    assert thin.symmetric < 0.01 * one.critical_speed < one.critical_speed < thin.antisymmetric


HELD = {"surface": "right_bottom", "free": []}
HISTORY = {"time": ["0 s", "1 s"], "force": ["1 N", "2 N"]}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"heat": None}, "heat: missing; required in a stability analysis"),
        ({"motions": {}}, "motions: missing; "),
        ({"contact": {"friction": 0.0}}, "contacts: have no friction"),
        (
            {"holders": {"left": {"surface": "left_top", "history": HISTORY}, "right": HELD}},
            "holders.left.history: requires a transient analysis, not stability",
        ),
        ({"contact": {"friction": "0.3 + v/(1 m/s)"}}, "contacts.left.friction: depends on v"),
    ],
)
def test_faults(changes, line):
    """requirement: in one line each, with the path of the key."""
    case = Brake("clamped", heated=True).tables("steady") | {"analysis": STABILITY} | changes
    if changes.get("heat", 0) is None:
        del case["heat"]
    with pytest.raises(CaseError) as caught:
        load(case)
    assert any(text.strip().startswith(line) for text in str(caught.value).splitlines())
