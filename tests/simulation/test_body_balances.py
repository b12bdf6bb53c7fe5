"""Balances of force, moment, torque, heat and worn volume of each body."""

from dataclasses import replace

import numpy as np
import pytest

import thermowear as tw
from thermowear.balances import errors_of, judged
from thermowear.bulk.heat.conduction import Conduction
from thermowear.contact.search.pairing import Contacts
from thermowear.output.report.figures import balances as shown
from thermowear.simulation.system.system import System
from thermowear.verification.cases.assembly.pad_disk_pad import Brake

from ..case.starter import GONE, solved

DRUM = {"heat": GONE, "mesh": {"degree": 5, "elements": 6}}
WORN_DRUM = DRUM | {
    "wear.drum.coefficient": "1e-8 1/MPa",
    "wear.drum.per": "pressure",
    "wear.drum.spread": "track",
    "analysis": {"type": "transient", "end_time": "600 s", "tolerance": 1e-2},
}
COARSE = {"mesh": {"degree": 2, "elements": 4}}
MECHANICS = {"force_balance", "moment_balance"}
IN_TIME = Brake("floating", 9.0, heated=True, transient=True, elements=4)


def kinds(summary):
    """Kinds of balances of all bodies of a summary."""
    each = [{key for key in body if "relative_error" in key} for body in summary["bodies"].values()]
    assert all(keys == each[0] for keys in each)
    return {key.removesuffix("_relative_error") for key in each[0]}


@pytest.mark.parametrize(
    ("starter", "changes", "expected"),
    [
        ("two-shoe-drum", {"mesh": {"degree": 5, "elements": 6}}, MECHANICS | {"heat_balance"}),
        ("two-pads-3d", {"mesh.degree": 2}, MECHANICS | {"heat_balance"}),
        ("disk-brake-two-pads", COARSE, {"force_balance", "heat_balance"}),
        ("two-shoe-drum", WORN_DRUM, MECHANICS | {"wear_volume"}),
        ("drum-brake", {"mesh.degree": 4}, MECHANICS),
        ("pin-on-disk-running-in", {}, MECHANICS | {"wear_volume"}),
        ("disk-brake-stop", {}, {"force_balance", "heat_balance", "wear_volume"}),
    ],
)
def test_each_body_is_in_balance(starter, changes, expected):
    """requirement: forces, moments, heat and volume of every body, glued ones too, to 1e-9."""
    result = solved(starter, changes)
    summary = result.summary
    assert kinds(summary) == expected
    errors = errors_of(summary)
    assert len(errors) > len(summary["bodies"]) * len(expected)
    assert max(abs(error) for _, _, error in errors) < 1e-9
    assert result.stopped is None
    torques = [body.get("friction_torque_Nm") or 0.0 for body in summary["bodies"].values()]
    assert sum(torques) == pytest.approx(0.0, abs=1e-9 * max(torques))
    lines = [figure.label for figure in shown(summary) if ", worst of " in figure.label]
    assert len(lines) == len(expected)


def test_heat_and_volume_in_time():
    """requirement: heat since the start, stored and passed on, and wear by the rates, by body."""
    result = IN_TIME.run("after running-in")
    assert kinds(result.summary) == {"force_balance", "heat_balance", "wear_volume"}
    assert max(abs(error) for _, _, error in errors_of(result.summary)) < 1e-9
    torques = {name: one["friction_torque_Nm"] for name, one in result.summary["bodies"].items()}
    each = [result.summary["contacts"][side]["friction_torque_Nm"] for side in ("left", "right")]
    assert torques["disk"] == pytest.approx(-sum(each), rel=1e-12)
    assert [torques["left"], torques["right"]] == pytest.approx(each, rel=1e-12)


def test_a_track_under_two_shoes_wears_by_both():
    """requirement: the volume of the drum is what both contacts remove, not that of one."""
    summary = solved("two-shoe-drum", WORN_DRUM).summary
    drum = summary["bodies"]["drum"]["wear_volume_m3"]
    each = [one["wear_volume_2_m3"] for one in summary["contacts"].values()]
    assert drum == pytest.approx(sum(each), rel=1e-12)
    assert min(each) > 0.0


def failed(result):
    """Balances that a run violates."""
    assert isinstance(result.stopped, tw.ComputationError)
    return str(result.stopped)


def test_a_moment_that_nothing_bears(monkeypatch):
    """requirement: contact forces beside their place leave forces balanced, but not moments."""
    on_body_2 = Contacts.on_body_2.func
    beside = np.array([0.0, 1e-4])
    monkeypatch.setattr(Contacts, "on_body_2", property(lambda self: on_body_2(self) + beside))
    reason = failed(solved("two-shoe-drum", DRUM | {"analysis": {"type": "initial"}}))
    assert "balance of moments of drum" in reason
    assert "balance of forces" not in reason


VARYING = {
    "bodies.upper.conductivity_factor": {"at": ["0 degC", "1000 degC"], "factor": [1.0, 0.2]},
    "bodies.lower.conductivity_factor": {"at": ["0 degC", "500 degC"], "factor": [1.0, 0.5]},
    "heat.temperature": {"upper_top": "800 degC", "lower_bottom": "100 degC"},
}
STORED = {"density": "7800 kg/m^3", "specific_heat": "480 J/(kg K)"}
HEATED = {
    "motion": None,
    "wear": None,
    "heat.transient": True,
    "heat.initial": "20 degC",
    "analysis": {"type": "transient", "end_time": "20 s"},
    **{f"bodies.{body}.{key}": v for body in ("upper", "lower") for key, v in STORED.items()},
}


@pytest.mark.parametrize(
    "changes", [{"analysis": {"type": "initial"}}, HEATED], ids=["steady", "in time"]
)
def test_conductivity_that_varies(changes):
    """requirement: heat through surfaces of given temperature is that of the conductivity there."""
    result = solved("stacked-blocks", VARYING | {"wear": None} | changes)
    assert result.stopped is None
    errors = [body["heat_balance_relative_error"] for body in result.summary["bodies"].values()]
    assert max(errors) < 1e-7


def lose_heat(monkeypatch, body):
    """Let a thousandth of the heat that a body exchanges vanish."""
    into_bodies = Conduction.into_bodies

    def lossy(self, rise, heat):
        found = into_bodies(self, rise, heat)
        found[0, self.spaces.rows(body)] -= 1e-3 * found[1, self.spaces.rows(body)]
        return found

    monkeypatch.setattr(Conduction, "into_bodies", lossy)


def raise_end(result):
    """Raise the reason for which a run in time has stopped."""
    raise result.stopped


@pytest.mark.parametrize(("body", "name", "other"), [(0, "pad", "disk"), (1, "disk", "pad")])
@pytest.mark.parametrize("starter", ["disk-brake", "disk-brake-stop"])
def test_heat_that_is_lost_in_one_of_two(monkeypatch, starter, body, name, other):
    """requirement: two bodies without names of contacts are told apart, steady and in time."""
    lose_heat(monkeypatch, body)
    with pytest.raises(tw.ComputationError) as caught:
        raise_end(solved(starter, {"mesh.degree": 3}))
    assert f"heat balance of {name} " in str(caught.value)
    assert f"heat balance of {other} " not in str(caught.value)


def test_heat_that_is_lost_in_one_body(monkeypatch):
    """requirement: heat that leaves one body unseen fails the run."""
    lose_heat(monkeypatch, 1)
    for transient, state in ((True, "after running-in"), (False, "steady")):
        with pytest.raises(tw.ComputationError) as caught:
            replace(IN_TIME, transient=transient).run(state)
        assert "heat balance of disk" in str(caught.value)
        assert "heat balance of left" not in str(caught.value)


def test_wear_that_is_counted_wrongly(monkeypatch):
    """requirement: areas of a track that are not those worn by its contacts fail the run."""
    areas = System.worn_areas.func
    monkeypatch.setattr(System, "worn_areas", property(lambda self: 1.001 * areas(self)))
    reason = failed(solved("two-shoe-drum", WORN_DRUM))
    assert "worn volume by the wear rates in time of drum has a relative error of 1.0e-03" in reason


def test_one_body_out_of_balance_is_enough():
    """requirement: the whole may balance where two bodies do not."""
    body = {"force_balance_relative_error": 1e-12, "moment_balance_relative_error": 2e-6}
    summary = {"equilibrium_relative_error": 0.0, "bodies": {"pad": body}}
    assert "balance of moments of pad has a relative error of 2.0e-06" in str(judged(summary))
    body["moment_balance_relative_error"] = 0.0
    assert judged(summary) is None


def test_a_restart_goes_on_with_the_volumes(tmp_path):
    """requirement: what is summed up in time is part of a checkpoint."""
    from mpi4py import MPI

    from thermowear.serialise import pack
    from thermowear.simulation.interface.condensed_method import ContactSolution
    from thermowear.simulation.interface.sdirk import InterfaceState

    contact = ContactSolution(np.ones(3), np.zeros(1), None)
    state = InterfaceState(np.ones((1, 3)), contact, removed=np.array([[1.0, 2.0]]))
    found = pack(MPI.COMM_SELF, state).state(0)
    np.testing.assert_array_equal(found.removed, state.removed)
    later = replace(state, removed=np.array([[3.0, 6.0]]))
    np.testing.assert_allclose(state.towards(later, 0.5).removed, [[2.0, 4.0]])
