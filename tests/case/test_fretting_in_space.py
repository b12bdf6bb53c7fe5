"""What fretting cases in space may have: one line a fault."""

import pytest

import thermowear as tw

from .bad import Bad, faults
from .starter import tables

BALL, RIG = "sphere-fretting", "strip-between-cylinders-fretting"
HISTORY = "load.history"
ZERO = ["0 N"] * 4
ACROSS = "is not symmetric about the plane y = const"
BAD = [
    Bad("across", {f"{HISTORY}.tangential_force_y": ZERO}, f"{HISTORY}.tangential_force_y", ACROSS),
    Bad("twist", {f"{HISTORY}.twist": ["0 rad"] * 4}, f"{HISTORY}.twist", ACROSS),
    Bad("large", {f"{HISTORY}.twist": ["0 rad"] * 3 + ["1 rad"]}, f"{HISTORY}.twist.3", "0.1"),
    Bad(
        "both",
        {"geometry.half": False, f"{HISTORY}.torque": ["0 N m"] * 4}
        | {f"{HISTORY}.twist": ["0 rad"] * 4},
        f"{HISTORY}.twist",
        "only one of torque and twist",
    ),
    Bad("moment", {f"{HISTORY}.moment": ["0 N m"] * 4}, f"{HISTORY}.moment", "several bodies"),
    Bad("holder", {"holder.free": ["z", "x"]}, "holder", "load.history prescribes its motion"),
    Bad(
        "across the sliding",
        {"contact.transverse_friction": 0.1},
        "contact.transverse_friction",
        "resists slip in any direction",
    ),
    Bad(
        "in time",
        {"analysis": {"type": "transient", "end_time": "1 s"}},
        f"{HISTORY}.tangential_force",
        "requires a fretting analysis",
    ),
]


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: bad.name)
def test_what_is_refused(bad):
    """requirement: what fretting in space does not support is refused, with the key."""
    lines = faults(bad.changes, BALL)
    found = [line for line in lines if line.startswith(f"{bad.path}: ")]
    assert any(bad.text in line for line in found), lines


def test_friction_across_the_sliding_of_several_bodies():
    """requirement: a table by contact is refused as that of a pair; sliding bodies have it."""
    across = {"contacts.upper": {"between": ["upper_face", "DISK_TOP"], "transverse_friction": 0.1}}
    case = tw.load(tables("two-pads-3d", across))
    assert case.contacts["upper"].transverse_friction == 0.1
    fretting = {"analysis": {"type": "fretting"}, "heat": None, "motions": None}
    lines = faults(across | fretting, "two-pads-3d")
    (line,) = [line for line in lines if line.startswith("contacts.upper.transverse_friction: ")]
    assert "resists slip in any direction" in line


@pytest.mark.parametrize(
    ("starter", "path"), [("cylinder-stick-slip", HISTORY), (RIG, "holders.grip.history")]
)
@pytest.mark.parametrize("key", ["tangential_force_y", "twist"])
def test_loads_of_space_in_a_section(starter, path, key):
    """requirement: a plane model has one tangential direction."""
    zero = "0 N" if key == "tangential_force_y" else "0 rad"
    history = tables(starter)
    for part in path.split("."):
        history = history[part]
    lines = faults({f"{path}.{key}": [zero] * len(history["time"])}, starter)
    assert f"{path}.{key}: requires a 3d model" in lines


def test_a_column_of_a_file(tmp_path):
    """requirement: histories from a CSV file have the loads of space, too."""
    file = tmp_path / "loads.csv"
    file.write_text("time [s], twist [mrad], tangential force y [N]\n0, 0, 0\n1, 2, 3\n")
    changes = {HISTORY: str(file), "geometry.half": False, "wear.cycles": 1}
    case = tw.load(tables(BALL, changes | {"analysis.output_times": []}))
    assert case.load.history.twist == (0.0, 0.002)
    assert case.load.history.loads.tangential_force_y == (0.0, 3.0)
