"""The wear laws of a case."""

from __future__ import annotations

from ...case.tables.schema import Case
from ...laws import WearLaw


def wear_laws(case: Case) -> dict[int, WearLaw]:
    """Wear laws by index of the body (0 is body 1); bodies that do not wear are left out."""
    laws = {}
    for index, name in enumerate(case.geometry.bodies):
        if name in case.wear:
            wear = case.wear[name]
            κ, b, a = wear.coefficient_si(), wear.pressure_exponent, wear.velocity_exponent
            laws[index] = (
                WearLaw.per_friction_stress(κ, case.contact.friction, b, a)
                if wear.per == "friction-stress"
                else WearLaw(κ, b, a)
            )
    return laws
