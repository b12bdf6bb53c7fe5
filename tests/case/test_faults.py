"""Everything that can be wrong in a case: one line a fault, with the key's path."""

from __future__ import annotations

import datetime
from math import inf, nan
from typing import Any

import pytest
import tomli_w

import thermowear as tw
from thermowear.app.cli import main

from .bad import Bad, assert_refused, faults
from .starter import (
    FILE,
    FRETTING,
    GONE,
    HERTZ,
    PUNCH,
    RECIPROCATING,
    RUNNING_IN,
    SPHERE,
    STEADY,
    tables,
)

YOUNG, NU, COOL = "bodies.punch.young_modulus", "bodies.punch.poisson_ratio", "heat.cooling"
COEFFICIENT, A, B = (
    f"wear.punch.{key}" for key in ("coefficient", "velocity_exponent", "pressure_exponent")
)
END, TIMES = "analysis.end_time", "analysis.output_times"
POINTWISE = {"contact.method": "pointwise"}

NAMES = [
    Bad("unknown key", {"mesh.elemnts": 4}, "mesh.elemnts", "did you mean elements?"),
    Bad(
        "key of another table",
        {"mesh.friction": 0.2},
        "mesh.friction",
        "known: accuracy, bodies, contact_size",
    ),
    Bad("key of another analysis", {TIMES: ["1 s"]}, TIMES, "unknown key here"),
    Bad("key named as an analysis", {"analysis.steady": 1}, "analysis.steady", "unknown key"),
    Bad("unknown table", {"geometri": {}}, "geometri", "did you mean geometry?"),
    Bad("unknown key of a body", {"bodies.punch.nu": 0.3}, "bodies.punch.nu", "unknown key"),
    Bad("unknown key of the geometry", {"geometry.width": "1 m"}, "geometry.width", "unknown key"),
    Bad("unknown body", {"bodies.disc": {"like": "punch"}}, "bodies.disc", "punch, plate"),
    Bad("body left out", {"bodies.plate": GONE}, "bodies.plate", "missing"),
    Bad(
        "wear of an unknown body",
        {"wear.disc": {"coefficient": "1e-7 1/MPa"}},
        "wear.disc",
        "one of: punch, plate",
    ),
    Bad(
        "mesh of an unknown body",
        {"mesh.bodies.disc": {"elements": 3}},
        "mesh.bodies.disc",
        "one of: punch, plate",
    ),
    Bad(
        "cooling of an unknown surface",
        {f"{COOL}.top": "1 W/(m^2 K)"},
        f"{COOL}.top",
        "plate_bottom",
    ),
    Bad(
        "temperature of an unknown surface",
        {"heat.temperature.top": "20 degC"},
        "heat.temperature.top",
        "plate_bottom",
    ),
    Bad("unknown geometry", {"geometry.type": "cone"}, "geometry.type", "annular-punch"),
    Bad("geometry without type", {"geometry.type": GONE}, "geometry.type", "annular-punch"),
    Bad("unknown analysis", {"analysis.type": "modal"}, "analysis.type", "found 'modal'"),
    Bad("analysis without type", {"analysis.type": GONE}, "analysis.type", "'transient'"),
    Bad("unknown method", {"contact.method": "magic"}, "contact.method", "'condensed'"),
    Bad("unknown model", {"model": "4d"}, "model", "found '4d'"),
    Bad(
        "unknown pressure or stress",
        {"wear.punch.per": "area"},
        "wear.punch.per",
        "'friction-stress' or 'pressure'",
    ),
    Bad("no model", {"model": GONE}, "model", "missing; must be 'axisymmetric', 'plane-strain'"),
    Bad("no geometry", {"geometry": GONE}, "geometry", "missing"),
    Bad("no bodies", {"bodies": GONE}, "bodies", "missing"),
    Bad(
        "no load",
        {"load": GONE},
        "load",
        "missing; needs one of load.force, load.mean_pressure and load.approach",
    ),
    Bad("no analysis", {"analysis": GONE}, "analysis", "missing; needs a type"),
    Bad("size left out", {"geometry.plate_height": GONE}, "geometry.plate_height", "missing"),
]

QUANTITIES = [
    Bad("no unit", {YOUNG: "200e9"}, YOUNG, "without a unit"),
    Bad("bare number", {YOUNG: 200e9}, YOUNG, "needs a quantity with its unit"),
    Bad("wrong dimension", {YOUNG: "200 mm"}, YOUNG, "dimension [length]; must be in Pa"),
    Bad(
        "unreadable unit",
        {YOUNG: "200 furlongpascal"},
        YOUNG,
        "cannot read \"200 furlongpascal\": unknown unit 'furlongpascal'; write it like",
    ),
    Bad("unit in other letters", {YOUNG: "200 Gpa"}, YOUNG, "unknown unit 'Gpa', perhaps GPa; "),
    Bad("unit with a letter too many", {YOUNG: "200 N/mmm^2"}, YOUNG, "'mmm', perhaps mm; "),
    Bad("unreadable number", {YOUNG: "two GPa"}, YOUNG, "cannot read"),
    Bad("unit alone", {YOUNG: "GPa"}, YOUNG, "cannot read"),
    Bad("two numbers", {YOUNG: "200 300 GPa"}, YOUNG, "cannot read"),
    Bad(
        "comma in the number",
        {"geometry.inner_radius": "20,5 mm"},
        "geometry.inner_radius",
        "cannot read",
    ),
    Bad("empty text", {YOUNG: ""}, YOUNG, "cannot read"),
    Bad("quantity nan", {YOUNG: "nan GPa"}, YOUNG, "must be finite"),
    Bad("quantity inf", {YOUNG: "inf GPa"}, YOUNG, "must be finite"),
    Bad("too large for a number", {YOUNG: "1e400 Pa"}, YOUNG, "must be finite"),
    Bad("too large in SI", {YOUNG: "1e308 GPa"}, YOUNG, "must be finite in Pa"),
    Bad("beyond all sizes", {YOUNG: "1e200 Pa"}, YOUNG, "must be from 1e-100 to 1e+100 Pa"),
    Bad("below all sizes", {YOUNG: "1e-320 Pa"}, YOUNG, "must be from 1e-100 to 1e+100 Pa"),
    Bad("too small in SI", {YOUNG: "1e-323 mPa"}, YOUNG, "greater than 0 Pa"),
    Bad(
        "negative conductivity",
        {"bodies.punch.conductivity": "-50 W/(m K)"},
        "bodies.punch.conductivity",
        'found "-50 W/(m K)"; must be greater than 0 W/m/K',
    ),
    Bad(
        "zero conductivity",
        {"bodies.punch.conductivity": "0 W/(m K)"},
        "bodies.punch.conductivity",
        "greater than 0",
    ),
    Bad(
        "negative expansion",
        {"bodies.punch.expansion": "-1e-5 1/K"},
        "bodies.punch.expansion",
        "at least 0 1/K",
    ),
    Bad("zero load", {"load.mean_pressure": "0 MPa"}, "load.mean_pressure", "greater than 0 Pa"),
    Bad(
        "colder than 0 K",
        {"heat.ambient": "-300 degC"},
        "heat.ambient",
        'found "-300 degC"; must be at least 0 K',
    ),
    Bad(
        "turns for an angle",
        {"motion.angular_velocity": "10 Hz"},
        "motion.angular_velocity",
        "turn/s or rad/s",
    ),
    Bad("zero conductance", {"heat.conductance": "0 W/(m^2 K)"}, "heat.conductance", "greater"),
]

NUMBERS = [
    Bad("incompressible", {NU: 0.5}, NU, "found 0.5; must be less than 0.5"),
    Bad("Poisson's ratio -1", {NU: -1}, NU, "found -1; must be greater than -1"),
    Bad("Poisson's ratio nan", {NU: nan}, NU, "finite number"),
    Bad("friction inf", {"contact.friction": inf}, "contact.friction", "finite number"),
    Bad("negative friction", {"contact.friction": -0.1}, "contact.friction", "at least 0"),
    Bad("friction as text", {"contact.friction": "0.25"}, "contact.friction", "must be a number"),
    Bad("friction true", {"contact.friction": True}, "contact.friction", "must be a number"),
    Bad("partition 1.5", {"heat.partition": 1.5}, "heat.partition", "at most 1"),
    Bad("degree 11", {"mesh.degree": 11}, "mesh.degree", "at most 10"),
    Bad("degree 0", {"mesh.degree": 0}, "mesh.degree", "at least 1"),
    Bad("degree 2.5", {"mesh.degree": 2.5}, "mesh.degree", "whole number"),
    Bad("degree 2.0", {"mesh.degree": 2.0}, "mesh.degree", "whole number"),
    Bad("degree true", {"mesh.degree": True}, "mesh.degree", "whole number"),
    Bad("degree nan", {"mesh.degree": nan}, "mesh.degree", "whole number"),
    Bad("no elements", {"mesh.elements": 0}, "mesh.elements", "at least 1"),
    Bad(
        "no elements of a body",
        {"mesh.bodies.plate": {"elements": 0}},
        "mesh.bodies.plate.elements",
        "at least 1",
    ),
    Bad("too many elements", {"mesh.elements": 10**30}, "mesh.elements", "at most 2000"),
    Bad("grading 1.5", {"mesh.grading": 1.5}, "mesh.grading", "at most 1"),
    Bad("grading true", {"mesh.grading": True}, "mesh.grading", "must be a number"),
    Bad(
        "degree of pressure above that of displacement",
        {"contact.pressure_degree": 9},
        "contact.pressure_degree",
        "at most mesh.degree = 8",
    ),
    Bad("tolerance 0", {"analysis.tolerance": 0}, "analysis.tolerance", "at least", RUNNING_IN),
    Bad("tolerance nan", {"analysis.tolerance": nan}, "analysis.tolerance", "finite", RUNNING_IN),
    Bad("no steps", {"analysis.max_steps": 0}, "analysis.max_steps", "at least 1", RUNNING_IN),
    Bad("exponent 0", {B: 0}, B, "at least 0.1"),
    Bad("exponent nan", {A: nan}, A, "finite number"),
]

KINDS = [
    Bad("table for a number", {NU: {"value": 0.3}}, NU, "must be a number"),
    Bad("list for a number", {NU: [0.3]}, NU, "found [0.3]; must be a number"),
    Bad("date for a number", {NU: datetime.date(2020, 2, 2)}, NU, "must be a number"),
    Bad("number for a table", {"mesh": 8}, "mesh", "found 8; must be a table"),
    Bad("number for the geometry", {"geometry": 8}, "geometry", "must be a table"),
    Bad("number for the analysis", {"analysis": 8}, "analysis", "found 8; must be a table"),
    Bad("number for a body", {"bodies.plate": 8}, "bodies.plate", "must be a table"),
    Bad("list for bodies", {"bodies": [1]}, "bodies", "must be a table"),
    Bad("text for a wear law", {"wear.punch": "hard"}, "wear.punch", "must be a table"),
    Bad("list for text", {"title": ["a"]}, "title", "must be text"),
    Bad("number for text", {"bodies.plate.like": 3}, "bodies.plate.like", "must be text"),
    Bad("list for a quantity", {YOUNG: ["200 GPa"]}, YOUNG, "needs a quantity"),
    Bad("table for a quantity", {YOUNG: {"GPa": 200}}, YOUNG, "needs a quantity"),
    Bad("list for a type", {"analysis.type": ["steady"]}, "analysis.type", "must be one of"),
    Bad("list for a geometry", {"geometry.type": ["cone"]}, "geometry.type", "must be one of"),
    Bad("text for a list", {TIMES: "1 s"}, TIMES, "must be a list", RUNNING_IN),
]

RELATIONS = [
    Bad(
        "ring inside out",
        {"geometry.inner_radius": "130 mm"},
        "geometry.inner_radius",
        "0.13 m must be less than outer_radius 0.12 m",
    ),
    Bad(
        "plate smaller than the ring",
        {"geometry.plate_radius": "110 mm"},
        "geometry.plate_radius",
        "greater than outer_radius",
    ),
    Bad("force and pressure", {"load.force": "1 kN"}, "load", "exactly one"),
    Bad("neither force nor pressure", {"load.mean_pressure": GONE}, "load", "exactly one"),
    Bad("no modulus", {YOUNG: GONE}, YOUNG, "missing"),
    Bad("no Poisson's ratio", {NU: GONE}, NU, "missing"),
    Bad("like no body", {"bodies.plate.like": "disc"}, "bodies.plate.like", "punch, plate"),
    Bad(
        "like itself",
        {"bodies.plate.like": "plate"},
        "bodies.plate.like",
        "is a circular reference",
    ),
    Bad(
        "like, and a key of its own",
        {"bodies.plate.density": "7800 kg/m^3"},
        "bodies.plate.density",
        "not allowed together with like",
    ),
    Bad(
        "no friction for friction stress",
        {"contact.friction": 0, "heat": GONE},
        "contact.friction",
        'write per = "pressure"',
    ),
    Bad(
        "no friction for heat",
        {"contact.friction": 0, "wear.punch.per": "pressure"},
        "contact.friction",
        "heat needs friction",
    ),
    Bad("steady without wear", {"wear": GONE}, "wear", "steady analysis needs"),
    Bad("transient without wear", {"wear": GONE}, "wear", "transient analysis needs", RUNNING_IN),
    Bad("no motion", {"motion": GONE}, "motion", "need sliding"),
    Bad("coefficient without unit", {COEFFICIENT: "2e-7"}, COEFFICIENT, "without a unit"),
    Bad("coefficient 0", {COEFFICIENT: "0 1/MPa"}, COEFFICIENT, "greater than 0"),
    Bad("coefficient vanishes in SI", {COEFFICIENT: "1e-320 1/MPa"}, COEFFICIENT, "out of range"),
    Bad("unit does not fit b", {B: 2.0}, COEFFICIENT, "needs 1/MPa^2"),
    Bad("unit does not fit b = 1/2", {B: 0.5}, COEFFICIENT, "needs 1/MPa^0.5"),
    Bad("unit does not fit a", {A: 0.5}, COEFFICIENT, "needs (m/s)^0.5 1/MPa^1"),
    Bad("coefficient a length", {COEFFICIENT: "2 mm"}, COEFFICIENT, "does not fit"),
    Bad("heat without sink", {"heat.cooling": GONE}, "heat", "there is no heat sink"),
    Bad(
        "cooled, and of given temperature",
        {"heat.temperature": {"plate_bottom": "20 degC"}},
        f"{COOL}.plate_bottom",
        "already has a prescribed temperature",
    ),
    Bad(
        "cooled contact face",
        {f"{COOL}.punch_face": "9 W/(m^2 K)"},
        f"{COOL}.punch_face",
        "contact face",
    ),
    Bad(
        "contact face of given temperature",
        {"heat.temperature": {"plate_face": "20 degC"}},
        "heat.temperature.plate_face",
        "contact face",
    ),
    Bad(
        "heat without conductivity",
        {"bodies.punch.conductivity": GONE},
        "bodies.punch.conductivity",
        "[heat]",
    ),
    Bad(
        "heat without expansion",
        {"bodies.punch.expansion": GONE},
        "bodies.punch.expansion",
        "[heat]",
    ),
    Bad("transient without end", {END: GONE}, END, 'or until = "steady"', RUNNING_IN),
    Bad("output after the end", {TIMES: ["1 s", "5 min"]}, TIMES, "300 s lies after", RUNNING_IN),
    Bad("negative output time", {TIMES: ["1 s", "-1 s"]}, f"{TIMES}.1", "greater", RUNNING_IN),
    Bad("output time twice", {TIMES: ["1 s", "1000 ms"]}, TIMES, "contains 1 s twice", RUNNING_IN),
    Bad("negative end", {END: "-1 s"}, END, "greater than 0 s", RUNNING_IN),
    Bad("end 0", {END: "0 s"}, END, "greater than 0 s", RUNNING_IN),
    Bad("until never", {"analysis.until": "never"}, "analysis.until", "'steady'", RUNNING_IN),
]

SPEED, TURN = {"velocity": "50 mm/s"}, {"angular_velocity": "1 rad/s"}

MOTIONS = [
    Bad("ring moved along", {"motion": SPEED}, "motion.velocity", "needs motion.angular_velocity"),
    Bad("ring turned and moved", {"motion.velocity": "1 m/s"}, "motion.velocity", "not supported"),
    Bad("ring not moved", {"motion": {}}, "motion.angular_velocity", "missing"),
    Bad(
        "punch turned", {"motion": TURN}, "motion.angular_velocity", "needs motion.velocity", PUNCH
    ),
    Bad(
        "box turned",
        {"motion": TURN},
        "motion.angular_velocity",
        "not supported; a 3d model needs motion.velocity",
        "rectangular-punch",
    ),
    Bad("punch not moved", {"motion": {}}, "motion.velocity", "missing; a plane-strain", PUNCH),
    Bad(
        "velocity 0",
        {"motion": {"velocity": "0 mm/s"}},
        "motion.velocity",
        "must be other than 0 m/s",
        PUNCH,
    ),
    Bad(
        "angular velocity 0",
        {"motion": {"angular_velocity": "0 rad/s"}},
        "motion.angular_velocity",
        "other than 0",
    ),
    Bad(
        "half of what slides with friction",
        {"motion": SPEED, "contact.friction": 0.3},
        "geometry.half",
        "mesh the whole section",
        HERTZ,
    ),
]

ONE = "exactly one of force, mean_pressure and approach"

LOADS = [
    Bad("pressure and approach", {"load.approach": "1 um"}, "load", ONE, PUNCH),
    Bad("force and approach", {"load.force": "1 N"}, "load", ONE, HERTZ),
    Bad("all three", {"load.force": "1 N", "load.approach": "1 um"}, "load", ONE, PUNCH),
    Bad("no load in the table", {"load": {}}, "load", ONE, HERTZ),
    Bad(
        "mean pressure of a cylinder",
        {"load": {"mean_pressure": "1 MPa"}},
        "load.mean_pressure",
        "no nominal contact area; give the force",
        HERTZ,
    ),
    Bad(
        "mean pressure of a file without an area",
        {"geometry": FILE, "mesh": {}, "contact": {}, "load": {"mean_pressure": "1 MPa"}},
        "load.mean_pressure",
        "no nominal contact area",
        HERTZ,
    ),
    Bad("steady approach", {"load": {"approach": "1 um"}}, "load.approach", "needs a force"),
    Bad("negative force", {"load": {"force": "-1 N"}}, "load.force", "greater than 0 N", HERTZ),
    Bad("negative approach", {"load": {"approach": "-1 um"}}, "load.approach", "greater", HERTZ),
]

HISTORY = "load.history"
PAST, PUSH, MOVE = f"{HISTORY}.time", f"{HISTORY}.tangential_force", f"{HISTORY}.approach"

HISTORIES = [
    Bad(
        "history of an initial contact",
        {HISTORY: {"time": ["0 s"]}},
        HISTORY,
        "requires a transient or fretting analysis, not initial",
        HERTZ,
    ),
    Bad(
        "fretting without history",
        {HISTORY: GONE},
        HISTORY,
        "missing; required in a fretting",
        FRETTING,
    ),
    Bad("history without time", {PAST: GONE}, PAST, "missing", FRETTING),
    Bad("empty history", {HISTORY: {"time": []}}, PAST, "is empty", FRETTING),
    Bad("lists that differ", {PUSH: ["0 N", "1 N"]}, PUSH, "has 2 values for 4 times", FRETTING),
    Bad("time goes back", {PAST: ["0 s", "2 s", "1 s", "3 s"]}, PAST, "must increase", FRETTING),
    Bad("time stands still", {PAST: ["0 s", "1 s", "1 s", "3 s"]}, PAST, "increase", FRETTING),
    Bad("time below 0", {PAST: ["-1 s", "1 s", "2 s", "3 s"]}, f"{PAST}.0", "at least", FRETTING),
    Bad("time is no list", {PAST: "0 s"}, PAST, "must be a list", FRETTING),
    Bad(
        "force and approach in the history",
        {"load": {"history": {"time": ["0 s"], "force": ["1 N"], "approach": ["1 um"]}}},
        MOVE,
        "only one of force and approach",
        FRETTING,
    ),
    Bad(
        "force and displacement across",
        {f"{HISTORY}.tangential_displacement": ["0 um"] * 4},
        f"{HISTORY}.tangential_displacement",
        "only one of tangential_force and",
        FRETTING,
    ),
    Bad(
        "force twice",
        {f"{HISTORY}.force": ["1 N"] * 4},
        "load",
        "load.history already prescribes the force or the approach",
        FRETTING,
    ),
    Bad("force, approach over time", {MOVE: ["1 um"] * 4}, "load", "already", FRETTING),
    Bad("nothing presses", {"load.force": GONE}, "load", ONE, FRETTING),
    Bad(
        "nothing presses for a moment",
        {f"{HISTORY}.force": ["1 N", "0 N", "1 N", "1 N"], "load.force": GONE},
        f"{HISTORY}.force.1",
        "must be greater than 0 N in a fretting analysis",
        FRETTING,
    ),
    Bad("pull", {f"{HISTORY}.force": ["1 N", "-1 N"]}, f"{HISTORY}.force.1", "at least", FRETTING),
    Bad("half pushed across", {"geometry.half": True}, "geometry.half", "not symmetric", FRETTING),
    Bad(
        "sphere pushed across",
        {
            "analysis": {"type": "fretting"},
            HISTORY: {"time": ["0 s"], "tangential_force": ["1 N"]},
            "contact": {},
        },
        HISTORY,
        "tangential loads are not supported in axisymmetric models",
        SPHERE,
    ),
    Bad("output after the history", {TIMES: ["1 s", "4 s"]}, TIMES, "4 s lies outside", FRETTING),
    Bad(
        "output before the history",
        {TIMES: ["1 s"], PAST: ["2 s", "3 s", "4 s", "5 s"]},
        TIMES,
        "1 s lies outside",
        FRETTING,
    ),
    Bad("output of fretting twice", {TIMES: ["1 s", "1000 ms"]}, TIMES, "twice", FRETTING),
    Bad("no increments", {"analysis.increments": 0}, "analysis.increments", "at least 1", FRETTING),
    Bad(
        "fretting pointwise",
        POINTWISE,
        "contact.method",
        "'pointwise' does not support a fretting analysis",
        FRETTING,
    ),
    Bad(
        "fretting and sliding", {"motion": SPEED}, "motion", "not supported in a fretting", FRETTING
    ),
    Bad(
        "wear by friction without friction",
        {"wear.block": {"coefficient": "1e-7 1/MPa"}, "contact": {}},
        "contact.friction",
        "wear.block is per friction stress",
        FRETTING,
    ),
    Bad("no cycle", {"analysis.cycles": 0}, "analysis.cycles", "at least 1", FRETTING),
    Bad("jump by nothing", {"analysis.jump": 0}, "analysis.jump", "at least 1", FRETTING),
    Bad("jump by a word", {"analysis.jump": "far"}, "analysis.jump", '"auto" or a whole', FRETTING),
    Bad(
        "two numbers of cycles",
        {"wear.cycles": 3, "analysis.cycles": 3},
        "wear.cycles",
        "only one of wear.cycles and analysis.cycles",
        FRETTING,
    ),
    Bad(
        "cycles of wear of loads that do not come back",
        {"wear.cycles": 2, PUSH: ["0 N", "36 N", "-36 N", "30 N"]},
        "wear.cycles",
        "no earlier instant of load.history has the loads of its last one",
        FRETTING,
    ),
    Bad(
        "largest jump of given ones",
        {"wear.max_jump": 2, "analysis.jump": 3},
        "wear.max_jump",
        'requires analysis.jump = "auto"',
        FRETTING,
    ),
    Bad("cycles of a running-in", {"wear.cycles": 3}, "wear.cycles", "not transient", RUNNING_IN),
    Bad("jumps of a running-in", {"wear.max_jump": 3}, "wear.max_jump", "not trans", RUNNING_IN),
    Bad(
        "cycles of loads that do not come back",
        {"analysis.cycles": 2, PUSH: ["0 N", "36 N", "-36 N", "30 N"]},
        "analysis.cycles",
        "no earlier instant of load.history has the loads of its last one",
        FRETTING,
    ),
    Bad(
        "a cycle that does not close",
        {f"{HISTORY}.cycle_start": "1.5 s"},
        f"{HISTORY}.cycle_start",
        "the loads at both ends of the cycle must be equal",
        FRETTING,
    ),
    Bad(
        "a cycle of nothing",
        {f"{HISTORY}.cycle_start": "3 s"},
        f"{HISTORY}.cycle_start",
        "must be at least 0 s and less than 3 s",
        FRETTING,
    ),
    Bad(
        "output after the cycles",
        {"analysis.cycles": 3, TIMES: ["1 s", "7.5 s"]},
        TIMES,
        "7.5 s lies outside the cycles",
        FRETTING,
    ),
    Bad(
        "fretting and heat",
        {
            "heat.cooling": {"block_bottom": "1 W/(m^2 K)"},
            "bodies.cylinder.conductivity": "50 W/(m K)",
            "bodies.cylinder.expansion": "1e-5 1/K",
        },
        "heat",
        "not supported in a fretting",
        FRETTING,
    ),
]

STROKE, TIMES_A_SECOND = "motion.amplitude", "motion.frequency"
ENDLESS = {"analysis": {"type": "reciprocating"}}

TO_AND_FRO = [
    Bad("no amplitude", {STROKE: GONE}, STROKE, "missing; a reciprocating", RECIPROCATING),
    Bad("no frequency", {TIMES_A_SECOND: GONE}, TIMES_A_SECOND, "missing", RECIPROCATING),
    Bad("no motion at all", {"motion": GONE}, "motion", "missing; wear", RECIPROCATING),
    Bad("no amplitude to speak of", {STROKE: "0 mm"}, STROKE, "greater than 0", RECIPROCATING),
    Bad(
        "frequency as an angular velocity",
        {TIMES_A_SECOND: "12 rad/s"},
        TIMES_A_SECOND,
        "an angular velocity; write Hz",
        RECIPROCATING,
    ),
    Bad(
        "frequency in turns",
        {TIMES_A_SECOND: "120 rpm"},
        TIMES_A_SECOND,
        "an angular velocity",
        RECIPROCATING,
    ),
    Bad(
        "velocity of a reciprocating body",
        {"motion.velocity": "1 mm/s"},
        "motion.velocity",
        "has amplitude and frequency",
        RECIPROCATING,
    ),
    Bad(
        "amplitude of a steady state",
        {"motion": {"velocity": "1 mm/s", "amplitude": "1 mm"}, "analysis": {"type": "steady"}},
        STROKE,
        "requires a reciprocating analysis, not steady",
        RECIPROCATING,
    ),
    Bad("no end of strokes", ENDLESS, END, "needs end_time, cycles or until", RECIPROCATING),
    Bad("two ends", {END: "2000 s"}, "analysis.cycles", "only one of", RECIPROCATING),
    Bad(
        "cycles of wear and an end",
        {"analysis": {"type": "reciprocating", "end_time": "1 s"}, "wear.cycles": 3},
        "wear.cycles",
        "only one of analysis.end_time and wear.cycles",
        RECIPROCATING,
    ),
    Bad(
        "output after the last cycle",
        {TIMES: ["1001 s"]},
        TIMES,
        "1001 s lies after the last cycle",
        RECIPROCATING,
    ),
    Bad(
        "one position",
        {"analysis.positions": 1},
        "analysis.positions",
        "at least 2",
        RECIPROCATING,
    ),
    Bad("no wear", {"wear": GONE}, "wear", "missing; a reciprocating", RECIPROCATING),
    Bad(
        "heat to and fro",
        {
            "heat": {"cooling": {"punch_top": "1 W/(m^2 K)"}},
            "bodies.punch.conductivity": "50 W/(m K)",
            "bodies.punch.expansion": "1e-5 1/K",
        },
        "heat",
        "is not supported in a reciprocating analysis",
        RECIPROCATING,
    ),
    Bad(
        "to and fro by penalty",
        {"contact.method": "penalty"},
        "contact.method",
        "use condensed",
        RECIPROCATING,
    ),
    Bad(
        "free along the stroke",
        {"holder.free": ["z", "x"]},
        "holder.free",
        "the motion of body 1 along x is prescribed",
        RECIPROCATING,
    ),
    Bad(
        "steady though it turns",
        {
            "holder.free": ["z", "rotation"],
            "analysis": {"type": "reciprocating", "until": "steady"},
        },
        "analysis.until",
        "wear rates do not become uniform",
        RECIPROCATING,
    ),
    Bad(
        "a strip that passes by and does not",
        {"wear.strip.spread": "track"},
        "wear.strip.spread",
        "not supported in a reciprocating analysis: body 2 does not pass by",
        RECIPROCATING,
    ),
    Bad(
        "a ring to and fro",
        {
            "motion": {"amplitude": "1 mm", "frequency": "1 Hz"},
            "analysis": {"type": "reciprocating", "cycles": 1},
        },
        "model",
        "needs a plane or 3d model with sliding along x",
        RUNNING_IN,
    ),
    Bad(
        "half of a punch to and fro",
        {
            "geometry.half": True,
            "motion": {"amplitude": "1 mm", "frequency": "1 Hz"},
            "wear.punch": {"coefficient": "1e-7 1/MPa", "per": "pressure"},
            "analysis": {"type": "reciprocating", "cycles": 1},
        },
        "geometry.half",
        "not symmetric",
        PUNCH,
    ),
]

NITSCHE, PENALTY = ({"contact": {"method": name}} for name in ("nitsche", "penalty"))
STIFF, THETA, GAMMA = (f"contact.{key}" for key in ("penalty", "theta", "gamma"))
DEGREE = "contact.pressure_degree"

METHODS = [
    Bad("penalty, condensed", {STIFF: "1e15 Pa/m"}, STIFF, 'method = "penalty"', HERTZ),
    Bad("penalty of Nitsche", NITSCHE | {STIFF: "1e15 Pa/m"}, STIFF, 'method = "penalty"', HERTZ),
    Bad("penalty 0", PENALTY | {STIFF: "0 Pa/m"}, STIFF, "greater than 0 Pa/m", HERTZ),
    Bad("penalty a pressure", PENALTY | {STIFF: "1e15 Pa"}, STIFF, "must be in Pa/m", HERTZ),
    Bad("theta, condensed", {THETA: 1}, THETA, 'method = "nitsche"', HERTZ),
    Bad("theta of penalty", PENALTY | {THETA: 0}, THETA, 'method = "nitsche"', HERTZ),
    Bad("theta 2", NITSCHE | {THETA: 2}, THETA, "found 2; must be 1, 0 or -1", HERTZ),
    Bad("theta 1.0", NITSCHE | {THETA: 1.0}, THETA, "found 1.0; must be 1, 0 or -1", HERTZ),
    Bad("theta true", NITSCHE | {THETA: True}, THETA, "found True; must be 1, 0 or -1", HERTZ),
    Bad("gamma, condensed", {GAMMA: 10.0}, GAMMA, 'method = "nitsche"', HERTZ),
    Bad("gamma of penalty", PENALTY | {GAMMA: 10.0}, GAMMA, 'method = "nitsche"', HERTZ),
    Bad("gamma 0", NITSCHE | {GAMMA: 0}, GAMMA, "found 0; must be greater than 0", HERTZ),
    Bad("pressure of Gauss", {DEGREE: "gauss"}, DEGREE, 'from 1 to 10, or "lobatto"', HERTZ),
    Bad("pressure degree 0", {DEGREE: 0}, DEGREE, "found 0; must be a whole number", HERTZ),
    Bad("pressure degree 2.5", {DEGREE: 2.5}, DEGREE, "found 2.5; must be a whole", HERTZ),
    Bad("pressure degree true", {DEGREE: True}, DEGREE, "found True; must be a whole", HERTZ),
    Bad("pressure degree in a list", {DEGREE: [3]}, DEGREE, "found [3]; must be a whole", HERTZ),
    Bad("pressure degree 7 of 6", {DEGREE: 7}, DEGREE, "found 7; at most mesh.degree = 6", HERTZ),
    Bad("positioning 1", {"contact.positioning": 1}, "contact.positioning", "true or false", HERTZ),
    Bad("positioning yes", {"contact.positioning": "yes"}, "contact.positioning", "true", HERTZ),
    Bad(
        "positioning of a file",
        {"geometry": FILE, "mesh": {}},
        "contact.positioning",
        "the mesh of 'file' cannot be moved",
        HERTZ,
    ),
    Bad("key of the contact", {"contact.penlty": 1}, "contact.penlty", "mean penalty?", HERTZ),
]

WIDE = "geometry.block_width"

PLANE = [
    Bad("ring in a plane", {"model": "plane-strain"}, "model", "allowed: axisymmetric"),
    Bad("cylinder turned", {"model": "axisymmetric"}, "model", "allowed: plane-strain", HERTZ),
    Bad("sphere in a plane", {"model": "plane-stress"}, "model", "allowed: axisymmetric", SPHERE),
    Bad("thickness 0", {"geometry.thickness": "0 mm"}, "geometry.thickness", "greater", HERTZ),
    Bad("half as text", {"geometry.half": "yes"}, "geometry.half", "must be true or false", HERTZ),
    Bad("half without its plane", {"geometry": FILE | {"half": True}}, "geometry.half", "symmetry"),
    Bad(
        "plane of a whole",
        {"geometry": FILE | {"symmetry": ["AXIS"]}},
        "geometry.symmetry",
        "half = true",
    ),
    Bad("half of a sphere", {"geometry.half": True}, "geometry.half", "unknown key here", SPHERE),
    Bad(
        "edges rounder than the punch",
        {"geometry.edge_radius": "5 mm"},
        "geometry.edge_radius",
        "less than half the width 0.005 m",
        PUNCH,
    ),
    Bad(
        "negative rounding",
        {"geometry.edge_radius": "-1 mm"},
        "geometry.edge_radius",
        "at least 0 m",
        PUNCH,
    ),
    Bad("narrow block", {WIDE: "13 mm"}, WIDE, "greater than 4/3 of width 0.01 m", PUNCH),
]


def of_file(name: str, key: str, value: Any, path: str, text: str) -> Bad:
    """A fault in the keys of a geometry that is read from a file."""
    geometry = {k: v for k, v in (FILE | {key: value}).items() if v is not GONE}
    changes = {"geometry": geometry, "mesh": {}, "contact": {}}
    return Bad(name, changes, f"geometry.{path}", text, HERTZ)


OF_FILES = [
    of_file("no path", "path", GONE, "path", "missing"),
    of_file("no bodies", "bodies", GONE, "bodies", "missing"),
    of_file("no contact", "contact", GONE, "contact", "missing"),
    of_file("no holder", "held", GONE, "held", "missing"),
    of_file("nothing fixed", "fixed", GONE, "fixed", "missing"),
    of_file("one body", "bodies", {"cylinder": "a"}, "bodies", "needs two"),
    of_file("list of bodies", "bodies", ["a", "b"], "bodies", "must be a table"),
    of_file("one face", "contact", ["a"], "contact.1", "missing"),
    of_file("three faces", "contact", ["a", "b", "c"], "contact", "at most 2"),
    of_file("faces as text", "contact", "a", "contact", "must be a list"),
    of_file("face by number", "contact", ["a", 2], "contact.1", "must be text"),
    of_file("one face twice", "contact", ["a", "a"], "contact", "'a' is used twice"),
    of_file("face on the holder", "held", "block_face", "held", "'block_face' is used twice"),
    of_file("unit of mass", "length_unit", "1 kg", "length_unit", "dimension [mass]"),
    of_file("unit without number", "length_unit", "mm", "length_unit", "cannot read"),
    of_file("area a length", "contact_area", "1 m", "contact_area", "must be in m^2"),
    of_file("unknown key of a file", "helt", "a", "helt", "did you mean held?"),
    of_file("name of an attribute", "held_name", "a", "held_name", "did you mean held?"),
    of_file("key of another geometry", "radius", "1 mm", "radius", "unknown key here"),
]

TILT, STRIP, PIVOT, DISK = (
    "punch-on-strip-tilting",
    "punch-on-strip",
    "pivoted-block",
    "block-on-disk",
)
BEAM, BOX, DRUM, PADS = "beam-on-foundation", "rectangular-punch", "drum-brake", "disk-brake"
FREE = "holder.free"

HOLDERS = [
    Bad("free in a word", {"holder": {"free": "z"}}, FREE, "must be a list", STRIP),
    Bad("unknown motion", {"holder": {"free": ["up"]}}, f"{FREE}.0", "found 'up'", STRIP),
    Bad("a motion twice", {"holder": {"free": ["z", "z"]}}, FREE, "twice", STRIP),
    Bad("tilt of a section", {"holder": {"free": ["rotation-x"]}}, FREE,
        "not supported in plane", STRIP),
    Bad("turning ring", {"holder": {"free": ["z", "rotation"]}}, FREE,
        "not supported in axisymmetric"),
    Bad("turn in space", {FREE: ["z", "rotation"]}, FREE, "not supported in 3d models", BOX),
    Bad("pivot in space", {"holder.pivot": ["0 mm"] * 2}, "holder.pivot", "needs 3", BOX),
    Bad("pivot without unit", {"holder.pivot": [0, "0 mm"]}, "holder.pivot.0", "its unit", TILT),
    Bad("point in space", {"load.point": ["0 mm"]}, "load.point", "3d needs 2", BOX),
    Bad("moments in the plane", {"load.moments": ["1 N m"] * 2}, "load.moments",
        "a 3d model", TILT),
    Bad("moment in space", {"load.moment": "1 N m"}, "load.moment", "a plane model", BOX),
    Bad("lever and point", {"load.lever": "1 mm"}, "load.lever", "only one of", TILT),
    Bad("lever that turns nothing", {"load.lever": "1 mm"}, "load.lever",
        "requires a holder that can rotate", STRIP),
    Bad("moment and lever", {"load.moment": "1 N m"}, "load", "a moment, or a force", PIVOT),
    Bad("moment with a lever", {"load": {"moment": "1 N m", "lever": "1 mm"}}, "load",
        "a moment, or a force", PIVOT),
    Bad("nothing that turns it", {"load": {}}, "load", ONE, DRUM),
    Bad("push in a guide", {"load.tangential_force": "1 N"}, "load.tangential_force", "free", DISK),
    Bad("approach of a lever",
        {"load": {"approach": "1 um"}, "analysis": {"type": "initial"}},
        "load.approach", "add", PIVOT),
    Bad("fixed and pushed", {"load.force": "1 N"}, "load", "load.pressure, and nothing", BEAM),
    Bad("fixed without a load", {"load": {}}, "load", "needs load.surfaces", BEAM),
    Bad("steady and fixed", {"analysis": {"type": "steady"}}, FREE, "no steady state", BEAM),
    Bad("load on a surface of a guided body", {"load.surfaces": {"punch_top": "1 N"}},
        "load.surfaces", "requires a fixed holder", STRIP),
    Bad("pressure on no surface", {"load.pressure": {"roof": "1 MPa"}},
        "load.pressure.roof", "unknown name in this geometry", STRIP),
    Bad("pressure without unit", {"load.pressure": {"punch_left": 2}},
        "load.pressure.punch_left", "its unit", STRIP),
    Bad("suction", {"load.pressure": {"punch_left": "-1 MPa"}},
        "load.pressure.punch_left", "greater than 0", STRIP),
    Bad("pressure in the contact", {"load.pressure": {"strip_face": "1 MPa"}},
        "load.pressure.strip_face", "is a contact face", STRIP),
    Bad("pressure on a fixed surface", {"load.pressure": {"strip_bottom": "1 MPa"}},
        "load.pressure.strip_bottom", "is fixed", STRIP),
    Bad("pressure on a plane of symmetry", {"load.pressure": {"cylinder_axis": "1 MPa"}},
        "load.pressure.cylinder_axis", "plane of symmetry", HERTZ),
    Bad("pressure alone on a round body", {"load": {"pressure": {"cylinder_top": "1 MPa"}}},
        "load", "needs one of force", HERTZ),
    Bad("pressure in fretting", {"load.pressure": {"block_side": "1 MPa"}},
        "load.pressure", "not supported in a fretting analysis", FRETTING),
    Bad("fluid in fretting", {"contact.fluid_pressure": "1 MPa"},
        "contact.fluid_pressure", "not supported in a fretting analysis", FRETTING),
    Bad("fluid without unit", {"contact.fluid_pressure": 1.0},
        "contact.fluid_pressure", "unit", STRIP),
    Bad("load on no surface", {"load.surfaces": {"roof": "1 kN"}},
        "load.surfaces.roof", "unknown name in this geometry", BEAM),
    Bad("layer without unit", {"contact.compliance": 1e-9}, "contact.compliance", "unit", BEAM),
    Bad("disk moved along", {"motion": SPEED}, "motion.velocity", "needs motion.angular", DISK),
    Bad("spread punch", {"wear.punch.spread": "track"},
        "wear.punch.spread", "only strip passes", STRIP),
    Bad("spread plate", {"wear": {"plate": {"coefficient": "1e-7 1/MPa", "spread": "track"}}},
        "wear.plate.spread", "is always in contact"),
    Bad("only the track wears",
        {"wear": {"strip": {"coefficient": "1e-7 1/MPa", "spread": "track"}}},
        "wear.strip.spread", "no unique steady pressure", STRIP),
    Bad("spread nowhere", {"wear.punch.spread": "thin"}, "wear.punch.spread", "must be", STRIP),
    Bad("material of no part", {"bodies.bolt": {"like": "drum"}}, "bodies.bolt", "lining", DRUM),
    Bad("nitsche and a disk in space",
        {"contact.method": "nitsche", "analysis": {"type": "transient", "end_time": "1 s"},
         "wear.disk": {"coefficient": "1e-8 1/MPa", "per": "friction-stress", "spread": "track"}},
        "contact.method", "does not support wear spread over the track", "disk-sector"),
    Bad("friction pointwise", POINTWISE | {"contact.friction": 0.2}, "contact.method",
        "'pointwise' does not support friction", HERTZ),
    Bad("heat pointwise", POINTWISE | {"analysis": {"type": "initial"}}, "contact.method",
        "'pointwise' does not support heat"),
    Bad("pad all the way and more", {"geometry.pad_angle": "400 deg"},
        "geometry.pad_angle", "at most 360 deg", PADS),
]  # fmt: skip

ALL = (NAMES + QUANTITIES + NUMBERS + KINDS + RELATIONS) + (
    MOTIONS + LOADS + HISTORIES + TO_AND_FRO + METHODS + PLANE + OF_FILES + HOLDERS
)


@pytest.mark.parametrize("bad", ALL, ids=lambda bad: bad.name)
def test_a_fault_is_one_line_with_the_path_of_its_key(bad, tmp_path, capsys):
    """
    requirement: bad input ends with exit code 1 and one line: exact path, what is wrong with it.
    """
    assert_refused(bad, tmp_path, capsys)


def test_several_faults_give_a_line_each():
    """
    requirement: one line per fault, not one run per fault.
    """
    found = faults({NU: 0.6, "mesh.degree": 11, "model": "4d", "geometry.plate_radius": "1 s"})
    assert sorted(line.split(":")[0] for line in found) == [
        NU,
        "geometry.plate_radius",
        "mesh.degree",
        "model",
    ]


def test_several_faults_between_tables_give_a_line_each():
    """
    requirement: one line per fault, for what does not fit together too.
    """
    found = faults({"load.force": "1 N", "motion": GONE, "wear": GONE, f"{COOL}.x": "1 W/m^2/K"})
    assert sorted(line.split(":")[0] for line in found) == [
        "heat.cooling.x",
        "load",
        "motion",
        "wear",
    ]


def test_every_key_beside_like_is_named():
    """
    requirement: one line per fault: each key that a body may not have beside `like`.
    """
    found = faults({"bodies.plate.density": "1 kg/m^3", "bodies.plate.poisson_ratio": 0.2})
    assert [line.split(":")[0] for line in found] == [
        "bodies.plate.density",
        "bodies.plate.poisson_ratio",
    ]


def test_bodies_like_each_other_in_a_circle():
    """
    requirement: a circle of `like` is reported at each of its bodies, and does not hang.
    """
    found = faults({"bodies.punch": {"like": "plate"}})
    assert [line.split(":")[0] for line in found] == ["bodies.punch.like", "bodies.plate.like"]
    assert all("is a circular reference" in line for line in found)


def test_an_unknown_body_is_not_asked_for_its_material():
    """
    requirement: one line per fault: the wrong name is the fault, not what is missing under it.
    """
    assert [line.split(":")[0] for line in faults({"bodies.disc": {}})] == ["bodies.disc"]


def test_an_empty_case_names_every_table_it_needs():
    """
    requirement: an empty file gets one line per missing table.
    """
    with pytest.raises(tw.CaseError) as caught:
        tw.load({})
    assert [line.split(";")[0] for line in caught.value.faults] == [
        f"{key}: missing" for key in ("model", "geometry", "bodies", "load", "analysis")
    ]


def test_what_is_wrong_with_heat_does_not_matter_without_heat():
    """
    requirement: without [heat] the run is isothermal and needs no thermal material.
    """
    gone = {f"bodies.punch.{key}": GONE for key in ("conductivity", "expansion")}
    assert tw.load(tables(STEADY, {"heat": GONE, **gone})).heat is None


def test_initial_contact_needs_neither_wear_nor_motion():
    """
    requirement: what an analysis does not use may be left out.
    """
    changes = {"wear": GONE, "motion": GONE, "heat": GONE, "analysis": {"type": "initial"}}
    assert tw.load(tables(STEADY, changes)).analysis.type == "initial"


FILES = [
    ("syntax", b'title = "a"\nmodel = \n', "line 2"),
    ("key twice", b"a = 1\na = 2\n", "line 2"),
    ("table twice", b"[mesh]\n[load]\n[mesh]\n", "line 3"),
    ("not UTF-8", b'title = "\xff"\n', "UTF-8"),
    ("binary", b"\x00\x01\x02", "line 1"),
    ("number too long", b"a = " + b"9" * 5000, "TOML"),
    ("nested too deeply", b"a = " + b"[" * 5000, "TOML"),
]


@pytest.mark.parametrize(("content", "text"), [f[1:] for f in FILES], ids=[f[0] for f in FILES])
def test_a_file_that_is_no_toml(content, text, tmp_path, capsys):
    """
    requirement: a file that cannot be read as TOML: exit code 1, one line with file and place.
    """
    file = tmp_path / "case.toml"
    file.write_bytes(content)
    assert main(["validate", str(file)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"error: {file}: ")
    assert text in line


@pytest.mark.parametrize(
    ("name", "text"),
    [("missing.toml", "No such file"), (".", "directory"), ("n" * 300, "too long")],
    ids=["missing", "directory", "name too long"],
)
def test_a_file_that_cannot_be_opened(name, text, tmp_path, capsys):
    """
    requirement: a case that is not there: exit code 1, one line that names it and says why.
    """
    assert main(["validate", str(tmp_path / name)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"error: {tmp_path / name}: cannot be read")
    assert text in line


def test_a_fault_stays_one_line_whatever_the_key(tmp_path, capsys):
    """
    requirement: one line per fault, though the key or the value has line breaks.
    """
    file = tmp_path / "case.toml"
    changes = {"mesh.a\nb": 1, YOUNG: "200\nGPb"}
    file.write_text(tomli_w.dumps(tables(STEADY, changes)), encoding="utf-8")
    assert main(["validate", str(file)]) == 1
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(": ")[1] for line in lines] == [r"mesh.a\nb", YOUNG]
