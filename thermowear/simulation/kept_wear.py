"""How much wear is kept in the gap, held against the sizes of the bodies."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..compat import geometry_dofmap
from ..contact.face import Face
from ..contact.worn_face import Paths, WornFace, curvatures, node_normals, nodes_of
from ..geometry.moved import MovableBody
from ..geometry.shapes import scaled_jacobians
from ..geometry.tagged import TaggedMesh
from ..laws.spreading import InPlace
from ..parallel import on_root
from .system import System
from .worn_geometry import WornGeometry, along

_TILT = 0.1
"""A tilt counts for so much: of two ends of an element, against its size."""


class KeptWear:
    """Wear kept in the gap of a system, and what the nodes of its faces can take up of it.

    Parameters
    ----------
    system : System
        Of a section.
    """

    def __init__(self, system: System):
        self._system = system
        self.bodies = [i for i, spread in system.spreads.items() if isinstance(spread, InPlace)]
        self._curvature = [_curvature(side.face) for side in system.pairing.sides]
        self._thickness = {index: _thickness(system, index) for index in self.bodies}

    def depth(self, worn: np.ndarray) -> np.ndarray:
        """Kept depths off both bodies, shape (2, n), from all the wear of those that wear [m]."""
        both = np.zeros((2, worn.shape[1]))
        both[list(self._system.laws)] = worn
        return both - self._system.moved

    @cached_property
    def geometry(self) -> WornGeometry:
        """Where the meshes are; every rank calls."""
        return self._system.worn or _unworn(self._system)

    @cached_property
    def faces(self) -> dict[int, WornFace]:
        """The faces that move, by index of the body."""
        ways = zip(self.geometry.directions, self.geometry.held, strict=True)
        paths = [Paths(directions, held) for directions, held in ways]
        return {index: WornFace(self._system.pairing, index, paths[index]) for index in self.bodies}

    def movable(self, depth: np.ndarray) -> np.ndarray:
        """What the nodes of the faces can take up of a depth (2, n) [m]."""
        result = np.zeros_like(depth)
        for index, face in self.faces.items():
            result[index] = face.depths(face.amounts(depth[index]))
        return result

    def fraction(self, depth: np.ndarray) -> float:
        """The largest of the ratios of a depth (2, n) of both bodies to their sizes.

        To the thickness behind the face, to the radius of curvature of either face, and a tenth of
        the tilt of an element: the difference of the depth at its ends, by its size.
        """
        return max((self._of_body(index, depth[index]) for index in self.bodies), default=0.0)

    def _of_body(self, index: int, depth: np.ndarray) -> float:
        side = self._system.pairing.sides[0]
        largest = float(np.abs(depth).max())
        facets, first = np.unique(side.facet, return_index=True)
        low, high = (f.reduceat(depth, first) for f in (np.minimum, np.maximum))
        tilt = float(((high - low) / side.face.sizes[facets]).max())
        curved = largest * max(self._curvature)
        return max(largest / self._thickness[index], curved, _TILT * tilt)


def _unworn(system: System) -> WornGeometry:
    """The geometry before its first update."""
    pairing, comm = system.pairing, system.comm
    second = pairing.sides[1]
    apart = second.face.points(second.facet, second.t) - pairing.points
    mesh, paths = on_root(comm, lambda: _ways(system))
    nothing = np.zeros(3)
    return WornGeometry(
        points=mesh.points,
        directions=tuple(path.directions for path in paths),
        held=tuple(path.held for path in paths),
        at=along(pairing),
        depth=np.zeros((2, len(pairing.weights))),
        lacking=pairing.gap - np.einsum("ni,ni->n", pairing.normals, apart),
        holder=(nothing, nothing),
        lost=np.zeros(2),
        updates=0,
        quality=float(scaled_jacobians(mesh).min()),
        volume_error=0.0,
    )


def _ways(system: System) -> tuple[TaggedMesh, list[Paths]]:
    """The unworn mesh, and how the nodes of its faces may go."""
    mesh = system.case.tagged_mesh(system.inputs.zone)
    paths = []
    for index, side in enumerate(system.pairing.sides):
        assert isinstance(side.face, Face)
        directions = node_normals(side.face)
        held = np.zeros(len(directions), dtype=bool)
        body = movable_body(system, mesh, index)
        for end, outline in zip((0, -1), body.sides, strict=True):
            held[end] = not outline.is_corner
            if outline.is_corner:
                directions[end] = -outline.inward
        paths.append(Paths(directions, held))
    return mesh, paths


def movable_body(system: System, mesh: TaggedMesh, index: int) -> MovableBody:
    """A body of the mesh of a system."""
    geometry, face = system.case.geometry, system.pairing.sides[index].face
    assert isinstance(face, Face)
    return MovableBody(mesh, geometry.parts_of(geometry.bodies[index]), nodes_of(face))


def _curvature(face) -> float:
    """The largest of a face [1/m]."""
    assert isinstance(face, Face)
    return float(curvatures(face).max())


def _thickness(system: System, index: int) -> float:
    """How far a body reaches behind the middle of its contact face; every rank calls [m]."""
    pairing, geometry, bodies = system.pairing, system.case.geometry, system.bodies
    out = (pairing.weights @ pairing.normals) * (1 if index == 0 else -1)
    out = out / np.linalg.norm(out)
    middle = np.average(pairing.points, axis=0, weights=pairing.weights)
    parts = geometry.parts_of(geometry.bodies[index])
    cells = np.concatenate([bodies.cell_tags.find(bodies.body_tag(part)) for part in parts])
    nodes = bodies.mesh.geometry.x[geometry_dofmap(bodies.mesh)[cells].ravel(), : len(middle)]
    return max(system.comm.allgather(float(((middle - nodes) @ out).max(initial=0.0))))
