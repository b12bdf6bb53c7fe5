"""Cache of set-up results (mesh, factors, condensed operators) shared by the cases of a sweep."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from ...model.model import Model, Zone
from ..points.contact_points import groups_of_parts, regions_of, softness_of_parts

Part = TypeVar("Part")


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
    stiffness : tuple
        Inputs of the factorised elastic bodies, which do not depend on thermal expansion.
    elasticity : tuple
        Inputs of the condensed elastic bodies with their expansion.
    conductivity : tuple
        Inputs of the factorised conduction and its condensation.
    conduction : tuple
        Inputs of the distortion by the temperatures of the conduction.
    """

    mesh: tuple
    points: tuple
    stiffness: tuple
    elasticity: tuple
    conductivity: tuple
    conduction: tuple

    def solved_by(self, solver: str, coupled: bool) -> CacheKeys:
        """Keys for a solver of the bodies, with heat exchange coupled without condensation or not.

        Those of condensed bodies with a direct solver are unchanged.
        """
        own = () if solver == "direct" else (solver,)
        exchange = ("coupled",) if coupled else ()
        return replace(
            self,
            stiffness=(*self.stiffness, *own),
            elasticity=(*self.elasticity, *own),
            conductivity=(*self.conductivity, *own, *exchange),
            conduction=(*self.conduction, *own, *exchange),
        )


def inputs(model: Model, zone: Zone | None = None) -> CacheKeys:
    """Cache keys of a model meshed for a zone (by default the expected contact zone)."""
    interfaces, materials, heat = model.interfaces, model.materials, model.heat
    zone = model.expected_zone if zone is None else zone
    section = model.kinematics, model.thickness, model.sector
    supports = model.symmetry, *((b.fixed, b.rollers, b.mid_plane) for b in model.bodies)
    spaces = model.discretisation.degree, [one.pressure_degree for one in interfaces]
    mesh = (section, supports, model.meshes, spaces, [tie.faces for tie in model.ties], zone)
    faces = [
        (
            one.faces,
            one.initial_shape,
            softness_of_parts(model, one),
            bool(one.wearing_in_place),
            groups_of_parts(model, one),
            regions_of(one),
        )
        for one in interfaces
    ]
    points = (mesh, faces)
    strained = {part: (m.young_modulus, m.poisson_ratio) for part, m in materials.items()}
    stiffness = strained, points
    if heat is None:
        return CacheKeys(mesh, points, stiffness, stiffness, (), ())
    expanding = {part: (m.expansion, m.expansion_factor) for part, m in materials.items()}
    elasticity = expanding, *stiffness
    conducting = {
        part: (m.conductivity, m.conductivity_factor, m.density, m.specific_heat)
        for part, m in materials.items()
    }
    motions = [interface.motion for interface in interfaces]
    carried = motions if heat.advection == "resolved" else None
    joints = [tie.conductance for tie in model.ties]
    tables = {part: factor for part, (_, factor) in expanding.items() if factor is not None}
    conductivity = conducting, heat, carried, joints, tables, *stiffness
    return CacheKeys(mesh, points, stiffness, elasticity, conductivity, (expanding, *conductivity))
