"""Heat in a case: what must be given with it, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

import thermowear as tw
from thermowear.laws import LocalState
from thermowear.model.body import Facing
from thermowear.simulation.from_case import model_of

from .bad import Bad, assert_refused, faults
from .starter import GONE, PUNCH, RECIPROCATING, STEADY, tables

STRIP, DRUM, DISK, BRAKE, BOX, BLOCKS, SECTOR = (
    "punch-on-strip",
    "drum-brake",
    "block-on-disk",
    "disk-brake",
    "rectangular-punch",
    "stacked-blocks",
    "disk-sector",
)
DENSE, WARM = "bodies.punch.density", "bodies.punch.specific_heat"
STORING = {DENSE: "7800 kg/m^3", WARM: "460 J/(kg K)"}
IN_TIME = {"analysis": {"type": "transient", "end_time": "10 s"}}
HOT = IN_TIME | STORING | {"heat.transient": True}
STABLE = {"analysis": {"type": "stability"}}
BY_PRESSURE = {"heat.conductance": {"type": "pressure", "coefficient": "2e4 1/m"}}
LAW, SHARE, PASSING = "heat.conductance", "heat.partition", "heat.advection"


FACES = Facing(("upper", "lower"), (np.array([0]), np.array([1])))


def conductance_law(case, faces):
    model = model_of(case)
    return model.interface.conductance_law(faces, model.materials)


def partition(case, faces):
    model = model_of(case)
    return model.interface.heat_partition(faces, model.materials)


def by_table(pressures: list[str], conductances: list[str]) -> dict:
    return {LAW: {"type": "table", "pressure": pressures, "conductance": conductances}}


def twice(value: str) -> list[str]:
    return [value, value]


CONDUCTANCES = [
    Bad("kind of conductance", {LAW: {"type": "cubic"}}, f"{LAW}.type", "'pressure', 'table'"),
    Bad("conductance without type", {LAW: {}}, f"{LAW}.type", "missing; must be one of"),
    Bad("type in a list", {LAW: {"type": ["table"]}}, f"{LAW}.type", "found ['table']"),
    Bad("number", {LAW: 1e6}, LAW, "needs a quantity with its unit"),
    Bad("list", {LAW: ["1 W/m^2/K"]}, LAW, "needs a quantity"),
    Bad("no coefficient", {LAW: {"type": "pressure"}}, f"{LAW}.coefficient", "missing"),
    Bad("negative", {LAW: {"type": "pressure", "coefficient": "-1 1/m"}},
        f"{LAW}.coefficient", "greater than 0 1/m"),
    Bad("unknown key of it", {LAW: {"type": "pressure", "coefficient": "1 1/m", "h": 1}},
        f"{LAW}.h", "unknown key"),
    Bad("pressures that fall", by_table(["1 MPa", "0 MPa"], twice("1 W/m^2/K")),
        f"{LAW}.pressure", "must increase"),
    Bad("tension", by_table(["-1 MPa"], ["1 W/m^2/K"]), f"{LAW}.pressure.0", "at least 0 Pa"),
    Bad("lists that differ", by_table(["1 MPa"], twice("1 W/m^2/K")),
        f"{LAW}.conductance", "has 2 values for 1 pressures"),
    Bad("empty table", by_table([], []), f"{LAW}.pressure", "is empty"),
    Bad("never any", by_table(["0 MPa", "1 MPa"], twice("0 W/m^2/K")),
        f"{LAW}.conductance", "at least one value must be greater"),
    Bad("no hardness", BY_PRESSURE, "bodies.punch.hardness", 'is of type "pressure"'),
    Bad("no hardness of one", BY_PRESSURE | {"bodies.upper.hardness": "2 GPa"},
        "bodies.lower.hardness", "missing", BLOCKS),
    Bad("gap that conducts nothing", {"heat.gap_conductance": "0 W/m^2/K"},
        "heat.gap_conductance", "greater"),
    Bad("running-in by penalty", IN_TIME | by_table(["1 MPa"], ["1 W/m^2/K"])
        | {"contact.method": "penalty"}, "contact.method", "use condensed"),
]  # fmt: skip

SHARES = [
    Bad("share above 1", {SHARE: 1.5}, SHARE, 'at most 1, or "effusivity"'),
    Bad("share below 0", {SHARE: -0.1}, SHARE, "at least 0"),
    Bad("share nan", {SHARE: math.nan}, SHARE, "found nan"),
    Bad("share true", {SHARE: True}, SHARE, "found True"),
    Bad("share by a word", {SHARE: "half"}, SHARE, "found 'half'"),
    Bad("share in a list", {SHARE: ["effusivity"]}, SHARE, "found ['effusivity']"),
    Bad("share of nothing stored", {SHARE: "effusivity", DENSE: "1 g/cm^3"}, WARM, '"effusivity"'),
]

MOVING = [
    Bad("some way", {PASSING: "fast"}, PASSING, "must be 'none', 'resolved' or 'spread'", STRIP),
    Bad("plate below a ring", {PASSING: "spread"}, PASSING, "plate does not pass under"),
    Bad("block below", {PASSING: "resolved", "bodies.lower.density": "1 g/cm^3",
        "bodies.lower.specific_heat": "1 J/kg/K"}, PASSING, "lower does not pass", BLOCKS),
    Bad("disk that is spread", {PASSING: "spread"}, PASSING,
        "already distributed around the disk", BRAKE),
    Bad("at a speed that changes", STORING | IN_TIME | {PASSING: "resolved",
        "motion.history": {"time": ["0 s", "1 s"], "factor": [1.0, 0.0]}},
        PASSING, "needs a constant speed", STRIP),
    Bad("carried round, and nothing cools", {PASSING: "resolved", "heat.cooling": GONE,
        "bodies.block.density": "1 g/cm^3", "bodies.block.specific_heat": "1 J/kg/K"},
        "heat", "there is no heat sink", DISK),
    Bad("carries what", {PASSING: "resolved", DENSE: "1 g/cm^3"}, WARM, '"resolved"', STRIP),
]  # fmt: skip

STORED = [
    Bad("steady in time", STORING | {"heat.transient": True}, "heat.transient", "not steady"),
    Bad("initial in time", HOT | {"analysis": {"type": "initial"}}, "heat.transient",
        "requires a transient analysis, not initial"),
    Bad("no density", IN_TIME | {"heat.transient": True, WARM: "460 J/kg/K"}, DENSE,
        "missing; needed because heat.transient is true"),
    Bad("no specific heat", IN_TIME | {"heat.transient": True, DENSE: "1 g/cm^3"}, WARM,
        "missing; needed because heat.transient is true"),
    Bad("by penalty", HOT | {"contact.method": "penalty"}, "contact.method",
        "'penalty' does not support temperatures in time; use condensed"),
    Bad("hot at the start", {"heat.initial": "80 degC"}, "heat.initial", "heat.transient = true"),
    Bad("colder than cold", HOT | {"heat.initial": "-300 degC"}, "heat.initial", "at least 0 K"),
    Bad("in time, 1", HOT | {"heat.transient": 1}, "heat.transient", "must be true or false"),
    Bad("until steady without wear",
        HOT | {"wear": GONE, "analysis": {"type": "transient", "until": "steady"}},
        "wear", "missing"),
    Bad("to and fro in time", {
        "heat": {"transient": True},
        "bodies.punch.conductivity": "1 W/m/K", "bodies.punch.expansion": "1e-5 1/K",
        "bodies.punch.density": "1 g/cm^3", "bodies.punch.specific_heat": "1 J/kg/K",
    }, "heat", "not supported in a reciprocating", RECIPROCATING),
]  # fmt: skip

UNSTABLE = [
    Bad("cold", STABLE | {"heat": GONE}, "heat", "missing; required in a stability analysis"),
    Bad("still", STABLE | {"motion": GONE}, "motion", "missing; wear and friction heat"),
    Bad("so many modes", STABLE | {"analysis.modes": 3}, "analysis.modes", "unknown key"),
    Bad("smooth", STABLE | {"contact.friction": 0, "wear": GONE}, "contact.friction", "is 0"),
    Bad("by Nitsche", STABLE | {"contact.method": "nitsche"}, "contact.method",
        "'nitsche' does not support a stability analysis"),
    Bad("insulated", STABLE | {"heat.cooling": GONE}, "heat", "there is no heat sink"),
    Bad("in time", STABLE | STORING | {"heat.transient": True}, "heat.transient",
        "not stability"),
]  # fmt: skip

REST = {"motion": GONE, "wear": GONE, "analysis": {"type": "initial"}}
HEATED = REST | {"heat.temperature.upper_top": "100 degC"}
RAMP = {"time": ["0 s", "1 s"], "temperature": ["20 degC", "90 degC"]}
TOP = "heat.temperature.upper_top"
FLUX, POWER, SURROUNDED = "heat.flux", "heat.power", "heat.ambient_history"
AT_REST = [
    Bad("nothing heats", REST, "motion", "no heat source: needs sliding, or", BLOCKS),
    Bad("smooth, and nothing heats", {"contact.friction": 0, "wear.upper.per": "pressure"},
        "contact.friction", "friction heat needs friction", BLOCKS),
    Bad("steady at rest", HEATED | {"wear.upper": {"coefficient": "1e-8 1/MPa"},
        "analysis": {"type": "steady"}}, "motion", 'at rest use analysis.type = "initial"', BLOCKS),
    Bad("nothing passes", REST | {PASSING: "spread",
        "heat.power": {"punch_top": "1 W"}}, PASSING, "needs [motion]", STRIP),
    Bad("heat with nowhere to go", REST | {"heat.temperature": GONE,
        FLUX: {"upper_top": "1 W/m^2"}}, "heat", "there is no heat sink", BLOCKS),
    Bad("no flux", {FLUX: {"upper_side": "0 W/m^2"}}, f"{FLUX}.upper_side", "other than", BLOCKS),
    Bad("flux in watts", {FLUX: {"upper_side": "1 W"}}, f"{FLUX}.upper_side", "W/m^2", BLOCKS),
    Bad("power per area", {POWER: {"upper_side": "1 W/m^2"}}, f"{POWER}.upper_side", "be in W",
        BLOCKS),
    Bad("unknown surface", {POWER: {"side": "1 W"}}, f"{POWER}.side", "one of: upper_face", BLOCKS),
    Bad("on the contact", {FLUX: {"lower_face": "1 W/m^2"}}, f"{FLUX}.lower_face",
        "exchanges heat with the other body only", BLOCKS),
    Bad("on a given temperature", {POWER: {"upper_top": "1 W"}}, f"{POWER}.upper_top",
        "already has a prescribed temperature", BLOCKS),
    Bad("twice", {FLUX: {"upper_side": "1 W/m^2"}, POWER: {"upper_side": "1 W"}},
        f"{POWER}.upper_side", "already has a prescribed flux", BLOCKS),
    Bad("steady ramp", {TOP: RAMP}, TOP, "requires a transient analysis, not steady", BLOCKS),
    Bad("ramp without memory", IN_TIME | {TOP: RAMP}, TOP, "heat.transient = true", BLOCKS),
    Bad("ramp of lists that differ", {TOP: RAMP | {"time": ["0 s"]}}, f"{TOP}.temperature",
        "has 2 values for 1 times", BLOCKS),
    Bad("ramp below nothing", {TOP: RAMP | {"temperature": ["20 degC", "-300 degC"]}},
        f"{TOP}.temperature.1", "at least 0 K", BLOCKS),
    Bad("unknown key of a ramp", {TOP: RAMP | {"factor": [1, 1]}}, f"{TOP}.factor", "unknown key",
        BLOCKS),
    Bad("ramp that jumps back", {TOP: RAMP | {"repeat": True}}, f"{TOP}.repeat",
        "the last value of temperature must equal", BLOCKS),
    Bad("number for a ramp", {TOP: 20}, TOP, "needs a quantity with its unit", BLOCKS),
    Bad("surroundings of nothing", HOT | {SURROUNDED: RAMP, "heat.cooling": GONE}, SURROUNDED,
        "no surface has heat.cooling"),
    Bad("until steady in other surroundings",
        HOT | {SURROUNDED: RAMP, "analysis": {"type": "transient", "until": "steady"}},
        "analysis.until", f"is not supported under {SURROUNDED}"),
]  # fmt: skip


@pytest.mark.parametrize(
    "bad",
    CONDUCTANCES + SHARES + MOVING + STORED + UNSTABLE + AT_REST,
    ids=lambda bad: bad.name,
)
def test_a_fault_of_heat_is_one_line_with_the_path_of_its_key(bad, tmp_path, capsys):
    """
    requirement: bad input ends with exit code 1 and one line: exact path, what is wrong with it.
    """
    assert_refused(bad, tmp_path, capsys)


def test_what_a_cold_stability_analysis_lacks_is_listed():
    """
    requirement: one line per fault: heat, motion and friction are each needed.
    """
    found = faults(STABLE | {"heat": GONE, "motion": GONE, "wear": GONE, "contact.friction": 0})
    assert sorted(line.split(":")[0] for line in found) == ["contact.friction", "heat", "motion"]


def test_a_material_that_is_missing_is_charged_to_the_body_that_has_it():
    """
    requirement: one line per fault: a body like another is not asked for keys it cannot have.
    """
    found = faults(IN_TIME | {"heat.transient": True})
    assert [line.split(":")[0] for line in found] == [DENSE, WARM]


def test_a_lining_needs_what_a_body_needs():
    """
    requirement: every part that stores heat, zones included, has its density.
    """
    changes = {f"bodies.{part}.conductivity": "1 W/m/K" for part in ("shoe", "lining", "drum")}
    changes |= {f"bodies.{part}.expansion": "1e-5 1/K" for part in ("shoe", "lining", "drum")}
    changes |= {"heat": {"transient": True}} | IN_TIME
    assert {line.split(":")[0] for line in faults(changes, DRUM)} == {
        f"bodies.{part}.{key}"
        for part in ("shoe", "lining", "drum")
        for key in ("density", "specific_heat")
    }


ALLOWED = {
    "insulated, in time": (STEADY, HOT | {"heat.cooling": GONE}),
    "warm, in time": (STEADY, HOT | {"heat.initial": "80 degC"}),
    "in time without wear": (STEADY, HOT | {"wear": GONE}),
    "in time until steady": (
        STEADY,
        HOT | {"analysis": {"type": "transient", "until": "steady"}},
    ),
    "strip that carries heat": (STRIP, STORING | {PASSING: "resolved"}),
    "heat that leaves with the strip": (
        STRIP,
        STORING | {PASSING: "resolved", "heat.cooling": GONE},
    ),
    "strip that spreads heat, in time": (STRIP, HOT | {PASSING: "spread"}),
    "unstable without wear": (STEADY, STABLE | {"wear": GONE}),
    "unstable under an approach": (STEADY, STABLE | {"load": {"approach": "1 um"}}),
    "pressure by Nitsche, steady": (
        STEADY,
        BY_PRESSURE | {"bodies.punch.hardness": "2 GPa", "contact.method": "nitsche"},
    ),
    "blocks of one material": (BLOCKS, {}),
    "at rest": (BLOCKS, HEATED),
    "at rest, smooth": (BLOCKS, HEATED | {"contact.friction": 0}),
    "at rest, in time, cooling down": (
        STEADY,
        HOT | {"wear": GONE, "motion": GONE, "heat.initial": "80 degC"},
    ),
    "smooth, and heated": (
        BLOCKS,
        {TOP: "90 degC", "contact.friction": 0, "wear.upper.per": "pressure"},
    ),
    "heat drawn out": (BLOCKS, {FLUX: {"lower_side": "-1 kW/m^2"}}),
    "warm surroundings": (STEADY, HOT | {SURROUNDED: RAMP}),
}


@pytest.mark.parametrize(("name", "changes"), ALLOWED.values(), ids=ALLOWED)
def test_what_heat_allows(name, changes):
    """
    requirement: what an analysis does not need may be left out, and what it can do is not refused;
    with all defaults written out it is the same case.
    """
    case = tw.load(tables(name, changes))
    assert tw.load(tw.case.as_plain(case)) == case
    assert case.heat is not None or "heat" not in tables(name, changes)


def test_a_disk_that_turns_in_space_passes_under_its_pads():
    """
    requirement: advection for strip, disk and drum, in sections and in space.
    """
    for name in (STRIP, DISK, DRUM, SECTOR):
        assert tw.load(tables(name)).geometry.passes
    for name in (STEADY, BRAKE, BOX, BLOCKS, PUNCH):
        assert not tw.load(tables(name)).geometry.passes


def test_half_of_what_slides_across_is_symmetric():
    """
    requirement: friction across the section drags within none of its halves.
    """
    case = tw.load(tables(BLOCKS))
    assert case.contact.friction > 0
    assert case.geometry.symmetry
    found = faults({"holder": {"free": ["z", "rotation"]}}, BLOCKS)
    assert [line.split(":")[0] for line in found] == ["holder.free"]


def test_conductance_by_pressure_is_that_of_the_harmonic_means():
    """
    requirement: h = coefficient k p / H with harmonic means of both bodies.

    By hand: k = 2·50·15/65, H = 2·2·3/5 GPa.
    """
    changes = BY_PRESSURE | {"bodies.upper.hardness": "2 GPa", "bodies.lower.hardness": "3 GPa"}
    case = tw.load(tables(BLOCKS, changes))
    expected = [0.0, 2e4 * (1500 / 65) * 5e6 / 2.4e9]
    found = conductance_law(case, FACES).value(LocalState(np.array([0.0, 5e6]), 0.1, 300.0))
    assert found == pytest.approx(expected, rel=1e-14)
    assert case.varies


def test_conductance_by_table_is_straight_between_and_constant_beyond():
    """
    requirement: conductance tabulated over pressure.
    """
    law = by_table(["0 MPa", "10 MPa"], ["1e3 W/(m^2 K)", "5e3 W/(m^2 K)"])
    case = tw.load(tables(STEADY, law))
    found = conductance_law(case, FACES).value(LocalState(np.array([0.0, 2.5e6, 2e7]), 0.1, 300.0))
    assert found == pytest.approx([1e3, 2e3, 5e3])
    assert case.varies


def test_conductance_that_is_constant_or_perfect():
    """
    requirement: a quantity alone is the constant conductance; none is perfect contact.
    """
    constant = tw.load(tables(STEADY))
    found = conductance_law(constant, FACES).value(LocalState(np.array([0.0, 1e6]), 0.1, 300.0))
    assert found == pytest.approx([1e6, 1e6])
    assert conductance_law(tw.load(tables(STEADY, {LAW: GONE})), FACES) is None
    assert not constant.varies


def test_partition_by_effusivity():
    """
    requirement: the share of body 1 is e1/(e1 + e2), e = sqrt(k rho c).

    By hand: e1² = 50·8000·400, e2² = 18·8000·250: e1 = 12649.1, e2 = 6000.
    """
    changes = {
        SHARE: "effusivity",
        "bodies.upper.density": "8 g/cm^3",
        "bodies.upper.specific_heat": "400 J/(kg K)",
        "bodies.lower.density": "8 g/cm^3",
        "bodies.lower.specific_heat": "250 J/(kg K)",
        "bodies.lower.conductivity": "18 W/(m K)",
    }
    shares = partition(tw.load(tables(BLOCKS, changes)), FACES)
    assert shares[0] == pytest.approx(0.678269, abs=1e-6)
    assert partition(tw.load(tables(BLOCKS, {SHARE: 1})), FACES) == 1.0


def test_the_lining_touches_the_drum_not_its_shoe():
    """
    requirement: shares and conductances are of what touches.
    """
    assert tw.load(tables(DRUM)).geometry.facing == ("lining", "drum")
    assert tw.load(tables(STEADY)).geometry.facing == ("punch", "plate")
