"""The material of a body, or the name of the body whose material it shares."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from . import units
from .section import Number, Section


class Body(Section):
    """Material of a body, or the name of the body whose material it shares."""

    like: str | None = None
    young_modulus: units.Pressure | None = None
    poisson_ratio: Annotated[Number, Field(gt=-1.0, lt=0.5)] | None = None
    conductivity: units.Conductivity | None = None
    expansion: units.Expansion | None = None
    density: units.Density | None = None
    specific_heat: units.SpecificHeat | None = None


def resolve_like(bodies: dict[str, Body], name: str) -> str:
    """Follow ``like`` from body to body.

    Raises
    ------
    ValueError
        If the chain names a body that does not exist, or comes back to itself.
    """
    seen = [name]
    while (other := bodies[seen[-1]].like) is not None:
        if other not in bodies:
            raise ValueError(f"like = {other!r} names no body; one of: {', '.join(bodies)}")
        if other in seen:
            raise ValueError(f"like = {other!r} leads back to itself")
        seen.append(other)
    return seen[-1]
