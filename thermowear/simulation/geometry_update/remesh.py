"""Remeshing of worn bodies: criterion, and transfer of the state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np
import scipy

from ...bulk.bodies import distribute
from ...bulk.mesh_motion import serial_extension
from ...contact.faces.face import Face, Renumbering, Surface, gather_faces, renumbering
from ...contact.search.pairing import Contacts, PairedFace, Pairing
from ...contact.wear.worn_face import nodes_of
from ...errors import ComputationError
from ...geometry.mesh.mixed import AnyMesh, block_of, exchanged
from ...geometry.mesh.tagged import TaggedMesh, quality
from ...geometry.moving.moved import nodes_at
from ...geometry.moving.new_face import NewFace
from ...geometry.moving.remeshed import meshed_anew
from ...geometry.moving.remeshed_solid import meshed_inside
from ..points.worn_geometry import WornContact, WornGeometry, along
from ..system.system import System
from .moving_faces import FaceKey, MovingFaces, parts_behind

New = TypeVar("New")
Renewed = dict[FaceKey, NewFace]
"""Redivided faces."""
FLOOR = 0.1
"""Smallest acceptable scaled Jacobian."""
_SOFT = 0.25
"""Scaled Jacobian below which remeshing is tried,"""
_WORSE = 0.75
"""and the same as a fraction of that of the new mesh."""


def improved(
    mesh: TaggedMesh,
    parts: tuple[str, ...],
    best: float,
    meshed: Callable[[], tuple[TaggedMesh, New]],
) -> tuple[TaggedMesh, New | None]:
    """Remesh a body if its cells are distorted and the new ones are better.

    Parameters
    ----------
    mesh : TaggedMesh
        Mesh of the body, with other ones.
    parts : tuple of str
        Names of the body's parts.
    best : float
        Smallest scaled Jacobian of the body's first mesh.
    meshed : callable
        Returns the mesh with the remeshed body, and what else is known of it.

    Raises
    ------
    ComputationError
        If remeshing fails and the old cells are not acceptable.
    """
    worst = quality(mesh, parts)
    if worst >= max(FLOOR, min(_SOFT, _WORSE * best)):
        return mesh, None
    try:
        anew, new = meshed()
    except ComputationError as reason:
        if worst >= FLOOR:
            return mesh, None
        raise ComputationError(f"geometry update: {reason}") from None
    return (anew, new) if quality(anew, parts) > worst else (mesh, None)


def redivided(
    system: System, worn: WornGeometry, mesh: AnyMesh, moving: MovingFaces
) -> tuple[AnyMesh, Renewed]:
    """Mesh with distorted bodies of sections remeshed, and their new faces.

    Bodies with several contact faces are not remeshed, as that would divide the others, too.

    Parameters
    ----------
    system : System
    worn : WornGeometry
        Before the mesh motion.
    mesh : TaggedMesh or MixedMesh
        After it.
    moving : MovingFaces
    """
    renewed: Renewed = {}
    moved, all_faces = mesh, [k for one in system.contacts.bodies for k in one]
    for key in moving.faces:
        index, side = key
        parts, body = parts_behind(system, key), system.contacts.bodies[index][side]
        if all_faces.count(body) > 1:
            continue
        face = system.contacts.each[index].sides[side].face
        before, after, block = (block_of(each, *parts) for each in (worn.mesh, moved, mesh))
        places = after.points[nodes_at(before, parts, nodes_of(face))]
        nodes = nodes_at(block, parts, places)  # remeshing of another body renumbers them
        wanted = worn.contacts[index].sizes[side], system.elastic.kinematics.area_factor
        anew = partial(meshed_anew, block, parts, nodes, *wanted, serial_extension)
        improved_block, new = improved(block, parts, worn.best[body], anew)
        mesh = exchanged(mesh, block, improved_block)
        renewed |= {} if new is None else {key: new}
    return mesh, renewed


def on_new_faces(worn: WornGeometry, system: System, faces: Renewed) -> WornGeometry:
    """Transfer worn-face data to the remeshed faces.

    Offsets of the new faces from the former ones count as depth lost or gained by the mesh, so that
    the gap is preserved.
    """
    contacts, best = list(worn.contacts), worn.best.copy()
    for (index, side), new in faces.items():
        pairing, interface = system.contacts.each[index], system.model.interfaces[index]
        contacts[index] = _on_new_face(contacts[index], pairing, side, new)
        parts = system.model.bodies[interface.bodies[side]].parts
        best[interface.bodies[side]] = quality(block_of(worn.mesh, *parts), parts)
    return replace(
        worn,
        contacts=tuple(contacts),
        best=best,
        meshed_anew=worn.meshed_anew + len(faces),
    )


def _on_new_face(contact: WornContact, pairing: Pairing, index: int, new: NewFace) -> WornContact:
    """Data of an interface one of whose faces, by side, has been remeshed."""
    side, at, depth = pairing.sides[index], contact.at, contact.depth.copy()
    assert isinstance(side.face, Face)
    depth[index] += _behind_former(side, new)
    if index == contact.carrier:
        at = new.at(along(pairing))
    carried = new.carried(contact.directions[index])
    held = np.zeros(len(carried), dtype=bool)
    held[[0, -1]] = contact.held[index][[0, -1]]
    directions = carried / np.linalg.norm(carried, axis=1, keepdims=True)
    return replace(
        contact,
        directions=exchanged_side(contact.directions, index, directions),
        held=exchanged_side(contact.held, index, held),
        sizes=exchanged_side(contact.sizes, index, new.sizes),
        at=at,
        depth=depth,
        renewed=contact.renewed | {index: new},
    )


def exchanged_side(
    pair: tuple[np.ndarray, ...], index: int, new: np.ndarray
) -> tuple[np.ndarray, ...]:
    """Values of both sides with new ones of one of them."""
    return tuple(new if side == index else values for side, values in enumerate(pair))


def carrying_error(worn: WornGeometry, contacts: Contacts) -> float:
    """Round-trip error of depths carried over to new pairings, relative to the largest."""
    each = zip(worn.contacts, contacts.each, strict=True)
    errors = (_carrying_error(one, pairing) for one, pairing in each if one.renewed)
    return max(errors, default=0.0)


def _carrying_error(worn: WornContact, pairing: Pairing) -> float:
    there = worn.carried(worn.depth, pairing)
    back = scipy.interpolate.Akima1DInterpolator(along(pairing), there, axis=-1, method="makima")
    after = np.clip(worn.at, *along(pairing)[[0, -1]])
    return float(np.abs(back(after) - worn.depth).max() / np.abs(worn.depth).max())


def _behind_former(side: PairedFace, new: NewFace) -> np.ndarray:
    """Offset of the curve of a new face behind points of the former face, shape (n,) [m]."""
    assert isinstance(side.face, Face)
    former = replace(side.face, nodes=new.former)
    out = former.normals(side.facet, side.t)
    to = new.on_curve(new.at(side.facet + side.t)) - former.points(side.facet, side.t)
    return -np.einsum("ni,ni->n", to, out)


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
