"""Thickness of the bodies behind their worn faces, and what wear has left of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...contact.wear.worn_face import directions_between, nodes_of
from ...geometry.checks.mesh_checks import length
from ...geometry.mesh.mixed import AnyMesh, block_of
from ...geometry.mesh.nodes import boundary, shape_functions
from ...geometry.moving.moved import cells_of, nodes_at
from ...parallel import on_root
from ..results.cell_grids import GRIDS
from ..system.system import System
from .moving_faces import FaceKey, MovingFaces, node_paths, parts_behind

_THIN = 0.1
"""Part of the unworn thickness below which the remaining one does not count less."""
_DEEP = 0.02
"""Depth, relative to the thickness behind the middle of a face, from which rays are cast."""
_NOTHING = 2e-3
"""Part of the thickness whose loss counts as that of all."""
_RAYS, _AT_ONCE = 500, 16
"""Largest number of rays from a face; number of those compared with all facets together."""
_GRAZING = 0.05
"""Least cosine between a ray and the normal of a facet through which it leaves the body."""
_FINE = 4
"""Number of straight parts of a curved edge."""


def thicknesses(system: System, keys: Iterable[FaceKey]) -> list[dict[int, float]]:
    """Thickness behind the worn faces of each interface, by side [m]; every rank calls.

    Faces of one body share it equally, as a disk becomes thinner by the wear of both of its faces.
    What is left of a thin wall counts as a tenth of the unworn one, as it is soon worn through.
    """
    bodies = {key: system.contacts.bodies[key[0]][key[1]] for key in keys}
    of_body, found = list(bodies.values()), [dict[int, float]() for _ in system.contacts.each]
    for (index, side), body in bodies.items():
        left = _thickness_behind(system, (index, side)) / of_body.count(body)
        worn = float(system.moved[side, system.contacts.ranges[index]].max(initial=0.0))
        found[index][side] = max(left, _THIN * (left + worn))
    return found


def _thickness_behind(system: System, key: FaceKey) -> float:
    """Thickness of a body behind the middle of a contact face [m]; every rank calls."""
    bodies, (index, side) = system.bodies, key
    pairing = system.contacts.each[index]
    out = (pairing.weights @ pairing.normals) * (1 if side == 0 else -1)
    out = out / np.linalg.norm(out)
    middle = np.average(pairing.points, axis=0, weights=pairing.weights)
    mesh = bodies.each[pairing.sides[side].face.body].mesh
    nodes = mesh.geometry.x[:, : len(middle)]
    return max(system.comm.allgather(float(((middle - nodes) @ out).max(initial=0.0))))


@dataclass(frozen=True)
class Thinnest:
    """Place where wear has left the smallest part of a body.

    Attributes
    ----------
    left : float
        Thickness left, relative to the unworn one; infinite while wear is not deep.
    body : str
        Name of the body.
    thickness : float
        Unworn thickness there [m].
    place : tuple of float
        Coordinates on the worn face [m].
    """

    left: float = np.inf
    body: str = ""
    thickness: float = 0.0
    place: tuple[float, ...] = ()

    @property
    def is_through(self) -> bool:
        """Whether the body is worn through here."""
        return self.left <= _NOTHING

    def step_to_end(self, before: Thinnest, step: float) -> float:
        """Size of a step from here, or from before it if this one went too far, to the end [s].

        By the mean rate in a step of a given size.
        """
        lost = min(before.left, 1.0) - self.left
        begin = min(before.left, 1.0) if self.left < 0.0 else self.left
        return step * (begin - _NOTHING / 2) / lost if lost > 0.0 and begin < np.inf else np.inf

    def text(self, time: float) -> str:
        """Note that the body is worn through at a time [s]."""
        at = ", ".join(
            f"{name} = {value:.4g}" for name, value in zip("xyz", self.place, strict=False)
        )
        return (
            f"wear: {self.body} is worn through at t = {time:.6g} s, at {at} m: of its thickness "
            f"of {length(self.thickness)} there, {max(self.left, 0.0):.1%} is left; the run ends"
        )


class Walls:
    """Thickness of the bodies behind their faces worn in place, in the meshes of a system.

    Measured from each contact point along the path on which the nodes of its face move.

    Parameters
    ----------
    system : System
    faces : MovingFaces
    """

    def __init__(self, system: System, faces: MovingFaces):
        self._system, self._rows = system, faces.rows
        middle = thicknesses(system, self._rows)
        self._deep = {key: _DEEP * middle[key[0]][key[1]] for key in self._rows}
        self._behind: dict[FaceKey, tuple[np.ndarray, np.ndarray]] | None = None

    def thinnest(self, depth: np.ndarray) -> Thinnest:
        """Smallest part left behind depths (2, n) of the faces [m]. Every rank calls."""
        if not any((depth[own] > self._deep[key]).any() for key, own in self._rows.items()):
            return Thinnest()
        if self._behind is None:
            self._behind = on_root(self._system.comm, self._measured)
        kept = depth - self._system.moved
        each = [self._of_face(key, depth[own], kept) for key, own in self._rows.items()]
        return min(each, key=lambda one: one.left)

    def _of_face(self, key: FaceKey, depth: np.ndarray, kept: np.ndarray) -> Thinnest:
        assert self._behind is not None
        system, (index, side) = self._system, key
        behind, far = self._behind[key]
        left = behind - kept[self._rows[key]]
        for other, own in self._rows.items():  # a disk is worn from both of its sides
            if other != key and parts_behind(system, other) == parts_behind(system, key):
                there = system.contacts.each[other[0]].points
                tree = cKDTree(there)
                apart, nearest = tree.query(far)
                spacing = tree.query(there, k=2)[0][:, 1].max()
                left = left - np.where(apart <= spacing, kept[own][nearest], 0.0)
        whole = behind - kept[self._rows[key]] + depth
        part = np.where(np.isfinite(whole), left / np.where(np.isfinite(whole), whole, 1.0), np.inf)
        k = int(np.argmin(part))
        place = tuple(float(x) for x in system.contacts.each[index].points[k])
        body = system.model.bodies[system.contacts.bodies[index][side]].name
        return Thinnest(float(part[k]), body, float(whole[k]), place)

    def _measured(self) -> dict[FaceKey, tuple[np.ndarray, np.ndarray]]:
        """Thickness (n_own,) behind each face, and places (n_own, gdim) at its far side [m]."""
        system = self._system
        worn, found = system.worn, {}
        if worn is None:
            mesh, paths = node_paths(system)
            directions = [tuple(path.directions for path in pair) for pair in paths]
        else:
            mesh, directions = worn.mesh, [contact.directions for contact in worn.contacts]
        for key in self._rows:
            index, side = key
            pairing = system.contacts.each[index]
            recession = np.array([side == 0, side == 1], dtype=float)
            out = directions_between(pairing.sides, directions[index], recession)
            inward = -out if side == 0 else out
            paired = pairing.sides[side]
            starts = paired.face.points(paired.facet, paired.t)
            some = np.unique(np.linspace(0, len(starts) - 1, _RAYS).round().astype(int))
            nearest = some[cKDTree(starts[some]).query(starts)[1]]
            lengths = np.full(len(starts), np.inf)
            lengths[some] = _lengths(_behind(system, mesh, key), starts[some], inward[some])
            lengths = lengths[nearest]
            far = starts + np.where(np.isfinite(lengths), lengths, 0.0)[:, None] * inward
            along = np.abs(np.einsum("ni,ni->n", inward, pairing.normals))
            found[key] = lengths * along, far
        return found


def thickness_at(system: System, key: FaceKey, point: int) -> float:
    """Thickness of a body along the normal at a point of one of its faces [m]. Every rank calls."""
    side = system.contacts.each[key[0]].sides[key[1]]
    facet, t = side.facet[point : point + 1], side.t[point : point + 1]
    start, inward = side.face.points(facet, t), -side.face.normals(facet, t)

    def cast() -> float:
        worn = system.worn
        mesh = system.model.meshes.mesh(system.zone) if worn is None else worn.mesh
        return float(_lengths(_behind(system, mesh, key), start, inward)[0])

    return on_root(system.comm, cast)


def _behind(system: System, mesh: AnyMesh, key: FaceKey) -> np.ndarray:
    """Straight pieces of the boundary of a body without one of its faces, (n, gdim, gdim) [m]."""
    parts = parts_behind(system, key)
    block, face = block_of(mesh, *parts), system.contacts.each[key[0]].sides[key[1]].face
    own = nodes_at(block, parts, nodes_of(face))
    facets = boundary(block.cell_type, block.order, cells_of(block, parts))
    facets = block.points[facets[~np.isin(facets, own).all(axis=1)]]
    kind, fine = block.facet_type, 1 if block.order == 1 else _FINE
    if facets.shape[2] == 2:
        at = np.linspace(0.0, 1.0, fine + 1)[:, None]
        pieces = np.column_stack([np.arange(fine), np.arange(fine) + 1])
    else:
        at, pieces = GRIDS[kind](fine)
        if kind == "quadrilateral":
            pieces = np.vstack([pieces[:, [0, 1, 2]], pieces[:, [0, 2, 3]]])
    points = np.einsum("qk,fki->fqi", shape_functions(kind, block.order, at), facets)
    return points[:, pieces].reshape(-1, *pieces.shape[1:], facets.shape[2])


def _lengths(pieces: np.ndarray, starts: np.ndarray, ways: np.ndarray) -> np.ndarray:
    """Lengths of rays inside a body, up to straight pieces of its boundary, shape (n,) [m]."""
    corner, edges = pieces[:, 0], pieces[:, 1:] - pieces[:, :1]
    in_space = edges.shape[1] == 2
    normals = np.cross(edges[:, 0], edges[:, 1]) if in_space else edges[:, 0, ::-1] * [1, -1]
    sizes = np.linalg.norm(normals, axis=1)
    solid = sizes > 0.0
    corner, edges, normals = corner[solid], edges[solid], normals[solid] / sizes[solid, None]
    inverse = np.linalg.solve(edges @ edges.mT, edges)
    found = []
    for few in np.array_split(np.arange(len(starts)), -(-len(starts) // _AT_ONCE)):
        start, way = starts[few, None], ways[few]
        across = way @ normals.T
        across = np.where(np.abs(across) > _GRAZING, across, np.nan)
        way_to = np.einsum("rfi,fi->rf", corner - start, normals) / across
        hit = start + way_to[..., None] * way[:, None] - corner
        at = np.einsum("rfi,fki->rfk", hit, inverse)
        inside = (at >= -1e-9).all(axis=2) & (at.sum(axis=2) <= 1 + 1e-9) & (way_to > 0.0)
        found.append(np.where(inside, way_to, np.inf).min(axis=1))
    return np.concatenate(found)
