"""Parts of a system that cost much, kept for the cases that come after."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from ...case.tables.schema import Case
from .wear_shares import closes_by_wear, softness_of_parts

Part = TypeVar("Part")

_EXCHANGE = ("conductance", "gap_conductance", "partition")
"""Keys of heat that say how it crosses the interface; the bodies conduct without knowing them."""


class SetupCache:
    """The last part of each kind, with what it was made from.

    A case that would make it from the same gets the very same part.
    """

    def __init__(self) -> None:
        self._kept: dict[str, tuple[Any, Any]] = {}

    def get(self, kind: str, inputs: Any, make: Callable[[], Part]) -> Part:
        """The part of a kind that is made from some inputs, made now unless it is at hand."""
        made_from, part = self._kept.get(kind, (None, None))
        if made_from is None or made_from != inputs:
            self._kept.pop(kind, None)  # its memory may be needed
            part = make()
            self._kept[kind] = (inputs, part)
        return part


@dataclass(frozen=True)
class CacheKeys:
    """What the parts of a system are made from; loads, friction and wear are in none of it.

    Attributes
    ----------
    mesh : tuple
        Of the meshed bodies.
    points : tuple
        Of their contact points.
    elasticity : tuple
        Of the elastic factor and of the condensed bodies.
    conduction : tuple
        Of the conducting factor, its condensation and the distortion.
    """

    mesh: tuple
    points: tuple
    elasticity: tuple
    conduction: tuple

    @property
    def zone(self) -> tuple[float, float] | None:
        """Range of x that the bodies are meshed for."""
        return self.mesh[-1]


def inputs(case: Case, zone: tuple[float, float] | None = None) -> CacheKeys:
    """What the parts of a case are made from, meshed for a zone (by default the expected one)."""
    if zone is None:
        zone = case.geometry.expected_zone(case.pressing())
    mesh = (case.model, case.geometry, case.mesh, case.contact.pressure_degree, zone)
    materials = {part: case.material(part).model_dump() for part in case.geometry.parts}
    hot = case.heat is not None
    elastic = (
        "young_modulus",
        "poisson_ratio",
        *(("expansion", "expansion_factor") if hot else ()),
    )
    points = (mesh, softness_of_parts(case), closes_by_wear(case))
    elasticity = (points, hot, _chosen(materials, lambda key: key in elastic))
    if case.heat is None:
        return CacheKeys(mesh, points, elasticity, ())
    bodies = _chosen(materials, lambda key: key not in ("hardness", *elastic))
    heat = {key: value for key, value in case.heat.model_dump().items() if key not in _EXCHANGE}
    carried = case.motion if heat.get("advection") == "resolved" else None
    return CacheKeys(mesh, points, elasticity, (elasticity, bodies, heat, carried))


def _chosen(tables: dict[str, dict], chooses: Callable[[str], bool]) -> dict[str, dict]:
    """Tables with some of their keys."""
    return {
        name: {key: value for key, value in table.items() if chooses(key)}
        for name, table in tables.items()
    }
