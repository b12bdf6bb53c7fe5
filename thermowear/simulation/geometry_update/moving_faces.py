"""Motion of the faces worn in place: smoothed wear, the part that nodes can follow, their paths."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...bulk.mesh_motion import serial_extension
from ...contact.operators.pressure import jumps, unresolved_gap
from ...contact.search.face import Surface
from ...contact.search.pairing import Pairing
from ...contact.search.projection import ray_intersections
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
from ...laws.distribution import InPlace
from ...parallel import on_root
from ..interface.interface_problem import InterfaceProblem
from ..interface.sdirk import InterfaceState
from ..results.recording import snapshot_at
from ..system.system import System
from ..system.worn_geometry import WornGeometry, along

STEPPED = (
    "wear: both faces wear in place, and materials side by side share it in different ratios; no "
    "mesh follows the step between them, so that all wear remains in the gap (small wear)"
)
"""Note if `steps_grow`."""
_WALL_SLOPE = 0.2
"""Largest slope of groove walls in a mesh."""


class MovingFaces:
    """Faces of the bodies worn in place, and the part of the wear that their nodes can follow.

    Parameters
    ----------
    system : System
        System with contact faces of a section or of a solid.
    """

    def __init__(self, system: System):
        self._system = system
        self.bodies = [i for i, spread in system.spreads.items() if isinstance(spread, InPlace)]

    @cached_property
    def geometry(self) -> WornGeometry:
        """Worn geometry of the present meshes; every rank calls."""
        return self._system.worn or _unworn(self._system, self.bodies)

    @cached_property
    def faces(self) -> dict[int, WornFace]:
        """Moving faces by index of the body."""
        pairs = zip(self.geometry.directions, self.geometry.held, strict=True)
        paths = [Paths(directions, held) for directions, held in pairs]
        pairing = self._system.pairing
        if self._system.worn is None:
            pairing = _along_directions(pairing, self.geometry.directions, self.bodies)[0]
        return {index: WornFace(pairing, index, paths[index]) for index in self.bodies}

    def movable(self, depth: np.ndarray) -> np.ndarray:
        """Part of a depth (2, n) that nodal displacements of the faces represent [m]."""
        result, followed = np.zeros_like(depth), self.followed(depth)
        for index, face in self.faces.items():
            result[index] = face.depths(face.offsets(followed[index]))
        return result

    def followed(self, depth: np.ndarray) -> np.ndarray:
        """Part of a depth (2, n) that the faces should follow [m].

        All of it except at the walls of a groove: where a face continues beside the contact its end
        is held, and the slope from there is limited to `_WALL_SLOPE` for the cells to follow.
        """
        result = np.zeros_like(depth)
        for index in self.bodies:
            room = _WALL_SLOPE * self._from_held_end(index) - self._system.moved[index]
            result[index] = np.minimum(depth[index], room)
        return result

    def _from_held_end(self, index: int) -> np.ndarray:
        """Distances of the points from the held ends of the face, shape (n,) [m]."""
        side, held = self._system.pairing.sides[index], self.geometry.held[index]
        if isinstance(side.face, Surface):
            stays = cKDTree(nodes_of(side.face)[held])  # infinite distance if no node is held
            return stays.query(side.face.points(side.facet, side.t))[0]
        before = side.position
        distances = before, side.face.sizes.sum() - before
        ends = zip(held[[0, -1]], distances, strict=True)
        return np.minimum(*(np.where(stays, distance, np.inf) for stays, distance in ends))


def steps_grow(system: System) -> bool:
    """True if wear makes a step in the common face, which no mesh can follow.

    Where both faces wear in place, and one of them by different laws side by side, they share the
    steady wear in different ratios.
    """
    in_place = [isinstance(spread, InPlace) for spread in system.spreads.values()]
    return jumps(system.pairing) and sum(in_place) > 1


def _unworn(system: System, bodies: list[int]) -> WornGeometry:
    """Geometry before its first update."""
    pairing, comm = system.pairing, system.comm
    mesh, paths = on_root(comm, lambda: _node_paths(system))
    directions = tuple(path.directions for path in paths)
    zeros = np.zeros(3)
    return WornGeometry(
        mesh=mesh,
        directions=directions,
        held=tuple(path.held for path in paths),
        sizes=tuple(side.face.sizes for side in pairing.sides),
        best=np.array(
            [quality(block_of(mesh, *body.parts), body.parts) for body in system.model.bodies]
        ),
        at=along(pairing),
        depth=np.zeros((2, len(pairing.weights))),
        missing_shape=pairing.gap - _along_directions(pairing, directions, bodies)[1],
        holder=(zeros, zeros),
        lost=np.zeros(2),
        updates=0,
        quality=worst_cell(mesh),
        volume_error=0.0,
        pieces=pairing.pieces if isinstance(pairing.sides[0].face, Surface) else None,
    )


def gap_of_initial_shape(pairing: Pairing) -> np.ndarray:
    """Gap of the initial shape minus that of the meshed faces, shape (n,) [m]."""
    first, second = pairing.sides
    return pairing.gap - np.einsum("ni,ni->n", pairing.normals, second.points - first.points)


def _along_directions(
    pairing: Pairing, directions: tuple[np.ndarray, ...], bodies: list[int]
) -> tuple[Pairing, np.ndarray]:
    """Pairing with points on body 2 projected along the node directions of the wearing bodies.

    Returns
    -------
    pairing : Pairing
    gap : ndarray, shape (n,)
        Gap between the paired points along the normals [m].
    """
    first, second = pairing.sides
    recession = np.isin([0, 1], bodies or [0, 1]).astype(float)
    toward = directions_between(pairing.sides, directions, recession)
    facet, t, distance = ray_intersections(
        second.face, first.face.points(first.facet, first.t), toward
    )
    gap = distance * np.einsum("ni,ni->n", pairing.normals, toward)
    return replace(pairing, sides=(first, replace(second, facet=facet, t=t))), gap


def worst_cell(mesh: AnyMesh) -> float:
    """Smallest scaled Jacobian of the cells of a mesh."""
    return min(float(scaled_jacobians(block).min()) for block in mesh.blocks)


def _node_paths(system: System) -> tuple[AnyMesh, list[Paths]]:
    """Unworn mesh, and the paths of the nodes of its faces."""
    mesh = system.model.meshes.mesh(system.zone)
    paths = []
    for index, side in enumerate(system.pairing.sides):
        body = movable_body(system, mesh, index)
        paths.append(Paths(*body.motion_paths(node_normals(side.face))))
    return mesh, paths


def movable_body(system: System, mesh: AnyMesh, index: int) -> MovableBody | MovableSolid:
    """Movable body of the mesh of a system, by its index, in its block of the mesh."""
    face, body = system.pairing.sides[index].face, system.model.bodies[index]
    block = block_of(mesh, *body.parts)
    if isinstance(face, Surface):
        return MovableSolid(block, body.parts, nodes_of(face), serial_extension)
    return MovableBody(block, body.parts, nodes_of(face))


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
    in_place = np.array([isinstance(s, InPlace) for s in system.spreads.values()])
    ours = np.where(in_place[:, None], state.worn, 0.0)
    whole = ours.sum(axis=0)
    shares = np.divide(ours, whole, out=np.zeros_like(ours), where=whole > 0.0)
    found = state.worn - shares * excess
    return found if np.all(found >= 0.0) else state.worn


def thickness_behind(system: System, pairing: Pairing, index: int) -> float:
    """Thickness of a body behind the middle of a contact face [m]; every rank calls."""
    bodies = system.bodies
    out = (pairing.weights @ pairing.normals) * (1 if index == 0 else -1)
    out = out / np.linalg.norm(out)
    middle = np.average(pairing.points, axis=0, weights=pairing.weights)
    mesh = bodies.each[pairing.sides[index].face.body].mesh
    nodes = mesh.geometry.x[:, : len(middle)]
    return max(system.comm.allgather(float(((middle - nodes) @ out).max(initial=0.0))))
