"""Wear kept in the gap, relative to the dimensions of the bodies."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...bulk.mesh_motion import serial_extension
from ...compat import geometry_dofmap
from ...contact.search.pairing import Pairing
from ...contact.search.projection import ahead
from ...contact.search.surface import Surface
from ...contact.wear.worn_face import (
    Paths,
    WornFace,
    curvatures,
    lengths,
    node_normals,
    nodes_of,
    ways_between,
)
from ...geometry.mesh.shapes import quality, scaled_jacobians
from ...geometry.mesh.tagged import TaggedMesh
from ...geometry.moving.moved import MovableBody
from ...geometry.moving.moved_solid import MovableSolid
from ...laws.distribution import InPlace
from ...parallel import on_root
from ..model.system import System
from ..model.worn_geometry import WornGeometry, along

_STEEPEST = 0.2
"""Largest slope of groove walls in a mesh."""
_TILT = 0.1
"""Weight of the element tilt: depth difference of its ends relative to its size."""


class GapWear:
    """Wear kept in the gap of a system, and its part that the nodes of the faces can follow.

    Parameters
    ----------
    system : System
        System with contact faces of a section or of a solid.
    """

    def __init__(self, system: System):
        self._system = system
        self.bodies = [i for i, spread in system.spreads.items() if isinstance(spread, InPlace)]
        self._curvature = [_curvature(side.face) for side in system.pairing.sides]
        self._thickness = {index: _thickness(system, index) for index in self.bodies}

    def depth(self, worn: np.ndarray) -> np.ndarray:
        """Depths kept in the gap (2, n) from the total depths of the wearing bodies [m]."""
        both = np.zeros((2, worn.shape[1]))
        both[list(self._system.laws)] = worn
        return both - self._system.moved

    @cached_property
    def geometry(self) -> WornGeometry:
        """Worn geometry of the present meshes; every rank calls."""
        return self._system.worn or _unworn(self._system, self.bodies)

    @cached_property
    def faces(self) -> dict[int, WornFace]:
        """Moving faces by index of the body."""
        ways = zip(self.geometry.directions, self.geometry.held, strict=True)
        paths = [Paths(directions, held) for directions, held in ways]
        pairing = self._system.pairing
        if self._system.worn is None:
            pairing = _along_ways(pairing, self.geometry.directions, self.bodies)[0]
        return {index: WornFace(pairing, index, paths[index]) for index in self.bodies}

    def movable(self, depth: np.ndarray) -> np.ndarray:
        """Part of a depth (2, n) that nodal displacements of the faces represent [m]."""
        result, due = np.zeros_like(depth), self.due(depth)
        for index, face in self.faces.items():
            result[index] = face.depths(face.amounts(due[index]))
        return result

    def due(self, depth: np.ndarray) -> np.ndarray:
        """Part of a depth (2, n) that the faces should follow [m].

        All of it except at the walls of a groove: where a face continues beside the contact its end
        is held, and the slope from there is limited to `_STEEPEST` for the cells to follow.
        """
        result = np.zeros_like(depth)
        for index in self.bodies:
            room = _STEEPEST * self._from_held_end(index) - self._system.moved[index]
            result[index] = np.minimum(depth[index], room)
        return result

    def fraction(self, depth: np.ndarray) -> float:
        """Largest ratio of a depth (2, n) of both bodies to their dimensions.

        Dimensions are the thickness behind the face and the radius of curvature of either face; a
        tenth of the element tilt (depth difference of its ends over its size) counts, too.
        """
        return max((self._of_body(index, depth[index]) for index in self.bodies), default=0.0)

    def _from_held_end(self, index: int) -> np.ndarray:
        """Distances of the points from the held ends of the face, shape (n,) [m]."""
        side, held = self._system.pairing.sides[index], self.geometry.held[index]
        if isinstance(side.face, Surface):
            stays = cKDTree(nodes_of(side.face)[held])  # infinite distance if no node is held
            return stays.query(side.face.points(side.facet, side.t))[0]
        before = side.face.position(side.facet, side.t)
        ways = before, side.face.sizes.sum() - before
        far = [np.where(stays, way, np.inf) for stays, way in zip(held[[0, -1]], ways, strict=True)]
        return np.minimum(*far)

    def _of_body(self, index: int, depth: np.ndarray) -> float:
        side = self._system.pairing.sides[0]
        largest = float(np.abs(depth).max())
        facets, first = np.unique(side.facet, return_index=True)
        low, high = (f.reduceat(depth, first) for f in (np.minimum, np.maximum))
        tilt = float(((high - low) / lengths(side.face)[facets]).max())
        curved = largest * max(self._curvature)
        return max(largest / self._thickness[index], curved, _TILT * tilt)


def _unworn(system: System, bodies: list[int]) -> WornGeometry:
    """Geometry before its first update."""
    pairing, comm = system.pairing, system.comm
    mesh, paths = on_root(comm, lambda: _ways(system))
    directions = tuple(path.directions for path in paths)
    nothing = np.zeros(3)
    return WornGeometry(
        mesh=mesh,
        directions=directions,
        held=tuple(path.held for path in paths),
        sizes=tuple(side.face.sizes for side in pairing.sides),
        best=np.array([quality(mesh, body.parts) for body in system.model.bodies]),
        at=along(pairing),
        depth=np.zeros((2, len(pairing.weights))),
        lacking=pairing.gap - _along_ways(pairing, directions, bodies)[1],
        holder=(nothing, nothing),
        lost=np.zeros(2),
        updates=0,
        quality=float(scaled_jacobians(mesh).min()),
        volume_error=0.0,
        pieces=pairing.pieces if isinstance(pairing.sides[0].face, Surface) else None,
    )


def lacking_in_shape(pairing: Pairing) -> np.ndarray:
    """Gap of the initial shape minus that of the meshed faces, shape (n,) [m]."""
    first, second = pairing.sides
    return pairing.gap - np.einsum("ni,ni->n", pairing.normals, second.points - first.points)


def _along_ways(
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
    gone = np.isin([0, 1], bodies or [0, 1]).astype(float)
    ways = ways_between(pairing.sides, directions, gone)
    facet, t, way = ahead(second.face, first.face.points(first.facet, first.t), ways)
    gap = way * np.einsum("ni,ni->n", pairing.normals, ways)
    return replace(pairing, sides=(first, replace(second, facet=facet, t=t))), gap


def _ways(system: System) -> tuple[TaggedMesh, list[Paths]]:
    """Unworn mesh, and the paths of the nodes of its faces."""
    mesh = system.model.meshes.mesh(system.zone)
    paths = []
    for index, side in enumerate(system.pairing.sides):
        body = movable_body(system, mesh, index)
        paths.append(Paths(*body.ways(node_normals(side.face))))
    return mesh, paths


def movable_body(system: System, mesh: TaggedMesh, index: int) -> MovableBody | MovableSolid:
    """Movable body of the mesh of a system, by its index."""
    face, parts = system.pairing.sides[index].face, system.model.bodies[index].parts
    if isinstance(face, Surface):
        return MovableSolid(mesh, parts, nodes_of(face), serial_extension)
    return MovableBody(mesh, parts, nodes_of(face))


def _curvature(face) -> float:
    """Largest curvature of a face [1/m]."""
    return float(curvatures(face).max())


def _thickness(system: System, index: int) -> float:
    """Thickness of a body behind the middle of its contact face [m]; every rank calls."""
    pairing, bodies = system.pairing, system.bodies
    out = (pairing.weights @ pairing.normals) * (1 if index == 0 else -1)
    out = out / np.linalg.norm(out)
    middle = np.average(pairing.points, axis=0, weights=pairing.weights)
    parts = system.model.bodies[index].parts
    cells = np.concatenate([bodies.cell_tags.find(bodies.body_tag(part)) for part in parts])
    nodes = bodies.mesh.geometry.x[geometry_dofmap(bodies.mesh)[cells].ravel(), : len(middle)]
    return max(system.comm.allgather(float(((middle - nodes) @ out).max(initial=0.0))))
