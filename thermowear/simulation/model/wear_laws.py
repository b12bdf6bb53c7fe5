"""Wear laws of a case."""

from __future__ import annotations

from ...case.tables.schema import Case
from ...case.tables.wear import BodyWearTable
from ...laws import PowerWear
from ...laws.interfaces import WearRate


def wear_laws(case: Case) -> dict[int, WearRate]:
    """Wear laws by index of the body (0 is body 1); bodies that do not wear are left out."""
    bodies = enumerate(case.geometry.bodies)
    friction = case.contact.nominal_friction
    return {
        index: case.wear[name].law or _power(case.wear[name], friction)
        for index, name in bodies
        if name in case.wear
    }


def _power(wear: BodyWearTable, friction: float) -> PowerWear:
    κ, b, a = wear.coefficient_si(), wear.pressure_exponent, wear.velocity_exponent
    if wear.per == "friction-stress":
        return PowerWear.per_friction_stress(κ, friction, b, a)
    return PowerWear(κ, b, a)
