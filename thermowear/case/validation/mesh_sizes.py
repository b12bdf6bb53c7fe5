"""Consistency checks of element sizes: of bodies from CAD, and of rows at contact faces."""

from __future__ import annotations

from collections.abc import Iterator

from ..assembly.schema import AssemblyCase
from ..tables.schema import Case
from ..values.section import Fault

_KEYS = ("size", "contact_size")


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
    tables = {"mesh": case.mesh} | {f"mesh.bodies.{b}": t for b, t in case.mesh.bodies.items()}
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
