"""Checks of a model in Python against the meshes of its bodies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..errors import CaseError
from ..geometry.checks.mesh_checks import depth, note_polygons, on_surface
from ..geometry.mesh.mixed import AnyMesh
from ..model.conditions import Heat
from ..model.model import Model


def check(model: Model, known: Sequence[str]) -> None:
    """Reject surfaces and laws that a model cannot have.

    Parameters
    ----------
    model : Model
    known : sequence of str
        Surfaces of the meshes.

    Raises
    ------
    CaseError
        If facets of a surface do not bound its body, or a law depends on
        temperatures that are not computed.
    """
    _surfaces(model, known)
    if model.heat is not None:
        return
    for interface in model.interfaces:
        for law in interface.of_temperature:
            name = f" {interface.name!r}" if interface.name else ""
            raise CaseError(f"Interface{name}: {law} depends on T; the model needs heat=Heat(...)")


def note_flat_facets(model: Model, mesh: AnyMesh) -> None:
    """Note flat facets that stand for curved contact faces."""
    moduli = [m.young_modulus for body in model.bodies for m in body.materials.values()]
    force = max(holder.force or 0.0 for holder in model.holders)
    approach = max(holder.approach or 0.0 for holder in model.holders)
    for interface in model.interfaces:
        radius = max(np.ptp(on_surface(mesh, face), axis=0).max() / 2 for face in interface.faces)
        closed = approach + depth(force, np.pi * radius**2, min(moduli), model.thickness)
        note_polygons(mesh, interface.faces, closed, "Body(curved=[...]) with the tags of {}")


def _surfaces(model: Model, known: Sequence[str]) -> None:
    """Reject surfaces whose facets do not bound their body."""
    heat = model.heat or Heat()
    supports = [n for b in model.bodies for n in (*b.fixed, *b.rollers, *b.mid_plane)]
    loads = [n for h in model.holders for n in h.surface_forces] + [*model.surface_pressures]
    faces = [
        *(n for i in model.interfaces for n in i.faces),
        *(n for t in model.ties for n in t.faces),
    ]
    thermal = *heat.cooling, *heat.temperature, *heat.flux, *heat.power
    for name in (*faces, *supports, *loads, *thermal, *model.symmetry):
        if name not in known:
            body, _, tag = name.rpartition(":")
            raise CaseError(f"Model: facets with the tag {tag} do not bound the body {body!r}")
    for held in model.bodies:
        if held.mid_plane and model.kinematics != "3d":
            raise CaseError(f"Body {held.name!r}: mid_plane requires a mesh in space")
