"""Remeshing of bodies of tetrahedra inside their worn surfaces, which keep their facets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...bulk.bodies import distribute
from ...bulk.mesh_motion import serial_extension
from ...contact.faces.face import Surface, gather_faces
from ...contact.faces.renumbered import Renumbering, renumbering
from ...contact.wear.worn_face import nodes_of
from ...geometry.mesh.mixed import AnyMesh, block_of, exchanged
from ...geometry.mesh.tagged import quality
from ...geometry.moving.moved import nodes_at
from ...geometry.moving.remeshed_solid import meshed_inside
from ..points.worn_geometry import WornContact, WornGeometry
from ..system.system import System
from .moving_faces import FaceKey, MovingFaces
from .remesh import exchanged_side, improved

Kept = dict[FaceKey, np.ndarray]
"""Places of the nodes of the contact faces of remeshed bodies, shape (n_nodes, 3) [m]."""


def refilled(
    system: System, worn: WornGeometry, mesh: AnyMesh, moving: MovingFaces
) -> tuple[AnyMesh, Kept]:
    """Mesh with new interiors of bodies of tetrahedra whose cells are distorted.

    Parameters
    ----------
    system : System
    worn : WornGeometry
        Before the mesh motion.
    mesh : TaggedMesh or MixedMesh
        After it.
    moving : MovingFaces
        Bodies with another contact face, which does not move, are not remeshed.
    """
    kept: Kept = {}
    moved = mesh
    faces = [(k, side) for k in range(len(system.contacts.each)) for side in (0, 1)]
    bodies = {key: system.contacts.bodies[key[0]][key[1]] for key in faces}
    for body in sorted({bodies[key] for key in moving.faces}):
        own = [key for key in faces if bodies[key] == body]
        parts = system.model.bodies[body].parts
        before, after, block = (block_of(each, *parts) for each in (worn.mesh, moved, mesh))
        if block.cell_type != "tetrahedron" or not set(own) <= set(moving.faces):
            continue
        former = {key: system.contacts.each[key[0]].sides[key[1]].face for key in own}
        nodes = {key: nodes_at(before, parts, nodes_of(face)) for key, face in former.items()}

        def filled(block=block, parts=parts):
            return meshed_inside(block, parts, serial_extension), True

        new, done = improved(block, parts, worn.best[body], filled)
        if done:
            mesh = exchanged(mesh, block, new)
            kept |= {key: after.points[at] for key, at in nodes.items()}
    return mesh, kept


def on_kept_faces(worn: WornGeometry, system: System, kept: Kept) -> WornGeometry:
    """Worn-face data in the numbers of the remeshed bodies. Every rank calls."""
    comm, contacts, best = system.comm, list(worn.contacts), worn.best.copy()
    bodies = distribute(worn.mesh if comm.rank == 0 else None, comm)
    for (index, side), places in kept.items():
        pairing, interface = system.contacts.each[index], system.model.interfaces[index]
        new, former = gather_faces(bodies, interface.faces)[side], pairing.sides[side].face
        assert isinstance(new, Surface)
        assert isinstance(former, Surface)
        numbers = renumbering(former, places, new)
        contacts[index] = _renumbered(contacts[index], side, numbers)
        body = interface.bodies[side]
        parts = system.model.bodies[body].parts
        best[body] = max(best[body], quality(block_of(worn.mesh, *parts), parts))
    count = len({system.model.interfaces[index].bodies[side] for index, side in kept})
    return replace(worn, contacts=tuple(contacts), best=best, meshed_anew=worn.meshed_anew + count)


def _renumbered(contact: WornContact, side: int, numbers: Renumbering) -> WornContact:
    """Data of an interface, one of whose faces, by side, has new numbers."""
    at, pieces = contact.at, contact.pieces
    if side == contact.carrier:
        assert pieces is not None
        facet, t = numbers.place(at[:, 0].astype(np.int64), at[:, 1:])
        at = np.column_stack([facet, t])
        facet, t = numbers.place(pieces.facet, pieces.t)
        pieces = replace(pieces, facet=facet, t=t)
    return replace(
        contact,
        directions=exchanged_side(
            contact.directions, side, contact.directions[side][numbers.nodes]
        ),
        held=exchanged_side(contact.held, side, contact.held[side][numbers.nodes]),
        sizes=exchanged_side(contact.sizes, side, numbers.of_facets(contact.sizes[side])),
        at=at,
        pieces=pieces,
    )
