"""Consistency checks of cases of several bodies: tables, supports, parts of bodies and heat.

Every check yields the path of the key at fault and a message.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...errors import CaseError, note
from ..assembly.checks import check as check_tables
from ..assembly.schema import AssemblyCase
from ..assembly.tables import SUPPORTS
from ..values.section import Fault
from . import cyclic_assembly, materials
from .analyses import varying
from .assembly_histories import histories
from .layer_wear import layer_wear
from .mesh_sizes import mesh_sizes
from .part_wear import part_wear


def check(case: AssemblyCase) -> None:
    """Raise a `CaseError` that lists inconsistencies of a case; note what is left out."""
    check_tables(case)
    faults = [f"{path}: {text}" for look in _CHECKS for path, text in look(case)]
    if faults:
        raise CaseError(*faults)
    turns = any(motion.angular_velocity is not None for motion in case.motions.values())
    cut = any(body.symmetry or body.rollers for body in case.bodies.values())
    rubs = any(contact.nominal_friction > 0.0 for contact in case.contacts.values())
    if case.model == "3d" and turns and cut and rubs:
        note(
            "bodies: planes of symmetry cut a sector from rotating bodies; the shear of friction, "
            "which twists the whole ring, is left out (its heat and wear are not)"
        )


def _supports(case: AssemblyCase) -> Iterator[Fault]:
    """Supports belong to their body, and hold no contact face."""
    faces = {face: name for name, joint in case.contacts.items() for face in joint.between or ()}
    held = [(f"holders.{name}.surface", of.surface) for name, of in case.holders.items()]
    for body, table in case.bodies.items():
        for key in SUPPORTS:
            path = f"bodies.{body}.{key}"
            held.append((path, getattr(table, key)))
            for surface in getattr(table, key):
                owner = case.geometry.body_of(surface)
                if owner != body:
                    yield path, f"{surface!r} is a surface of {owner}"
        if table.mid_plane and case.model != "3d":
            yield f"bodies.{body}.mid_plane", "requires a 3d model"
        if table.symmetry and case.model == "axisymmetric":
            yield f"bodies.{body}.symmetry", "an axisymmetric model has no plane of symmetry"
    held.append(("load.pressure", tuple(case.load.pressure)))
    for path, surfaces in held:
        for surface in surfaces:
            if surface in faces:
                yield path, f"{surface!r} is a face of contacts.{faces[surface]}"


def _sliding(case: AssemblyCase) -> Iterator[Fault]:
    """Sliding along x is not symmetric about a plane x = const."""
    drags = any(contact.nominal_friction > 0.0 for contact in case.contacts.values())
    along = any(of.mean_velocity is not None and not of.across for of in case.motions.values())
    for body, table in case.bodies.items():
        if table.symmetry and drags and along:
            yield (
                f"bodies.{body}.symmetry",
                "sliding friction along x is not symmetric about a plane x = const",
            )


def _carried(case: AssemblyCase) -> Iterator[Fault]:
    """Bodies that carry heat along need their heat capacity."""
    if case.heat is None or case.heat.advection != "resolved":
        return
    for body in case.motions:
        for part in case.geometry.parts_of(body):
            path, material = case.located_material(part)
            for key in ("density", "specific_heat"):
                if getattr(material, key) is None:
                    yield f"{path}.{key}", 'missing; needed because heat.advection is "resolved"'


_CHECKS = (
    _supports,
    _sliding,
    materials.cell_sets,
    materials.locking,
    histories,
    varying,
    layer_wear,
    part_wear,
    _carried,
    mesh_sizes,
    cyclic_assembly.unsupported,
    cyclic_assembly.fretting,
    cyclic_assembly.reciprocating,
    cyclic_assembly.one_way,
)
