"""Cache of set-up results (mesh, factors, condensed operators) shared by the cases of a sweep."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from ...case.tables.schema import Case
from .wear_shares import closes_by_wear, softness_of_parts

Part = TypeVar("Part")

_EXCHANGE = ("conductance", "gap_conductance", "partition")
"""Keys of the heat table for the interface alone, no inputs of the conduction in the bodies."""


class SetupCache:
    """Cache of the last part of each kind, with its inputs as key.

    Cases with equal inputs share the same object.
    """

    def __init__(self) -> None:
        self._kept: dict[str, tuple[Any, Any]] = {}

    def get(self, kind: str, inputs: Any, make: Callable[[], Part]) -> Part:
        """Return the cached part of a kind if its inputs are equal; make it otherwise."""
        made_from, part = self._kept.get(kind, (None, None))
        if made_from is None or made_from != inputs:
            self._kept.pop(kind, None)  # frees its memory before the new part is made
            part = make()
            self._kept[kind] = (inputs, part)
        return part


@dataclass(frozen=True)
class CacheKeys:
    """Inputs of the cached parts of a system; independent of loads, friction and wear laws.

    Attributes
    ----------
    mesh : tuple
        Inputs of the meshed bodies.
    points : tuple
        Inputs of the contact points.
    elasticity : tuple
        Inputs of the factorised and the condensed elastic bodies.
    conduction : tuple
        Inputs of the factorised conduction, its condensation and the distortion.
    """

    mesh: tuple
    points: tuple
    elasticity: tuple
    conduction: tuple

    @property
    def zone(self) -> tuple[float, float] | None:
        """Range of x that the bodies are meshed for [m]."""
        return self.mesh[-1]


def inputs(case: Case, zone: tuple[float, float] | None = None) -> CacheKeys:
    """Cache keys of a case meshed for a zone (by default the expected contact zone)."""
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
    """Tables reduced to the chosen keys."""
    return {
        name: {key: value for key, value in table.items() if chooses(key)}
        for name, table in tables.items()
    }
