"""Consistency checks of cyclic analyses of several bodies."""

from __future__ import annotations

from collections.abc import Iterator

from ..assembly.schema import AssemblyCase
from ..assembly.tables import AssemblyHolderTable
from ..tables.analyses import Fretting, Reciprocating
from ..values.section import Fault
from .analyses import cycles, cycles_of_loads, not_symmetric

_CONFLICTS = {
    "force": ("force", "approach"),
    "approach": ("force", "approach"),
    "tangential_force": ("tangential_force",),
    "tangential_displacement": ("tangential_force",),
    "moment": ("moments",),
}
"""Constant loads that a load of a history takes the place of."""
NO_DIRECTION = (
    "is not supported in a fretting analysis in space: its friction resists slip in any direction"
)
"""Refusal of a coefficient across the direction of sliding."""


def unsupported(case: AssemblyCase) -> Iterator[Fault]:
    """Features without a meaning for faces that move back and forth."""
    if not case.analysis.cyclic:
        return
    refused = f"is not supported in a {case.analysis.type} analysis"
    if case.load.pressure:
        yield "load.pressure", refused
    for path, contact in case.contact_tables.items():
        for key in ("friction_history", "fluid_pressure"):
            if getattr(contact, key) is not None:
                yield f"{path}.{key}", refused
        in_space = case.model == "3d" and isinstance(case.analysis, Fretting)
        if in_space and contact.transverse_friction > 0:
            yield f"{path}.transverse_friction", NO_DIRECTION
    for name, holder in case.holders.items():
        if holder.reaction is not None:
            yield f"holders.{name}.reaction", refused
    for name, wear in case.wear.items():
        if wear.spread != "in-place":
            yield f"wear.{name}.spread", refused


def fretting(case: AssemblyCase) -> Iterator[Fault]:
    """Load histories of the holders, with a cycle common to all."""
    analysis = case.analysis
    if not isinstance(analysis, Fretting):
        return
    for name in case.motions:
        yield f"motions.{name}", "is not supported in a fretting analysis; use holders.NAME.history"
    yield from cycles(case)
    if not case.load_histories.each:
        yield "holders", "needs a history in one of them: [holders.NAME.history]"
        return
    for name, holder in case.holders.items():
        for key, text in _history(case, holder):
            yield f"holders.{name}.{key}", text
    yield from cycles_of_loads(case, analysis, "holders.NAME.history")


def _history(case: AssemblyCase, holder: AssemblyHolderTable) -> Iterator[Fault]:
    """Faults of the history of a holder, by key in its table."""
    history = holder.history
    if history is None:
        return
    if history.repeat:
        yield "history.repeat", "requires a transient analysis; use analysis.cycles"
    for i, force in enumerate(history.force or ()):
        if force == 0.0:
            yield f"history.force.{i}", "must be greater than 0 N in a fretting analysis"
    for key, constant in _CONFLICTS.items():
        given = getattr(history, key) is not None
        for other in constant if given else ():
            if getattr(holder, other) is not None:
                yield other, f"cannot be given together with history.{key}"
    for key, motion in (("force", "z"), ("approach", "z"), ("moment", "rotation")):
        if getattr(history, key) is not None and motion not in holder.free:
            yield f"history.{key}", f"needs the motion {motion!r} in free"
    if not history.loads.tangential:
        return
    bodies = [case.bodies[case.geometry.body_of(surface)] for surface in holder.surface]
    x, y = (any(getattr(body, key) for body in bodies) for key in ("symmetry", "rollers"))
    if case.model == "axisymmetric":
        yield "history", "tangential loads are not supported in axisymmetric models"
    elif case.model == "3d":
        for key, text in not_symmetric(history.loads, x, y):
            yield f"history.{key}", text
    elif x:
        yield "history", "tangential loads are not symmetric about a plane x = const"
    if case.model != "3d":
        for key in history.loads.in_space:
            yield f"history.{key}", "requires a 3d model"


def reciprocating(case: AssemblyCase) -> Iterator[Fault]:
    """Bodies reciprocate along x with one frequency, and the analysis ends."""
    analysis = case.analysis
    if not isinstance(analysis, Reciprocating):
        return
    refused = "is not supported in a reciprocating analysis"
    if case.model == "axisymmetric":
        yield "model", "a reciprocating analysis needs a plane or 3d model with sliding along x"
    if case.reciprocation is None:
        yield "motions", "needs a body with amplitude and frequency: [motions.NAME]"
        return
    frequency = case.reciprocation[1]
    for name, motion in case.motions.items():
        if motion.amplitude is None:
            key = "velocity" if motion.angular_velocity is None else "angular_velocity"
            yield f"motions.{name}.{key}", f"{refused}; give amplitude and frequency"
        elif motion.frequency != frequency:
            yield f"motions.{name}.frequency", "must be the same for all bodies"
        for key in ("across", "history", "axis"):
            if getattr(motion, key):
                yield f"motions.{name}.{key}", refused
    for name, holder in case.holders.items():
        if holder.history is not None:
            yield f"holders.{name}.history", refused
        if "x" in holder.free:
            yield f"holders.{name}.free", '"x" is not allowed: motions along x are prescribed'
        elif analysis.until == "steady" and set(holder.free) - {"z", "y"}:
            yield (
                "analysis.until",
                f"holders.{name} can rotate: wear rates do not become uniform; give an end_time",
            )
    for name, body in case.bodies.items():
        if body.symmetry:
            yield f"bodies.{name}.symmetry", "reciprocating sliding is not symmetric"
    if not case.wear:
        yield "wear", "missing; a reciprocating analysis needs the wear law of a body"
    yield from cycles(case)
    yield from _end(case, analysis, frequency)


def _end(case: AssemblyCase, analysis: Reciprocating, frequency: float) -> Iterator[Fault]:
    """The analysis has an end, after all output times."""
    if case.cycles is not None:
        end = case.cycles / frequency
        late = [t for t in analysis.output_times if t > end]
        if late:
            yield "analysis.output_times", f"{late[0]:g} s lies after the last cycle, {end:g} s"
    elif analysis.end_time is None and analysis.until is None:
        yield "analysis.end_time", 'missing; needs end_time, cycles or until = "steady"'


def one_way(case: AssemblyCase) -> Iterator[Fault]:
    """Reciprocation and cycles, which need a cyclic analysis."""
    if case.analysis.cyclic:
        return
    for name, motion in case.motions.items():
        if motion.amplitude is not None:
            yield (
                f"motions.{name}.amplitude",
                f"requires a reciprocating analysis, not {case.analysis.type}",
            )
    for key in ("cycles", "max_jump"):
        if getattr(case.wear, key) is not None:
            yield (
                f"wear.{key}",
                f"requires a fretting or reciprocating analysis, not {case.analysis.type}",
            )
