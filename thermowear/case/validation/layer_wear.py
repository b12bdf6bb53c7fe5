"""Consistency checks of layers on a contact face."""

from __future__ import annotations

from collections.abc import Iterator

from ..any_case import AnyCase
from ..tables.contact import InterfaceTable
from ..tables.schema import Case
from ..tables.wear import BodyWearTable
from ..values.section import Fault


def layer_wear(case: AnyCase) -> Iterator[Fault]:
    """Layers cover a face of one material, and their laws have what they depend on."""
    for body, wear in case.wear.items():
        if wear.layers is None:
            continue
        path = f"wear.{body}.layers"
        if wear.materials:
            yield path, "is not supported together with materials; the face must be of one material"
        if case.analysis.cyclic:
            yield path, f"is not supported in a {case.analysis.type} analysis"
        yield from _state(case, path, wear)
        for table, contact in _contacts(case, body):
            yield from _friction(table, contact, path, wear)


def _contacts(case: AnyCase, body: str) -> Iterator[tuple[str, InterfaceTable]]:
    """Contacts that a body slides in, and the paths of their tables."""
    if isinstance(case, Case):
        yield "contact", case.contact
        return
    for name, contact in case.contacts.items():
        if not contact.tie and body in map(case.geometry.body_of, contact.between or ()):
            yield f"contacts.{name}", contact


def _state(case: AnyCase, path: str, wear: BodyWearTable) -> Iterator[Fault]:
    """Temperatures that rates depend on need heat."""
    for layer, law in enumerate(wear.of_layers):
        if law.rate is not None and "T" in law.variables and case.heat is None:
            yield f"{path}.rate.{layer}", "depends on T; requires a [heat] table"


def _friction(
    table: str, contact: InterfaceTable, path: str, wear: BodyWearTable
) -> Iterator[Fault]:
    """Laws per friction stress need friction, and one exponent where it varies."""
    no_friction = contact.nominal_friction == 0.0
    exponents = set()
    for layer, law in enumerate(wear.of_layers):
        by_stress = law.rate is None and law.per == "friction-stress"
        exponents.add(law.pressure_exponent if by_stress else 0.0)
        if no_friction and "mu" in law.variables:
            what = "is per friction stress" if by_stress else "depends on mu"
            yield f"{table}.friction", f"is 0; layer {layer} of {path} {what}"
    of_body = wear.rate is None and wear.per == "friction-stress"
    exponents.add(wear.pressure_exponent if of_body else 0.0)
    varies = contact.friction_variables or contact.friction_history is not None
    if varies and len(exponents) > 1:
        yield (
            path,
            f"requires the same per and pressure_exponent as the body while {table}.friction "
            "varies; write the laws as a rate in mu",
        )
