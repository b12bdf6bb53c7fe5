"""What fretting and reciprocating cases of several bodies may have: one line a fault."""

from __future__ import annotations

import pytest

import thermowear as tw

from ..simulation.test_reciprocating_assembly import CASE
from .bad import Bad, assert_refused, faults
from .starter import GONE, changed

RIG, SUPPORTS, PADS = (
    "strip-between-cylinders-fretting",
    "tube-between-supports",
    "disk-brake-two-pads",
)
GRIP, HISTORY = "holders.grip.history", "holders.press.history"
LAW = "not supported in a fretting analysis"
NOT = "is not supported in a fretting analysis"
REGIONS = {"left": {"coefficient": "1e-8 1/MPa", "per": "pressure", "where": "x < 0 mm"}}
LAYERS = {"thickness": ["1 um"], "coefficient": ["1e-9 1/MPa"]}
FORCES = {"time": ["0 s", "1 s"], "force": ["50 N", "60 N"]}

FRETTING = [
    Bad("motion", {"motions.strip": {"velocity": "1 m/s"}}, "motions.strip", NOT),
    Bad("heat", {"heat": {"cooling": {}}}, "heat", NOT),
    Bad("pressure", {"load.pressure": {"strip_left": "1 MPa"}}, "load.pressure", NOT),
    Bad("reaction", {"holders.press.reaction": "grip"}, "holders.press.reaction", NOT),
    Bad("fluid", {"contact.fluid_pressure": "1 MPa"}, "contacts.upper.fluid_pressure", NOT),
    Bad(
        "friction law",
        {"contact.friction": "0.3 + p/(1e12 Pa)"},
        "contacts.upper.friction",
        "not supported in a fretting",
    ),
    Bad("materials", {"wear.strip.materials": REGIONS}, "wear.strip.materials", NOT),
    Bad("layers", {"wear.upper.layers": LAYERS}, "wear.upper.layers", NOT),
    Bad("no history", {GRIP: GONE}, "holders", "needs a history in one of them"),
    Bad("repeat", {f"{GRIP}.repeat": True}, f"{GRIP}.repeat", "use analysis.cycles"),
    Bad("both forces", {HISTORY: FORCES}, "holders.press.force", "together with history.force"),
    Bad("no z", {"holders.base.history": FORCES}, "holders.base.free", "is empty"),
    Bad("symmetry", {"bodies.strip.symmetry": "strip_left"}, GRIP, "not symmetric"),
    Bad(
        "cycle of one holder only",
        {HISTORY: FORCES, "holders.press.force": GONE},
        "wear.cycles",
        "no cycle to repeat",
    ),
    Bad("late", {"analysis.output_times": ["2000 s"]}, "analysis.output_times", "to 1000 s"),
]


@pytest.mark.parametrize("bad", FRETTING, ids=lambda bad: bad.name)
def test_fretting(bad):
    """requirement: what fretting of several bodies does not support is refused, with the key."""
    lines = faults(bad.changes, RIG)
    found = [line for line in lines if line.startswith(f"{bad.path}: ")]
    assert any(bad.text in line for line in found), lines


ONE_WAY = [
    Bad("cycles", {"wear.cycles": 10}, "wear.cycles", "or reciprocating analysis", SUPPORTS),
    Bad(
        "tangential history",
        {"holders.rod.history": {"time": ["0 s", "1 s"], "tangential_force": ["0 N", "1 N"]}},
        "holders.rod.history.tangential_force",
        "requires a fretting analysis",
        SUPPORTS,
    ),
    Bad(
        "amplitude",
        {"motions.tube": {"amplitude": "1 mm", "frequency": "1 Hz"}},
        "motions.tube.amplitude",
        "requires a reciprocating analysis",
        SUPPORTS,
    ),
]


@pytest.mark.parametrize("bad", ONE_WAY, ids=lambda bad: bad.name)
def test_other_analyses(bad, tmp_path, capsys):
    """requirement: keys that only cyclic analyses follow are refused elsewhere."""
    assert_refused(bad, tmp_path, capsys)


RECIPROCATING = [
    ({"motions": GONE}, "motions: needs a body with amplitude and frequency"),
    ({"motions.strip": {"velocity": "1 m/s"}}, "motions: needs a body with amplitude"),
    ({"motions.strip.frequency": GONE}, "motions.strip.frequency: missing"),
    (
        {"motions.upper": {"amplitude": "1 mm", "frequency": "3 Hz"}},
        "frequency: must be the same for all bodies",
    ),
    ({"holders.press.free": ["z", "x"]}, 'holders.press.free: "x" is not allowed'),
    ({"holders.press.history": FORCES}, "holders.press.history: is not supported"),
    ({"wear": {}}, "wear: missing"),
    ({"analysis.cycles": GONE}, "analysis.end_time: missing"),
    ({"analysis.output_times": ["2000 s"]}, "analysis.output_times: 2000 s lies after"),
    ({"bodies.strip.symmetry": "strip_left"}, "bodies.strip.symmetry: reciprocating"),
    ({"wear.strip.layers": LAYERS}, "wear.strip.layers: is not supported in a reciprocating"),
]


@pytest.mark.parametrize(("changes", "text"), RECIPROCATING)
def test_reciprocating(changes, text):
    """requirement: the same of reciprocating analyses."""
    with pytest.raises(tw.CaseError) as caught:
        tw.load(changed(CASE, changes))
    assert any(text in fault for fault in caught.value.faults), caught.value.faults
