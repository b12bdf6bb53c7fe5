"""Consistency checks of variable properties."""

from __future__ import annotations

from collections.abc import Iterator

from ..tables.schema import Case

Fault = tuple[str, str]

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
