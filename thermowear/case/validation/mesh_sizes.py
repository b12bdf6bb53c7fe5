"""Consistency checks of element sizes: of bodies from files and CAD, of rows at contact faces."""

from __future__ import annotations

from collections.abc import Iterator

from ..assembly.schema import AssemblyCase
from ..tables.mesh import FaceMesh, MeshTable
from ..tables.schema import Case
from ..values.section import Fault

_KEYS = ("size", "contact_size")
_OF_ROWS = ("elements", "grading")
"""Keys of meshes that the program makes by rows; the grading also of bodies from CAD."""


def mesh_sizes(case: Case | AssemblyCase) -> Iterator[Fault]:
    """Sizes are those of meshes made by the program of bodies from CAD, finer at the contact."""
    if case.mesh.skin is not None and not case.geometry.has_skin:
        yield (
            "mesh.skin",
            f"the mesh of {case.geometry.name!r} has no rows along its contact faces; remove this "
            "key",
        )
    if case.mesh.skin is not None and any(
        case.mesh.face(b)[1] == 1.0 for b in case.geometry.bodies
    ):
        yield "mesh.skin", "the rows grow by mesh.grading, which must be less than 1"
    tables: dict[str, MeshTable | FaceMesh] = {"mesh": case.mesh}
    tables |= {f"mesh.bodies.{b}": t for b, t in case.mesh.bodies.items()}
    yield from _without_effect(case, tables)
    if not case.geometry.sized:
        for path, table in tables.items():
            for key in _KEYS:
                if getattr(table, key) is not None:
                    yield (
                        f"{path}.{key}",
                        f'requires geometry.type = "cad"; the mesh of {case.geometry.name!r} '
                        "follows mesh.elements or its file",
                    )
        return
    for body in case.geometry.bodies:
        size, contact = case.mesh.sizes(body)
        if size is not None and contact is not None and contact > size:
            own = case.mesh.bodies.get(body)
            path = f"mesh.bodies.{body}" if own and (own.size or own.contact_size) else "mesh"
            yield f"{path}.contact_size", f"{contact:g} m must be at most size {size:g} m"
            return


def _without_effect(
    case: Case | AssemblyCase, tables: dict[str, MeshTable | FaceMesh]
) -> Iterator[Fault]:
    """Element numbers and gradings of meshes that are read, or made from CAD.

    Default values are accepted: they stand in every resolved case.
    """
    geometry = case.geometry
    if not (geometry.from_file or geometry.sized):
        return
    for path, table in tables.items():
        for key in _OF_ROWS[:1] if geometry.sized else _OF_ROWS:
            if getattr(table, key) != type(table).model_fields[key].default:
                own = "set mesh.size and mesh.contact_size" if geometry.sized else "mesh it anew"
                yield (
                    f"{path}.{key}",
                    f"has no effect on geometry.type = {geometry.name!r}; remove this key "
                    f"(for other elements, {own})",
                )
