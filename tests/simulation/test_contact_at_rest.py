"""Contacts at rest next to one that slides and wears: elastic contact, whatever their order."""

import numpy as np
import pytest

import thermowear as tw
from thermowear.errors import ComputationError

from ..case.starter import changed, tables

STORING = {"density": "2000 kg/m^3", "specific_heat": "700 J/(kg K)"}
JOINT = {"between": ["seat_bottom", "base_top"]}


def seal(changes=None, first="joint", **analysis):
    """Face seal whose seat, held at its rim, is pressed by another ring from below."""
    case = tables("face-seal")
    faces = {"between": ["ring_bottom", "seat_top"], "friction": 0.07}
    contacts = {"joint": JOINT, "faces": faces}
    case["contacts"] = {name: contacts[name] for name in (first, *contacts)}
    case["geometry"]["layers"]["base"] = {"x": ["27 mm", "35 mm"], "height": "6 mm"}
    case["bodies"]["base"] = {"like": "seat"}
    case["holders"]["shaft"]["surface"] = "seat_outside"
    case["holders"]["nut"] = {"surface": "base_bottom", "force": "300 N"}
    case["motions"] = {"seat": {"angular_velocity": "100 rpm"}}
    case["motions"]["base"] = case["motions"]["seat"]
    case["mesh"] = {"degree": 2, "elements": 5}
    case["load"] = {}
    del case["heat"]["cooling"]["seat_outside"]
    for body in ("ring", "seat"):
        case["bodies"][body] |= STORING
    return changed(case, {"analysis": analysis, **(changes or {})})


def run(*given, **analysis):
    return tw.run(tw.load(seal(*given, **analysis)))


def test_steady_state_is_the_limit_of_running_in():
    """requirement: a contact at rest keeps Signorini's conditions and its force, without wear."""
    steady, ended = run(type="steady"), run(type="transient", until="steady", tolerance=1e-3)
    assert ended.stopped is None
    one, other, points = steady.interface, ended.interface, steady.contacts
    for part in points.values():
        largest = one.pressure[part].max()
        np.testing.assert_allclose(one.pressure[part], other.pressure[part], atol=5e-3 * largest)
    np.testing.assert_allclose(one.temperature_1, other.temperature_1, atol=1e-2)
    joint = points["joint"]
    pressure, gap = one.pressure[joint], one.gap[joint]
    assert one.weight[joint] @ pressure == pytest.approx(300.0, rel=1e-9)
    assert not one.wear_rate_1[joint].any()
    assert np.abs(one.weight[joint] @ (pressure * gap)) < 1e-6 * 300.0 * 1e-6
    holders = steady.summary["holders"]
    assert holders["nut"]["rigid_wear_velocity_m_per_s"] == pytest.approx(0.0, abs=1e-30)
    worn = ended.summary["holders"]["spring"]["rigid_wear_velocity_m_per_s"]
    assert holders["spring"]["rigid_wear_velocity_m_per_s"] == pytest.approx(worn, rel=1e-9)


def test_the_order_of_contacts_changes_nothing():
    """requirement: critical speed and decay of a contact that slides, listed first or last."""
    found = [run(None, first, type="stability").summary for first in ("joint", "faces")]
    for key in ("critical_speed_factor", "growth_rate_per_s", "growth_rate_without_wear_per_s"):
        assert found[0][key] == pytest.approx(found[1][key], rel=1e-6)
    assert found[0]["growth_rate_per_s"] < 0


def test_without_friction_heat_diffuses():
    """requirement: decay, without critical speed, and no slower than with little friction."""
    little, none = (
        run({"contacts.faces.friction": mu, "contacts.joint.friction": 0.1}, type="stability")
        for mu in (1e-6, 0.0)
    )
    assert none.summary["critical_speed_factor"] is None
    rate = none.summary["growth_rate_without_wear_per_s"]
    assert rate == pytest.approx(little.summary["growth_rate_without_wear_per_s"], rel=1e-3)
    assert rate < 0


def test_a_contact_at_rest_that_stops_wear_is_named():
    """requirement: where the worn body cannot follow, the contact that holds it is named."""
    stopped = {"holders.spring": {"surface": "ring_top", "free": []}}
    with pytest.raises(ComputationError, match=r"^contacts\.joint: no steady state"):
        run(stopped, type="steady")
