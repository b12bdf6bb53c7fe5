"""Consistency checks of cases of several bodies: tables, supports, parts of bodies and heat.

Every check yields the path of the key at fault and a message.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...errors import CaseError, note
from ..assembly.checks import check as check_tables
from ..assembly.schema import AssemblyCase
from ..assembly.tables import SUPPORTS
from ..tables.materials import check_pressure
from ..values.section import Fault
from . import cyclic_assembly, materials
from .analyses import varying
from .assembly_histories import histories
from .conditions import heat_in_time, heated_surfaces
from .defaults import note_assembly_defaults
from .layer_wear import layer_wear
from .mesh_sizes import mesh_sizes
from .part_wear import note_default_per, part_wear
from .probes import probes


def check(case: AssemblyCase) -> None:
    """Raise a `CaseError` that lists inconsistencies of a case; note what is left out."""
    check_tables(case)
    faults = [f"{path}: {text}" for look in _CHECKS for path, text in look(case)]
    if faults:
        raise CaseError(*faults)
    for name, pressure in case.load.pressure.items():
        check_pressure(f"load.pressure.{name}", pressure, "", case)
    turns = any(motion.angular_velocity is not None for motion in case.motions.values())
    cut = any(body.symmetry or body.rollers for body in case.bodies.values())
    rubs = any(contact.nominal_friction > 0.0 for contact in case.contacts.values())
    if case.model == "3d" and turns and cut and rubs:
        note(
            "bodies: planes of symmetry cut a sector from rotating bodies; the shear of friction, "
            "which twists the whole ring, is left out (its heat and wear are not)"
        )
    _note_left_out(case)
    _note_default_per(case)
    note_assembly_defaults(case)


def _note_left_out(case: AssemblyCase) -> None:
    """Note contacts of the geometry without a table, whose faces then do not touch."""
    known = {frozenset(table.between or ()) for table in case.contacts.values()}
    for name, faces in case.geometry.contacts.items():
        if frozenset(faces) not in known:
            one, other = faces
            note(
                f"contacts: {name!r}, where {one!r} and {other!r} touch, has no table and is left "
                f"out: its faces can pass through each other; add [contacts.{name}]"
            )


def _note_default_per(case: AssemblyCase) -> None:
    """Note wear laws of friction stress by default, once for each law."""
    for name, law in case.wear.laws.items():
        body = name.partition(".materials.")[0]
        rubbing = [
            contact.nominal_friction
            for contact in case.sliding.values()
            if body in map(case.geometry.body_of, contact.between or ())
        ]
        note_default_per(name, law, max(rubbing, default=0.0))


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
    yield from _unloaded(case)


def _unloaded(case: AssemblyCase) -> Iterator[Fault]:
    """Pressures on supports, which bear them."""
    keys = ("fixed", "symmetry", "rollers", "mid_plane") if case.model == "3d" else ("fixed",)
    for body, table in case.bodies.items():
        for key in keys:
            for surface in case.load.pressure.keys() & set(getattr(table, key)):
                text = f"is one of bodies.{body}.{key}; a pressure on it has no effect"
                yield f"load.pressure.{surface}", text


def _heat(case: AssemblyCase) -> Iterator[Fault]:
    """One condition a surface, and a sink; courses need temperatures in time."""
    if case.heat is None or case.analysis.cyclic:
        return
    faces = {face for contact in case.contacts.values() for face in contact.between or ()}
    yield from heated_surfaces(case.heat, faces, leaves=False)
    yield from heat_in_time(case, case.heat)
    rubs = any(contact.nominal_friction for contact in case.contact_tables.values())
    if not case.heat.driven and not rubs and case.analysis.type != "stability":
        yield "contacts", "have no friction; friction heat needs friction"


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


def _pressure_degrees(case: AssemblyCase) -> Iterator[Fault]:
    """The pressure has at most the degree of the displacement; nodal ones are for sections."""
    for path, contact in case.contact_tables.items():
        own = contact.pressure_degree
        if isinstance(own, int) and own > case.mesh.degree:
            yield (
                f"{path}.pressure_degree",
                f"found {own}; at most mesh.degree = {case.mesh.degree}",
            )
        elif own == "lobatto" and case.model == "3d":
            yield f"{path}.pressure_degree", "not supported in 3d models"


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
    materials.like_alone,
    materials.locking,
    histories,
    varying,
    layer_wear,
    part_wear,
    _pressure_degrees,
    _carried,
    _heat,
    mesh_sizes,
    probes,
    cyclic_assembly.unsupported,
    cyclic_assembly.fretting,
    cyclic_assembly.reciprocating,
    cyclic_assembly.one_way,
)
