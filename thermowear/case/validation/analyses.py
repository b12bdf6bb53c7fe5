"""Consistency checks of the analysis: features that it supports, load histories, cycles."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import Any

from ...laws.histories import TANGENTIAL, LoadHistory
from ..any_case import AnyCase
from ..tables.analyses import Fretting, Reciprocating, Transient
from ..tables.schema import Case
from ..tables.tabulated import History
from ..values.section import Fault

_ONLY_IN: dict[str, tuple[str, ...]] = {
    "load.history": ("transient", "fretting"),
    "wear.cycles": ("fretting", "reciprocating"),
    "wear.max_jump": ("fretting", "reciprocating"),
}
"""Analyses that support a key."""
_NOT_IN = {
    "heat": ("fretting", "reciprocating"),
    "motion": ("fretting",),
    "load.pressure": ("fretting",),
    "contact.fluid_pressure": ("fretting", "reciprocating"),
}
"""Analyses that do not support a table."""
_CONSTANT = ("fretting", "reciprocating", "stability")
"""Analyses in which all properties are constant."""
_FACTORS = ("conductivity_factor", "expansion_factor")
_UNVARIED = ("moment", "moments", "tangential_force", "surfaces")
"""Loads that no history changes."""


def supported(case: Case) -> Iterator[Fault]:
    """Keys and histories that the analysis supports."""
    type_ = case.analysis.type
    only_in = dict(_ONLY_IN)
    if type_ != "fretting":  # refuses motion and heat altogether
        only_in |= dict.fromkeys(case.histories.keys() - {"load.history"}, ("transient",))
    elif case.contact.friction_history is not None:
        only_in["contact.friction_history"] = ("transient",)
    for path in sorted(only_in):
        if type_ not in only_in[path] and (path in case.histories or _given(case, path)):
            yield path, f"requires a {' or '.join(only_in[path])} analysis, not {type_}"
    for path, refusing in _NOT_IN.items():
        if type_ in refusing and _given(case, path) not in (None, {}):
            yield path, f"is not supported in a {type_} analysis"


def _given(case: Case, path: str) -> Any:
    """Value at the path of a key."""
    found: Any = case
    for key in path.split("."):
        found = getattr(found, key, None)
    return found


def condensed_only(case: Case) -> Iterator[Fault]:
    """Features that require the condensed method."""
    if case.contact.method != "condensed":
        for feature in _condensed_features(case):
            yield (
                "contact.method",
                f"{case.contact.method!r} does not support {feature}; use condensed",
            )


def _condensed_features(case: Case) -> Iterator[str]:
    type_, heat = case.analysis.type, case.heat
    if case.contact.method == "pointwise":
        yield from _beside_pressure(case)
    elif type_ == "reciprocating":
        yield "a reciprocating analysis"
    if case.model == "3d" and type_ == "transient" and _passes_disk(case):
        yield "wear spread over the track of a disk in 3d"
    elif type_ == "stability":
        yield "a stability analysis"
    elif heat is not None and heat.transient:
        yield "temperatures in time"
    elif type_ in ("initial", "transient") and (case.varies or case.contact.friction_history):
        yield "variable friction, wear or conductance"
    elif heat is not None and any(_factors(case)):
        yield "variable conductivity or expansion"


def _beside_pressure(case: Case) -> Iterator[str]:
    """Everything but the pressure between unworn faces."""
    contact = case.contact
    if case.analysis.type != "initial":
        yield f"a {case.analysis.type} analysis"
    elif case.heat is not None:
        yield "heat"
    elif contact.nominal_friction or contact.transverse_friction:
        yield "friction"


def _passes_disk(case: Case) -> bool:
    """True if the wear of a body is averaged along its circles, which couples distant points."""
    geometry, spread = case.geometry, any(w.spread != "in-place" for w in case.wear.values())
    tracks = geometry.duty, geometry.duty_by_radius, geometry.footprint
    return spread and any(track is not None for track in tracks)


def _factors(case: AnyCase) -> Iterator[str]:
    """Paths of all tables of factors of materials."""
    for name, body in case.bodies.items():
        yield from (f"bodies.{name}.{key}" for key in _FACTORS if getattr(body, key) is not None)


def varying(case: AnyCase) -> Iterator[Fault]:
    """Variables of laws and tables of factors that are available in the analysis."""
    type_, constant = case.analysis.type, case.analysis.type in _CONSTANT
    contacts = case.contact_tables
    tables = {f"{path}.friction_factor": table.friction_factor for path, table in contacts.items()}
    tables |= {f"wear.{name}.factor": law.factor for name, law in case.wear.laws.items()}
    for path, table in tables.items():
        if constant and table.depends_on:
            yield path, f"is not supported in a {type_} analysis"
        elif table.temperature is not None and case.heat is None:
            yield f"{path}.temperature", "needs a [heat] table, which computes the temperatures"
    if constant:
        yield from ((path, f"is not supported in a {type_} analysis") for path in _factors(case))
    frictions = {f"{path}.friction": table for path, table in contacts.items()}
    laws = {path: table.friction_law.variables for path, table in frictions.items()}
    laws |= {f"wear.{name}.rate": law.variables for name, law in case.wear.laws.items() if law.rate}
    for path, variables in laws.items():
        friction = path in frictions
        refused = sorted(variables if friction else variables & {"T", "depth"})
        unsupported = f"depends on {', '.join(refused)}; not supported in a {type_} analysis"
        if constant and refused and friction:
            yield path, unsupported
        if "T" in variables and case.heat is None:
            yield path, "depends on T; requires a [heat] table"
        elif constant and refused and not friction:
            yield path, unsupported
        elif "depth" in variables and "steady" in (type_, getattr(case.analysis, "until", None)):
            yield path, "depends on depth, which grows without end: there is no steady state"


NOT_UNDER = "is not supported under {}, where a steady state may be periodic; give end_time only"


def histories(case: Case) -> Iterator[Fault]:
    """Time histories that have an effect, and end the analysis in time."""
    analysis, history = case.analysis, case.load.history
    if history is not None and history.moment is not None:
        yield "load.history.moment", "requires a fretting analysis of several bodies (holders.NAME)"
    if isinstance(analysis, Transient):
        if history is not None:
            yield from _force_history(case, history)
        if analysis.until is not None and case.histories:
            which = next(iter(case.histories))
            yield "analysis.until", NOT_UNDER.format(which)
    elif isinstance(analysis, Fretting) and history is not None:
        if history.repeat:
            yield (
                "load.history.repeat",
                "requires a transient analysis; use analysis.cycles in a fretting analysis",
            )
        for i, force in enumerate(history.force or ()):
            if force == 0.0:
                yield f"load.history.force.{i}", "must be greater than 0 N in a fretting analysis"
    if case.contact.friction_history is not None:
        why = None
        if case.contact.nominal_friction == 0.0:
            why = "contact.friction is 0"
        elif case.motion is None and isinstance(analysis, Transient):
            why = "without [motion] the bodies do not slide"
        if why is not None:
            yield "contact.friction_history", f"has no effect: {why}"


def _force_history(case: Case, history: History) -> Iterator[Fault]:
    """Only the force may vary in a transient analysis, without other normal loads."""
    others = ("approach", *chain.from_iterable(TANGENTIAL))
    refused = [key for key in others if getattr(history, key) is not None]
    for key in refused:
        yield (
            f"load.history.{key}",
            "requires a fretting analysis; a transient one supports force only",
        )
    if history.force is None and not refused:
        yield "load.history.force", "missing; required in a transient analysis"
    if history.cycle_start is not None:
        yield (
            "load.history.cycle_start",
            "requires a fretting analysis; use repeat = true in a transient one",
        )
    constant = [key for key in _UNVARIED if getattr(case.load, key)]
    for key in constant:
        yield f"load.{key}", "cannot be combined with load.history, which varies the force only"
    if not case.holder.free and not constant:
        yield "load.history", "has no effect: the holder is fixed (holder.free = [])"


def cycles(case: AnyCase) -> Iterator[Fault]:
    """The number of cycles is given once; `max_jump` limits automatic jumps only."""
    analysis, wear = case.analysis, case.wear
    if wear.cycles is not None and getattr(analysis, "cycles", None) is not None:
        yield "wear.cycles", "only one of wear.cycles and analysis.cycles can be given"
    ends = isinstance(analysis, Reciprocating) and analysis.end_time is not None
    if wear.cycles is not None and ends:
        yield "wear.cycles", "only one of analysis.end_time and wear.cycles can be given"
    if isinstance(analysis, Fretting) and analysis.jump != "auto" and wear.max_jump is not None:
        yield "wear.max_jump", 'requires analysis.jump = "auto"'


def fretting(case: Case) -> Iterator[Fault]:
    """Load history of a fretting analysis, and features that it does not support."""
    analysis = case.analysis
    if not isinstance(analysis, Fretting):
        return
    history = None if case.load.history is None else case.load.history.loads
    if history is None:
        yield "load.history", "missing; required in a fretting analysis"
    elif history.tangential and case.model == "axisymmetric":
        yield "load.history", "tangential loads are not supported in axisymmetric models"
    elif history.tangential and case.geometry.symmetry and case.model != "3d":
        yield "geometry.half", "tangential loads are not symmetric; mesh the whole section"
    else:
        yield from cycles_of_loads(case, analysis, "load.history")
    if history is not None and case.model == "3d":
        planes = bool(case.geometry.symmetry), bool(case.geometry.rollers)
        for key, text in not_symmetric(history, *planes):
            yield f"load.history.{key}", text
    elif history is not None:
        for key in history.in_space:
            yield f"load.history.{key}", "requires a 3d model"


def not_symmetric(history: LoadHistory, x: bool, y: bool) -> Iterator[Fault]:
    """Tangential loads in space that planes of symmetry x or y = const do not permit, by key."""
    for number, pair in enumerate(TANGENTIAL):
        for plane, cut, refused in (("x", x, (0, 2)), ("y", y, (1, 2))):
            if cut and number in refused:
                for key in pair:
                    if getattr(history, key) is not None:
                        yield key, f"is not symmetric about the plane {plane} = const of the model"


def cycles_of_loads(case: AnyCase, analysis: Fretting, path: str) -> Iterator[Fault]:
    """Cycles need a closed load cycle; output times lie within the history and its repetitions.

    Parameters
    ----------
    case : AnyCase
    analysis : Fretting
        Its analysis.
    path : str
        Path of the tables of the histories.
    """
    loads, count = case.load_histories, int(case.cycles or 1)
    start, end = loads.time[0], loads.end(count)
    if loads.cycle is None and count > 1:
        yield (
            "analysis.cycles" if case.wear.cycles is None else "wear.cycles",
            f"no earlier instant of {path} has the loads of its last one: no cycle to repeat",
        )
    late = [t for t in analysis.output_times if not start <= t <= end]
    if late:
        where = f"{path}.time" if count == 1 else "the cycles"
        limits = f"from {start:g} s to {end:g} s"
        yield "analysis.output_times", f"{late[0]:g} s lies outside {where}, {limits}"


def reciprocating(case: Case) -> Iterator[Fault]:
    """Reciprocating sliding is along x, and has an end."""
    analysis, motion, count = case.analysis, case.motion, case.cycles
    if not isinstance(analysis, Reciprocating):
        return
    if case.model == "axisymmetric" or case.geometry.rotation_center or case.geometry.slides_across:
        yield "model", "a reciprocating analysis needs a plane or 3d model with sliding along x"
    elif case.geometry.symmetry:
        key = "symmetry" if case.model == "3d" else "half"
        yield f"geometry.{key}", "reciprocating sliding is not symmetric; mesh the whole section"
    if "x" in case.holder.free:
        yield "holder.free", '"x" is not allowed: the motion of body 1 along x is prescribed'
    if analysis.until == "steady" and case.holder.free != ("z",):
        yield (
            "analysis.until",
            'needs holder.free = ["z"]: otherwise wear rates do not become uniform',
        )
    for key, text in {
        "amplitude": "missing; a reciprocating analysis needs it",
        "frequency": "missing; a reciprocating analysis needs it",
        "velocity": "not supported; a reciprocating motion has amplitude and frequency",
        "angular_velocity": "not supported; a reciprocating motion has amplitude and frequency",
        "axis": "not supported; a reciprocating motion is along x",
    }.items():
        if motion is not None and (getattr(motion, key) is None) == text.startswith("missing"):
            yield f"motion.{key}", text
    if motion is not None and motion.frequency is not None and count is not None:
        end = count / motion.frequency
        late = [t for t in analysis.output_times if t > end]
        if late:
            yield "analysis.output_times", f"{late[0]:g} s lies after the last cycle, {end:g} s"
    if count is None and analysis.end_time is None and analysis.until is None:
        yield "analysis.end_time", 'missing; needs end_time, cycles or until = "steady"'
