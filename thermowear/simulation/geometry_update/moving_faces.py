"""Motion of the faces worn in place: smoothed wear, the part that nodes can follow, their paths."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...bulk.mesh_motion import serial_extension
from ...contact.faces.face import Surface
from ...contact.faces.projection import ray_intersections
from ...contact.operators.pressure import jumps, unresolved_gap
from ...contact.search.pairing import Pairing
from ...contact.wear.worn_face import (
    Paths,
    WornFace,
    directions_between,
    node_normals,
    nodes_of,
)
from ...geometry.mesh.mixed import AnyMesh, block_of
from ...geometry.mesh.tagged import quality, scaled_jacobians
from ...geometry.moving.moved import MovableBody
from ...geometry.moving.moved_solid import MovableSolid
from ...model.interface import Interface
from ...model.tie import Tie
from ...parallel import on_root
from ..interface.interface_problem import InterfaceProblem
from ..interface.sdirk import InterfaceState
from ..points.worn_geometry import WornContact, WornGeometry, along
from ..results.recording import snapshot_at
from ..system.system import System

KEPT = (
    "wear.update: at {:.4g} s the meshes would have to follow the wear, but {}; all wear remains "
    "in the gap (small wear)"
)
"""Note on a time and on what keeps the meshes from following."""
STEPPED = (
    "wear: both faces wear in place, and materials side by side share it in different ratios; no "
    "mesh follows the step between them, so that all wear remains in the gap (small wear)"
)
"""Note if `steps_grow`."""
_WALL_SLOPE = 0.2
"""Largest slope of groove walls in a mesh."""
FaceKey = tuple[int, int]
"""Index of an interface, and side of one of its faces."""


class MovingFaces:
    """Faces of the bodies worn in place, and the part of the wear that their nodes can follow.

    Parameters
    ----------
    system : System
        System with contact faces of sections or of solids.

    Attributes
    ----------
    rows : dict of FaceKey to (int, slice)
        Side and range of the contact points of each face: its place in arrays (2, n).
    """

    def __init__(self, system: System):
        self._system = system
        ranges = system.contacts.ranges
        self.rows = {(index, side): (side, ranges[index]) for index, side in in_place(system)}

    @cached_property
    def geometry(self) -> WornGeometry:
        """Worn geometry of the present meshes; every rank calls."""
        return self._system.worn or _unworn(self._system, list(self.rows))

    @cached_property
    def faces(self) -> dict[FaceKey, WornFace]:
        """Moving faces."""
        return {key: self._face(*key) for key in self.rows}

    def _face(self, index: int, side: int) -> WornFace:
        worn, pairing = self.geometry.contacts[index], self._system.contacts.each[index]
        if not worn.is_moved:
            pairing = _along_directions(pairing, worn.directions, _sides_of(index, self.rows))[0]
        return WornFace(pairing, side, Paths(worn.directions[side], worn.held[side]))

    def movable(self, depth: np.ndarray) -> np.ndarray:
        """Part of a depth (2, n) that nodal displacements of the faces represent [m]."""
        result, followed = np.zeros_like(depth), self.followed(depth)
        for key, face in self.faces.items():
            own = self.rows[key]
            result[own] = face.depths(face.offsets(followed[own]))
        return result

    def followed(self, depth: np.ndarray) -> np.ndarray:
        """Part of a depth (2, n) that the faces should follow [m].

        All of it except at the walls of a groove: where a face continues beside the contact its end
        is held, and the slope from there is limited to `_WALL_SLOPE` for the cells to follow.
        """
        result = np.zeros_like(depth)
        for key, own in self.rows.items():
            room = _WALL_SLOPE * self._from_held_end(*key) - self._system.moved[own]
            result[own] = np.minimum(depth[own], room)
        return result

    def _from_held_end(self, index: int, side: int) -> np.ndarray:
        """Distances of the points from the held ends of a face, shape (n_own,) [m]."""
        held = self.geometry.contacts[index].held[side]
        paired = self._system.contacts.each[index].sides[side]
        if isinstance(paired.face, Surface):
            stays = cKDTree(nodes_of(paired.face)[held])  # infinite distance if no node is held
            return stays.query(paired.face.points(paired.facet, paired.t))[0]
        before = paired.position
        distances = before, paired.face.sizes.sum() - before
        ends = zip(held[[0, -1]], distances, strict=True)
        return np.minimum(*(np.where(stays, distance, np.inf) for stays, distance in ends))

    @cached_property
    def obstacle(self) -> str | None:
        """Face that a moving one would take along; None if there is none. Every rank calls."""
        if all(len(names) == 1 for names in _faces_of_bodies(self._system).values()):
            return None
        geometry = self.geometry
        return on_root(self._system.comm, lambda: _bent_face(self._system, geometry, self.rows))


def in_place(system: System) -> list[FaceKey]:
    """Faces that wear in place."""
    each = enumerate(system.model.interfaces)
    return [(k, side) for k, one in each for side in sorted(one.wear) if one.wear[side].in_place]


def _sides_of(index: int, keys: Iterable[FaceKey]) -> list[int]:
    """Sides of an interface among some faces."""
    return [side for k, side in keys if k == index]


def steps_grow(system: System) -> bool:
    """True if wear makes a step in a common face, which no mesh can follow.

    Where both faces wear in place, and one of them by different laws side by side, they share the
    steady wear in different ratios.
    """
    worn, each = in_place(system), enumerate(system.contacts.each)
    return any(jumps(pairing) and len(_sides_of(k, worn)) > 1 for k, pairing in each)


def _faces_of_bodies(system: System) -> dict[int, list[str]]:
    """Names of the contact faces and of the glued faces of each body."""
    found: dict[int, list[str]] = {}
    joints: list[Interface | Tie] = [*system.model.interfaces, *system.model.ties]
    for joint in joints:
        for body, face in zip(joint.bodies, joint.faces, strict=True):
            found.setdefault(body, []).append(face)
    return found


def _bent_face(system: System, geometry: WornGeometry, keys: Iterable[FaceKey]) -> str | None:
    """Moving face and the one that it would take along, as it ends there; for messages."""
    names = _faces_of_bodies(system)
    for index, side in keys:
        interface, worn = system.model.interfaces[index], geometry.contacts[index]
        body, own = interface.bodies[side], interface.faces[side]
        inwards = -worn.directions[side] * ~worn.held[side][:, None]
        moved = movable_body(system, geometry.mesh, (index, side)).outlined(inwards).any(axis=1)
        block = block_of(geometry.mesh, *parts_behind(system, (index, side)))
        for other in names[body]:
            if other != own and moved[block.facets_of(other)].any():
                return f"the worn face {own} ends at the face {other}, which it would take along"
    return None


def _unworn(system: System, keys: list[FaceKey]) -> WornGeometry:
    """Geometry before its first update."""
    mesh, paths = on_root(system.comm, lambda: node_paths(system))
    zeros = np.zeros(3)
    contacts = []
    for index, (pairing, own) in enumerate(zip(system.contacts.each, paths, strict=True)):
        directions = tuple(path.directions for path in own)
        drawn = _along_directions(pairing, directions, _sides_of(index, keys))[1]
        contacts.append(
            WornContact(
                directions=directions,
                held=tuple(path.held for path in own),
                sizes=tuple(side.face.sizes for side in pairing.sides),
                at=along(pairing),
                depth=np.zeros((2, len(pairing.weights))),
                missing_shape=pairing.gap - drawn,
                lost=np.zeros(2),
                pieces=pairing.pieces if system.contacts.in_space else None,
                carrier=pairing.carrier,
            )
        )
    return WornGeometry(
        mesh=mesh,
        contacts=tuple(contacts),
        motions=((zeros, zeros),) * len(system.model.bodies),
        best=np.array(
            [quality(block_of(mesh, *body.parts), body.parts) for body in system.model.bodies]
        ),
        updates=0,
        quality=worst_cell(mesh),
        volume_error=0.0,
    )


def gap_of_initial_shape(pairing: Pairing) -> np.ndarray:
    """Gap of the initial shape minus that of the meshed faces, shape (n,) [m]."""
    first, second = pairing.sides
    return pairing.gap - np.einsum("ni,ni->n", pairing.normals, second.points - first.points)


def _along_directions(
    pairing: Pairing, directions: tuple[np.ndarray, ...], sides: list[int]
) -> tuple[Pairing, np.ndarray]:
    """Pairing with points projected from the carrying face along the directions of wearing nodes.

    Returns
    -------
    pairing : Pairing
    gap : ndarray, shape (n,)
        Gap between the paired points along the normals [m].
    """
    if pairing.carrier:
        given = directions[::-1], [1 - side for side in sides]
        found, gap = _along_directions(pairing.exchanged, *given)
        return found.exchanged, gap
    first, second = pairing.sides
    recession = np.isin([0, 1], sides or [0, 1]).astype(float)
    toward = directions_between(pairing.sides, directions, recession)
    facet, t, distance = ray_intersections(
        second.face, first.face.points(first.facet, first.t), toward
    )
    gap = distance * np.einsum("ni,ni->n", pairing.normals, toward)
    return replace(pairing, sides=(first, replace(second, facet=facet, t=t))), gap


def worst_cell(mesh: AnyMesh) -> float:
    """Smallest scaled Jacobian of the cells of a mesh."""
    return min(float(scaled_jacobians(block).min()) for block in mesh.blocks)


def node_paths(system: System) -> tuple[AnyMesh, list[list[Paths]]]:
    """Unworn mesh, and the paths of the nodes of both faces of each interface."""
    mesh = system.model.meshes.mesh(system.zone)
    return mesh, [
        [
            Paths(*movable_body(system, mesh, (index, k)).motion_paths(node_normals(side.face)))
            for k, side in enumerate(pairing.sides)
        ]
        for index, pairing in enumerate(system.contacts.each)
    ]


def movable_body(system: System, mesh: AnyMesh, key: FaceKey) -> MovableBody | MovableSolid:
    """Movable body of the mesh of a system behind one of its faces, in its block of the mesh."""
    index, side = key
    face, parts = system.contacts.each[index].sides[side].face, parts_behind(system, key)
    block = block_of(mesh, *parts)
    if isinstance(face, Surface):
        return MovableSolid(block, parts, nodes_of(face), serial_extension)
    return MovableBody(block, parts, nodes_of(face))


def parts_behind(system: System, key: FaceKey) -> tuple[str, ...]:
    """Parts of the body behind a face."""
    index, side = key
    return system.model.bodies[system.contacts.bodies[index][side]].parts


def smoothed_wear(problem: InterfaceProblem, state: InterfaceState, time: float) -> np.ndarray:
    """Worn depths with pointwise conforming faces where they press. Every rank calls.

    The gap is changed only orthogonally to the pressure space: pressure, forces and volumes stay.
    The change is shared by the bodies worn in place, in proportion to their depths.

    Returns
    -------
    ndarray, shape (n_wearing, n)
        [m]; those of the state if any of them became negative otherwise.
    """
    system, gap = problem.system, snapshot_at(problem, state, time).interface.gap
    weak = state.pressure > 0
    if state.pointwise is not None:
        weak &= ~state.pointwise  # there faces conform already, and the gap is resolved
    excess = unresolved_gap(gap, weak, system.contacts, system.basis)
    moving = np.zeros((2, len(excess)), dtype=bool)
    for index, side in in_place(system):
        moving[side, system.contacts.ranges[index]] = True
    ours = np.where(moving[list(system.laws)], state.worn, 0.0)
    whole = ours.sum(axis=0)
    shares = np.divide(ours, whole, out=np.zeros_like(ours), where=whole > 0.0)
    found = state.worn - shares * excess
    return found if np.all(found >= 0.0) else state.worn
