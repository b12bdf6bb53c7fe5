"""Consistency checks of a stability analysis of several bodies: heat by friction."""

from __future__ import annotations

from collections.abc import Iterator

from ..values.section import Fault
from .schema import AssemblyCase


def check_stability(case: AssemblyCase) -> Iterator[Fault]:
    """Faults of a case with a stability analysis; none of others."""
    if case.analysis.type != "stability":
        return
    if case.heat is None:
        yield "heat", "missing; required in a stability analysis"
    if not case.motions and not case.wear:
        yield "motions", "missing; a stability analysis needs a sliding body: [motions.NAME]"
    if not any(contact.nominal_friction for contact in case.contact_tables.values()):
        yield "contacts", "have no friction; friction heat needs friction"
