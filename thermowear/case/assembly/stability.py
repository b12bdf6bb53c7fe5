"""Consistency checks of a stability analysis of several bodies: heat by friction, all constant."""

from __future__ import annotations

from collections.abc import Iterator

from ..values.section import Fault
from .schema import AssemblyCase

_FACTORS = ("conductivity_factor", "expansion_factor")


def check_stability(case: AssemblyCase) -> Iterator[Fault]:
    """Faults of a case with a stability analysis; none of others."""
    if case.analysis.type != "stability":
        return
    if case.heat is None:
        yield "heat", "missing; required in a stability analysis"
    if not case.motions and not case.wear:
        yield "motions", "missing; a stability analysis needs a sliding body: [motions.NAME]"
    if not any(contact.nominal_friction for contact in _sliding(case).values()):
        yield "contacts", "have no friction; friction heat needs friction"
    for path in _histories(case):
        yield path, "requires a transient analysis, not stability"
    for path in _varying(case):
        yield path, "is not constant, which is not supported in a stability analysis"


def _sliding(case: AssemblyCase) -> dict:
    """Contacts that are not glued, by name."""
    return {name: contact for name, contact in case.contacts.items() if not contact.tie}


def _histories(case: AssemblyCase) -> Iterator[str]:
    """Paths of functions of time."""
    tables = {"holders": case.holders, "motions": case.motions}
    for kind, each in tables.items():
        yield from (f"{kind}.{name}.history" for name, one in each.items() if one.history)  # type: ignore[attr-defined]
    for name, contact in _sliding(case).items():
        if contact.friction_history is not None:
            yield f"contacts.{name}.friction_history"
    if case.heat is not None:
        yield from (f"heat.{key}" for key in case.heat.histories)


def _varying(case: AssemblyCase) -> Iterator[str]:
    """Paths of properties that depend on pressure, temperature, speed or wear."""
    for name, contact in _sliding(case).items():
        if contact.friction_factor.depends_on:
            yield f"contacts.{name}.friction_factor"
        if contact.friction_law.variables:
            yield f"contacts.{name}.friction"
    for name, law in case.wear.laws.items():
        if law.factor.depends_on:
            yield f"wear.{name}.factor"
        if law.rate is not None and law.variables & {"T", "depth"}:
            yield f"wear.{name}.rate"
    for name, body in case.bodies.items():
        yield from (f"bodies.{name}.{key}" for key in _FACTORS if getattr(body, key) is not None)
