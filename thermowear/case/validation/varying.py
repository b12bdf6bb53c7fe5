"""Consistency checks of variable properties."""

from __future__ import annotations

from collections.abc import Iterator

from ..tables.schema import Case
from .faults import Fault

_CONSTANT = ("fretting", "reciprocating", "stability")
"""Analyses in which all properties are constant."""
_OF_BODIES = ("conductivity_factor", "expansion_factor")


def varying(case: Case) -> Iterator[Fault]:
    """Analyses that support variable properties; temperature tables need heat."""
    constant = case.analysis.type in _CONSTANT
    tables = {"contact.friction_factor": case.contact.friction_factor}
    tables |= {f"wear.{name}.factor": law.factor for name, law in case.wear.items()}
    for path, table in tables.items():
        if constant and table.depends_on:
            yield path, f"is not supported in a {case.analysis.type} analysis"
        elif table.temperature is not None and case.heat is None:
            yield f"{path}.temperature", "needs a [heat] table, which computes the temperatures"
    for name, body in case.bodies.items():
        for key in _OF_BODIES:
            if constant and getattr(body, key) is not None:
                yield f"bodies.{name}.{key}", f"is not supported in a {case.analysis.type} analysis"
    yield from _laws(case)


def _laws(case: Case) -> Iterator[Fault]:
    """Variables of laws that are not available in an analysis."""
    type_, constant = case.analysis.type, case.analysis.type in _CONSTANT
    friction = case.contact.friction_law.variables
    if constant and friction:
        yield (
            "contact.friction",
            f"depends on {_listed(friction)}; not supported in a {type_} analysis",
        )
    laws = {"contact.friction": friction}
    laws |= {f"wear.{name}.rate": law.variables for name, law in case.wear.items() if law.rate}
    for path, variables in laws.items():
        followed = variables & {"T", "depth"}
        if "T" in variables and case.heat is None:
            yield path, "depends on T; requires a [heat] table"
        elif constant and followed and path != "contact.friction":
            yield path, f"depends on {_listed(followed)}; not supported in a {type_} analysis"
        elif "depth" in variables and "steady" in (type_, getattr(case.analysis, "until", None)):
            yield path, "depends on depth, which grows without end: there is no steady state"


def _listed(variables: frozenset[str]) -> str:
    return ", ".join(sorted(variables))


def condensed_only(case: Case) -> str | None:
    """Feature of a case that requires the condensed method; None if there is none."""
    bodies, hot = case.bodies.values(), case.heat is not None
    if case.analysis.type == "stability":
        return "a stability analysis"
    if case.heat is not None and case.heat.transient:
        return "temperatures in time"
    changes = case.varies or case.contact.friction_history is not None
    if changes and case.analysis.type in ("initial", "transient"):
        return "variable friction, wear or conductance"
    if hot and any(getattr(body, key) is not None for body in bodies for key in _OF_BODIES):
        return "variable conductivity or expansion"
    return None
